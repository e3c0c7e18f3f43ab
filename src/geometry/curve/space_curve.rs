//! Curves in space by arc length: circles, arcs, polylines, splines. What lies across them is in
//! `ribbon`; curves that are pieces of an arrangement are [`crate::Curves`].

use serde::{Deserialize, Serialize};

use crate::{Point, Point3};

/// A curve as a fine polyline by arc length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpaceCurve {
    /// Distinct neighbours; a closed curve repeats its first point at its end.
    points: Vec<Point3>,
    /// The arc length up to each point.
    lengths: Vec<f64>,
    closed: bool,
    /// Turns of the frame (part of the length, radians), by place.
    twist: Vec<(f64, f64)>,
    /// The normals of the surface that the curve lies on, one a point; empty when it lies on none.
    normals: Vec<Point3>,
}

/// Why points give no curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SpaceCurveError {
    /// A coordinate is NaN or infinite, or so large that lengths are.
    #[error("a point of the curve is not finite")]
    NotFinite,
    /// Fewer than two distinct points, or fewer than three for a closed curve.
    #[error("a curve needs at least two distinct points, three if it is closed, and has {0}")]
    TooFewPoints(usize),
    /// A radius that is not above zero.
    #[error("the radius {0} is not above zero")]
    Radius(f64),
}

/// Points on a full circle: the chord is 10^-5 of the radius inside the arc.
const CIRCLE: usize = 720;
/// Points between two points of a spline.
const SPLINE: usize = 48;

impl SpaceCurve {
    /// The polyline through `points`, closed to the first one where `closed` says so; repeated points count once.
    pub fn new(
        points: impl IntoIterator<Item = Point3>,
        closed: bool,
    ) -> Result<SpaceCurve, SpaceCurveError> {
        let mut points: Vec<Point3> = points.into_iter().collect();
        if points.iter().any(|p| !p.is_finite()) {
            return Err(SpaceCurveError::NotFinite);
        }
        points.dedup();
        if closed {
            while points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            points.extend(points.first().copied());
        }
        let distinct = points.len() - usize::from(closed && !points.is_empty());
        if distinct < if closed { 3 } else { 2 } {
            return Err(SpaceCurveError::TooFewPoints(distinct));
        }
        let mut lengths = vec![0.0];
        let mut sum = 0.0;
        for w in points.windows(2) {
            sum += w[0].distance(w[1]);
            lengths.push(sum);
        }
        if !(sum > 0.0 && sum.is_finite()) {
            return Err(SpaceCurveError::NotFinite);
        }
        Ok(SpaceCurve {
            points,
            lengths,
            closed,
            twist: Vec::new(),
            normals: Vec::new(),
        })
    }

    /// The circle about the origin in the plane z = 0, counter-clockwise from +x.
    pub fn circle(radius: f64) -> Result<SpaceCurve, SpaceCurveError> {
        SpaceCurve::round(radius, 0.0, std::f64::consts::TAU, CIRCLE, true)
    }

    /// The part of that circle from the angle `from` to the angle `to`, in radians; clockwise when `to` is less.
    pub fn arc(radius: f64, from: f64, to: f64) -> Result<SpaceCurve, SpaceCurveError> {
        let part = ((to - from).abs() / std::f64::consts::TAU).min(64.0);
        SpaceCurve::round(
            radius,
            from,
            to,
            (part * CIRCLE as f64).ceil().max(8.0) as usize,
            false,
        )
    }

