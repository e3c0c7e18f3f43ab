//! Lines widened to areas, and outlines moved sideways. What the rings made here enclose is worked out
//! where areas are combined.

use crate::drawing::{Cap, Join, Stroke};
use crate::{Point, Ring};

/// Appends to `out` rings whose non-zero fill is the stroke of the polyline `path` (closed when it
/// ends where it began). They may cross themselves; no point has a negative winding number. Arcs are
/// inscribed polylines within `tolerance`. A path of one point has the area of its caps: a disc, an
/// upright square, or nothing.
pub fn outlines(path: &[Point], stroke: &Stroke, tolerance: f64, out: &mut Vec<Ring>) {
    let Some(pen) = Pen::new(0.5 * stroke.width, stroke.join, tolerance) else {
        return;
    };
    let mut points = path.to_vec();
    points.dedup();
    let closed = points.len() > 2 && points.first() == points.last();
    match points[..] {
        [] => {}
        [p] => pen.dot(p, stroke.cap, out),
        _ if closed => {
            points.pop();
            out.push(pen.beside(&points, true));
            points.reverse();
            out.push(pen.beside(&points, true));
        }
        [first, .., last] => {
            let (begin, end) = (
                direction(first, points[1]),
                direction(points[points.len() - 2], last),
            );
            let mut ring = pen.beside(&points, false);
            pen.cap(last, end, stroke.cap, &mut ring);
            points.reverse();
            ring.extend(pen.beside(&points, false));
            pen.cap(first, -begin, stroke.cap, &mut ring);
            out.push(ring);
        }
    }
}

/// The ring that runs `distance` beside `ring`, on its right, or on its left where the distance is
/// negative. It may cross itself: together with those beside the other rings of an area, all of which
/// have the inside on their left, the points of positive winding number are the area grown, or shrunk.
pub(super) fn parallel(ring: &[Point], distance: f64, join: Join, tolerance: f64) -> Ring {
    let mut points = ring.to_vec();
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let Some(pen) = Pen::new(distance.abs(), join, tolerance).filter(|_| points.len() > 2) else {
        return points;
    };
    if distance > 0.0 {
        return pen.beside(&points, true);
    }
    points.reverse();
    let mut inner = pen.beside(&points, true);
    inner.reverse();
    inner
}

/// The unit vector from one point to another.
fn direction(from: Point, to: Point) -> Point {
    (to - from) * (1.0 / from.distance(to))
}

/// The angle between the corners of a polygon inscribed in a circle that is nowhere farther from
/// it than `tolerance`; an eighth of a turn at most.
fn step(radius: f64, tolerance: f64) -> f64 {
    let ratio = (tolerance / (2.0 * radius)).clamp(1e-9, 1.0);
    (4.0 * libm::asin(ratio.sqrt())).min(std::f64::consts::FRAC_PI_4)
}

struct Pen {
    radius: f64,
    step: f64,
    join: Join,
}

impl Pen {
    fn new(radius: f64, join: Join, tolerance: f64) -> Option<Pen> {
        (radius > 0.0).then(|| Pen {
            radius,
            step: step(radius, tolerance),
            join,
        })
    }

    /// The line on the right of `points`, none of which equals the next, from beside the first to beside
    /// the last, or all the way round.
    ///
    /// It is the border of what is swept: half a stroke's width of every segment, and the wedges at
    /// corners that turn to the left. At a corner to the right it takes the short way where the two
    /// segments reach far enough, else that through the corner itself.
    fn beside(&self, points: &[Point], closed: bool) -> Ring {
        let n = points.len();
        let count = if closed { n } else { n - 1 };
        let segment = |i: usize| (points[i % n], points[(i + 1) % n]);
        let lengths: Vec<f64> = (0..count)
            .map(|i| segment(i).0.distance(segment(i).1))
            .collect();
        let directions: Vec<Point> = (0..count)
            .map(|i| direction(segment(i).0, segment(i).1))
            .collect();
        // At the end of segment i.
        let turn = |i: usize| {
            let (d, e) = (directions[i], directions[(i + 1) % count]);
            libm::atan2(d.cross(e), d.dot(e))
        };
        let corners = if closed { count } else { count - 1 };
        let turns: Vec<f64> = (0..corners).map(turn).collect();
        let trim = |i: usize| {
            turns.get(i).map_or(0.0, |t| {
                if *t < 0.0 {
                    self.radius * libm::tan(-0.5 * t)
                } else {
                    0.0
                }
            })
        };
        let fits = |i: usize| trim((i + count - 1) % count) + trim(i) <= lengths[i];
        let mut ring = Vec::with_capacity(2 * n);
        let right = |i: usize| -directions[i].left() * self.radius;
        if !closed {
            ring.push(points[0] + right(0));
        }
        for (i, turn) in turns.iter().enumerate() {
            let (p, next) = (segment(i).1, (i + 1) % count);
            if *turn >= 0.0 {
                self.corner(p, directions[i], directions[next], *turn, &mut ring);
            } else if fits(i) && fits(next) {
                ring.push(p + right(i) - directions[i] * trim(i));
            } else {
                ring.extend([p + right(i), p, p + right(next)]);
            }
        }
        if !closed {
            ring.push(points[n - 1] + right(count - 1));
        }
        ring
    }

