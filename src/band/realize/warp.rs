//! The gaps between the pieces of a sequence are closed (Zhou 2014, section 4.2). Which piece stands where is
//! known already; the outlines are linked to rings in `assemble`.
//!
//! A piece is moved by a map that keeps every line across the band on itself and in order: near a
//! seam it takes the endpoints of portals to the places that both sides share, and in between it
//! blends. Such a map cannot change the topology, whatever the misfit. Then the outlines are
//! turned near the seams until the tangents of both sides agree, by linear rotation-invariant deformation
//! (Lipman et al. 2005).

use fretwork_geometry::{Point, Ring};

use crate::exemplar::piece::{Chain, Endpoint, Piece, Side};
use crate::exemplar::seam::Seam;

/// The outlines of one piece in its place: x along the curve, y across it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placed {
    /// The open outlines.
    pub chains: Vec<Chain>,
    /// The closed outlines.
    pub rings: Vec<Ring>,
    /// Where the piece begins and ends.
    pub span: [f64; 2],
}

/// A sequence with everything that its geometry needs.
#[derive(Clone, Copy, Debug)]
pub struct Layout<'a> {
    /// The pieces of the exemplar.
    pub pieces: &'a [Piece],
    /// The numbers of those that follow one another.
    pub sequence: &'a [usize],
    /// The seam after each of them, also the one that closes a loop.
    pub seams: &'a [Seam],
    /// The offset of each of them.
    pub offsets: &'a [f64],
    /// The length of the curve, to which the pieces are stretched.
    pub length: f64,
    /// Whether the last is joined to the first.
    pub closed: bool,
}

/// Puts the pieces in place. `turned` says for each seam whether tangents are made to agree there.
pub fn stitch(layout: &Layout, turned: &[bool]) -> Vec<Placed> {
    let Layout {
        pieces,
        sequence,
        seams,
        offsets,
        ..
    } = *layout;
    let n = sequence.len();
    let total: f64 = sequence.iter().map(|&p| pieces[p].width).sum::<f64>()
        + seams.iter().map(|s| s.gap).sum::<f64>();
    let stretch = layout.length / total;
    let shared: Vec<Vec<f64>> = (0..seams.len()).map(|k| layout.shared(k)).collect();
    let free: Vec<f64> = Vec::new();
    let mut placed = Vec::with_capacity(n);
    let mut at = 0.0;
    for k in 0..n {
        let piece = &pieces[sequence[k]];
        let left = if k > 0 {
            &shared[k - 1]
        } else if layout.closed {
            &shared[n - 1]
        } else {
            &free
        };
        let right = shared.get(k).unwrap_or(&free);
        // The last end is the length itself, so that the seam of a loop meets exactly.
        let begin = at * stretch;
        at += piece.width;
        let end = if k + 1 == n && !layout.closed {
            layout.length
        } else {
            at * stretch
        };
        at += seams.get(k).map_or(0.0, |s| s.gap);
        let warp = Warp {
            span: [begin, end],
            width: piece.width,
            left: Fibre::new(&piece.left, left, offsets[k]),
            right: Fibre::new(&piece.right, right, offsets[k]),
        };
        placed.push(warp.apply(piece));
    }
    for (k, _) in seams.iter().enumerate().filter(|(k, _)| turned[*k]) {
        turn(&mut placed, k, (k + 1) % n, &shared[k]);
    }
    placed
}

impl Layout<'_> {
    /// The places of the endpoints at the seam after piece `k`: the means of both sides.
    fn shared(&self, k: usize) -> Vec<f64> {
        let next = (k + 1) % self.sequence.len();
        let (a, b) = (
            &self.pieces[self.sequence[k]],
            &self.pieces[self.sequence[next]],
        );
        let mean = |(r, l): (&Endpoint, &Endpoint)| {
            0.5 * (r.v + self.offsets[k] + l.v + self.offsets[next])
        };
        a.right.iter().zip(&b.left).map(mean).collect()
    }
}

