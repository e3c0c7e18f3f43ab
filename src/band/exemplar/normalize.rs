//! The exemplar in the axes of a band (Zhou 2014, section 3.2): u runs to the right from its left
//! end, v runs up as drawn from the middle of its height, and contours have the interior on their
//! left. Outlines that cross or touch are repaired in `mend`; where the exemplar is cut is decided
//! in `slicing`.

use fretwork_geometry::polygon::signed_area;
use fretwork_geometry::{Bounds, Point, Polygon, Ring, neck, topology};

use super::error::{ExemplarError, ExemplarWarning};
use super::mend::mend_if_needed;

/// A vector shape that can be cut into pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Exemplar {
    /// Simple rings that do not touch, the interior on their left.
    pub contours: Vec<Ring>,
    /// Extent along u, which begins at 0.
    pub width: f64,
    /// Extent along v, whose middle is 0.
    pub height: f64,
}

impl Exemplar {
    /// The shape of `area`, which is in the drawing plane (y down). Contours that cross are
    /// repaired by taking what lies in any polygon, with a warning.
    ///
    /// # Errors
    /// An exemplar without area or with coordinates that are not numbers, and outlines that no
    /// repair makes simple.
    pub fn new(area: &[Polygon]) -> Result<(Exemplar, Vec<ExemplarWarning>), ExemplarError> {
        let (repaired, warnings) = mend_if_needed(area)?;
        let area = repaired.as_deref().unwrap_or(area);
        let bounds = area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let total: f64 = area.iter().map(Polygon::area).sum();
        let box_area = bounds.width() * bounds.height();
        if !(total > 1e-9 * box_area && total.is_finite()) {
            return Err(ExemplarError::Empty);
        }
        let center = bounds.center().y;
        let place = |p: &Point| Point::new(p.x - bounds.min.x, center - p.y);
        // A ring smaller than this is what rounding has left of a point or a line.
        let speck = 1e-10 * bounds.width() * bounds.height();
        let contours: Vec<Ring> = area
            .iter()
            .flat_map(Polygon::rings)
            .map(|ring| without_repeats(ring.iter().rev().map(place).collect()))
            .filter(|ring| signed_area(ring).abs() > speck)
            .collect();
        topology::count_rings(&contours).map_err(ExemplarError::NotSimple)?;
        let exemplar = Exemplar {
            contours,
            width: bounds.width(),
            height: bounds.height(),
        };
        Ok((exemplar, warnings))
    }

    /// The exemplar with these contours, moved to the axes of a band. They are taken as they are:
    /// simple rings that do not touch, the interior on their left, v up.
    pub fn from_contours(contours: Vec<Ring>) -> Exemplar {
        let bounds = Bounds::of(contours.iter().flatten().copied());
        let shift = Point::new(-bounds.min.x, -bounds.center().y);
        let moved = |ring: Ring| ring.into_iter().map(|p| p + shift).collect();
        Exemplar {
            contours: contours.into_iter().map(moved).collect(),
            width: bounds.width(),
            height: bounds.height(),
        }
    }

    /// The same shape, larger by a factor.
    pub fn scaled(&self, factor: f64) -> Exemplar {
        let ring = |contour: &Ring| contour.iter().map(|&p| p * factor).collect();
        Exemplar {
            contours: self.contours.iter().map(ring).collect(),
            width: self.width * factor,
            height: self.height * factor,
        }
    }

    /// The least width that necks and gaps of a pattern in a band of this height should keep: a
    /// part of the height, but not more than most of what the exemplar has at its narrowest place.
    pub fn finest(&self, height: f64) -> f64 {
        let whole = FRAGILE * height;
        let ring = |contour: &Ring| Polygon {
            outer: contour.clone(),
            holes: Vec::new(),
        };
        let area: Vec<Polygon> = self.contours.iter().map(ring).collect();
        neck::below(&area, whole / KEPT)
            .into_iter()
            .map(|neck| KEPT * neck.width)
            .fold(whole, f64::min)
    }
}

