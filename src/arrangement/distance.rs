//! Distances between polylines.

use fretwork_geometry::{Curves, Point};

/// A segment.
pub(crate) type Segment = [Point; 2];

/// All segments of curves.
pub(crate) fn segments(curves: &Curves) -> impl Iterator<Item = Segment> + '_ {
    curves
        .iter()
        .flat_map(|curve| curve.points.windows(2).map(|w| [w[0], w[1]]))
}

/// The nearest points of two segments, the first on `s`; where they cross, the crossing.
pub(crate) fn nearest(s: Segment, t: Segment) -> [Point; 2] {
    if let Some(p) = crossing(s, t) {
        return [p, p];
    }
    // Segments that do not cross are nearest at an end of one of them.
    let ends = [
        [s[0], project(s[0], t)],
        [s[1], project(s[1], t)],
        [project(t[0], s), t[0]],
        [project(t[1], s), t[1]],
    ];
    let distance = |pair: &[Point; 2]| pair[0].distance(pair[1]);
    ends.into_iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .expect("there are four pairs")
}

/// The point of a segment that is nearest to `p`.
pub(crate) fn project(p: Point, [a, b]: Segment) -> Point {
    let along = b - a;
    let part = (p - a).dot(along) / along.dot(along);
    if part.is_nan() {
        a
    } else {
        a.lerp(b, part.clamp(0.0, 1.0))
    }
}

/// Where two segments cross in the inside of both.
fn crossing([a, b]: Segment, [c, d]: Segment) -> Option<Point> {
    let side = |p: Point, q: Point, r: Point| (q - p).cross(r - p);
    let (of_c, of_d) = (side(a, b, c), side(a, b, d));
    let (of_a, of_b) = (side(c, d, a), side(c, d, b));
    let is_crossed = of_c * of_d < 0.0 && of_a * of_b < 0.0;
    is_crossed.then(|| c.lerp(d, of_c / (of_c - of_d)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    #[test]
    fn nearest_points_agree_with_walking_along_both() {
        for case in 0..200 {
            let seed = Seed::root(case);
            let p = |n: u64| Point::new(seed.unit(2 * n), seed.unit(2 * n + 1));
            let (s, t) = ([p(0), p(1)], [p(2), p(3)]);
            let [on_s, on_t] = nearest(s, t);
            assert!(
                on_s.distance(project(on_s, s)) < 1e-12 && on_t.distance(project(on_t, t)) < 1e-12
            );
            let steps = || (0..=100).map(|i| f64::from(i) / 100.0);
            let walked =
                steps().map(|u| s[0].lerp(s[1], u).distance(project(s[0].lerp(s[1], u), t)));
            let least = walked.fold(f64::INFINITY, f64::min);
            let found = on_s.distance(on_t);
            assert!(
                found <= least + 1e-12 && found > least - 0.02,
                "case {case}: {found} {least}"
            );
        }
        let point = Point::new(3.0, 4.0);
        assert_eq!(
            nearest([point, point], [Point::ORIGIN, Point::ORIGIN])[1],
            Point::ORIGIN
        );
    }
}
