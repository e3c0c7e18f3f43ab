//! Stripes: a region cut by parallel lines (Loi 2015, section 3.3; rules R5 and R6).

use crate::error::ArrangementError;
use crate::partition::boundary::{Cutting, add_contour};
use crate::partition::lines::Lines;
use crate::partition::period::check_period;
use crate::partition::properties::StripesProperties;
use fretwork_geometry::{Bounds, CurveLabels, Curves, Region};

/// The lines of `properties` inside `region`, oriented along their angle, and after them the
/// contour of the region. Lines are anchored at the anchor or the lower-left corner of the region's box, which
/// lies in the middle of stripe 0.
///
/// Time and memory grow with the crossings of lines and border, sorted.
pub fn stripes(
    properties: &StripesProperties,
    region: &Region,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    stripes_in(properties, region, resolution, None)
}

/// The same without curves that do not come into a room, and perhaps some more; all where there is none. Time grows with the
/// lines in the room and with the crossings of all lines with the border.
///
/// # Errors
/// Those of [`stripes`].
pub(crate) fn stripes_in(
    properties: &StripesProperties,
    region: &Region,
    resolution: f64,
    room: Option<&Bounds>,
) -> Result<Curves, ArrangementError> {
    let anchor = properties.anchor.unwrap_or(region.page().min);
    let lines = Lines::new(properties, anchor, resolution)?;
    let mut curves = Curves::new();
    if region.bounds().is_empty() {
        return Ok(curves);
    }
    lines.check_extent(region.area.iter().flat_map(|p| p.outer.iter().copied()))?;
    lines.check_extent(region.contour.points().iter().copied())?;
    check_period(properties, region)?;
    for piece in lines.clip(region, resolution, &lines.through(room))? {
        let labels = CurveLabels {
            edge: lines.edge_label(piece.line),
            left: lines.face_label(piece.line),
            right: lines.face_label(piece.line - 1),
            ..CurveLabels::default()
        };
        curves.push([piece.from, piece.to], labels);
    }
    add_contour(
        &region.contour,
        &[&lines],
        |[k, _]| lines.face_label(k),
        Cutting {
            tolerance: resolution,
            room,
        },
        &mut curves,
    );
    Ok(curves)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{LabelSet, Point, Polygon, Region};
    use std::f64::consts::PI;

    fn square(side: f64) -> Region {
        Region::rectangle(Point::ORIGIN, Point::new(side, side))
    }

    fn lines_of(curves: &Curves, count: usize) -> Vec<[Point; 2]> {
        (0..count)
            .map(|i| [curves.get(i).points[0], curves.get(i).points[1]])
            .collect()
    }

    #[test]
    fn the_anchor_lies_in_the_middle_of_stripe_zero() {
        let mut p = StripesProperties::new(0.0, vec![4.0, 2.0]);
        p.face_labels = vec![LabelSet::one("a"), LabelSet::one("b")];
        let curves = stripes(&p, &square(10.0), 1e-9).unwrap();
        // Lines at 2, 4, 8, 10: the last runs along the upper side and is inside.
        let y: Vec<f64> = curves
            .iter()
            .filter(|c| c.points.len() == 2 && c.points[0].y == c.points[1].y)
            .map(|c| c.points[0].y)
            .collect();
        assert_eq!(y, [2.0, 4.0, 8.0, 10.0, 0.0, 10.0]);
        let labels = curves.get(0).labels;
        assert!(
            labels.left.contains("b") && labels.right.contains("a"),
            "stripe 0 lies below line 1 of offset 2"
        );
    }

    #[test]
    fn lines_are_oriented_along_their_angle_and_end_on_the_contour() {
        let curves = stripes(
            &StripesProperties::new(-PI / 3.0, vec![110.0]),
            &square(2000.0),
            1e-6,
        )
        .unwrap();
        let d = Point::unit(-PI / 3.0);
        let ends: Vec<Point> = curves
            .iter()
            .skip(25)
            .flat_map(|c| c.points.to_vec())
            .collect();
        for [a, b] in lines_of(&curves, 25) {
            assert!(((b - a) * (1.0 / a.distance(b))).distance(d) < 1e-9);
            assert!(
                ends.contains(&a) && ends.contains(&b),
                "the contour is cut at the same bits"
            );
        }
        // 25 lines, 4 corners and 50 ends: 54 pieces of contour.
        assert_eq!(curves.len(), 25 + 54);
        let length: f64 = curves
            .iter()
            .map(|c| c.points[0].distance(c.points[1]))
            .sum();
        assert!((length - 44369.50417228136).abs() < 1e-6 * length);
    }

    #[test]
    fn holes_and_lines_through_corners_are_clipped_exactly() {
        let ring = |lo: f64, hi: f64| vec![[lo, lo], [hi, lo], [hi, hi], [lo, hi]];
        let ring = |lo, hi| {
            ring(lo, hi)
                .into_iter()
                .map(Point::from)
                .collect::<Vec<_>>()
        };
        let mut hole = ring(4.0, 6.0);
        hole.reverse();
        let region = Region::of_area(vec![Polygon {
            outer: ring(0.0, 10.0),
            holes: vec![hole],
        }]);
        // Lines at 2, 6, 10: along the upper sides of the hole and of the square.
        let lines = stripes(&StripesProperties::new(0.0, vec![4.0]), &region, 1e-9).unwrap();
        let along: f64 = lines_of(&lines, 3)
            .iter()
            .map(|[a, b]| a.distance(*b))
            .sum();
        assert_eq!(along, 30.0);
        // Lines at 45 degrees that touch two corners of a square leave nothing, and cut nothing.
        let p = StripesProperties::new(PI / 4.0, vec![2f64.sqrt() * 8.0]);
        let curves = stripes(
            &p,
            &Region::of_area(vec![Polygon {
                outer: ring(0.0, 8.0),
                holes: vec![],
            }]),
            1e-9,
        )
        .unwrap();
        assert_eq!((curves.len(), curves.points().len()), (1, 5));
    }

    #[test]
    fn what_is_no_stripe_is_an_error() {
        let at =
            |angle, spacing| stripes(&StripesProperties::new(angle, spacing), &square(10.0), 1e-9);
        for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-12] {
            assert!(
                matches!(
                    at(0.0, vec![1.0, spacing]),
                    Err(ArrangementError::Spacing { .. })
                ),
                "{spacing}"
            );
        }
        assert_eq!(at(0.0, vec![]), Err(ArrangementError::NoSpacing));
        assert!(matches!(
            at(f64::NAN, vec![1.0]),
            Err(ArrangementError::Angle(_))
        ));
        assert!(matches!(
            at(0.0, vec![1e-7]),
            Err(ArrangementError::TooMany { .. })
        ));
        assert_eq!(
            stripes(
                &StripesProperties::new(0.0, vec![1.0]),
                &Region::of_area(vec![]),
                1e-9
            ),
            Ok(Curves::new())
        );
    }
}