/// Gaps and necks below this part of a band's height are mended where that is possible: 0.12 mm in
/// a band of 30 mm. With a greater part, patterns are given up that a machine could make; with a
/// smaller one, threads are left that no machine can.
const FRAGILE: f64 = 4e-3;
/// An exemplar that is itself finer than that keeps this part of its narrowest place. At 1, bending
/// the exemplar a little would already count as damage; far below, real damage would pass.
const KEPT: f64 = 0.8;

/// The ring without repeated points.
fn without_repeats(mut ring: Ring) -> Ring {
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Polygon {
        let corners = [[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
        Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: vec![],
        }
    }

    #[test]
    fn up_is_up_as_drawn_and_the_interior_is_on_the_left() {
        let (exemplar, warnings) = Exemplar::new(&[rectangle(10.0, 10.0, 30.0, 2.0)]).unwrap();
        let exemplar = exemplar.scaled(2.0);
        assert!(warnings.is_empty());
        assert_eq!((exemplar.width, exemplar.height), (60.0, 4.0));
        assert_eq!(signed_area(&exemplar.contours[0]), 240.0);
        assert!(exemplar.contours[0].contains(&Point::new(0.0, 2.0)));
    }

    #[test]
    fn overlaps_are_united_with_a_warning() {
        let (exemplar, warnings) = Exemplar::new(&[
            rectangle(0.0, 0.0, 10.0, 4.0),
            rectangle(5.0, 1.0, 10.0, 2.0),
        ])
        .unwrap();
        assert_eq!((exemplar.contours.len(), warnings.len()), (1, 1));
        assert_eq!(signed_area(&exemplar.contours[0]), 50.0);
    }

    #[test]
    fn parts_that_touch_in_a_point_are_joined_with_a_warning() {
        let board = [rectangle(0.0, 0.0, 5.0, 5.0), rectangle(5.0, 5.0, 5.0, 5.0)];
        let (exemplar, warnings) = Exemplar::new(&board).unwrap();
        assert_eq!(
            topology::count_rings(&exemplar.contours)
                .unwrap()
                .components,
            1
        );
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        let total: f64 = exemplar.contours.iter().map(|r| signed_area(r)).sum();
        assert!((total - 50.0).abs() < 0.3);
    }

    #[test]
    fn crossing_strokes_are_an_exemplar() {
        // Wheels whose spokes end on their rims: the union's rings touch.
        use fretwork_geometry::drawing::{Drawing, Shape, Stroke};
        use fretwork_geometry::{FillRule, LabelSet};
        let at = |c: f64, r: f64, a: f64| Point::new(c, 9.0) + Point::unit(a) * r;
        let circle = |c: f64, r: f64| {
            (0..=40)
                .map(|i| at(c, r, f64::from(i) * 0.157_079_632_679))
                .collect()
        };
        let mut paths: Vec<Vec<Point>> = Vec::new();
        for k in 0..6 {
            let c = 8.0 + 11.0 * f64::from(k);
            paths.extend([circle(c, 5.0), circle(c, 2.2), circle(c + 5.5, 1.6)]);
            paths.extend(
                (0..5)
                    .map(|j| 1.2566 * f64::from(j) + 0.3 * f64::from(k))
                    .map(|a| vec![at(c, 2.2, a), at(c, 5.0, a)]),
            );
        }
        let shape = Shape {
            label: LabelSet::EMPTY,
            paths,
            filled: false,
            rule: FillRule::NonZero,
            stroke: Some(Stroke::round(0.9)),
        };
        let area = Drawing {
            shapes: vec![shape],
            points: vec![],
        }
        .areas(0.05)
        .unwrap();
        let (exemplar, warnings) = Exemplar::new(&area).unwrap();
        assert_eq!(warnings, []);
        assert_eq!(
            topology::count_rings(&exemplar.contours)
                .unwrap()
                .components,
            1
        );
    }

    #[test]
    fn nothing_is_no_exemplar() {
        assert!(Exemplar::new(&[]).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, 4.0, 0.0)]).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, f64::NAN, 1.0)]).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, f64::INFINITY, 1.0)]).is_err());
    }
}
