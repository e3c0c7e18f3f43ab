//! Curves to polylines: cubic and quadratic Béziers, elliptical arcs.
//!
//! The tolerance is the largest distance between a chord and the piece of curve that it stands
//! for. Points lie on the curve, the ends exactly. Only `libm` and square roots are used, so the
//! polylines are the same on every machine. Reading path data is not done here.

use crate::{Affine, Point};

/// How often a Bézier is halved at most; with four chords a piece it has at most 2^16 of them.
const HALVINGS: u32 = 14;
/// The most chords that a full turn of an arc gets.
const ARC_CHORDS: f64 = 65536.0;

/// Appends the cubic Bézier with these control points to `out`, without its first point.
///
/// Guarantee: every chord is within `tolerance` of its piece, for a finite curve whose extent is
/// below 10^8 tolerances. A piece is cut evenly by the bound on the second derivative (Wang's
/// formula) and halved first where that bound is far from even along it.
pub fn cubic(p: [Point; 4], tolerance: f64, out: &mut Vec<Point>) {
    if p.iter().all(|q| q.is_finite()) && tolerance > 0.0 {
        cubic_piece(p, tolerance, HALVINGS, out);
    } else {
        out.push(p[3]);
    }
}

/// Appends the quadratic Bézier with these control points to `out`, without its first point; the
/// guarantee is that of [`cubic`].
pub fn quadratic([a, b, c]: [Point; 3], tolerance: f64, out: &mut Vec<Point>) {
    cubic(
        [a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c],
        tolerance,
        out,
    );
}

/// An arc of an ellipse, θ ↦ center + cos θ · u + sin θ · v for θ from `start` to `start + sweep`.
/// `u` and `v` need not be perpendicular, so that every affine image of an arc is an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticalArc {
    /// The middle of the ellipse.
    pub center: Point,
    /// From the center to the point at θ = 0.
    pub u: Point,
    /// From the center to the point at θ = π/2.
    pub v: Point,
    /// The first angle, in radians.
    pub start: f64,
    /// The angle gone through, in radians; negative backwards.
    pub sweep: f64,
}

impl EllipticalArc {
    /// The full circle, once round from its point of greatest x toward +y.
    pub fn circle(center: Point, radius: f64) -> EllipticalArc {
        let (u, v) = (Point::new(radius, 0.0), Point::new(0.0, radius));
        EllipticalArc {
            center,
            u,
            v,
            start: 0.0,
            sweep: std::f64::consts::TAU,
        }
    }

    /// The arc between two points as SVG describes it (SVG 2, appendix B.2.4): radii along axes
    /// turned by `turn` radians, grown where they are too short to reach; `large` asks for the
    /// longer way round, `positive` for the one from +x toward +y. None when a radius is zero or
    /// the points are the same: then the arc is a straight line or nothing.
    pub fn between(
        from: Point,
        to: Point,
        radii: Point,
        turn: f64,
        large: bool,
        positive: bool,
    ) -> Option<EllipticalArc> {
        let (rx, ry) = (radii.x.abs(), radii.y.abs());
        if from == to || rx == 0.0 || ry == 0.0 || !rx.is_finite() || !ry.is_finite() {
            return None;
        }
        let (ex, ey) = (Point::unit(turn), Point::unit(turn).left());
        // In the frame whose unit circle is the ellipse, half the chord is h and the center lies
        // on its bisector.
        let half = (from - to) * 0.5;
        let h = Point::new(half.dot(ex) / rx, half.dot(ey) / ry);
        let grow = h.length().max(1.0);
        let (rx, ry, h) = (rx * grow, ry * grow, h * (1.0 / grow));
        let across = (1.0 / h.dot(h) - 1.0).max(0.0).sqrt();
        let middle = if large == positive {
            h.left() * across
        } else {
            h.left() * -across
        };
        let (u, v) = (ex * rx, ey * ry);
        let center = from.lerp(to, 0.5) + u * middle.x + v * middle.y;
        let (first, last) = (h - middle, -h - middle);
        let start = libm::atan2(first.y, first.x);
        let mut sweep = libm::atan2(first.cross(last), first.dot(last));
        if positive && sweep <= 0.0 {
            sweep += std::f64::consts::TAU;
        } else if !positive && sweep >= 0.0 {
            sweep -= std::f64::consts::TAU;
        }
        Some(EllipticalArc {
            center,
            u,
            v,
            start,
            sweep,
        })
    }

