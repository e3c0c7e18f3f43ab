//! Lines widened to areas.

use crate::geometry::drawing::{Cap, Join, Stroke};
use crate::geometry::{Point, Ring};

/// Appends to `out` the pieces whose union is the stroke of the polyline `path` (closed when it
/// ends where it began): a rectangle per segment, a wedge per corner, the caps. All run
/// counter-clockwise and are convex. Discs are inscribed polygons within `tolerance`.
/// A path of one point has the area of its caps: a disc, an upright square, or nothing.
pub fn pieces(path: &[Point], stroke: &Stroke, tolerance: f64, out: &mut Vec<Ring>) {
    let radius = 0.5 * stroke.width;
    if radius.is_nan() || radius <= 0.0 {
        return;
    }
    let pen = Pen { radius, step: step(radius, tolerance), join: stroke.join };
    let mut points = path.to_vec();
    points.dedup();
    let closed = points.len() > 2 && points.first() == points.last();
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return };
    let directions: Vec<Point> = points.windows(2).map(|w| (w[1] - w[0]) * (1.0 / w[0].distance(w[1]))).collect();
    let (Some(&begin), Some(&end)) = (directions.first(), directions.last()) else {
        return pen.dot(first, stroke.cap, out);
    };
    for (w, d) in points.windows(2).zip(&directions) {
        let side = d.left() * radius;
        out.push(vec![w[0] - side, w[1] - side, w[1] + side, w[0] + side]);
    }
    for (p, d) in points[1..].iter().zip(directions.windows(2)) {
        pen.corner(*p, d[0], d[1], out);
    }
    if closed {
        pen.corner(first, end, begin, out);
    } else {
        pen.cap(first, -begin, stroke.cap, out);
        pen.cap(last, end, stroke.cap, out);
    }
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
    fn dot(&self, p: Point, cap: Cap, out: &mut Vec<Ring>) {
        let east = Point::new(1.0, 0.0);
        match cap {
            Cap::Butt => {}
            Cap::Round => {
                let mut ring = vec![p + east * self.radius];
                self.arc(p, east, std::f64::consts::TAU, &mut ring);
                ring.pop();
                out.push(ring);
            }
            Cap::Square => {
                self.cap(p, east, cap, out);
                self.cap(p, -east, cap, out);
            }
        }
    }

    /// The cap at `p`, beyond which the line would go on along `d`.
    fn cap(&self, p: Point, d: Point, cap: Cap, out: &mut Vec<Ring>) {
        let (ahead, side) = (d * self.radius, d.left() * self.radius);
        match cap {
            Cap::Butt => {}
            Cap::Round => {
                let mut ring = vec![p - side];
                self.arc(p, -d.left(), std::f64::consts::PI, &mut ring);
                out.push(ring);
            }
            Cap::Square => out.push(vec![p - side, p - side + ahead, p + side + ahead, p + side]),
        }
    }

    /// The wedge on the outer side of the corner at `p` from direction `d` to `e`.
    fn corner(&self, p: Point, d: Point, e: Point, out: &mut Vec<Ring>) {
        let turn = libm::atan2(d.cross(e), d.dot(e));
        if turn == 0.0 {
            return;
        }
        // The outer side is on the right of a turn to the left. The wedge goes round it positively.
        let (from, to) = if turn > 0.0 { (-d.left(), -e.left()) } else { (e.left(), d.left()) };
        let mut ring = vec![p, p + from * self.radius];
        let half_cosine = 1.0 + from.dot(to);
        match self.join {
            Join::Round => self.arc(p, from, turn.abs(), &mut ring),
            Join::Miter(limit) if half_cosine * limit * limit >= 2.0 && half_cosine > 1e-9 => {
                ring.push(p + (from + to) * (self.radius / half_cosine));
                ring.push(p + to * self.radius);
            }
            Join::Miter(_) | Join::Bevel => ring.push(p + to * self.radius),
        }
        out.push(ring);
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
