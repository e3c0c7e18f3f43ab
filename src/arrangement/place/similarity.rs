//! Elements put in place: turned, scaled, fitted to points (Loi 2015, tables 3.4 and 3.6;
//! rules R15 to R17).

use crate::cells::contour;
use crate::distance::{project, segments};
use fretwork_geometry::planar_map::{FaceId, PlanarMap};
use fretwork_geometry::{Affine, Curves, Point};

/// Two points nearer than this do not fix a similarity.
const LEAST_DISTANCE: f64 = 1e-6;

/// `curves` scaled by `factor` about the centre of their box, which does not count named points.
pub fn scale(curves: &Curves, factor: f64) -> Curves {
    about_center(curves, Affine::scale(factor, factor))
}

/// `curves` turned by `angle` radians (from +x toward +y) about the centre of their box, which does
/// not count named points.
pub fn rotate(curves: &Curves, angle: f64) -> Curves {
    about_center(curves, Affine::rotation(angle))
}

/// `curves` moved by `by`.
pub fn translate(curves: &Curves, by: Point) -> Curves {
    curves.transformed(&Affine::translation(by))
}

/// `curves` moved so that `source` comes to `target`.
pub fn match_point(curves: &Curves, source: Point, target: Point) -> Curves {
    translate(curves, target - source)
}

/// `curves` turned, scaled and moved so that the two points `source` come to the two points
/// `target`; nothing where the points of a pair (almost) coincide.
pub fn match_points(curves: &Curves, source: [Point; 2], target: [Point; 2]) -> Curves {
    let (from, to) = (source[1] - source[0], target[1] - target[0]);
    if !(from.length() > LEAST_DISTANCE && to.length() > LEAST_DISTANCE) {
        return Curves::new();
    }
    // The quotient to / from as complex numbers: rotation and scale at once.
    let (re, im) = (
        from.dot(to) / from.dot(from),
        from.cross(to) / from.dot(from),
    );
    let turn = Affine([re, im, -im, re, 0.0, 0.0]);
    let map = Affine::translation(-source[0])
        .then(turn)
        .then(Affine::translation(target[0]));
    curves.transformed(&map)
}

/// `curves` scaled and moved so that the circle around them fills the circle in a bounded face: their
/// centre, that of their box, comes to the face's centroid, and the greatest distance of their
/// points from it becomes the distance of the centroid from the face's contour. Nothing for the
/// unbounded face; curves of a single point are only moved.
pub fn match_face(curves: &Curves, map: &PlanarMap, face: FaceId) -> Curves {
    if face == FaceId::UNBOUNDED || curves.is_empty() {
        return Curves::new();
    }
    let (center, target) = (curves.bounds().center(), map.centroid(face));
    let radius = curves
        .points()
        .iter()
        .map(|p| p.distance(center))
        .fold(0.0, f64::max);
    let outline = contour(map, face);
    let room = segments(&outline)
        .map(|s| project(target, s).distance(target))
        .fold(f64::INFINITY, f64::min);
    let factor = if radius > 0.0 { room / radius } else { 1.0 };
    let map = Affine::translation(-center)
        .then(Affine::scale(factor, factor))
        .then(Affine::translation(target));
    curves.transformed(&map)
}

/// The curves whose edge label holds `label`, with all named points.
pub fn curve_labeled(curves: &Curves, label: &str) -> Curves {
    curves.filtered(|_, curve| curve.labels.edge.contains(label))
}

/// The point named `name`, if there is one.
pub fn point_labeled(curves: &Curves, name: &str) -> Option<Point> {
    curves.point_named(name)
}

fn about_center(curves: &Curves, map: Affine) -> Curves {
    let bounds = curves.bounds();
    if bounds.is_empty() {
        curves.clone()
    } else {
        curves.transformed(&map.about(bounds.center()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::CurveLabels;

    fn hook() -> Curves {
        let mut curves = Curves::new();
        curves.push(
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]].map(Point::from),
            CurveLabels::default(),
        );
        curves.name_point("far", Point::new(100.0, 0.0));
        curves
    }

    #[test]
    fn scaling_and_turning_keep_the_middle_of_the_box() {
        for moved in [scale(&hook(), 3.0), rotate(&hook(), std::f64::consts::PI)] {
            assert!(moved.bounds().center().distance(Point::new(1.0, 0.5)) < 1e-12);
        }
        assert_eq!(
            scale(&hook(), 3.0).point_named("far"),
            Some(Point::new(298.0, -1.0))
        );
        assert_eq!(scale(&Curves::new(), 3.0), Curves::new());
    }

    #[test]
    fn a_square_is_fitted_to_a_face_as_a_disc_to_a_disc() {
        let face =
            fretwork_geometry::Region::rectangle(Point::new(10.0, 10.0), Point::new(16.0, 14.0))
                .contour;
        let map = PlanarMap::build(&face, fretwork_geometry::planar_map::resolution(10.0)).unwrap();
        let fitted = match_face(&hook(), &map, FaceId(1));
        assert!(fitted.bounds().center().distance(Point::new(13.0, 12.0)) < 1e-12);
        let farthest = fitted
            .points()
            .iter()
            .map(|p| p.distance(Point::new(13.0, 12.0)))
            .fold(0.0, f64::max);
        assert!((farthest - 2.0).abs() < 1e-9);
        assert!(match_face(&hook(), &map, FaceId::UNBOUNDED).is_empty());
    }

    #[test]
    fn two_points_fix_a_similarity_that_does_not_mirror() {
        let target = [Point::new(5.0, 5.0), Point::new(5.0, 9.0)];
        let moved = match_points(&hook(), [Point::ORIGIN, Point::new(2.0, 0.0)], target);
        let expected = [[5.0, 5.0], [5.0, 9.0], [3.0, 9.0]].map(Point::from);
        assert!(
            moved
                .points()
                .iter()
                .zip(expected)
                .all(|(p, q)| p.distance(q) < 1e-12),
            "{moved:?}"
        );
        assert!(match_points(&hook(), [Point::ORIGIN; 2], target).is_empty());
        assert!(match_points(&hook(), target, [Point::ORIGIN; 2]).is_empty());
        assert!(
            match_points(&hook(), [Point::ORIGIN, Point::new(f64::NAN, 0.0)], target).is_empty()
        );
    }
}