    /// The image under `map`.
    pub fn transformed(&self, map: &Affine) -> EllipticalArc {
        let linear = |p: Point| map.apply(p) - map.apply(Point::ORIGIN);
        EllipticalArc {
            center: map.apply(self.center),
            u: linear(self.u),
            v: linear(self.v),
            ..*self
        }
    }

    /// The point at `angle` radians.
    pub fn at(&self, angle: f64) -> Point {
        self.center + self.u * libm::cos(angle) + self.v * libm::sin(angle)
    }

    /// Appends the arc to `out` without its first point; `end` is taken for its last. A chord
    /// spans an eighth of a turn at most, so that a small circle stays one.
    pub fn flatten(&self, tolerance: f64, end: Point, out: &mut Vec<Point>) {
        let count = self.chords(tolerance);
        for i in 1..count {
            out.push(self.at(self.start + self.sweep * (i as f64 / count as f64)));
        }
        out.push(end);
    }

    /// How many chords keep within `tolerance`: a chord over the angle 2h is off by at most
    /// (1 - cos h) · R, where R is the longer half axis.
    fn chords(&self, tolerance: f64) -> usize {
        let radius = self.longer_half_axis();
        let ratio = tolerance / (2.0 * radius);
        if !ratio.is_finite() || !self.sweep.is_finite() {
            return 1;
        }
        let step = 4.0 * libm::asin(ratio.clamp(0.0, 1.0).sqrt());
        let turn = self.sweep.abs();
        let finest = std::f64::consts::TAU / ARC_CHORDS;
        (turn / step.clamp(finest, std::f64::consts::FRAC_PI_4) - 1e-9)
            .ceil()
            .max(1.0) as usize
    }

    /// The largest singular value of the matrix with the columns u and v.
    fn longer_half_axis(&self) -> f64 {
        let (a, b, c) = (self.u.dot(self.u), self.u.dot(self.v), self.v.dot(self.v));
        (0.5 * (a + c) + (0.25 * (a - c) * (a - c) + b * b).sqrt()).sqrt()
    }
}

fn cubic_piece(p: [Point; 4], tolerance: f64, halvings: u32, out: &mut Vec<Point>) {
    let [a, b, c, d] = p;
    // The curve lies at most three quarters as far from the chord as its inner control points.
    if 0.75 * distance_to_segment(b, a, d).max(distance_to_segment(c, a, d)) <= tolerance {
        out.push(d);
        return;
    }
    let bend = (a - b * 2.0 + c).length().max((b - c * 2.0 + d).length());
    let count = (0.75 * bend / tolerance).sqrt().ceil();
    if count > 4.0 && halvings > 0 {
        let (ab, bc, cd) = (a.lerp(b, 0.5), b.lerp(c, 0.5), c.lerp(d, 0.5));
        let (abc, bcd) = (ab.lerp(bc, 0.5), bc.lerp(cd, 0.5));
        let middle = abc.lerp(bcd, 0.5);
        cubic_piece([a, ab, abc, middle], tolerance, halvings - 1, out);
        cubic_piece([middle, bcd, cd, d], tolerance, halvings - 1, out);
        return;
    }
    let count = count.clamp(1.0, 4.0) as usize;
    out.extend((1..count).map(|i| cubic_point(p, i as f64 / count as f64)));
    out.push(d);
}

fn cubic_point([a, b, c, d]: [Point; 4], t: f64) -> Point {
    let s = 1.0 - t;
    a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
}

