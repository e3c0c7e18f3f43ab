//! Pieces of an exemplar between two cuts (Zhou 2014, section 3.3): their outlines, portals,
//! tangents and descriptors. Where the cuts are made is decided in `slicing`.

use fretwork_geometry::polygon::signed_area;
use fretwork_geometry::{Bounds, Point, Ring};

use super::descriptor::Descriptor;

/// One end of a portal: where the outline passes a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Endpoint {
    /// The place along the cut.
    pub v: f64,
    /// The outline's direction there, of length one, toward larger u.
    pub tangent: Point,
}

/// A side of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// That of smaller u.
    Left,
    /// That of larger u.
    Right,
}

/// A place on a side of a piece: the number of an endpoint, counted from below upward. Portal k
/// has the endpoints 2k and 2k + 1.
pub type Port = (Side, u16);

/// A part of the outline from port to port, the interior on its left.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Two or more points, the first and the last on the cuts.
    pub points: Vec<Point>,
    /// Where it begins.
    pub from: Port,
    /// Where it ends.
    pub to: Port,
}

/// A part of an exemplar between two cuts. u counts from its left cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The distance between its cuts.
    pub width: f64,
    /// The box of its outlines, which may end before a cut where it has no portal.
    pub bounds: Bounds,
    /// The open outlines.
    pub chains: Vec<Chain>,
    /// The closed outlines: components that reach no cut, and holes.
    pub rings: Vec<Ring>,
    /// The ends of the portals on the left, from below upward.
    pub left: Vec<Endpoint>,
    /// The ends of the portals on the right.
    pub right: Vec<Endpoint>,
    /// How the portals belong together.
    pub descriptor: Descriptor,
}

impl Piece {
    /// Whether it changes no topology: every portal on the left leads to its counterpart on the
    /// right, and nothing else is there.
    pub fn is_trivial(&self) -> bool {
        let d = &self.descriptor;
        let straight = d.left == d.right && d.open_components() == d.left.len();
        straight && (d.components, d.holes) == (0, 0)
    }

    /// The piece of these outlines, whose ports are the ends of `left` and `right`.
    pub fn of_outlines(
        width: f64,
        mut chains: Vec<Chain>,
        rings: Vec<Ring>,
        [left, right]: [Vec<Endpoint>; 2],
    ) -> Piece {
        chains.sort_by_key(|c| c.from);
        let points = chains
            .iter()
            .flat_map(|c| &c.points)
            .chain(rings.iter().flatten());
        let bounds = Bounds::of(points.copied());
        let descriptor = describe(&chains, &rings, left.len(), right.len());
        Piece {
            width,
            bounds,
            chains,
            rings,
            left,
            right,
            descriptor,
        }
    }

    /// The width of the narrowest portal on the left.
    pub fn narrowest_left_portal(&self) -> f64 {
        self.left
            .chunks(2)
            .map(|p| p[1].v - p[0].v)
            .fold(f64::INFINITY, f64::min)
    }
}

/// Why contours cannot be cut at a place.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CutError {
    /// A vertex lies on the cut, or two outlines meet there.
    #[error("the outline has a corner on the cut at {0}")]
    Corner(f64),
}

/// The pieces of `contours` (the interior on their left) between `cuts`, which ascend and lie
/// strictly inside (0, width).
///
/// # Errors
/// [`CutError`] where a cut does not pass the outline cleanly; a cut beside it will.
pub fn cut(contours: &[Ring], width: f64, cuts: &[f64]) -> Result<Vec<Piece>, CutError> {
    let clear = 1e-9 * width;
    for p in contours.iter().flatten() {
        let next = cuts.partition_point(|&c| c < p.x - clear);
        if cuts.get(next).is_some_and(|c| (c - p.x).abs() <= clear) {
            return Err(CutError::Corner(cuts[next]));
        }
    }
    let mut parts: Vec<Outlines> = (0..=cuts.len()).map(|_| Outlines::default()).collect();
    let mut crossings: Vec<Vec<Endpoint>> = vec![Vec::new(); cuts.len()];
    for contour in contours {
        distribute(contour, cuts, &mut crossings, &mut parts);
    }
    let ranks = crossings
        .iter_mut()
        .zip(cuts)
        .map(|(list, &c)| rank(list, clear).ok_or(CutError::Corner(c)))
        .collect::<Result<Vec<_>, _>>()?;
    let mut pieces = Vec::with_capacity(parts.len());
    for (i, part) in parts.into_iter().enumerate() {
        let span = [
            if i == 0 { 0.0 } else { cuts[i - 1] },
            cuts.get(i).copied().unwrap_or(width),
        ];
        let sides = [
            if i == 0 { None } else { Some(i - 1) },
            (i < cuts.len()).then_some(i),
        ];
        let ends = |s: usize| sides[s].map_or(Vec::new(), |cut| crossings[cut].clone());
        let port = |(cut, index): Crossing| -> Port {
            let side = if sides[0] == Some(cut) {
                Side::Left
            } else {
                Side::Right
            };
            (side, ranks[cut][index])
        };
        pieces.push(part.finish(span, ends(0), ends(1), port));
    }
    Ok(pieces)
}

