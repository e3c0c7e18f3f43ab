//! Cutouts made thick along what they lie on, the drawing plane or the strip along a curve, to either side of it or
//! to both. Every component becomes a closed mesh with one handle for each hole, and a loop has no seam. Areas that lie
//! in the drawing plane are thickened by `extrude`.

use super::inlay::thicken_imprint;
use super::strip::{Sheet, tidied};
use super::{SolidError, extrude};
use fretwork_geometry::mesh::{Along, self_crossing};
use fretwork_geometry::{Carrier, Cutout, Mesh, Point3, Ribbon, Side};

/// Where a body overlaps itself. It is closed all the same; a slicer takes what lies in any part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Overlap {
    /// The strip is bent so sharply here that one of its faces shows from the other side.
    Fold(Point3),
    /// Two parts of the strip, or the strip's two ends, pass through each other here.
    Crossing(Point3),
}

/// The body of `cutout`, `thickness` thick on this side of what it lies on; and a place where the body overlaps itself, if
/// there is one.
///
/// The polygons are triangulated in the coordinates of their carrier, where a loop is a ring, by a constrained
/// Delaunay triangulation that has the lines across the strip at the curve's joints as edges (each as far as it is inside);
/// between two joints the strip is ruled, so that the body follows it exactly at its corners. No corner is added. O(n log n).
///
/// # Errors
/// A thickness that is not above zero; polygons that cross; a body whose components or handles are not those that
/// the cutout has.
pub fn thicken(
    cutout: &Cutout,
    thickness: f64,
    side: Side,
) -> Result<(Mesh, Option<Overlap>), SolidError> {
    if !(thickness > 0.0 && thickness.is_finite()) {
        return Err(SolidError::Size(thickness));
    }
    let [low, high] = cutout.thickness_between(thickness, side);
    thicken_between(cutout, low, high)
}

/// As [`thicken`], between these distances from the drawing plane or the strip, outward.
///
/// # Errors
/// Distances that are not in order, and as there.
pub fn thicken_between(
    cutout: &Cutout,
    low: f64,
    high: f64,
) -> Result<(Mesh, Option<Overlap>), SolidError> {
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(SolidError::Size(high - low));
    }
    if let Carrier::Surface(imprint) = &cutout.carrier {
        return Ok((thicken_imprint(cutout, imprint, low, high)?, None));
    }
    let polygons = tidied(cutout);
    let ribbon = match &cutout.carrier {
        Carrier::Plane | Carrier::Surface(_) => {
            return Ok((extrude(&polygons, low, high)?, None));
        }
        Carrier::Strip(ribbon) | Carrier::Ring { ribbon, .. } => ribbon,
    };
    let mut mesh = Mesh::default();
    let mut fold = None;
    // Of every corner of the mesh, where it is along the curve and across it.
    let mut places = Vec::new();
    for polygon in &polygons {
        let sheet = Sheet::new(polygon, cutout, ribbon)?;
        sheet.push_body(&mut mesh, ribbon, [low, high]);
        places.extend(sheet.corners.iter().chain(&sheet.corners));
        fold = fold.or_else(|| sheet.fold(ribbon, [low, high]));
    }
    if mesh.triangles.is_empty() {
        return Err(SolidError::Nothing);
    }
    let found = mesh.check_closed()?;
    let wanted = (cutout.components, Some(cutout.holes + cutout.around));
    if (found.components, found.genus) != wanted {
        return Err(SolidError::Handles {
            found: (found.components, found.genus.unwrap_or(0)),
            wanted: (wanted.0, cutout.holes + cutout.around),
        });
    }
    // What lies in the plane of its curve is known not to cross itself.
    let crossing = || {
        if cutout.is_in_place() {
            None
        } else {
            far_crossing(&mesh, &places, ribbon, high - low)
        }
    };
    let overlap = fold
        .map(Overlap::Fold)
        .or_else(|| crossing().map(Overlap::Crossing));
    Ok((mesh, overlap))
}

/// Where parts of the body meet that are farther from one another along the curve than the body is wide and thick.
fn far_crossing(
    mesh: &Mesh,
    places: &[(f64, f64)],
    ribbon: &Ribbon,
    thickness: f64,
) -> Option<Point3> {
    let far = places
        .iter()
        .map(|place| place.1.abs())
        .fold(thickness, |far, across| far.max(across + thickness));
    let period = ribbon.curve().is_closed().then(|| ribbon.curve().length());
    let places: Vec<f64> = places.iter().map(|place| place.0).collect();
    self_crossing(
        mesh,
        &Along {
            places: &places,
            far,
            period,
        },
    )
}

#[cfg(test)]
mod tests;