/// The distance of `p` from the segment between `a` and `b`.
pub(crate) fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    let square = along.dot(along);
    let t = if square > 0.0 {
        ((p - a).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    p.distance(a.lerp(b, t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The largest distance of a densely sampled curve from the polyline.
    fn deviation(curve: impl Fn(f64) -> Point, polyline: &[Point]) -> f64 {
        let nearest = |p: Point| {
            polyline
                .windows(2)
                .map(|w| distance_to_segment(p, w[0], w[1]))
                .fold(f64::INFINITY, f64::min)
        };
        (0..=2000)
            .map(|i| nearest(curve(i as f64 / 2000.0)))
            .fold(0.0, f64::max)
    }

    fn point() -> impl Strategy<Value = Point> {
        (-100.0..100.0f64, -100.0..100.0f64).prop_map(|(x, y)| Point::new(x, y))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn a_cubic_keeps_within_the_tolerance(p in [point(), point(), point(), point()], e in -3.0..1.0f64) {
            let tolerance = libm::exp10(e);
            let mut out = vec![p[0]];
            cubic(p, tolerance, &mut out);
            prop_assert!(deviation(|t| cubic_point(p, t), &out) <= tolerance);
            prop_assert_eq!(out.last(), Some(&p[3]));
        }

        #[test]
        fn an_arc_keeps_within_the_tolerance(
            center in point(), u in point(), v in point(), start in -4.0..4.0f64, sweep in -6.2..6.2f64, e in -3.0..1.0f64,
        ) {
            let tolerance = libm::exp10(e);
            let arc = EllipticalArc { center, u, v, start, sweep };
            let mut out = vec![arc.at(start)];
            arc.flatten(tolerance, arc.at(start + sweep), &mut out);
            prop_assert!(deviation(|t| arc.at(start + sweep * t), &out) <= tolerance + 1e-9);
        }

        #[test]
        fn an_arc_between_two_points_meets_both(
            from in point(), to in point(), rx in 1.0..200.0f64, ry in 1.0..200.0f64, turn in -4.0..4.0f64,
            large: bool, positive: bool,
        ) {
            let arc = EllipticalArc::between(from, to, Point::new(rx, ry), turn, large, positive).unwrap();
            prop_assert!(arc.at(arc.start).distance(from) < 1e-6);
            prop_assert!(arc.at(arc.start + arc.sweep).distance(to) < 1e-6);
            prop_assert_eq!(arc.sweep > 0.0, positive);
            let half_turn = std::f64::consts::PI;
            let beyond = (arc.sweep.abs() - half_turn) * f64::from(2 * i8::from(large) - 1);
            prop_assert!(beyond > -1e-6);
        }
    }

    #[test]
    fn a_straight_cubic_is_one_chord_however_uneven_its_speed() {
        let (a, b) = (Point::ORIGIN, Point::new(100.0, 50.0));
        let mut out = Vec::new();
        cubic([a, a, b, b], 0.01, &mut out);
        assert_eq!(out, [b]);
    }

    #[test]
    fn the_number_of_chords_is_near_the_least() {
        let mut out = Vec::new();
        EllipticalArc::circle(Point::ORIGIN, 100.0).flatten(0.01, Point::new(100.0, 0.0), &mut out);
        // One chord per 2·acos(1 - 1e-4).
        assert_eq!(out.len(), 223);
        let k = 55.228_474_983;
        let quarter = [
            Point::new(100.0, 0.0),
            Point::new(100.0, k),
            Point::new(k, 100.0),
            Point::new(0.0, 100.0),
        ];
        let mut out = Vec::new();
        cubic(quarter, 0.01, &mut out);
        assert!((56..=72).contains(&out.len()), "{}", out.len());
    }

    #[test]
    fn degenerate_curves_give_points() {
        let nan = Point::new(f64::NAN, 0.0);
        let mut out = Vec::new();
        cubic(
            [Point::ORIGIN, nan, Point::ORIGIN, Point::ORIGIN],
            0.1,
            &mut out,
        );
        cubic([Point::ORIGIN; 4], 0.1, &mut out);
        EllipticalArc::circle(nan, f64::NAN).flatten(0.1, Point::ORIGIN, &mut out);
        assert_eq!(out, [Point::ORIGIN; 3]);
        out.clear();
        EllipticalArc::circle(Point::ORIGIN, 1e-9).flatten(0.1, Point::new(1e-9, 0.0), &mut out);
        assert_eq!(out.len(), 8);
        assert!(
            EllipticalArc::between(Point::ORIGIN, nan, Point::new(0.0, 1.0), 0.0, true, true)
                .is_none()
        );
    }
}
