//! From what is drawn to what a machine is given, in the order in which the steps depend on one
//! another.

use super::clip::clip;
use super::deduplicate::deduplicate;
use super::kerf;
use super::layer::Sheet;
use super::optimize::{Outlines, ordered};
use super::unite::united;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::Polygon;

/// How a sheet is made ready.
#[derive(Clone, Copy, Debug, Default)]
pub struct Preparation<'a> {
    /// What lies outside of it is left out.
    pub region: Option<&'a [Polygon]>,
    /// The full width of the beam, in millimetres in the file.
    pub kerf_mm: f64,
    /// Whether lines are chained and ordered for short travel.
    pub is_optimized: bool,
    /// Whether the file has lines alone, so that areas are their outlines.
    pub is_outlined: bool,
    /// The distance below which points are one, in the units of the sheet.
    pub resolution: f64,
}

/// The sheet made ready, and warnings about it: clipped, one layer a name, compensated for the
/// beam, then no line twice, then in the order of a machine.
///
/// # Errors
/// What [`kerf::compensate`] refuses; areas that cannot be computed.
pub fn prepare(
    sheet: &Sheet,
    preparation: &Preparation<'_>,
) -> Result<(Sheet, Vec<Diagnostic>), Diagnostic> {
    let mut sheet = sheet.clone();
    if let Some(region) = preparation.region {
        sheet = clip(&sheet, region).map_err(|e| Diagnostic::error(e.to_string()))?;
    }
    if preparation.is_outlined {
        sheet
            .layers
            .iter_mut()
            .for_each(|layer| layer.style.fill = None);
    }
    let (sheet, warnings) = kerf::compensate(&united(&sheet), preparation.kerf_mm)?;
    let outlines = Outlines::of(&sheet);
    let sheet = ordered(
        &deduplicate(&sheet, preparation.resolution),
        &outlines,
        preparation.is_optimized,
    );
    Ok((sheet, warnings))
}
