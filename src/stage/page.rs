//! What all files of the plane are made of: the parts that an artifact shows, their page, and where its
//! diagnostics stand.

use super::preview;
use fretwork_action::{Action, Definition, Window};
use fretwork_artifact::{Fault, MapPlane, Page, Part, SLACK};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::Origin;
use fretwork_fabricate::format::FileUnit;
use fretwork_geometry::{Affine, Bounds, Point, budget};
use fretwork_language::kinds::artifacts::{Artifact, Content, Format, Role};
use fretwork_language::scalar::{Scale, Unit};
use fretwork_language::{Ref, wants};
use fretwork_primitive::placement::plane_maps;

/// Bytes of a file and warnings about it, or errors and warnings.
pub(super) type Written = Result<(Vec<u8>, Vec<Diagnostic>), Vec<Diagnostic>>;

/// The same diagnostic at the artifact.
pub(super) fn here(action: &Action) -> impl Fn(Diagnostic) -> Diagnostic {
    let span = action.span();
    move |diagnostic| diagnostic.at(span.clone(), "in this artifact")
}

pub(super) fn failed(action: &Action) -> impl Fn(Diagnostic) -> Vec<Diagnostic> {
    let here = here(action);
    move |diagnostic| vec![here(diagnostic)]
}

/// What the file says of where it comes from.
pub(super) fn origin(action: &Action) -> Option<Origin> {
    let origin = action.origin.as_ref()?;
    Some(Origin {
        spec: origin.spec.to_string(),
        artifact: origin.artifact.to_string(),
        recipe: origin.recipe.to_string(),
    })
}

/// How far beyond a window of an artifact lines are wanted, in the unit of the spec: what is rounded for the file may come into
/// the window.
pub fn slack(definition: &Definition, kind: &Artifact) -> f64 {
    let (unit, _) = units(definition, kind);
    // A file of features is in the unit of the map.
    let least = definition.map.as_ref().map_or(unit, |_| unit.min(1.0));
    SLACK / least
}

/// Units of a drawing per unit of the spec, and millimetres in one of them. A map without a scale is drawn in its own unit.
fn units(definition: &Definition, kind: &Artifact) -> (f64, f64) {
    let unit = definition.units.millimetres();
    match scale(definition, kind) {
        Some(scale) => (unit * scale.0, 1.0),
        None if definition.map.is_some() => (1.0, unit),
        None => (unit, 1.0),
    }
}

/// What an artifact shows in the plane, once for each tile of a preview.
pub(super) fn parts<'a>(action: &'a Action, kind: &Artifact) -> Vec<Part<'a>> {
    let mut parts = single(action, kind);
    let shifts = preview::shifts(action, kind);
    for part in &mut parts {
        let moved = |map: &Affine| -> Vec<Affine> {
            let by = |shift: &Point| map.then(Affine::translation(*shift));
            shifts.iter().map(by).collect()
        };
        part.maps = part.maps.iter().flat_map(moved).collect();
    }
    parts
}

/// What an artifact shows in the plane, once.
fn single<'a>(action: &'a Action, kind: &Artifact) -> Vec<Part<'a>> {
    let part = |from: &Ref<wants::Product>, role, maps| Part {
        name: action.definition.target(from).name.clone(),
        number: 0,
        value: action.value(from),
        role,
        layer: None,
        pen: None,
        maps,
    };
    // What a beam has a width for is cut.
    let alone = match kind.kerf.0 > 0.0 {
        true => Role::Cut,
        false => Role::Draw,
    };
    let among_parts = match action.definition.map {
        Some(_) => alone,
        None => Role::Cut,
    };
    match &kind.content {
        Content::From(from) => vec![part(from, alone, vec![Affine::IDENTITY])],
        Content::Parts(parts) => parts
            .iter()
            .enumerate()
            .map(|(number, p)| Part {
                number,
                layer: p.layer.as_ref().map(|layer| layer.0.clone()),
                pen: p.pen.map(|pen| pen.0),
                ..part(
                    &p.from,
                    p.role.unwrap_or(among_parts),
                    plane_maps(&p.placement),
                )
            })
            .collect(),
    }
}

/// Millimetres of paper per millimetre of the object, if an artifact has a scale or a map for it.
fn scale(definition: &Definition, kind: &Artifact) -> Option<Scale> {
    let map = definition.map.as_deref();
    kind.scale.or(map.and_then(|map| map.scale))
}

/// What a unit of a drawing's file is.
pub(super) fn file_unit(action: &Action, kind: &Artifact) -> FileUnit {
    let is_ground = action.definition.map.is_some() && scale(&action.definition, kind).is_none();
    match action.definition.units {
        Unit::Centimetre if is_ground => FileUnit::Centimetre,
        Unit::Inch if is_ground => FileUnit::Inch,
        Unit::Metre if is_ground => FileUnit::Metre,
        _ => FileUnit::Millimetre,
    }
}

/// What all parts of an artifact share.
pub(super) fn page<'a>(action: &Action, kind: &'a Artifact, format: Format) -> Page<'a> {
    let map = action.definition.map.as_deref();
    let scale = scale(&action.definition, kind);
    let (unit_mm, width_mm) = units(&action.definition, kind);
    Page {
        artifact: kind,
        region: preview::shown(action, kind),
        unit_mm,
        width_mm,
        scale: scale.map_or(1.0, |scale| scale.0),
        format,
        plane: map.map(|_| MapPlane {
            is_paper: scale.is_some(),
        }),
        window: action.window.map(bounds_of),
        is_shared: false,
    }
}

/// What an artifact shows, made ready by `make` and cut to the window of its page by `cut`. Windows that are asked for
/// together are cut of one that is made ready as a whole, of which `near` takes what comes near the window.
pub(super) fn cut_of<R: Send + Sync + 'static, C>(
    action: &Action,
    (parts, page): (&[Part<'_>], &mut Page<'_>),
    make: impl Fn(&[Part<'_>], &Page<'_>) -> Result<R, Fault>,
    near: impl Fn(&R, &Page<'_>) -> R,
    cut: impl Fn(R, &Page<'_>) -> Result<C, Fault>,
) -> Result<C, Fault> {
    let roles = parts.iter().map(|part| part.role);
    let common = action.common.as_ref();
    let ready = match common.filter(|_| page.may_be_shared(roles)) {
        None => make(parts, page)?,
        Some(common) => {
            page.is_shared = true;
            // It is by chance which of the windows is the first.
            let whole = common.get(|| budget::apart(|| make(parts, page)));
            near(whole.as_ref().as_ref().map_err(Fault::clone)?, page)
        }
    };
    cut(ready, page)
}

pub(super) fn bounds_of(window: Window) -> Bounds {
    Bounds {
        min: window.low().into(),
        max: window.high().into(),
    }
}