    fn round(
        radius: f64,
        from: f64,
        to: f64,
        steps: usize,
        closed: bool,
    ) -> Result<SpaceCurve, SpaceCurveError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(SpaceCurveError::Radius(radius));
        }
        let last = if closed { steps - 1 } else { steps };
        let at = |i: usize| Point::unit(from + (to - from) * i as f64 / steps as f64) * radius;
        SpaceCurve::new((0..=last).map(|i| Point3::flat(at(i))), closed)
    }

    /// The centripetal Catmull-Rom spline through `points` (Yuksel, Schaefer, Keyser 2011): no cusps and no loops between
    /// neighbours. The ends of an open one are continued by reflection.
    pub fn spline(points: &[Point3], closed: bool) -> Result<SpaceCurve, SpaceCurveError> {
        let frame = SpaceCurve::new(points.iter().copied(), closed)?;
        let knots = &frame.points[..frame.points.len() - usize::from(closed)];
        let n = knots.len();
        let knot = |i: isize| match (closed, usize::try_from(i)) {
            (true, _) => knots[i.rem_euclid(n as isize) as usize],
            (false, Ok(i)) if i < n => knots[i],
            (false, Ok(_)) => knots[n - 1] * 2.0 - knots[n - 2],
            (false, Err(_)) => knots[0] * 2.0 - knots[1],
        };
        let spans = if closed { n } else { n - 1 };
        let mut curve = Vec::with_capacity(spans * SPLINE + 1);
        for i in 0..spans as isize {
            let four = [knot(i - 1), knot(i), knot(i + 1), knot(i + 2)];
            curve.extend((0..SPLINE).map(|k| catmull_rom(four, k as f64 / SPLINE as f64)));
        }
        curve.push(knot(spans as isize));
        SpaceCurve::new(curve, closed)
    }

    /// The same curve whose frame is turned by `twist`: pairs of a part of the length, in order, and radians. Long
    /// straight pieces are divided, so that the frame can turn along them.
    pub fn twisted(mut self, twist: Vec<(f64, f64)>) -> SpaceCurve {
        let longest = self.length() / CIRCLE as f64;
        let (mut points, mut normals) = (Vec::new(), Vec::new());
        for i in 0..self.points.len() - 1 {
            let parts = ((self.lengths[i + 1] - self.lengths[i]) / longest)
                .ceil()
                .max(1.0) as usize;
            for k in 0..parts {
                let t = k as f64 / parts as f64;
                points.push(self.points[i].lerp(self.points[i + 1], t));
                normals.extend(
                    self.normals
                        .get(i)
                        .zip(self.normals.get(i + 1))
                        .map(|(a, b)| a.lerp(*b, t)),
                );
            }
        }
        points.extend(self.points.last());
        normals.extend(self.normals.last());
        self.lengths = std::iter::once(0.0)
            .chain(points.windows(2).scan(0.0, |sum, w| {
                *sum += w[0].distance(w[1]);
                Some(*sum)
            }))
            .collect();
        SpaceCurve {
            points,
            normals,
            twist,
            ..self
        }
    }

    /// The curve through `points` of a surface whose normals there are `normals`.
    ///
    /// # Errors
    /// As [`SpaceCurve::new`]; a missing or vanishing normal is not finite.
    pub fn on_surface(
        points: &[Point3],
        normals: &[Point3],
        closed: bool,
    ) -> Result<SpaceCurve, SpaceCurveError> {
        let mut pairs: Vec<(Point3, Point3)> = points
            .iter()
            .copied()
            .zip(normals.iter().copied())
            .collect();
        pairs.dedup_by(|a, b| a.0 == b.0);
        while closed && pairs.len() > 1 && pairs.first().map(|p| p.0) == pairs.last().map(|p| p.0) {
            pairs.pop();
        }
        let units: Option<Vec<Point3>> = pairs.iter().map(|p| p.1.unit()).collect();
        let mut curve = SpaceCurve::new(pairs.iter().map(|p| p.0), closed)?;
        curve.normals = units.ok_or(SpaceCurveError::NotFinite)?;
        if closed {
            curve.normals.extend(curve.normals.first().copied());
        }
        Ok(curve)
    }

    /// The curve whose points are moved by `map`; surface normals are moved as differences.
    ///
    /// # Errors
    /// As [`SpaceCurve::new`], where the map is not one to one.
    pub fn mapped(&self, map: impl Fn(Point3) -> Point3) -> Result<SpaceCurve, SpaceCurveError> {
        let curve = SpaceCurve::new(self.points.iter().map(|&p| map(p)), self.closed)?;
        let moved = |(&p, &n): (&Point3, &Point3)| {
            (map(p + n) - map(p))
                .unit()
                .ok_or(SpaceCurveError::NotFinite)
        };
        let normals = self
            .points
            .iter()
            .zip(&self.normals)
            .map(moved)
            .collect::<Result<_, _>>()?;
        Ok(SpaceCurve {
            normals,
            twist: self.twist.clone(),
            ..curve
        })
    }

    /// The arc length.
    pub fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Whether the end is the beginning.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The polyline; a closed curve repeats its first point at its end.
    pub fn points(&self) -> &[Point3] {
        &self.points
    }

    /// The arc length up to each point.
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// The normals of the surface that the curve lies on; empty when it lies on none.
    pub fn normals(&self) -> &[Point3] {
        &self.normals
    }

    /// The user's turn of the frame at the arc length `s`, linear between the places where it is given.
    pub fn twist_at(&self, s: f64) -> f64 {
        let part = s / self.length();
        let after = self.twist.partition_point(|&(at, _)| at <= part);
        match (
            after.checked_sub(1).map(|i| self.twist[i]),
            self.twist.get(after),
        ) {
            (Some((a, x)), Some(&(b, y))) => x + (y - x) * (part - a) / (b - a),
            (Some((_, x)), None) => x,
            (None, Some(&(_, y))) => y,
            (None, None) => 0.0,
        }
    }

    /// The unit normal of the plane that the curve lies in, if there is one: up where it can be. A straight curve
    /// lies in the plane that is as level as possible.
    pub fn plane(&self) -> Option<Point3> {
        let origin = self.points[0];
        let far = |f: &dyn Fn(Point3) -> f64| {
            let best = self
                .points
                .iter()
                .copied()
                .max_by(|a, b| f(*a).total_cmp(&f(*b)));
            best.unwrap_or(origin)
        };
        let size = far(&|p| p.distance(origin)).distance(origin);
        let along = (far(&|p| p.distance(origin)) - origin).unit()?;
        let aside = |p: Point3| (p - origin) - along * along.dot(p - origin);
        let widest = aside(far(&|p| aside(p).length()));
        let flat = 1e-7 * size;
        let normal = if widest.length() > flat {
            along.cross(widest).unit()?
        } else {
            let up = Point3::new(0.0, 0.0, 1.0);
            let level = up - along * up.dot(along);
            if level.length() > 1e-6 {
                level.unit()?
            } else {
                Point3::new(0.0, -1.0, 0.0)
            }
        };
        let upward =
            normal.z + 1e-9 * normal.y + 1e-12 * normal.x >= 0.0 || widest.length() <= flat;
        let normal = if upward { normal } else { -normal };
        self.points
            .iter()
            .all(|&p| normal.dot(p - origin).abs() <= flat)
            .then_some(normal)
    }
}

