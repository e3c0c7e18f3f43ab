//! Bands and panels: the area of the exemplar and the curve fetched, the room called.

use std::sync::Arc;

use fretwork_action::{Action, Data, StageResult};
use fretwork_band::{Areas, Fault};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Cutout, Drawing, FillRule, Polygon, STEPS_PER_MM, topology};
use fretwork_language::kinds::bands::{Band, Ends};
use fretwork_language::kinds::panels::Panel;
use fretwork_language::kinds::side::Side;
use fretwork_language::{Ref, wants};
use fretwork_primitive::placement::thickness_side;
use fretwork_primitive::{default_tolerance, fine_on_object};

/// Round ends and corners of strokes are within this part of the drawing's longer side.
const ROUNDNESS: f64 = 1e-3;

/// Makes a pattern along a curve.
pub fn band(action: &Action, kind: &Band) -> StageResult {
    let (exemplar, mut warnings) = area(action, &kind.exemplar, "its exemplar")?;
    let cap = match &kind.ends {
        Ends::Cap(cap) => {
            let (cap, more) = area(action, cap, "the cap of its ends")?;
            warnings.extend(more);
            Some(cap)
        }
        Ends::Free | Ends::Bar(_) => None,
    };
    let areas = Areas {
        exemplar: &exemplar,
        cap: cap.as_deref(),
    };
    let curve = action.input(&kind.curve);
    let made = fretwork_band::band(kind, areas, &curve, steps(action)).map_err(|fault| {
        let Fault { diagnostic, field } = fault;
        vec![match field {
            Some(field) => diagnostic.at(action.definition.field(&[field]), ""),
            None => diagnostic,
        }]
    });
    finished(action, made, kind.side, &mut warnings)
}

/// Makes a pattern that fills a rectangle.
pub fn panel(action: &Action, kind: &Panel) -> StageResult {
    let (area, mut warnings) = area(action, &kind.exemplar, "its exemplar")?;
    let made = fretwork_band::panel(kind, &area, steps(action));
    finished(action, made, kind.side, &mut warnings)
}

/// Steps of the coordinates in files that make a unit.
fn steps(action: &Action) -> f64 {
    STEPS_PER_MM * action.definition.units.millimetres()
}

/// The value of a stage: the cutout, with its thickness on this side when it becomes a solid, and the warnings.
fn finished(
    action: &Action,
    made: Result<(Cutout, Vec<Diagnostic>), Vec<Diagnostic>>,
    side: Side,
    warnings: &mut Vec<Diagnostic>,
) -> StageResult {
    let here = |d: Diagnostic| d.at(action.span(), "in this pattern");
    let mut warnings = std::mem::take(warnings);
    match made {
        Ok((mut cutout, more)) => {
            cutout.side = thickness_side(side);
            warnings.extend(more.into_iter().map(here));
            Ok((Data::Cutout(Arc::new(cutout)), warnings))
        }
        Err(errors) => {
            warnings.extend(errors.into_iter().map(here));
            Err(warnings)
        }
    }
}

/// The area that an exemplar covers, with a warning where an outline of it crosses itself; `what` it
/// is to the pattern is told with these.
fn area(
    action: &Action,
    exemplar: &Ref<wants::VectorExemplar>,
    what: &'static str,
) -> Result<(Vec<Polygon>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let drawing = action.input(exemplar);
    let side = drawing.bounds().longer_side();
    let fine = fine_on_object(action.definition.units);
    let tolerance = default_tolerance(side, ROUNDNESS, fine);
    let here = |d: Diagnostic| d.at(action.span(), what);
    let area = drawing.areas(tolerance);
    let area = area.map_err(|e| {
        vec![here(Diagnostic::error(format!(
            "the exemplar cannot be used: {e}"
        )))]
    })?;
    Ok((area, crossing(&drawing).map(here).into_iter().collect()))
}

/// The warning about the first filled outline that crosses itself.
fn crossing(drawing: &Drawing) -> Option<Diagnostic> {
    let filled = drawing.shapes.iter().filter(|shape| shape.filled);
    let mut crossed = filled.flat_map(|s| s.paths.iter().map(move |path| (s.rule, path)));
    let (rule, at) = crossed.find_map(|(rule, path)| Some((rule, topology::crossing(path)?)))?;
    let rule = match rule {
        FillRule::NonZero => "non-zero",
        FillRule::EvenOdd => "even-odd",
    };
    let message = format!(
        "an outline of the exemplar crosses or touches itself near ({:.3}, {:.3})",
        at.x, at.y
    );
    Some(Diagnostic::warning(message).help(format!(
        "what lies inside by its fill rule, {rule}, is used"
    )))
}