/// A crossing of the outline with a cut: the cut, and its number there.
type Crossing = (usize, usize);

/// The outlines of one piece while contours are distributed.
#[derive(Default)]
struct Outlines {
    /// Points, with the crossings where they begin and end.
    chains: Vec<(Vec<Point>, Crossing, Crossing)>,
    rings: Vec<Ring>,
}

/// Distributes one contour over the pieces and notes where it passes the cuts.
fn distribute(
    contour: &Ring,
    cuts: &[f64],
    crossings: &mut [Vec<Endpoint>],
    parts: &mut [Outlines],
) {
    let slab = |p: Point| cuts.partition_point(|&c| c < p.x);
    let n = contour.len();
    let Some(first) = (0..n).find(|&i| slab(contour[i]) != slab(contour[(i + 1) % n])) else {
        if let Some(&p) = contour.first() {
            parts[slab(p)].rings.push(contour.clone());
        }
        return;
    };
    let mut open: Option<(Vec<Point>, Crossing)> = None;
    // The first edge is visited twice: its crossings begin the first outline and end the last one.
    let mut first_crossing = 0;
    for step in 0..=n {
        let (a, b) = (contour[(first + step) % n], contour[(first + step + 1) % n]);
        let (from, to) = (slab(a), slab(b));
        let passed: Vec<usize> = if from < to {
            (from..to).collect()
        } else {
            (to..from).rev().collect()
        };
        for &cut in &passed {
            let crossing = if step == n {
                (cut, first_crossing)
            } else {
                let number = crossings[cut].len();
                crossings[cut].push(endpoint(a, b, cuts[cut]));
                (cut, number)
            };
            let at = Point::new(cuts[cut], crossings[crossing.0][crossing.1].v);
            let inside = if from < to { cut } else { cut + 1 };
            if let Some((mut points, begun)) = open.take() {
                points.push(at);
                parts[inside].chains.push((points, begun, crossing));
            }
            open = Some((vec![at], crossing));
            if step == n {
                return;
            }
        }
        if step == 0 {
            first_crossing = passed.first().map_or(0, |&cut| crossings[cut].len() - 1);
        }
        if let Some((points, _)) = &mut open {
            points.push(b);
        }
    }
}

fn endpoint(a: Point, b: Point, u: f64) -> Endpoint {
    let d = if b.x > a.x { b - a } else { a - b };
    Endpoint {
        v: a.y + (b.y - a.y) * ((u - a.x) / (b.x - a.x)),
        tangent: d * (1.0 / d.length()),
    }
}

/// Sorts the crossings of a cut upward and returns the new number of each; none when two of them
/// are no more than `clear` apart.
fn rank(crossings: &mut [Endpoint], clear: f64) -> Option<Vec<u16>> {
    let mut order: Vec<usize> = (0..crossings.len()).collect();
    order.sort_by(|&i, &j| crossings[i].v.total_cmp(&crossings[j].v));
    let sorted: Vec<Endpoint> = order.iter().map(|&i| crossings[i]).collect();
    crossings.copy_from_slice(&sorted);
    let mut ranks = vec![0u16; order.len()];
    for (rank, &i) in order.iter().enumerate() {
        ranks[i] = u16::try_from(rank).ok()?;
    }
    let apart = sorted.windows(2).all(|w| w[1].v - w[0].v > clear);
    (apart && sorted.len().is_multiple_of(2)).then_some(ranks)
}

impl Outlines {
    fn finish(
        self,
        span: [f64; 2],
        left: Vec<Endpoint>,
        right: Vec<Endpoint>,
        port: impl Fn(Crossing) -> Port,
    ) -> Piece {
        let local = |p: &mut Point| p.x -= span[0];
        let chains: Vec<Chain> = self
            .chains
            .into_iter()
            .map(|(mut points, from, to)| {
                points.iter_mut().for_each(local);
                points.dedup();
                Chain {
                    points,
                    from: port(from),
                    to: port(to),
                }
            })
            .collect();
        let mut rings = self.rings;
        rings.iter_mut().flatten().for_each(local);
        Piece::of_outlines(span[1] - span[0], chains, rings, [left, right])
    }
}

