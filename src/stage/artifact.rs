//! Artifacts: the values of its parts as a sheet, a body or measures, and these in the file's format.

use super::expect::check_expected;
use super::model::Form;
use super::shown::{page_bounds, shown_model};
use super::stress::reasoned;
use fretwork_action::{Action, Data, StageResult, Value, Window};
use fretwork_artifact::{MapPlane, Page, Part, measure, report};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::format::geojson::{self, Coordinates, Feature};
use fretwork_fabricate::format::{dxf, glb, stl, svg, threemf};
use fretwork_fabricate::picture::solid::{self as solid_picture, View};
use fretwork_fabricate::picture::{field_picture, sheet_picture};
use fretwork_fabricate::{Color, Item, Sheet};
use fretwork_geometry::{Affine, Bounds, Field, Model, Point, Polygon};
use fretwork_language::kinds::artifacts::{Artifact, Content, Format, OutputCrs, Role, Show};
use fretwork_language::{Node, Ref, ValueType, wants};
use fretwork_primitive::field::field;
use fretwork_primitive::placement::plane_maps;
use fretwork_primitive::plane;
use fretwork_source::geo::crs::{Crs, Transform};

/// The width of a picture in pixels, where the artifact does not say.
const PICTURE_WIDTH: u32 = 1024;
/// From where things in space are seen, where the artifact does not say.
const VIEW: [f64; 3] = [1.0, -2.0, 1.2];

/// Bytes of a file and warnings about it, or errors and warnings.
type Written = Result<(Vec<u8>, Vec<Diagnostic>), Vec<Diagnostic>>;

/// Makes the bytes of an artifact.
///
/// # Errors
/// When its values cannot be shown in its format.
pub fn artifact(action: &Action, kind: &Artifact) -> StageResult {
    let Some(format) = action.format else {
        return Err(vec![action.unsupported("an artifact without a format")]);
    };
    let (bytes, warnings) = match format {
        Format::Svg | Format::Dxf => drawing(action, kind, format)?,
        Format::Png => picture(action, kind)?,
        Format::Json => (json(action, kind)?, Vec::new()),
        Format::GeoJson => ground(action, kind)?,
        Format::Stl | Format::ThreeMf | Format::Glb => body(action, kind, format)?,
    };
    let unmet = check_expected(action, kind, format)?;
    if unmet.is_empty() {
        return Ok((Data::File(bytes.into()), warnings));
    }
    Err(unmet.into_iter().chain(warnings).collect())
}

/// The same diagnostic at the artifact.
fn here(action: &Action) -> impl Fn(Diagnostic) -> Diagnostic {
    let span = action.span();
    move |diagnostic| diagnostic.at(span.clone(), "in this artifact")
}

fn failed(action: &Action) -> impl Fn(Diagnostic) -> Vec<Diagnostic> {
    let here = here(action);
    move |diagnostic| vec![here(diagnostic)]
}

/// Millimetres in the file per unit of the spec.
fn unit_mm(action: &Action, kind: &Artifact) -> f64 {
    action.definition.units.millimetres() * kind.scale.map_or(1.0, |scale| scale.0)
}

fn drawing(action: &Action, kind: &Artifact, format: Format) -> Written {
    let (sheet, warnings) = sheet(action, kind, format)?;
    let bytes = match format {
        Format::Dxf => dxf::write(&sheet),
        _ if action.window.is_some() => svg::write_cut(&sheet),
        _ => svg::write(&sheet),
    };
    Ok((bytes, warnings))
}

