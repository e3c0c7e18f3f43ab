//! Regions that are cut out of solids: sections and slices.

use super::model::{Form, Thickness, model};
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::sections;
use fretwork_geometry::{Mesh, Point3, Region, View};
use fretwork_language::kinds::regions::{Section, Slices, StackAxis};
use fretwork_language::{Ref, wants};
use fretwork_solid::Slicing;

/// What of a solid lies in a plane.
///
/// # Errors
/// When the solid is open, or the plane misses it.
pub fn section(action: &Action, kind: &Section) -> StageResult {
    let mut warnings = Vec::new();
    let mesh = closed(action, &kind.of, &mut warnings)?;
    let view = view(action, kind.plane.normal.0.into())?;
    let level = view.nearness(kind.plane.at.0.into());
    let made = sections(&mesh, &view, &[level]).map_err(|e| failed(action, &e.to_string()))?;
    let area = made.into_iter().flatten().collect::<Vec<_>>();
    if area.is_empty() {
        return Err(missed(action, kind, &mesh, &view, level));
    }
    Ok((Data::Region(Region::of_area(area).into()), warnings))
}

/// The error for a plane that has nothing of the solid in it.
fn missed(
    action: &Action,
    kind: &Section,
    mesh: &Mesh,
    view: &View,
    level: f64,
) -> Vec<Diagnostic> {
    let nearness = mesh.positions.iter().map(|p| view.nearness(*p));
    let (low, high) = nearness.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    let message = format!("the plane misses `{}`", kind.of.name);
    let error = Diagnostic::error(message).at(
        action.definition.field_key(&["section", "plane"]),
        "nothing lies in it",
    );
    let help = format!(
        "along its normal the plane is at {}, and the solid reaches from {} to {}",
        rounded(level),
        rounded(low),
        rounded(high)
    );
    vec![error.help(help)]
}

/// A solid as sheets to be stacked.
///
/// # Errors
/// When the solid is open, and where there are too many slices or no place for pins.
pub fn slices(action: &Action, kind: &Slices) -> StageResult {
    let mut warnings = Vec::new();
    let mesh = closed(action, &kind.of, &mut warnings)?;
    let axis = match kind.along {
        StackAxis::X => Point3::new(1.0, 0.0, 0.0),
        StackAxis::Y => Point3::new(0.0, 1.0, 0.0),
        StackAxis::Z => Point3::new(0.0, 0.0, 1.0),
    };
    let slicing = Slicing {
        view: view(action, axis)?,
        every: kind.every.0,
        gap: kind.gap.0,
        columns: kind.columns.map(|columns| columns.0 as usize),
        pins: kind.pins.0,
    };
    let region =
        fretwork_solid::slices(&mesh, &slicing).map_err(|e| failed(action, &e.to_string()))?;
    Ok((Data::Region(region.into()), warnings))
}

/// A solid as one closed mesh.
fn closed(
    action: &Action,
    of: &Ref<wants::Solid>,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Mesh, Vec<Diagnostic>> {
    let mesh = model(action, of, Form::Solid, Thickness::default(), warnings)?.merged();
    match mesh.check_closed() {
        Ok(_) => Ok(mesh),
        Err(error) => {
            let target = action.definition.target(of);
            Err(failed(
                action,
                &format!("`{target}` cannot be cut: {error}"),
            ))
        }
    }
}

fn view(action: &Action, from: Point3) -> Result<View, Vec<Diagnostic>> {
    View::from(from).ok_or_else(|| failed(action, "the direction has no length"))
}

fn failed(action: &Action, message: &str) -> Vec<Diagnostic> {
    vec![Diagnostic::error(message).at(action.span(), "in this region")]
}

/// A length for people, to three digits after the point.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}