/// The point at `t` of the span between the middle two of four knots (Barry, Goldman 1988).
fn catmull_rom(p: [Point3; 4], t: f64) -> Point3 {
    let step = |a: Point3, b: Point3| a.distance(b).sqrt().max(1e-150);
    let k1 = step(p[0], p[1]);
    let k2 = k1 + step(p[1], p[2]);
    let k3 = k2 + step(p[2], p[3]);
    let at = k1 + (k2 - k1) * t;
    let mix = |a: Point3, b: Point3, x: f64, y: f64| a.lerp(b, (at - x) / (y - x));
    let a = [
        mix(p[0], p[1], 0.0, k1),
        mix(p[1], p[2], k1, k2),
        mix(p[2], p[3], k2, k3),
    ];
    let b = [mix(a[0], a[1], 0.0, k2), mix(a[1], a[2], k1, k3)];
    mix(b[0], b[1], k1, k2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_curves_have_the_length_of_their_arcs() {
        let circle = SpaceCurve::circle(79.577).unwrap();
        assert!((circle.length() - 499.997).abs() < 5e-3 && circle.is_closed());
        let half = SpaceCurve::arc(10.0, 0.0, std::f64::consts::PI).unwrap();
        assert!((half.length() - 31.41593).abs() < 1e-3 && !half.is_closed());
        assert_eq!(circle.plane(), Some(Point3::new(0.0, 0.0, 1.0)));
        assert!(SpaceCurve::circle(f64::NAN).is_err() && SpaceCurve::circle(-1.0).is_err());
    }

    #[test]
    fn splines_run_through_their_points_smoothly() {
        let knots = [
            [0., 0., 0.],
            [80., 60., 40.],
            [0., 140., 90.],
            [-90., 60., 140.],
            [0., 0., 200.],
        ]
        .map(Point3::from);
        let spline = SpaceCurve::spline(&knots, false).unwrap();
        assert!(
            (485.0..550.0).contains(&spline.length()),
            "{}",
            spline.length()
        );
        for knot in knots {
            assert!(spline.points().iter().any(|p| p.distance(knot) < 1e-9));
        }
        let turn = |w: &[Point3]| {
            (w[1] - w[0])
                .unit()
                .unwrap()
                .dot((w[2] - w[1]).unit().unwrap())
        };
        assert!(spline.points().windows(3).all(|w| turn(w) > 0.99));
        assert_eq!(spline.plane(), None);
    }

    #[test]
    fn straight_and_level_curves_have_a_plane() {
        let line = SpaceCurve::new([Point3::ORIGIN, Point3::new(480.0, 0.0, 0.0)], false).unwrap();
        assert_eq!(line.plane(), Some(Point3::new(0.0, 0.0, 1.0)));
        assert!(
            SpaceCurve::new([Point3::ORIGIN, Point3::new(0.0, 0.0, 9.0)], false)
                .unwrap()
                .plane()
                .is_some()
        );
    }

    #[test]
    fn too_little_is_no_curve() {
        let p = Point3::new(1.0, 1.0, 1.0);
        assert_eq!(
            SpaceCurve::new([p, p], false),
            Err(SpaceCurveError::TooFewPoints(1))
        );
        assert_eq!(
            SpaceCurve::new([], true),
            Err(SpaceCurveError::TooFewPoints(0))
        );
        assert_eq!(
            SpaceCurve::new([p, Point3::ORIGIN, p], true),
            Err(SpaceCurveError::TooFewPoints(2))
        );
        assert_eq!(
            SpaceCurve::new([p, p * f64::INFINITY], false),
            Err(SpaceCurveError::NotFinite)
        );
    }

    #[test]
    fn twist_is_linear_between_its_places() {
        let line = SpaceCurve::new([Point3::ORIGIN, Point3::new(10.0, 0.0, 0.0)], false).unwrap();
        let line = line.twisted(vec![(0.2, 1.0), (0.7, 2.0)]);
        assert_eq!(
            [0.0, 2.0, 4.5, 10.0].map(|s| line.twist_at(s)),
            [1.0, 1.0, 1.5, 2.0]
        );
        assert_eq!(SpaceCurve::circle(1.0).unwrap().twist_at(1.0), 0.0);
    }
}