/// An increasing map of a line across the band: linear between endpoints, a shift beyond them.
struct Fibre {
    from: Vec<f64>,
    to: Vec<f64>,
    shift: f64,
}

impl Fibre {
    fn new(ends: &[Endpoint], to: &[f64], shift: f64) -> Fibre {
        // The outer ends of an open pattern have no portals.
        let from: Vec<f64> = if to.is_empty() {
            Vec::new()
        } else {
            ends.iter().map(|e| e.v).collect()
        };
        Fibre {
            from,
            to: to.to_vec(),
            shift,
        }
    }

    fn map(&self, v: f64) -> f64 {
        let n = self.from.len();
        let after = self.from.partition_point(|&f| f <= v);
        match after {
            _ if n == 0 => v + self.shift,
            0 => v + (self.to[0] - self.from[0]),
            i if i == n => v + (self.to[n - 1] - self.from[n - 1]),
            i => {
                let t = (v - self.from[i - 1]) / (self.from[i] - self.from[i - 1]);
                self.to[i - 1] + (self.to[i] - self.to[i - 1]) * t
            }
        }
    }
}

/// The map of one piece.
struct Warp {
    span: [f64; 2],
    width: f64,
    left: Fibre,
    right: Fibre,
}

/// Edges are divided into parts of this share of the piece's width, where the map bends them.
const PARTS: f64 = 12.0;
/// Corners within this part of an edge of its end are there already.
const AT_END: f64 = 1e-6;

impl Warp {
    fn apply(&self, piece: &Piece) -> Placed {
        let chains = piece.chains.iter().map(|c| {
            let mut points = self.refine(c.points.iter().copied());
            // The ends are exactly where the other side has them.
            for (end, port) in [(0, c.from), (points.len() - 1, c.to)] {
                let (fibre, x) = if port.0 == Side::Left {
                    (&self.left, self.span[0])
                } else {
                    (&self.right, self.span[1])
                };
                if let Some(&y) = fibre.to.get(port.1 as usize) {
                    points[end] = Point::new(x, y);
                }
            }
            Chain {
                points,
                from: c.from,
                to: c.to,
            }
        });
        let rings = piece.rings.iter().map(|r| {
            let mut ring = self.refine(r.iter().chain(r.first()).copied());
            ring.pop();
            ring
        });
        Placed {
            chains: chains.collect(),
            rings: rings.collect(),
            span: self.span,
        }
    }

    fn map(&self, p: Point) -> Point {
        let t = (p.x / self.width).clamp(0.0, 1.0);
        // Level at both ends, so that tangents are not changed there.
        let blend = t * t * (3.0 - 2.0 * t);
        let (l, r) = (self.left.map(p.y), self.right.map(p.y));
        Point::new(
            self.span[0] + (self.span[1] - self.span[0]) * p.x / self.width,
            l + (r - l) * blend,
        )
    }

    /// The image of a polyline, divided where it bends.
    fn refine(&self, points: impl Iterator<Item = Point>) -> Vec<Point> {
        let mut image: Vec<Point> = Vec::new();
        let mut last: Option<Point> = None;
        for p in points {
            if let Some(q) = last {
                let mut cuts = self.divisions(q, p);
                cuts.sort_by(f64::total_cmp);
                // Corners of both fibre maps often stand in one place.
                cuts.dedup_by(|b, a| *b - *a < AT_END);
                image.extend(cuts.into_iter().map(|t| self.map(q.lerp(p, t))));
            }
            image.push(self.map(p));
            last = Some(p);
        }
        image
    }

