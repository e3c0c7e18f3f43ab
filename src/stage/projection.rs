//! Solids as line drawings.

use super::model::{Form, Thickness, model};
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::{Line, LineKind, Wanted, line_drawing};
use fretwork_geometry::{CurveLabels, Curves, LabelSet, Model, View};
use fretwork_language::kinds::arrangements::{Projection, ShownLines};

/// The lines of a solid, a facade or a surface as it is seen from a direction, labelled by what they are drawn for, or
/// `hidden` where something lies before them.
///
/// # Errors
/// When the value has no volume.
pub fn projection(action: &Action, kind: &Projection) -> StageResult {
    let mut warnings = Vec::new();
    let model = model(
        action,
        &kind.of,
        Form::Scene,
        Thickness::default(),
        &mut warnings,
    )?;
    let Some(view) = View::from(kind.from.0.into()) else {
        let error = Diagnostic::error("the direction has no length");
        return Err(vec![error.at(action.span(), "in this drawing")]);
    };
    let wanted = Wanted {
        crease: libm::cos(kind.crease.0),
        hidden: kind.lines == ShownLines::All,
    };
    Ok((Data::Curves(lines(&model, &view, wanted).into()), warnings))
}

/// The lines of a model, with their labels.
pub fn lines(model: &Model, view: &View, wanted: Wanted) -> Curves {
    let mut curves = Curves::new();
    for line in line_drawing(&model.merged(), view, wanted) {
        let labels = labels(&line);
        curves.push(line.points, CurveLabels::edge(labels));
    }
    curves
}

/// What is hidden has no other label, so that it can have a look of its own.
fn labels(line: &Line) -> LabelSet {
    LabelSet::one(match line.kind {
        _ if !line.is_visible => "hidden",
        LineKind::Border => "border",
        LineKind::Silhouette => "silhouette",
        LineKind::Crease => "crease",
    })
}
