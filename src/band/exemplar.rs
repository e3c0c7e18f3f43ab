//! The exemplar in the axes of a band (Zhou 2014, section 3.2): u to the right from its left end,
//! v up as drawn from the middle of its height, contours with the interior on their left. Where
//! it is cut is decided elsewhere.

use crate::diagnostic::Diagnostic;
use crate::geometry::polygon::{signed_area, unite};
use crate::geometry::{Bounds, Point, Polygon, Ring, topology};

/// A vector shape ready to be cut into pieces.
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
    /// The shape of `area`, which is in the drawing plane (y down), scaled to the height `fit` if there
    /// is one. Contours that cross are repaired by taking what lies in any polygon, with a warning.
    ///
    /// # Errors
    /// An exemplar without area, or with coordinates that are not numbers.
    pub fn new(area: &[Polygon], fit: Option<f64>) -> Result<(Exemplar, Vec<Diagnostic>), Diagnostic> {
        let mut warnings = Vec::new();
        let repaired;
        let mut area = area;
        if let Err(error) = topology::count(area) {
            repaired = unite(area).map_err(|e| Diagnostic::error(format!("the exemplar cannot be used: {e}")))?;
            area = &repaired;
            let place = error.place().map_or(String::new(), |p| format!(" near ({}, {})", p.x, p.y));
            warnings.push(
                Diagnostic::warning(format!("the exemplar's outline crosses or touches itself{place}"))
                    .help("what lies inside by the fill rule is used"),
            );
        }
        let bounds = area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let total: f64 = area.iter().map(Polygon::area).sum();
        if !(total > 1e-9 * bounds.width() * bounds.height() && total.is_finite()) {
            return Err(Diagnostic::error("the exemplar has no area")
                .help("bands are made of filled shapes or of strokes with a width"));
        }
        let scale = fit.map_or(1.0, |height| height / bounds.height());
        let center = bounds.center().y;
        let place = |p: &Point| Point::new((p.x - bounds.min.x) * scale, (center - p.y) * scale);
        let speck = 1e-10 * bounds.width() * bounds.height() * scale * scale;
        let contours: Vec<Ring> = area
            .iter()
            .flat_map(Polygon::rings)
            .map(|ring| separated(ring.iter().rev().map(place).collect()))
            .filter(|ring| signed_area(ring).abs() > speck)
            .collect();
        if let Err(error) = topology::count_rings(&contours) {
            return Err(Diagnostic::error(format!("the exemplar cannot be cut into pieces: {error}")));
        }
        Ok((Exemplar { contours, width: bounds.width() * scale, height: bounds.height() * scale }, warnings))
    }
}

/// The ring without repeated points.
fn separated(mut ring: Ring) -> Ring {
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
        Polygon { outer: corners.map(Point::from).to_vec(), holes: vec![] }
    }

    #[test]
    fn up_is_up_as_drawn_and_the_interior_is_on_the_left() {
        let (exemplar, warnings) = Exemplar::new(&[rectangle(10.0, 10.0, 30.0, 2.0)], Some(4.0)).unwrap();
        assert!(warnings.is_empty());
        assert_eq!((exemplar.width, exemplar.height), (60.0, 4.0));
        assert_eq!(signed_area(&exemplar.contours[0]), 240.0);
        assert!(exemplar.contours[0].contains(&Point::new(0.0, 2.0)));
    }

    #[test]
    fn overlaps_are_united_with_a_warning() {
        let (exemplar, warnings) =
            Exemplar::new(&[rectangle(0.0, 0.0, 10.0, 4.0), rectangle(5.0, 1.0, 10.0, 2.0)], None).unwrap();
        assert_eq!((exemplar.contours.len(), warnings.len()), (1, 1));
        assert_eq!(signed_area(&exemplar.contours[0]), 50.0);
    }

    #[test]
    fn nothing_is_no_exemplar() {
        assert!(Exemplar::new(&[], None).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, 4.0, 0.0)], None).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, f64::NAN, 1.0)], None).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, f64::INFINITY, 1.0)], None).is_err());
    }
}
