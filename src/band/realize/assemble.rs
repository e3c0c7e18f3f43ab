//! The outlines of placed pieces are linked to closed contours, and contours are grouped to
//! polygons with holes (Zhou 2014, section 4.3). What comes out is counted again in `shape`.

use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::polygon::signed_area;
use fretwork_geometry::{Bounds, Point, Polygon, Ring};

use super::placed::Placed;
use crate::exemplar::piece::{Port, Side};

/// How outlines become rings.
pub struct Linking<'a> {
    /// The length of the loop at whose end the last piece is joined to the first. Without it every
    /// open portal is closed by a straight edge.
    pub period: Option<f64>,
    /// Adds the points where the edge between two points is divided. On a loop they may lie before
    /// 0 or beyond its length.
    pub divide: &'a dyn Fn(Point, Point, &mut Vec<Point>),
    /// Where points go in the end. The map keeps the interior on the left.
    pub map: &'a dyn Fn(Point) -> Point,
}

/// The polygons of pieces that follow one another.
pub fn assemble(placed: &[Placed], linking: &Linking) -> Vec<Polygon> {
    let index = Index::new(placed);
    let mut ring_of = vec![usize::MAX; index.len()];
    let mut rings: Vec<Ring> = Vec::new();
    for start in 0..index.len() {
        if ring_of[start] != usize::MAX {
            continue;
        }
        let mut points = Vec::new();
        // How far the outline has gone round the loop.
        let mut round = 0.0;
        let mut at = start;
        while ring_of[at] == usize::MAX {
            ring_of[at] = rings.len();
            let (k, c) = index.outline(at);
            let shift = Point::new(round, 0.0);
            points.extend(placed[k].chains[c].points.iter().map(|&p| p + shift));
            let (next, turns) = index.after(placed, at, linking.period.is_some());
            round += turns * linking.period.unwrap_or(0.0);
            at = next;
        }
        rings.push(linking.image(points, round));
    }
    let mut sets = UnionFind::new(rings.len());
    for (a, b) in index.portals(placed) {
        sets.unite(ring_of[a] as u32, ring_of[b] as u32);
    }
    let numbers = 0..rings.len() as u32;
    let components: Vec<usize> = numbers.map(|i| sets.find(i) as usize).collect();
    let loose = placed
        .iter()
        .flat_map(|p| &p.rings)
        .map(|r| linking.image(r.clone(), 0.0))
        .collect();
    group(rings, &components, loose)
}

impl Linking<'_> {
    /// The ring of these points, divided and mapped. It closes where the first point comes again,
    /// `round` farther along the curve.
    fn image(&self, mut points: Vec<Point>, round: f64) -> Ring {
        // Outlines meet in a common point, up to the rounding of its place along the curve. Without
        // this, a ring could turn back between two points that are one.
        let farthest = || {
            points
                .iter()
                .map(|p| p.x.abs().max(p.y.abs()))
                .fold(0.0, f64::max)
        };
        let size = self.period.unwrap_or_else(farthest);
        let same = |a: &Point, b: &Point| a.distance(*b) <= 1e-12 * size;
        points.dedup_by(|b, a| same(a, b));
        let end = points[0] + Point::new(round, 0.0);
        while points.len() > 1 && same(&points[points.len() - 1], &end) {
            points.pop();
        }
        let mut ring = Vec::with_capacity(points.len());
        for (i, &p) in points.iter().enumerate() {
            ring.push(p);
            (self.divide)(p, points.get(i + 1).copied().unwrap_or(end), &mut ring);
        }
        let mut ring: Ring = ring.into_iter().map(self.map).collect();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    }
}

/// Which chain begins where.
struct Index {
    /// The number of the first chain of each piece.
    base: Vec<usize>,
    /// For each piece, the chains by the ports where they begin, in order.
    starts: Vec<Vec<(Port, usize)>>,
}

impl Index {
    fn new(placed: &[Placed]) -> Index {
        let mut base = vec![0];
        let mut starts = Vec::with_capacity(placed.len());
        for piece in placed {
            base.push(base[base.len() - 1] + piece.chains.len());
            let mut list: Vec<(Port, usize)> = piece
                .chains
                .iter()
                .enumerate()
                .map(|(i, c)| (c.from, i))
                .collect();
            list.sort_unstable();
            starts.push(list);
        }
        Index { base, starts }
    }

    fn len(&self) -> usize {
        self.base[self.base.len() - 1]
    }

    /// The piece and the chain with this number.
    fn outline(&self, number: usize) -> (usize, usize) {
        let k = self.base.partition_point(|&b| b <= number) - 1;
        (k, number - self.base[k])
    }

    /// The number of the chain that begins at a port of piece `k`.
    fn starting(&self, k: usize, port: Port) -> Option<usize> {
        let list = &self.starts[k];
        let i = list.binary_search_by_key(&port, |s| s.0).ok()?;
        Some(self.base[k] + list[i].1)
    }

    /// The chain after this one, and how many times round the loop the way to it leads.
    fn after(&self, placed: &[Placed], number: usize, closed: bool) -> (usize, f64) {
        let (k, c) = self.outline(number);
        let n = placed.len();
        let (side, end) = placed[k].chains[c].to;
        let (across, turns) = match side {
            Side::Right if k + 1 < n => (self.starting(k + 1, (Side::Left, end)), 0.0),
            Side::Right if closed => (self.starting(0, (Side::Left, end)), 1.0),
            Side::Left if k > 0 => (self.starting(k - 1, (Side::Right, end)), 0.0),
            Side::Left if closed => (self.starting(n - 1, (Side::Right, end)), -1.0),
            _ => (None, 0.0),
        };
        match across {
            Some(next) => (next, turns),
            // The portal is open: the outline goes on at its other end.
            None => (self.starting(k, (side, end ^ 1)).unwrap_or(number), 0.0),
        }
    }

