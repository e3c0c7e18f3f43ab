//! Cutouts as files hold them: rounding must not join what is apart, or part what is one.

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Polygon, STEPS_PER_MM, polygon, topology};

/// The polygons with coordinates as they are written, whole ten-thousandths of a millimetre, in
/// units of `unit_mm` millimetres. Their components and holes are counted before and after.
///
/// # Errors
/// Parts so small, or so near to one another, that the counts differ.
pub fn rounded(polygons: &[Polygon], unit_mm: f64) -> Result<Vec<Polygon>, Diagnostic> {
    let held = polygon::rounded(polygons, STEPS_PER_MM * unit_mm);
    let (before, after) = rayon::join(|| topology::count(polygons), || topology::count(&held));
    match after {
        Ok(counts) if before == Ok(counts) => Ok(held),
        _ => {
            let place = after.err().or(before.err()).and_then(|e| e.place());
            let near = place.map_or(String::new(), |p| format!(" near ({:.3}, {:.3})", p.x, p.y));
            let message = format!("parts of the cutout touch or vanish in the file{near}");
            Err(Diagnostic::error(message)
                .help("files hold ten-thousandths of a millimetre: make it larger"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point;

    fn rectangle(x: f64, w: f64) -> Polygon {
        let corners = [[x, 0.0], [x + w, 0.0], [x + w, 3.0], [x, 3.0]];
        Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: vec![],
        }
    }

    #[test]
    fn what_rounding_joins_or_loses_is_an_error() {
        let apart = |gap: f64| [rectangle(0.0, 2.0), rectangle(2.0 + gap, 2.0)];
        assert!(rounded(&apart(2e-4), 1.0).is_ok());
        assert!(rounded(&apart(2e-5), 1.0).is_err());
        assert!(rounded(&apart(2e-5), 10.0).is_ok());
        assert!(
            rounded(&apart(2e-4), 0.1)
                .unwrap_err()
                .message
                .contains("near (2.000, ")
        );
        assert!(rounded(&[rectangle(0.0, 1.0), rectangle(2.0, 2e-5)], 1.0).is_err());
    }
}
