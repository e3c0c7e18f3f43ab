//! Artifacts: the values of its parts as a sheet, a body or measures, and these in the file's format.

use super::expect::check_expected;
use super::ground::ground;
use super::model::Form;
use super::page::{Written, bounds_of, cut_of, failed, file_unit, here, origin, page, parts};
use super::preview;
use super::shown::{page_bounds, shown_model};
use super::stress::reasoned;
use fretwork_action::{Action, Data, StageResult, Value};
use fretwork_artifact::{ReadySheet, measure, ready_sheet, report};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::format::{dxf, glb, stl, svg, threemf};
use fretwork_fabricate::picture::solid::{self as solid_picture, View};
use fretwork_fabricate::picture::{chunk, field_picture, sheet_picture};
use fretwork_fabricate::{Color, Sheet};
use fretwork_geometry::{Field, Model, budget};
use fretwork_language::kinds::artifacts::{Artifact, Content, Format, Show};
use fretwork_language::{Node, Ref, ValueType, wants};
use fretwork_primitive::field::field;

/// The width of a picture in pixels, where the artifact does not say.
const PICTURE_WIDTH: u32 = 1024;
/// From where things in space are seen, where the artifact does not say.
const VIEW: [f64; 3] = [1.0, -2.0, 1.2];

/// Makes the bytes of an artifact.
///
/// # Errors
/// When its values cannot be shown in its format.
pub fn artifact(action: &Action, kind: &Artifact) -> StageResult {
    let Some(format) = action.format else {
        return Err(vec![action.unsupported("an artifact without a format")]);
    };
    preview::check(action, kind, format)?;
    let (bytes, warnings) = match format {
        Format::Svg | Format::Dxf => drawing(action, kind, format)?,
        Format::Png => {
            let (bytes, warnings) = picture(action, kind)?;
            match origin(action) {
                Some(origin) => (chunk::with_origin(&bytes, &origin), warnings),
                None => (bytes, warnings),
            }
        }
        Format::Json => (json(action, kind)?, Vec::new()),
        Format::GeoJson => ground(action, kind)?,
        Format::Stl | Format::ThreeMf | Format::Glb => body(action, kind, format)?,
    };
    // As a value they are shared, which takes a copy of them.
    budget::hold("bytes of a file", bytes.len(), 1);
    let unmet = check_expected(action, kind, format)?;
    if unmet.is_empty() {
        return Ok((Data::File(bytes.into()), warnings));
    }
    Err(unmet.into_iter().chain(warnings).collect())
}

/// Millimetres in the file per unit of the spec.
pub(super) fn unit_mm(action: &Action, kind: &Artifact) -> f64 {
    action.definition.units.millimetres() * kind.scale.map_or(1.0, |scale| scale.0)
}

fn drawing(action: &Action, kind: &Artifact, format: Format) -> Written {
    let (sheet, warnings) = sheet(action, kind, format)?;
    let (unit, origin) = (file_unit(action, kind), origin(action));
    let bytes = match format {
        Format::Dxf => dxf::write(&sheet, unit, origin.as_ref()),
        _ if action.window.is_some() => svg::write_cut(&sheet, unit, origin.as_ref()),
        _ => svg::write(&sheet, unit, origin.as_ref()),
    };
    Ok((bytes, warnings))
}

/// A picture: of a field, of things in space, or of a sheet.
fn picture(action: &Action, kind: &Artifact) -> Written {
    let width = kind.width.map_or(PICTURE_WIDTH, |width| width.0);
    if kind.width.is_some() && kind.dpi.is_some() {
        let error = Diagnostic::error("a picture has a `width` or a `dpi`, not both");
        return Err(vec![error.at(action.definition.field_key(&["dpi"]), "")]);
    }
    if let Some(field) = shown_field(action, kind)? {
        let Some(region) = &kind.region else {
            return Err(vec![
                action.unsupported("a picture of a field without a region"),
            ]);
        };
        let page = action.input(region).bounds();
        let page = action.window.map_or(page, bounds_of);
        let is_north_up = action.definition.map.is_some();
        let bytes = field_picture::write(&field, page, width, is_north_up);
        let bytes = bytes.map_err(failed(action))?;
        return Ok((bytes, not_on_paper(action, kind)));
    }
    if is_spatial(action, kind) {
        let (mut model, mut warnings) = shown_model(action, kind, Form::Scene)?;
        warnings.extend(not_on_paper(action, kind));
        match kind.show {
            None => model.without_colors(),
            Some(Show::Stress) if model.bodies.iter().all(|body| body.coloring.is_none()) => {
                let error = Diagnostic::error("nothing that is shown has been analysed");
                let at = action.definition.field(&["show"]);
                let help = "stress is shown of `analyses`, and of shells with a `force_profile` and without `analysis: false`";
                return Err(vec![error.at(at, "there is no stress").help(help)]);
            }
            Some(Show::Stress) => {}
            Some(Show::Bridges) => model = reasons(action, kind)?,
        }
        let view = View {
            width,
            direction: kind.view.map_or(VIEW, |view| view.0).into(),
            background: Some(Color([255; 3])),
        };
        let bytes = solid_picture::write(&model, &view).map_err(failed(action))?;
        return Ok((bytes, warnings));
    }
    let (sheet, warnings) = sheet(action, kind, Format::Png)?;
    let bytes = match kind.dpi {
        None => sheet_picture::write(&sheet, width),
        Some(dpi) => sheet_picture::write_at(&sheet, dpi.0),
    };
    Ok((bytes.map_err(failed(action))?, warnings))
}

