//! Drawings laid on surfaces: their areas fetched, the room called.

use std::sync::Arc;

use fretwork_action::{Action, Data, StageResult, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::nearest::Nearest;
use fretwork_geometry::{Bounds, Curves, Cutout, Form, Point3, Polygon, Region};
use fretwork_language::kinds::wraps::{AroundForm, Wrap};
use fretwork_primitive::placement::thickness_side;
use fretwork_primitive::{default_tolerance, fine_on_object};
use fretwork_wrap::{Around, Drawn, Laying};

/// Round ends and corners of strokes are within this part of the drawing's longer side.
const ROUNDNESS: f64 = 1e-3;

/// A place is far from a surface when it is farther than this part of its longest side.
const FAR: f64 = 0.45;

/// Lengths that change by more than this factor show.
const STRETCHED: f64 = 1.5;

/// Lays a drawing on a surface.
///
/// # Errors
/// A drawing without an area, and one that cannot be laid there.
pub fn wrap(action: &Action, kind: &Wrap) -> StageResult {
    let region = kind.region.as_ref().map(|region| action.input(region));
    let (area, own) = area(action, kind, region.as_deref())?;
    let bounds = region.as_ref().or(own.as_ref()).map_or_else(
        || area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds())),
        |region| region.bounds(),
    );
    let is_periodic = region.or(own).is_some_and(|region| region.tile().is_some());
    let laying = Laying {
        scale: kind.scale.0,
        rotate: kind.rotate.0,
        around: match kind.repeat {
            Some(AroundForm::Spaced(count)) => Around::Spaced(count as usize),
            Some(AroundForm::Joined) => Around::Joined,
            None if is_periodic => Around::Joined,
            None => Around::Once,
        },
        tolerance: kind.length_tolerance.0,
    };
    let quarters = kind.rotate.0 / std::f64::consts::FRAC_PI_2;
    if is_periodic && (quarters - libm::round(quarters)).abs() > 1e-9 {
        let error = Diagnostic::error("a periodic region closes only when it stands upright");
        let at = action.definition.field_key(&["wrap", "rotate"]);
        return Err(vec![error.at(at, "turn it by quarter turns")]);
    }
    let drawn = Drawn {
        area: &area,
        bounds,
    };
    let at = kind.at.map(|at| Point3::from(at.0));
    match fretwork_wrap::wrap(&drawn, &action.input(&kind.onto), at, &laying) {
        Ok(mut cutout) => {
            cutout.side = thickness_side(kind.side);
            let warnings = stretched(action, kind, &cutout).into_iter();
            let warnings = warnings.chain(far(action, kind)).collect();
            Ok((Data::Cutout(Arc::new(cutout)), warnings))
        }
        Err(error) => {
            let told = failed(action, error.to_string());
            Err(vec![match error.help(kind.scale.0) {
                Some(help) => told.help(help),
                None => told,
            }])
        }
    }
}

/// A warning where the place for a drawing is nowhere near the surface, so that the nearest place of that says little.
fn far(action: &Action, kind: &Wrap) -> Option<Diagnostic> {
    let at = Point3::from(kind.at?.0);
    let surface = action.input(&kind.onto);
    let foot = Nearest::new(&surface.mesh).foot(at)?;
    let off = foot.at.distance(at);
    if off < FAR * surface.bounds().longest_side() {
        return None;
    }
    let message = format!(
        "the place is {} away from the surface, whose nearest place is ({}, {}, {})",
        rounded(off),
        rounded(foot.at.x),
        rounded(foot.at.y),
        rounded(foot.at.z)
    );
    let place = action.definition.field(&["wrap", "at"]);
    Some(Diagnostic::warning(message).at(place, "taken instead"))
}

/// A length for people, to three digits after the point.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

/// A warning where a drawing on a mesh is distorted so that it shows. On turned surfaces lengths around change by rule.
fn stretched(action: &Action, kind: &Wrap, cutout: &Cutout) -> Option<Diagnostic> {
    let [least, _, most] = cutout.measures.wrapping.as_ref()?.stretch;
    let is_mesh = matches!(action.input(&kind.onto).form, Form::Free);
    if !is_mesh || (least >= 1.0 / STRETCHED && most <= STRETCHED) {
        return None;
    }
    let message = format!(
        "the surface cannot be laid flat there: lengths of `{}` become {least:.2} to {most:.2} times what they are",
        kind.from.name
    );
    let warning = Diagnostic::warning(message).at(action.span(), "in this cutout");
    Some(warning.help("scale it down, choose a flatter place, or divide it into several drawings"))
}

/// The area of what is laid on the surface, and the region that it is, if it is one.
fn area(
    action: &Action,
    kind: &Wrap,
    region: Option<&Region>,
) -> Result<(Vec<Polygon>, Option<Arc<Region>>), Vec<Diagnostic>> {
    let value = action.value(&kind.from);
    if kind.width.is_some() && !matches!(value, Value::Data(Data::Curves(_)) | Value::Deferred(_)) {
        let error = Diagnostic::error(format!("`{}` has an area already", kind.from.name));
        let at = action.definition.field_key(&["wrap", "width"]);
        return Err(vec![error.at(at, "the width is that of lines")]);
    }
    match value {
        Value::Data(Data::Region(own)) => Ok((own.area.clone(), Some(own.clone()))),
        Value::Data(Data::Cutout(cutout)) => Ok((cutout.flat(), None)),
        Value::Data(Data::Drawing(drawing)) => {
            let fine = fine_on_object(action.definition.units);
            let side = drawing.bounds().longer_side();
            let tolerance = default_tolerance(side, ROUNDNESS, fine);
            let area = drawing.areas(tolerance);
            Ok((area.map_err(|e| vec![failed(action, e.to_string())])?, None))
        }
        Value::Data(Data::Curves(curves)) => {
            lines(action, kind, curves, region).map(|area| (area, None))
        }
        Value::Deferred(_) => {
            let told = failed(
                action,
                format!("`{}` is drawn on no region", kind.from.name),
            );
            Err(vec![told.help("add `region:` beside `from`")])
        }
        Value::Data(_) => Err(vec![action.unsupported("this on a surface")]),
    }
}

/// The area of lines of the width that the node gives.
fn lines(
    action: &Action,
    kind: &Wrap,
    curves: &Curves,
    region: Option<&Region>,
) -> Result<Vec<Polygon>, Vec<Diagnostic>> {
    let Some(width) = kind.width else {
        let told = failed(
            action,
            format!("the lines of `{}` have no width", kind.from.name),
        );
        return Err(vec![told.help("add `width: 1.2` beside `from`")]);
    };
    fretwork_arrangement::widened(curves, region, width.0)
        .map_err(|e| vec![failed(action, e.to_string())])
}

fn failed(action: &Action, message: String) -> Diagnostic {
    Diagnostic::error(message).at(action.span(), "in this cutout")
}