/// The descriptor of a piece. Its components are the cycles that chains and portals form, and the
/// closed outlines that run counter-clockwise. The other closed outlines are its holes; a hole that
/// reaches a cut is not yet one.
fn describe(chains: &[Chain], rings: &[Ring], left: usize, right: usize) -> Descriptor {
    let slot = |(side, k): Port| k as usize + if side == Side::Left { 0 } else { left };
    let mut component = vec![u16::MAX; left + right];
    let mut after = vec![None; left + right];
    for chain in chains {
        after[slot(chain.from)] = Some(chain.to);
    }
    let mut components = 0;
    for start in 0..left + right {
        if component[start] != u16::MAX {
            continue;
        }
        let mut at = start;
        while component[at] == u16::MAX {
            component[at] = components;
            let (side, k) = if at < left {
                (Side::Left, at)
            } else {
                (Side::Right, at - left)
            };
            // Chains begin at the lower ends of left portals and at the upper ends of right ones.
            let begins = (side == Side::Left) == k.is_multiple_of(2);
            at = match after[at] {
                Some(to) if begins => slot(to),
                _ => slot((side, (k ^ 1) as u16)),
            };
        }
        components += 1;
    }
    let components_of = |range: std::ops::Range<usize>| -> Vec<u16> {
        component[range].iter().step_by(2).copied().collect()
    };
    let islands = rings.iter().filter(|ring| signed_area(ring) > 0.0).count();
    Descriptor::new(
        &components_of(0..left),
        &components_of(left..left + right),
        islands as u32,
        (rings.len() - islands) as u32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    /// A frame, 10 by 4 with a hole from 2 to 8, and an island in the hole.
    fn frame() -> Vec<Ring> {
        vec![
            ring(&[[0., -2.], [10., -2.], [10., 2.], [0., 2.]]),
            ring(&[[2., -1.], [2., 1.], [8., 1.], [8., -1.]]),
            ring(&[[4., -0.5], [6., -0.5], [6., 0.5], [4., 0.5]]),
        ]
    }

    #[test]
    fn a_frame_splits_and_merges() {
        let pieces = cut(&frame(), 10.0, &[3.0, 5.0, 7.0]).unwrap();
        let descriptors: Vec<_> = pieces.iter().map(|p| p.descriptor.clone()).collect();
        assert_eq!(descriptors[0], Descriptor::new(&[], &[0, 0], 0, 0));
        assert_eq!(descriptors[1], Descriptor::new(&[0, 1], &[0, 2, 1], 0, 0));
        assert_eq!(descriptors[2], Descriptor::new(&[0, 1, 2], &[0, 2], 0, 0));
        let whole = descriptors[1..]
            .iter()
            .fold(descriptors[0].clone(), |d, next| d.merge(next).unwrap());
        assert_eq!(whole, Descriptor::new(&[], &[], 2, 1));
        assert_eq!(
            pieces[0].right.iter().map(|e| e.v).collect::<Vec<_>>(),
            [-2.0, -1.0, 1.0, 2.0]
        );
        assert_eq!(pieces[1].chains[0].from, (Side::Left, 0));
        assert_eq!(
            pieces[1].chains[0].points,
            [Point::new(0.0, -2.0), Point::new(2.0, -2.0)]
        );
        assert_eq!(pieces[1].narrowest_left_portal(), 1.0);
    }

    #[test]
    fn what_reaches_no_cut_is_counted() {
        let pieces = cut(&frame(), 10.0, &[1.0, 9.0]).unwrap();
        assert_eq!(pieces[1].descriptor, Descriptor::new(&[0], &[0], 1, 1));
        assert_eq!(
            cut(&frame(), 10.0, &[]).unwrap()[0].descriptor,
            Descriptor::new(&[], &[], 2, 1)
        );
        assert!(!pieces[1].is_trivial());
    }

    #[test]
    fn a_cut_through_a_corner_is_refused() {
        assert_eq!(cut(&frame(), 10.0, &[2.0]), Err(CutError::Corner(2.0)));
    }

    #[test]
    fn an_edge_across_several_cuts_is_cut_at_each() {
        let bar = vec![ring(&[[0., 0.], [9., 0.], [9., 1.], [0., 1.]])];
        let pieces = cut(&bar, 9.0, &[2.0, 4.0, 6.0]).unwrap();
        assert!(pieces[1].is_trivial() && pieces[2].is_trivial());
        assert!(pieces.iter().all(|p| p.chains.len()
            == if p.left.is_empty() || p.right.is_empty() {
                1
            } else {
                2
            }));
        assert_eq!(pieces[3].bounds.max.x, 3.0);
    }
}
