//! The pieces of a sequence are put in place and joined (Zhou 2014, section 4.2). Tangents are made
//! to agree in `turn`; the outlines are linked to rings in `assemble`.
//!
//! The paper deforms outlines freely. Here a piece is moved by a map that keeps every line across
//! the band on itself and in order: near a seam it takes the endpoints of portals to the places
//! that both sides share, and in between it blends. Such a map cannot change the topology, however
//! badly the pieces fit.

use fretwork_geometry::Point;

use super::placed::{Layout, Placed};
use super::turn::turn;
use crate::exemplar::piece::{Chain, Endpoint, Piece, Side};

/// Puts the pieces in place. `turned` says for each seam whether tangents are made to agree there.
pub fn place(layout: &Layout, turned: &[bool]) -> Vec<Placed> {
    let Layout {
        pieces,
        sequence,
        seams,
        ..
    } = *layout;
    let n = sequence.len();
    let total: f64 = sequence.iter().map(|&p| pieces[p].width).sum::<f64>()
        + seams.iter().map(|s| s.gap).sum::<f64>();
    let stretch = layout.length / total;
    let count = seams.len();
    let shared: Vec<Vec<f64>> = (0..count).map(|k| layout.shared_endpoints(k)).collect();
    let free: Vec<f64> = Vec::new();
    let mut placed = Vec::with_capacity(n);
    let mut at = 0.0;
    for k in 0..n {
        let piece = &pieces[sequence[k]];
        let left = match k {
            0 if layout.closed => &shared[n - 1],
            0 => &free,
            _ => &shared[k - 1],
        };
        let right = shared.get(k).unwrap_or(&free);
        let begin = at * stretch;
        at += piece.width;
        // The last end of an open pattern is the length itself, whatever rounding has added up to.
        let end = if k + 1 == n && !layout.closed {
            layout.length
        } else {
            at * stretch
        };
        at += seams.get(k).map_or(0.0, |s| s.gap);
        let warp = Warp {
            span: [begin, end],
            width: piece.width,
            left: Fiber::new(&piece.left, left, layout.offsets[k]),
            right: Fiber::new(&piece.right, right, layout.offsets[k]),
        };
        placed.push(warp.apply(piece));
    }
    for k in (0..count).filter(|&k| turned[k]) {
        turn(&mut placed, k, (k + 1) % n, &shared[k]);
    }
    placed
}

/// An increasing map of a line across the band: linear between endpoints, a shift beyond them.
struct Fiber {
    from: Vec<f64>,
    to: Vec<f64>,
    shift: f64,
}

impl Fiber {
    fn new(ends: &[Endpoint], to: &[f64], shift: f64) -> Fiber {
        // The outer ends of an open pattern are joined to nothing.
        let from: Vec<f64> = if to.is_empty() {
            Vec::new()
        } else {
            ends.iter().map(|e| e.v).collect()
        };
        Fiber {
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
    left: Fiber,
    right: Fiber,
}

/// Into how many parts an edge as wide as its piece is divided where the map bends it. The blend
/// then differs from a smooth curve by at most 0.5 % of what it moves; more parts only make larger
/// files.
const PARTS: f64 = 12.0;
/// Corners within this part of an edge from its end are taken to be its end. Two points that are
/// nearer look like one to every format; at 0, rounding would leave pairs of them.
const AT_END: f64 = 1e-6;

impl Warp {
    /// The outlines of the piece in their place.
    fn apply(&self, piece: &Piece) -> Placed {
        let chains = piece.chains.iter().map(|c| {
            let mut points = self.refine(c.points.iter().copied());
            // The ends are exactly where the other piece has them.
            for (end, port) in [(0, c.from), (points.len() - 1, c.to)] {
                let (fiber, x) = if port.0 == Side::Left {
                    (&self.left, self.span[0])
                } else {
                    (&self.right, self.span[1])
                };
                if let Some(&y) = fiber.to.get(port.1 as usize) {
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

    /// The image of a point of the piece.
    fn map(&self, p: Point) -> Point {
        let t = (p.x / self.width).clamp(0.0, 1.0);
        // The blend is level at both ends, so that it does not change tangents there.
        let blend = t * t * (3.0 - 2.0 * t);
        let (l, r) = (self.left.map(p.y), self.right.map(p.y));
        Point::new(
            self.span[0] + (self.span[1] - self.span[0]) * p.x / self.width,
            l + (r - l) * blend,
        )
    }

    /// The image of a polyline, divided where the map bends it.
    fn refine(&self, points: impl Iterator<Item = Point>) -> Vec<Point> {
        let mut image: Vec<Point> = Vec::new();
        let mut last: Option<Point> = None;
        for p in points {
            if let Some(q) = last {
                let mut cuts = self.divisions(q, p);
                cuts.sort_by(f64::total_cmp);
                // Both fibers often have a corner in one place.
                cuts.dedup_by(|b, a| *b - *a < AT_END);
                image.extend(cuts.into_iter().map(|t| self.map(q.lerp(p, t))));
            }
            image.push(self.map(p));
            last = Some(p);
        }
        image
    }

    /// Where the edge from `p` to `q` is divided: at regular steps along the band, and where a
    /// fiber has a corner.
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
    fn fibers_stay_in_order_and_meet_their_ends() {
        let fiber = Fiber::new(&ends(&[0.0, 1.0, 4.0, 5.0]), &[1.0, 1.5, 6.0, 9.0], 7.0);
        assert_eq!(
            [0.0, 1.0, 4.0, 5.0].map(|v| fiber.map(v)),
            [1.0, 1.5, 6.0, 9.0]
        );
        let values: Vec<f64> = (-20..80).map(|i| fiber.map(f64::from(i) * 0.1)).collect();
        assert!(values.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(Fiber::new(&[], &[], 7.0).map(1.0), 8.0);
    }

    #[test]
    fn corners_of_both_fibers_in_one_place_divide_once() {
        let fiber = |up: f64| Fiber::new(&ends(&[0.0, 1.0]), &[up, 1.0 + up], 0.0);
        let mut left = fiber(0.0);
        left.from[1] += 1e-13;
        let warp = Warp {
            span: [0.0, 2.0],
            width: 2.0,
            left,
            right: fiber(0.5),
        };
        let points = warp.refine([Point::new(0.0, -1.0), Point::new(2.0, 3.0)].into_iter());
        assert!(
            points.windows(2).all(|w| w[0].distance(w[1]) > 1e-3),
            "{points:?}"
        );
    }
}