/// A warning for fields about paper, where a picture shows nothing that has a size on it.
fn not_on_paper(action: &Action, kind: &Artifact) -> Vec<Diagnostic> {
    let said = [
        ("page", kind.page.is_some()),
        ("margin", kind.margin.is_some()),
        ("dpi", kind.dpi.is_some()),
    ];
    let idle = said.into_iter().filter(|(_, is_said)| *is_said);
    let warning = |(name, _): (&str, bool)| {
        let message = format!("`{name}` has no effect in this picture");
        let at = action.definition.field_key(&[name]);
        Diagnostic::warning(message).at(at, "what it shows is no drawing on paper")
    };
    idle.map(warning).collect()
}

/// A shell coloured by why it is solid.
fn reasons(action: &Action, kind: &Artifact) -> Result<Model, Vec<Diagnostic>> {
    if let Content::From(from) = &kind.content
        && let Value::Data(Data::Shell(shell)) = action.value(from)
    {
        return Ok(reasoned(&action.definition.target(from).name, shell));
    }
    Err(vec![
        Diagnostic::error("bridges are shown of one shell, by itself")
            .at(action.span(), "in this artifact"),
    ])
}

/// The field that an artifact shows, if it is one.
pub(super) fn shown_field(
    action: &Action,
    kind: &Artifact,
) -> Result<Option<Field>, Vec<Diagnostic>> {
    let Content::From(from) = &kind.content else {
        return Ok(None);
    };
    match action.value(from) {
        Value::Deferred(inner) if matches!(inner.definition.node, Node::Field(_)) => {
            field(inner).map(Some)
        }
        _ => Ok(None),
    }
}

/// Whether a picture shows its values in space rather than drawn: they are there, or a view is asked
/// for.
pub(super) fn is_spatial(action: &Action, kind: &Artifact) -> bool {
    let stands = |from: &Ref<wants::Product>| match action.value(from) {
        Value::Data(Data::Solid(_) | Data::Surface(_) | Data::Shell(_) | Data::Analysis(_)) => true,
        Value::Data(Data::Facade(_)) => kind.view.is_some(),
        Value::Data(Data::Cutout(cutout)) => kind.view.is_some() || !cutout.is_in_place(),
        _ => false,
    };
    match &kind.content {
        Content::From(from) => stands(from),
        Content::Parts(parts) => parts.iter().any(|part| stands(&part.from)),
    }
}

/// What an artifact draws.
fn sheet(
    action: &Action,
    kind: &Artifact,
    format: Format,
) -> Result<(Sheet, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (parts, mut page) = (parts(action, kind), page(action, kind, format));
    let sheet = cut_of(
        action,
        (&parts, &mut page),
        ready_sheet,
        ReadySheet::near,
        ReadySheet::sheet,
    );
    let (sheet, warnings) = sheet.map_err(|fault| vec![fault.placed(action)])?;
    if action.window.is_none() {
        sheet.check().map_err(failed(action))?;
    }
    Ok((sheet, warnings.into_iter().map(here(action)).collect()))
}

/// The measures of what an artifact shows.
fn json(action: &Action, kind: &Artifact) -> Result<Vec<u8>, Vec<Diagnostic>> {
    let bounds = page_bounds(action, kind);
    let whole;
    let value = match &kind.content {
        Content::From(from) => action.value(from),
        Content::Parts(_) => {
            let model = shown_model(action, kind, Form::Solid)?.0;
            whole = Value::Data(Data::Solid(model.into()));
            &whole
        }
    };
    let measures = measure(
        value,
        bounds,
        action.definition.map.is_some(),
        &action.span(),
    )?;
    let mut measures = report(measures, action.definition.units);
    if let Some(origin) = origin(action) {
        measures["origin"] = origin.json();
    }
    Ok(format!("{measures:#}\n").into_bytes())
}

/// A file of solids.
fn body(action: &Action, kind: &Artifact, format: Format) -> Written {
    let form = if format == Format::Glb {
        Form::Scene
    } else {
        Form::Solid
    };
    let (model, mut warnings) = shown_model(action, kind, form)?;
    let (unit_mm, origin) = (unit_mm(action, kind), origin(action));
    let origin = origin.as_ref();
    let written = match format {
        Format::Stl => stl::write(&model, unit_mm, origin),
        Format::ThreeMf => threemf::write(&model, unit_mm, origin),
        _ => glb::write(&model, unit_mm, origin),
    };
    let bytes = written.map_err(failed(action))?;
    if format != Format::Glb {
        warnings.extend(open_part(action, &model));
    }
    Ok((bytes, warnings))
}

/// A warning for a part that is not closed: surfaces may be open, but what is made of a file may then
/// be anything.
fn open_part(action: &Action, model: &Model) -> Option<Diagnostic> {
    model.parts.iter().find_map(|part| {
        let error = model.bodies[part.body as usize].mesh.check_closed().err()?;
        let warning = Diagnostic::warning(format!("`{}` has no inside: {error}", part.name));
        let place = format!("{} in this artifact", ValueType::Surface.name());
        Some(warning.at(action.span(), place))
    })
}
