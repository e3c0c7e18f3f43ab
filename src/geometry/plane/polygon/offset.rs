//! Polygons grown and shrunk.

use super::stroke::parallel;
use super::{AreaError, Grid, Polygon, Ring};
use crate::drawing::Join;

/// The polygons grown by `distance` on every side of their outlines, or shrunk where it is
/// negative: the union with, or the difference from, everything that close to an outline. What
/// gets thinner than nothing vanishes, what meets is united. `join` shapes the corners
/// ([`Join::Round`] gives the exact parallel outline within `tolerance`).
pub fn offset(
    polygons: &[Polygon],
    distance: f64,
    join: Join,
    tolerance: f64,
) -> Result<Vec<Polygon>, AreaError> {
    if !(tolerance.is_finite() && tolerance > 0.0) {
        return Err(AreaError::Tolerance(tolerance));
    }
    if distance == 0.0 {
        return Grid::over(polygons.iter().flat_map(Polygon::rings))?.unite(polygons);
    }
    let rings = polygons.iter().flat_map(Polygon::rings);
    let moved: Vec<Ring> = rings
        .map(|ring| parallel(ring, distance, join, tolerance))
        .collect();
    Grid::over(&moved)?.positive(&moved)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Point;

    fn frame() -> Polygon {
        let square = |a: f64, b: f64| {
            vec![
                Point::new(a, a),
                Point::new(b, a),
                Point::new(b, b),
                Point::new(a, b),
            ]
        };
        let mut hole = square(3.0, 7.0);
        hole.reverse();
        Polygon {
            outer: square(0.0, 10.0),
            holes: vec![hole],
        }
    }

    fn area(distance: f64, join: Join) -> f64 {
        offset(&[frame()], distance, join, 1e-4)
            .unwrap()
            .iter()
            .map(Polygon::area)
            .sum()
    }

    #[test]
    fn corners_are_mitred_or_round() {
        assert!((area(0.5, Join::Miter(4.0)) - (121.0 - 9.0)).abs() < 1e-6);
        let rounding = 1.0 - std::f64::consts::PI / 4.0;
        assert!((area(0.5, Join::Round) - (121.0 - rounding - 9.0)).abs() < 1e-3);
        assert!((area(-0.5, Join::Round) - (81.0 - 25.0 + rounding)).abs() < 1e-3);
    }

    #[test]
    fn what_is_thinner_than_the_distance_vanishes() {
        assert!(
            offset(&[frame()], -1.9, Join::Round, 1e-3)
                .unwrap()
                .is_empty()
        );
        let solid = offset(&[frame()], 2.1, Join::Round, 1e-3).unwrap();
        assert!(solid.len() == 1 && solid[0].holes.is_empty());
        assert_eq!(area(0.0, Join::Round), 84.0);
    }

    #[test]
    fn a_bad_tolerance_is_an_error() {
        assert_eq!(
            offset(&[frame()], 1.0, Join::Round, 0.0),
            Err(AreaError::Tolerance(0.0))
        );
        assert!(offset(&[frame()], f64::INFINITY, Join::Round, 1.0).is_err());
    }
}
