//! Regions that are cut out of solids: sections and slices.

use std::collections::BTreeSet;

use super::model::{Form, Thickness, model, open_surface};
use fretwork_action::{Action, Data, StageResult, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::sections;
use fretwork_geometry::{Affine3, Mesh, Model, Point3, Polygon, Region, View};
use fretwork_language::kinds::regions::{Section, Slices, StackAxis};
use fretwork_language::{Ref, wants};
use fretwork_solid::Slicing;

/// A plane that is nearer to a face than this part of the solid's longest side goes through it.
const ON_FACE: f64 = 1e-9;

/// So much of a sheet may stay empty above the solid, or not be there at all, without a word.
const PART_OF_SHEET: f64 = 0.1;

/// What of a solid lies in a plane.
///
/// # Errors
/// When the solid is open, or the plane misses it.
pub fn section(action: &Action, kind: &Section) -> StageResult {
    let mut warnings = Vec::new();
    let mesh = closed(action, &kind.of, &mut warnings)?;
    let view = view(action, kind.plane.normal.0.into())?;
    let level = view.nearness(kind.plane.at.0.into());
    let at = |level: f64| {
        let made = sections(&mesh, &view, &[level]).map_err(|e| failed(action, &e.to_string()))?;
        Ok::<_, Vec<Diagnostic>>(made.into_iter().flatten().collect::<Vec<_>>())
    };
    let mut area = at(level)?;
    if area.is_empty() {
        // A plane through a face that looks away from the viewer has the face in it as well.
        area = face(&mesh, at(level + ON_FACE * mesh.bounds().longest_side())?);
    }
    if area.is_empty() {
        return Err(missed(action, kind, &mesh, &view, level));
    }
    Ok((Data::Region(Region::of_area(area).into()), warnings))
}

/// A section just above a plane, where it is that of a face in the plane: of a tip there is next to nothing.
fn face(mesh: &Mesh, area: Vec<Polygon>) -> Vec<Polygon> {
    let side = mesh.bounds().longest_side();
    let whole: f64 = area.iter().map(Polygon::area).sum();
    if whole > ON_FACE.sqrt() * side * side {
        area
    } else {
        Vec::new()
    }
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
    warnings.extend(uneven(action, kind, &mesh, &slicing.view));
    warnings.extend(hanging(action, kind, &region));
    Ok((Data::Region(region.into()), warnings))
}

/// A solid as it stands in space: a facade, which is made lying on its back, upright as elevations and models show it.
fn as_seen(value: &Value, made: Model) -> Model {
    let is_flat = matches!(value, Value::Data(Data::Facade(facade)) if facade.wrap.is_none());
    if !is_flat {
        return made;
    }
    let axes = Affine3::IDENTITY;
    made.transformed(&Affine3 {
        y: axes.z,
        z: -axes.y,
        ..axes
    })
}

/// A warning where there are empty sheets between others: what lies above them is held by nothing.
fn hanging(action: &Action, kind: &Slices, region: &Region) -> Option<Diagnostic> {
    let inside = region.contour.iter().map(|curve| curve.labels.left);
    let numbers = inside.flat_map(|labels| labels.names().to_vec());
    let filled: BTreeSet<u64> = numbers.filter_map(|name| name.parse().ok()).collect();
    let last = *filled.last()?;
    let empty: Vec<u64> = (1..last).filter(|n| !filled.contains(n)).collect();
    let first = empty.first()?;
    let message = match empty.len() {
        1 => format!("sheet {first} is empty, and nothing holds what lies above it"),
        count => format!(
            "{count} sheets are empty, the first of them sheet {first}, and nothing holds what lies above"
        ),
    };
    let at = action.definition.field(&["slices", "of"]);
    let warning = Diagnostic::warning(message).at(at, "has a gap");
    Some(warning.help(format!(
        "slice the parts of `{}` by themselves",
        kind.of.name
    )))
}

/// A warning where sheets do not come to the height of the solid.
fn uneven(action: &Action, kind: &Slices, mesh: &Mesh, view: &View) -> Option<Diagnostic> {
    let nearness = mesh.positions.iter().map(|p| view.nearness(*p));
    let (low, high) = nearness.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    let (height, every) = (high - low, kind.every.0);
    let sheets = libm::ceil(height / every - 1e-6).max(1.0);
    let over = sheets * every - height;
    if over <= PART_OF_SHEET * every {
        return None;
    }
    let stack = if sheets == 1.0 {
        format!("a sheet is {} thick", rounded(every))
    } else {
        let (each, all) = (rounded(every), rounded(sheets * every));
        format!("{sheets} sheets of {each} are {all} high")
    };
    let message = format!("{stack}, and `{}` is {}", kind.of.name, rounded(height));
    let at = action.definition.field(&["slices", "every"]);
    let warning = Diagnostic::warning(message).at(at, "the last sheet is not filled");
    let even = match sheets {
        1.0 => format!("{}", rounded(height)),
        _ => format!(
            "{} or {}",
            rounded(height / (sheets - 1.0)),
            rounded(height / sheets)
        ),
    };
    Some(warning.help(format!("sheets of {even} fill it evenly")))
}

/// A solid as one closed mesh.
fn closed(
    action: &Action,
    of: &Ref<wants::Solid>,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Mesh, Vec<Diagnostic>> {
    let made = model(action, of, Form::Solid, Thickness::default(), warnings)?;
    let mesh = as_seen(action.value(of), made).merged();
    match mesh.check_closed() {
        Ok(_) => Ok(mesh),
        Err(error) => {
            let target = action.definition.target(of);
            let told = failed(action, &format!("`{target}` cannot be cut: {error}"));
            let help =
                "a surface becomes a body by `assemble: { parts: [{ from: NAME, thickness: 2 }] }`";
            let told = told.into_iter();
            let told = told.map(|told| open_surface(action.value(of), told, help));
            Err(told.collect())
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