    /// The way round the outside of the corner at `p` that turns to the left from direction `d` to `e`.
    fn corner(&self, p: Point, d: Point, e: Point, turn: f64, ring: &mut Ring) {
        let (from, to) = (-d.left(), -e.left());
        let half_cosine = 1.0 + from.dot(to);
        let tip = |ring: &mut Ring| ring.push(p + (from + to) * (self.radius / half_cosine));
        match self.join {
            // The tip of so small a turn is as near to the circle as the middle of a chord.
            Join::Round if turn < 0.5 * self.step => tip(ring),
            Join::Round => {
                ring.push(p + from * self.radius);
                self.arc(p, from, turn, ring);
            }
            Join::Miter(limit) if half_cosine * limit * limit >= 2.0 && half_cosine > 1e-9 => {
                tip(ring)
            }
            Join::Miter(_) | Join::Bevel => {
                ring.extend([p + from * self.radius, p + to * self.radius])
            }
        }
    }

    fn dot(&self, p: Point, cap: Cap, out: &mut Vec<Ring>) {
        let east = Point::new(1.0, 0.0);
        match cap {
            Cap::Butt => {}
            Cap::Round => {
                let mut ring = Vec::new();
                self.arc(p, east, std::f64::consts::TAU, &mut ring);
                out.push(ring);
            }
            Cap::Square => {
                let mut ring = Vec::new();
                self.cap(p, east, cap, &mut ring);
                self.cap(p, -east, cap, &mut ring);
                out.push(ring);
            }
        }
    }

    /// The way round the end `p` of a line in direction `d`, from its right to its left, without these two.
    fn cap(&self, p: Point, d: Point, cap: Cap, ring: &mut Ring) {
        let (ahead, side) = (d * self.radius, d.left() * self.radius);
        match cap {
            Cap::Butt => {}
            Cap::Round => {
                self.arc(p, -d.left(), std::f64::consts::PI, ring);
                ring.pop();
            }
            Cap::Square => ring.extend([p - side + ahead, p + side + ahead]),
        }
    }