    /// Where the edge from `p` to `q` is divided: at regular steps along the band, and where a fibre map has a corner.
    fn divisions(&self, p: Point, q: Point) -> Vec<f64> {
        let run = (q.x - p.x).abs() / self.width;
        let moved = |y: f64| (self.left.map(y) - self.right.map(y)).abs();
        let bend = moved(p.y).max(moved(q.y)) * run;
        let steps = if bend > 1e-6 * self.width {
            (run * PARTS).ceil().max(1.0) as usize
        } else {
            1
        };
        let mut cuts: Vec<f64> = (1..steps).map(|i| i as f64 / steps as f64).collect();
        if run > 1e-6 {
            // A corner at an end of the edge, up to rounding, would leave two points in one place.
            let inside = |t: &f64| *t > AT_END && *t < 1.0 - AT_END;
            let along = |y: &f64| (y - p.y) / (q.y - p.y);
            cuts.extend(
                self.left
                    .from
                    .iter()
                    .chain(&self.right.from)
                    .map(along)
                    .filter(inside),
            );
        }
        cuts
    }
}

/// Outlines turn over this many mean portal widths.
const REACH: f64 = 1.5;
/// Edges that a turn is spread over.
const TURN_STEPS: f64 = 8.0;
/// Greater differences of tangents are corners, and stay.
const LARGEST_TURN: f64 = 1.2;

/// Makes the tangents of the pieces `a` and `b` agree at their seam.
fn turn(placed: &mut [Placed], a: usize, b: usize, shared: &[f64]) {
    let portals = shared.len() / 2;
    let mean = shared.chunks(2).map(|p| p[1] - p[0]).sum::<f64>() / portals.max(1) as f64;
    for port in 0..shared.len() as u16 {
        let (Some(before), Some(after)) = (
            outline(&placed[a], Side::Right, port),
            outline(&placed[b], Side::Left, port),
        ) else {
            continue;
        };
        let (d, e) = (heading(&placed[a], before), heading(&placed[b], after));
        // Half the angle from the one to the other, for both.
        let half = 0.5 * libm::atan2(d.cross(e), d.dot(e));
        if half.abs() > 1e-9 && half.abs() < 0.5 * LARGEST_TURN {
            bend(
                &mut placed[a].chains[before.0].points,
                before.1,
                half,
                REACH * mean,
            );
            bend(
                &mut placed[b].chains[after.0].points,
                after.1,
                -half,
                REACH * mean,
            );
        }
    }
}

/// The chain that has this port, and whether it ends there.
fn outline(placed: &Placed, side: Side, port: u16) -> Option<(usize, bool)> {
    placed.chains.iter().enumerate().find_map(|(i, c)| {
        match (c.from == (side, port), c.to == (side, port)) {
            (true, _) => Some((i, false)),
            (_, true) => Some((i, true)),
            _ => None,
        }
    })
}

/// The direction of a chain at one of its ends, toward larger u.
fn heading(placed: &Placed, (chain, at_end): (usize, bool)) -> Point {
    let points = &placed.chains[chain].points;
    let n = points.len();
    let d = if at_end {
        points[n - 1] - points[n - 2]
    } else {
        points[1] - points[0]
    };
    let forward = if d.x < 0.0 { -d } else { d };
    forward * (1.0 / forward.length())
}

/// Turns a polyline by `angle` at one end, over `reach` at most; its ends and what is farther away stay.
///
/// Lipman's two systems, frames and then positions, with handles at both ends of the part that turns: among the
/// rotations a(s) that are `angle` at the end and 0 at the other, and that move neither, the least sum of squared
/// differences has a(s) = angle·(1 - s)(1 - 3 s). On an open polyline that is all there is to solve.
fn bend(points: &mut Vec<Point>, at_end: bool, angle: f64, reach: f64) {
    if at_end {
        points.reverse();
        bend(points, false, angle, reach);
        points.reverse();
        return;
    }
    let total: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let reach = reach.min(0.5 * total);
    let mut part = resampled(points, reach);
    let edges: Vec<Point> = part.windows(2).map(|w| w[1] - w[0]).collect();
    let mut at = 0.0;
    let mut moved = vec![part[0]];
    for edge in &edges {
        let length = edge.length();
        let s = (at + 0.5 * length) / reach;
        let a = angle * (1.0 - s) * (1.0 - 3.0 * s);
        let (sin, cos) = (libm::sin(a), libm::cos(a));
        let turned = Point::new(edge.x * cos - edge.y * sin, edge.x * sin + edge.y * cos);
        moved.push(moved[moved.len() - 1] + turned);
        at += length;
    }
    // What is left, of second order, is spread evenly.
    let last = part.len() - 1;
    let rest = part[last] - moved[last];
    let mut at = 0.0;
    for (i, edge) in edges.iter().enumerate() {
        at += edge.length();
        part[i + 1] = moved[i + 1] + rest * (at / reach).min(1.0);
    }
    let mut sum = 0.0;
    let kept = points.windows(2).position(|w| {
        sum += w[0].distance(w[1]);
        sum > reach
    });
    let kept = kept.map_or(points.len(), |i| i + 1);
    points.splice(..kept, part);
}