    /// The chains at the lower and upper end of every portal: they bound the same component.
    fn portals(&self, placed: &[Placed]) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for (k, piece) in placed.iter().enumerate() {
            for (c, chain) in piece.chains.iter().enumerate() {
                // The other chain begins at the other end of the portal in which this one ends.
                if let Some(other) = self.starting(k, (chain.to.0, chain.to.1 ^ 1)) {
                    pairs.push((self.base[k] + c, other));
                }
            }
        }
        pairs
    }
}

/// The polygons of linked `rings`, whose components are known, and of `loose` rings, which lie
/// within one piece. A loose outer ring is a polygon of its own; a loose hole belongs to the
/// smallest polygon round it.
fn group(rings: Vec<Ring>, components: &[usize], loose: Vec<Ring>) -> Vec<Polygon> {
    let mut polygons: Vec<Polygon> = vec![Polygon::default(); rings.len()];
    for (ring, &component) in rings.into_iter().zip(components) {
        if signed_area(&ring) > 0.0 {
            polygons[component].outer = ring;
        } else {
            polygons[component].holes.push(ring);
        }
    }
    polygons.retain(|p| !p.outer.is_empty() || !p.holes.is_empty());
    let (outer, holes): (Vec<Ring>, Vec<Ring>) =
        loose.into_iter().partition(|ring| signed_area(ring) > 0.0);
    polygons.extend(outer.into_iter().map(|outer| Polygon {
        outer,
        holes: Vec::new(),
    }));
    let sizes: Vec<(f64, Bounds)> = polygons
        .iter()
        .map(|p| (signed_area(&p.outer), p.bounds()))
        .collect();
    for hole in holes {
        let round = |i: &usize| {
            sizes[*i].1.contains(hole[0])
                && Polygon {
                    outer: polygons[*i].outer.clone(),
                    holes: vec![],
                }
                .contains(hole[0])
        };
        let host = (0..polygons.len())
            .filter(round)
            .min_by(|&a, &b| sizes[a].0.total_cmp(&sizes[b].0));
        if let Some(host) = host {
            polygons[host].holes.push(hole);
        }
    }
    polygons
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exemplar::piece::cut;
    use fretwork_geometry::topology;

    const OPEN: Linking = Linking {
        period: None,
        divide: &|_, _, _| {},
        map: &|p| p,
    };

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    /// A frame with an island, cut into three and put together again.
    fn placed() -> Vec<Placed> {
        let contours = [
            ring(&[[0., -2.], [12., -2.], [12., 2.], [0., 2.]]),
            ring(&[[2., -1.], [2., 1.], [10., 1.], [10., -1.]]),
            ring(&[[5., -0.5], [7., -0.5], [7., 0.5], [5., 0.5]]),
        ];
        let pieces = cut(&contours, 12.0, &[4.0, 8.0]).unwrap();
        let shift = |mut p: Placed, by: f64| {
            let points = p
                .chains
                .iter_mut()
                .flat_map(|c| &mut c.points)
                .chain(p.rings.iter_mut().flatten());
            points.for_each(|q| q.x += by);
            p
        };
        let placed = pieces.into_iter().map(|p| Placed {
            chains: p.chains,
            rings: p.rings,
            span: [0.0, 4.0],
        });
        placed
            .zip([0.0, 4.0, 8.0])
            .map(|(p, by)| shift(p, by))
            .collect()
    }

    #[test]
    fn pieces_become_the_whole_again() {
        let polygons = assemble(&placed(), &OPEN);
        let counts = topology::count(&polygons).unwrap();
        assert_eq!((counts.components, counts.holes), (2, 1));
        assert_eq!(
            polygons.iter().map(Polygon::area).sum::<f64>(),
            12.0 * 4.0 - 8.0 * 2.0 + 2.0
        );
    }

    #[test]
    fn open_portals_are_closed_by_an_edge() {
        let polygons = assemble(&placed()[1..2], &OPEN);
        assert_eq!(polygons.len(), 3);
        assert_eq!(topology::count(&polygons).unwrap().holes, 0);
    }

    #[test]
    fn edges_are_divided_before_they_are_mapped() {
        let halve = |a: Point, b: Point, out: &mut Vec<Point>| out.push(a.lerp(b, 0.5));
        let polygons = assemble(
            &placed(),
            &Linking {
                divide: &halve,
                ..OPEN
            },
        );
        let whole = assemble(&placed(), &OPEN);
        let count = |p: &[Polygon]| {
            p.iter()
                .flat_map(Polygon::rings)
                .map(Vec::len)
                .sum::<usize>()
        };
        assert_eq!(count(&polygons), 2 * count(&whole));
    }

    #[test]
    fn a_loop_of_one_piece_goes_round() {
        let stripe = [ring(&[[0., -1.], [10., -1.], [10., 1.], [0., 1.]])];
        let middle = cut(&stripe, 10.0, &[2.0, 8.0]).unwrap().remove(1);
        let placed = [Placed {
            chains: middle.chains,
            rings: middle.rings,
            span: [0.0, 6.0],
        }];
        let map = |p: Point| fretwork_geometry::cutout::roll(p.x, p.y, 5.0, 6.0);
        let divide = |a: Point, b: Point, out: &mut Vec<Point>| {
            out.extend((1..60).map(|i| a.lerp(b, f64::from(i) / 60.0)))
        };
        let polygons = assemble(
            &placed,
            &Linking {
                period: Some(6.0),
                divide: &divide,
                map: &map,
            },
        );
        let counts = topology::count(&polygons).unwrap();
        assert_eq!((counts.components, counts.holes), (1, 1));
    }
}
