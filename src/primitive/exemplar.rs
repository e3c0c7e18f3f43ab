//! Vector exemplars: drawings read from SVG.

use std::sync::Arc;

use super::placement::turn;
use super::tolerance::{default_tolerance, fine_in_plane};
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine, Drawing};
use fretwork_language::kinds::exemplars::VectorExemplar;
use fretwork_language::scalar::{FilePath, Text};
use fretwork_source::svg::{self, SvgOptions};

/// Reads the drawing, or an element of it, and turns it. Without a tolerance it is flattened to a
/// thousandth of its longer side, and to what nobody sees at most.
pub fn vector(action: &Action, kind: &VectorExemplar) -> StageResult {
    let tolerance = match &kind.tolerance {
        Some(length) => Tolerance::Length(length.0),
        None => Tolerance::Default {
            part: 1e-3,
            magnified: magnification(kind.turn.scale.0),
        },
    };
    let (drawing, warnings) = read(action, &kind.file, kind.id.as_ref(), tolerance)?;
    let drawing = upright(action, drawing);
    let map = turn(&kind.turn, drawing.bounds().center());
    Ok((Data::Drawing(Arc::new(drawing.transformed(&map))), warnings))
}

/// How far a polyline may be from its curve.
pub enum Tolerance {
    /// A length.
    Length(f64),
    /// The usual one.
    Default {
        /// The part of the drawing's longer side that it is at most.
        part: f64,
        /// By how much the drawing grows after it was read.
        magnified: f64,
    },
}

/// By how much these factors make something larger; 1 where they make it smaller.
pub fn magnification(scale: [f64; 2]) -> f64 {
    scale.iter().fold(1.0, |most, s| most.max(s.abs()))
}

/// A nanometre: finer polylines only cost time.
pub const LEAST_TOLERANCE_MM: f64 = 1e-6;

/// The drawing as it lies in the plane of the spec: files of drawings have y down, and maps have it up.
pub(super) fn upright(action: &Action, drawing: Drawing) -> Drawing {
    match action.definition.map {
        Some(_) => drawing.transformed(&Affine::scale(1.0, -1.0)),
        None => drawing,
    }
}

/// A drawing in units of `unit`.
fn in_units(drawing: Drawing, unit: f64) -> Drawing {
    if unit == 1.0 {
        drawing
    } else {
        drawing.transformed(&Affine::scale(unit, unit))
    }
}

/// The drawing in an SVG file, or the element of it that `id` names, and warnings.
///
/// # Errors
/// When the file cannot be read, is no SVG, or has no such element.
pub fn read(
    action: &Action,
    file: &FilePath,
    id: Option<&Text>,
    tolerance: Tolerance,
) -> Result<(Drawing, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (path, bytes) = action.file(&file.0)?;
    let named = |d: Diagnostic| d.at(action.span(), "the drawing is named here");
    let text = svg::decode(&bytes, &path).map_err(|d| vec![named(d)])?;
    let unit_mm = action.definition.units.millimetres();
    if let Tolerance::Length(tolerance) = tolerance
        && tolerance * unit_mm < LEAST_TOLERANCE_MM
    {
        let error = Diagnostic::error(format!(
            "a tolerance of {tolerance} is finer than anything can be made"
        ));
        let help = format!("the least is {LEAST_TOLERANCE_MM} mm");
        return Err(vec![error.at(action.span(), "in this drawing").help(help)]);
    }
    // What a drawing without a size is drawn in is a unit of the file that names it.
    let unit = action.definition.own_unit();
    let read = |tolerance: f64| {
        let options = SvgOptions {
            tolerance: tolerance / unit,
            unit_mm: unit_mm * unit,
        };
        let all = |told: Vec<Diagnostic>| told.into_iter().map(named).collect();
        svg::select(text, &path, &options, id.map(|id| &*id.0))
            .map(|(drawing, warnings)| (in_units(drawing, unit), all(warnings)))
            .map_err(all)
    };
    match tolerance {
        Tolerance::Length(tolerance) => read(tolerance),
        Tolerance::Default { part, magnified } => {
            // How large it is shows in the coarsest reading.
            let side = read(1e12)?.0.bounds().longer_side();
            let fine = fine_in_plane(&action.definition, action.definition.units);
            read(default_tolerance(side, part, fine / magnified))
        }
    }
}