/// A picture: of a field, of things in space, or of a sheet.
fn picture(action: &Action, kind: &Artifact) -> Written {
    let width = kind.width.map_or(PICTURE_WIDTH, |width| width.0);
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
        return Ok((bytes, Vec::new()));
    }
    if is_spatial(action, kind) {
        let (mut model, warnings) = shown_model(action, kind, Form::Scene)?;
        match kind.show {
            None => model.without_colors(),
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
    let bytes = sheet_picture::write(&sheet, width).map_err(failed(action))?;
    Ok((bytes, warnings))
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
fn shown_field(action: &Action, kind: &Artifact) -> Result<Option<Field>, Vec<Diagnostic>> {
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
fn is_spatial(action: &Action, kind: &Artifact) -> bool {
    let stands = |from: &Ref<wants::Product>| match action.value(from) {
        Value::Data(Data::Solid(_) | Data::Surface(_) | Data::Shell(_)) => true,
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
    let page = page(action, kind, format);
    let (sheet, warnings) =
        fretwork_artifact::sheet(&parts(action, kind), &page).map_err(failed(action))?;
    if action.window.is_none() {
        sheet.check().map_err(failed(action))?;
    }
    Ok((sheet, warnings.into_iter().map(here(action)).collect()))
}

/// What an artifact shows in the plane.
fn parts<'a>(action: &'a Action, kind: &Artifact) -> Vec<Part<'a>> {
    let part = |from: &Ref<wants::Product>, role, maps| Part {
        name: action.definition.target(from).name.clone(),
        value: action.value(from),
        role,
        maps,
    };
    match &kind.content {
        Content::From(from) => {
            // What a beam has a width for is cut.
            let role = if kind.kerf.0 > 0.0 {
                Role::Cut
            } else {
                Role::Draw
            };
            vec![part(from, role, vec![Affine::IDENTITY])]
        }
        Content::Parts(parts) => parts
            .iter()
            .map(|p| part(&p.from, p.role, plane_maps(&p.placement)))
            .collect(),
    }
}

/// What all parts of an artifact share. A map without a scale is drawn in its own unit.
fn page<'a>(action: &Action, kind: &'a Artifact, format: Format) -> Page<'a> {
    let map = action.definition.map.as_deref();
    let scale = kind.scale.or(map.and_then(|map| map.scale));
    let unit = action.definition.units.millimetres();
    let (unit_mm, width_mm) = match scale {
        Some(scale) => (unit * scale.0, 1.0),
        None if map.is_some() => (1.0, unit),
        None => (unit, 1.0),
    };
    Page {
        artifact: kind,
        region: kind.region.as_ref().map(|region| action.input(region)),
        unit_mm,
        width_mm,
        format,
        plane: map.map(|_| MapPlane {
            is_paper: scale.is_some(),
        }),
        window: action.window.map(bounds_of),
    }
}

fn bounds_of(window: Window) -> Bounds {
    Bounds {
        min: window.low().into(),
        max: window.high().into(),
    }
}

/// A file of features on the ground.
fn ground(action: &Action, kind: &Artifact) -> Written {
    let page = page(action, kind, Format::GeoJson);
    let (features, warnings) =
        fretwork_artifact::features(&parts(action, kind), &page).map_err(failed(action))?;
    let crs = plane::crs(action)?;
    let (features, coordinates) = if kind.crs == OutputCrs::Wgs84 {
        let degrees = Coordinates {
            digits: 9,
            crs: None,
        };
        (in_degrees(action, crs, features)?, degrees)
    } else {
        let code = crs.and_then(|crs| crs.epsg());
        let metres = Coordinates {
            digits: 4,
            crs: code.map(|code| format!("urn:ogc:def:crs:EPSG::{code}")),
        };
        (features, metres)
    };
    let bytes = geojson::write(&features, &coordinates, kind.optimize);
    let warnings = warnings.into_iter().map(here(action)).collect();
    Ok((bytes, warnings))
}

/// The features in longitudes and latitudes of WGS 84, vertex by vertex.
fn in_degrees(
    action: &Action,
    crs: Option<Crs>,
    features: Vec<Feature>,
) -> Result<Vec<Feature>, Vec<Diagnostic>> {
    let failed = |message: String| Diagnostic::error(message).at(action.span(), "in this artifact");
    let Some(crs) = crs else {
        let message = "longitudes and latitudes are known only of a map with a coordinate system";
        let help = "write `crs: map` here, or say where the map is: `map: { crs: \"EPSG:…\" }`";
        return Err(vec![failed(message.to_string()).help(help)]);
    };
    let wgs84 = Crs::wgs84().map_err(|error| vec![failed(error.to_string())])?;
    let transform = Transform::new(crs, wgs84);
    let place = |p: &Point| {
        let message = format!("({}, {}) has no longitude and latitude", p.x, p.y);
        transform.apply(*p).ok_or_else(|| vec![failed(message)])
    };
    let line = |points: &Vec<Point>| points.iter().map(place).collect::<Result<Vec<_>, _>>();
    let turned = |feature: Feature| {
        let shape = match &feature.shape {
            Item::Line(points) => Item::Line(line(points)?),
            Item::Area(area) => Item::Area(Polygon {
                outer: line(&area.outer)?,
                holes: area.holes.iter().map(line).collect::<Result<_, _>>()?,
            }),
        };
        Ok(Feature { shape, ..feature })
    };
    features.into_iter().map(turned).collect()
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
    let measures = report(measures, action.definition.units);
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
    let unit_mm = unit_mm(action, kind);
    let written = match format {
        Format::Stl => stl::write(&model, unit_mm),
        Format::ThreeMf => threemf::write(&model, unit_mm),
        _ => glb::write(&model, unit_mm),
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