    /// Appends the arc about `p` over the positive angle `sweep`, without its first point, which
    /// lies in direction `from`.
    fn arc(&self, p: Point, from: Point, sweep: f64, ring: &mut Ring) {
        let count = (sweep / self.step - 1e-9).ceil().max(1.0) as usize;
        for i in 1..=count {
            let angle = sweep * (i as f64 / count as f64);
            let along = from * libm::cos(angle) + from.left() * libm::sin(angle);
            ring.push(p + along * self.radius);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::{Polygon, fill, offset, signed_area, unite};
    use crate::{FillRule, Seed};

    /// The union of a rectangle per segment and a disc per point: the stroke with round ends.
    fn slow_stroke(path: &[Point], width: f64, tolerance: f64) -> Vec<Polygon> {
        let mut pieces = Vec::new();
        for w in path.windows(2).filter(|w| w[0] != w[1]) {
            let side = direction(w[0], w[1]).left() * (0.5 * width);
            pieces.push(vec![w[0] - side, w[1] - side, w[1] + side, w[0] + side]);
        }
        for p in path {
            outlines(&[*p], &Stroke::round(width), tolerance, &mut pieces);
        }
        fill(&pieces, FillRule::NonZero).unwrap()
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    /// A walk of steps that are short or long against the width, with sharp turns and reversals.
    fn walk(seed: Seed, count: u64) -> Vec<Point> {
        let mut points = vec![Point::ORIGIN];
        for i in 0..count {
            let (length, turn) = (seed.unit(3 * i), seed.unit(3 * i + 1));
            let angle =
                std::f64::consts::TAU * (turn * 8.0).round() / 8.0 + 0.1 * seed.unit(3 * i + 2);
            points.push(
                points[points.len() - 1] + Point::unit(angle) * (0.05 + 3.0 * length * length),
            );
        }
        points
    }

    #[test]
    fn strokes_are_the_union_of_their_pieces() {
        for case in 0..60 {
            let mut path = walk(Seed::root(case), 3 + case % 12);
            if case % 2 == 0 {
                path.push(path[0]);
            }
            let mut rings = Vec::new();
            outlines(&path, &Stroke::round(1.0), 1e-4, &mut rings);
            let (fast, slow) = (
                fill(&rings, FillRule::NonZero).unwrap(),
                slow_stroke(&path, 1.0, 1e-4),
            );
            assert!(
                (area(&fast) - area(&slow)).abs() < 2e-3 * area(&slow),
                "case {case}"
            );
            let both = unite(&[fast.clone(), slow.clone()].concat()).unwrap();
            assert!(
                area(&both) - area(&slow) < 2e-3 * area(&slow),
                "case {case}"
            );
        }
    }

    #[test]
    fn grown_and_shrunk_areas_are_those_of_the_stroked_outline() {
        for case in 0..40 {
            let mut rings = Vec::new();
            outlines(
                &walk(Seed::root(100 + case), 6),
                &Stroke::round(0.9),
                1e-3,
                &mut rings,
            );
            let shape = fill(&rings, FillRule::NonZero).unwrap();
            let mut border = Vec::new();
            for ring in shape.iter().flat_map(Polygon::rings) {
                let closed: Ring = ring.iter().chain(ring.first()).copied().collect();
                border.extend(slow_stroke(&closed, 0.5, 1e-4));
            }
            let grown = unite(&[shape.clone(), border.clone()].concat()).unwrap();
            let (out, inside) = (
                offset(&shape, 0.25, Join::Round, 1e-4).unwrap(),
                offset(&shape, -0.25, Join::Round, 1e-4).unwrap(),
            );
            assert!(
                (area(&out) - area(&grown)).abs() < 2e-3 * area(&grown),
                "case {case}"
            );
            let shrunk = crate::polygon::subtract(&shape, &unite(&border).unwrap()).unwrap();
            assert!(
                (area(&inside) - area(&shrunk)).abs() < 2e-3 * area(&grown),
                "case {case}"
            );
        }
    }

    #[test]
    fn a_straight_line_has_its_caps() {
        let line = [Point::ORIGIN, Point::new(10.0, 0.0)];
        for (cap, expected) in [
            (Cap::Butt, 20.0),
            (Cap::Square, 24.0),
            (Cap::Round, 20.0 + std::f64::consts::PI),
        ] {
            let mut rings = Vec::new();
            outlines(
                &line,
                &Stroke {
                    width: 2.0,
                    cap,
                    join: Join::Round,
                },
                1e-5,
                &mut rings,
            );
            assert!((signed_area(&rings[0]) - expected).abs() < 1e-3, "{cap:?}");
        }
    }

    #[test]
    fn a_smooth_line_gives_a_smooth_outline() {
        let circle: Vec<Point> = (0..=360)
            .map(|i| Point::unit(f64::from(i % 360).to_radians()) * 8.0)
            .collect();
        let mut rings = Vec::new();
        outlines(&circle, &Stroke::round(1.4), 0.014, &mut rings);
        assert_eq!(rings.iter().map(Vec::len).collect::<Vec<_>>(), [360, 360]);
        let ring = fill(&rings, FillRule::NonZero).unwrap();
        assert_eq!((ring.len(), ring[0].holes.len()), (1, 1));
    }

    #[test]
    fn points_have_the_area_of_their_caps() {
        let dot = |cap| {
            let mut rings = Vec::new();
            outlines(
                &[Point::ORIGIN],
                &Stroke {
                    width: 2.0,
                    cap,
                    join: Join::Round,
                },
                1e-5,
                &mut rings,
            );
            rings.iter().map(|ring| signed_area(ring)).sum::<f64>()
        };
        assert_eq!((dot(Cap::Butt), dot(Cap::Square)), (0.0, 4.0));
        assert!((dot(Cap::Round) - std::f64::consts::PI).abs() < 1e-3);
    }
}