/// The beginning of a polyline up to the length `reach`, in short edges.
fn resampled(points: &[Point], reach: f64) -> Vec<Point> {
    let mut part = vec![points[0]];
    let mut left = reach;
    for w in points.windows(2) {
        let length = w[0].distance(w[1]);
        if left <= 0.0 || length == 0.0 {
            continue;
        }
        let end = w[0].lerp(w[1], (left / length).min(1.0));
        let steps = (length.min(left) / reach * TURN_STEPS).ceil().max(1.0) as usize;
        part.extend((1..=steps).map(|i| w[0].lerp(end, i as f64 / steps as f64)));
        left -= length;
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(v: &[f64]) -> Vec<Endpoint> {
        v.iter()
            .map(|&v| Endpoint {
                v,
                tangent: Point::new(1.0, 0.0),
            })
            .collect()
    }

    #[test]
    fn fibres_stay_in_order_and_meet_their_ends() {
        let fibre = Fibre::new(&ends(&[0.0, 1.0, 4.0, 5.0]), &[1.0, 1.5, 6.0, 9.0], 7.0);
        assert_eq!(
            [0.0, 1.0, 4.0, 5.0].map(|v| fibre.map(v)),
            [1.0, 1.5, 6.0, 9.0]
        );
        let values: Vec<f64> = (-20..80).map(|i| fibre.map(f64::from(i) * 0.1)).collect();
        assert!(values.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(Fibre::new(&[], &[], 7.0).map(1.0), 8.0);
    }

    #[test]
    fn corners_of_both_fibres_in_one_place_divide_once() {
        let fibre = |up: f64| Fibre::new(&ends(&[0.0, 1.0]), &[up, 1.0 + up], 0.0);
        let mut left = fibre(0.0);
        left.from[1] += 1e-13;
        let warp = Warp {
            span: [0.0, 2.0],
            width: 2.0,
            left,
            right: fibre(0.5),
        };
        let points = warp.refine([Point::new(0.0, -1.0), Point::new(2.0, 3.0)].into_iter());
        assert!(
            points.windows(2).all(|w| w[0].distance(w[1]) > 1e-3),
            "{points:?}"
        );
    }

    #[test]
    fn bending_turns_one_end_and_keeps_both() {
        let line: Vec<Point> = (0..=20).map(|i| Point::new(f64::from(i), 0.0)).collect();
        let mut bent = line.clone();
        bend(&mut bent, false, 0.3, 6.5);
        let n = bent.len();
        assert_eq!(
            (bent[0], bent[n - 1], bent[n - 2]),
            (line[0], line[20], line[19])
        );
        let d = bent[1] - bent[0];
        assert!((libm::atan2(d.y, d.x) - 0.3).abs() < 0.1);
        let turns = bent
            .windows(3)
            .map(|w| (w[1] - w[0]).cross(w[2] - w[1]).abs());
        assert!(turns.fold(0.0, f64::max) < 0.15, "no corner");
        assert!(bent.windows(2).all(|w| w[0].distance(w[1]) > 1e-6));
        let mut other = line.clone();
        bend(&mut other, true, 0.3, 6.5);
        assert_eq!(other[0], line[0]);
        assert!(other[other.len() - 2].y < 0.0);
    }
}
