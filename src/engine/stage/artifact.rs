//! Artifacts: values drawn on a sheet, and the sheet written in the format of the file's name.

use std::sync::Arc;

use super::elevation::elevation;
use super::facade::Form;
use super::placement::plane_maps;
use super::{Stage, StageResult, body};
use crate::measure::measure;
use crate::target;
use crate::value::{Data, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::format::dxf_color;
use fretwork_fabricate::{Layer, Preparation, Sheet, prepare};
use fretwork_geometry::{
    Affine, CurveLabels, Curves, Field, PlanarMap, Point, Polygon, Region, SpaceCurve, cutout,
    planar_map,
};
use fretwork_graph::NodeId;
use fretwork_language::kinds::artifacts::{Artifact, ArtifactPart, Content, Draw, Format, Role};
use fretwork_language::{Ref, wants};

use super::look::Looks;

/// The width of a picture in pixels, where the artifact does not say.
pub const PICTURE_WIDTH: u32 = 1024;
/// The width of a line in millimetres, where the artifact does not say.
const STROKE: f64 = 0.25;

/// Makes the bytes of an artifact.
pub fn artifact(stage: &Stage<'_>, kind: &Artifact) -> StageResult {
    let job = stage.job;
    let format = target::format(stage.db, job.root, job.settings.clone(), job.node.clone());
    let extension = &*format.expect("a target has a path");
    let (bytes, warnings) = match extension {
        "png" if body::is_spatial(stage, kind) => return body::picture(stage, kind),
        "png" if let Some(field) = shown_field(stage, kind) => {
            (shades(stage, kind, &field)?, Vec::new())
        }
        "svg" | "dxf" | "png" => {
            let (sheet, warnings) = sheet(stage, kind)?;
            (write(stage, kind, &sheet, extension)?, warnings)
        }
        "json" => (json(stage, kind)?, Vec::new()),
        "stl" => return body::body(stage, kind, Format::Stl),
        "3mf" => return body::body(stage, kind, Format::ThreeMf),
        "glb" => return body::body(stage, kind, Format::Glb),
        _ => return Err(vec![unknown_format(stage)]),
    };
    Ok((Value::Data(Data::File(bytes.into())), warnings))
}

/// The field that an artifact shows, if it is one.
fn shown_field(stage: &Stage<'_>, kind: &Artifact) -> Option<Field> {
    match &kind.content {
        Content::From(from) => match shown(stage, kind, from) {
            Value::Field(field) => Some(field),
            _ => None,
        },
        Content::Parts(_) => None,
    }
}

/// A picture of a field on the artifact's region.
fn shades(stage: &Stage<'_>, kind: &Artifact, field: &Field) -> Result<Vec<u8>, Vec<Diagnostic>> {
    let region = kind
        .region
        .as_ref()
        .expect("the front end asks for the region of a field");
    let page = stage.region(region).bounds();
    fretwork_fabricate::picture::field_picture::write(
        field,
        page,
        kind.width.map_or(PICTURE_WIDTH, |w| w.0),
    )
    .map_err(|d| vec![d.at(stage.definition.span(), "in this artifact")])
}

fn is_picture(stage: &Stage<'_>) -> bool {
    let job = stage.job;
    target::format(stage.db, job.root, job.settings.clone(), job.node.clone()).as_deref()
        == Some("png")
}

fn unknown_format(stage: &Stage<'_>) -> Diagnostic {
    Diagnostic::error(format!(
        "`{}` has the extension of no format",
        stage.definition.id.name
    ))
    .at(stage.definition.span(), "")
    .help("formats are svg, dxf, stl, 3mf, glb, png, json")
}

fn write(
    stage: &Stage<'_>,
    kind: &Artifact,
    sheet: &Sheet,
    extension: &str,
) -> Result<Vec<u8>, Vec<Diagnostic>> {
    let at_entry = |d: Diagnostic| vec![d.at(stage.definition.span(), "in this artifact")];
    sheet.check().map_err(at_entry)?;
    match extension {
        "svg" => Ok(fretwork_fabricate::format::svg::write(sheet)),
        "dxf" => Ok(fretwork_fabricate::format::dxf::write(sheet)),
        _ => fretwork_fabricate::picture::sheet_picture::write(
            sheet,
            kind.width.map_or(PICTURE_WIDTH, |w| w.0),
        )
        .map_err(at_entry),
    }
}

/// The measures of what an artifact shows.
fn json(stage: &Stage<'_>, kind: &Artifact) -> Result<Vec<u8>, Vec<Diagnostic>> {
    let bounds = kind.region.as_ref().map(|r| stage.region(r).bounds());
    let value = match &kind.content {
        Content::From(from) => shown(stage, kind, from),
        Content::Parts(_) => Value::Data(Data::Solid(Arc::new(
            body::shown(stage, kind, Form::Solid)?.0,
        ))),
    };
    let measures = measure(&value, bounds, stage.definition)?;
    let text = serde_json::to_string_pretty(&measures).expect("a JSON value can be written");
    Ok((text + "\n").into_bytes())
}

/// The value that a part shows: an arrangement on the artifact's region, anything else as it is.
pub fn shown(stage: &Stage<'_>, kind: &Artifact, from: &Ref<wants::Product>) -> Value {
    let target = stage.definition.target(from);
    let region = kind.region.as_ref().map(|r| stage.definition.target(r));
    stage.value_on(
        target,
        region.filter(|_| stage.job.is_arrangement(stage.db, target)),
    )
}

fn sheet(stage: &Stage<'_>, kind: &Artifact) -> Result<(Sheet, Vec<Diagnostic>), Vec<Diagnostic>> {
    let region = kind.region.as_ref().map(|r| stage.region(r));
    let unit_mm = unit_mm(stage, kind);
    let format = target::format(
        stage.db,
        stage.job.root,
        stage.job.settings.clone(),
        stage.job.node.clone(),
    );
    let is_dxf = format.as_deref() == Some("dxf");
    let looks = Looks::new(kind, STROKE, is_dxf || format.as_deref() == Some("svg"));
    let mut layers = Vec::new();
    match &kind.content {
        Content::From(from) => {
            // What a beam has a width for is cut.
            let role = if kind.kerf.0 > 0.0 {
                Role::Cut
            } else {
                Role::Draw
            };
            let whole = Part {
                from,
                role,
                maps: vec![Affine::IDENTITY],
            };
            layers.extend(part_layers(stage, kind, &whole, &looks, region.as_deref())?);
        }
        Content::Parts(parts) => {
            for part in parts.iter() {
                layers.extend(part_layers(
                    stage,
                    kind,
                    &Part::of(part),
                    &looks,
                    region.as_deref(),
                )?);
            }
        }
    }
    let sheet = Sheet {
        page: region.as_ref().map(|r| r.bounds()),
        unit_mm,
        layers,
    };
    let failed = |d: Diagnostic| vec![d.at(stage.definition.span(), "in this artifact")];
    sheet.check().map_err(failed)?;
    let clip = region.as_ref().filter(|_| kind.clip);
    let preparation = Preparation {
        region: clip.map(|region| &region.area[..]),
        kerf_mm: kind.kerf.0,
        is_optimized: kind.optimize,
        is_outlined: is_dxf,
    };
    let (sheet, mut warnings) = prepare(&sheet, &preparation).map_err(failed)?;
    warnings.extend(looks.unused());
    if is_dxf {
        warnings.extend(dxf_color::warnings(&sheet.layers));
    }
    let warnings = warnings
        .into_iter()
        .map(|d| d.at(stage.definition.span(), "in this artifact"))
        .collect();
    Ok((sheet, warnings))
}

/// Millimetres in the file per unit of the spec.
fn unit_mm(stage: &Stage<'_>, kind: &Artifact) -> f64 {
    stage.definition.units.millimetres() * kind.scale.0
}

/// A value, what is done with it, and where its copies stand.
struct Part<'a> {
    from: &'a Ref<wants::Product>,
    role: Role,
    maps: Vec<Affine>,
}

impl<'a> Part<'a> {
    fn of(part: &'a ArtifactPart) -> Part<'a> {
        Part {
            from: &part.from,
            role: part.role,
            maps: plane_maps(&part.placement),
        }
    }
}

/// The layers of a part: one for each set of labels, in the order in which they first occur.
fn part_layers(
    stage: &Stage<'_>,
    kind: &Artifact,
    part: &Part<'_>,
    looks: &Looks,
    region: Option<&Region>,
) -> Result<Vec<Layer>, Vec<Diagnostic>> {
    let target: &NodeId = stage.definition.target(part.from);
    let is_filled = kind.draw == Some(Draw::Filled);
    let name = &target.name;
    let unit_mm = unit_mm(stage, kind);
    let failed = |d: Diagnostic| vec![d.at(stage.definition.span(), "in this artifact")];
    let mut layers = Vec::new();
    for map in &part.maps {
        let more = match shown(stage, kind, part.from) {
            Value::Data(Data::Curves(curves)) => {
                let curves = curves.transformed(map);
                if is_filled {
                    let bounds = region.map_or_else(|| curves.bounds(), Region::bounds);
                    let resolution = planar_map::resolution(bounds.longer_side());
                    let map = PlanarMap::build(&curves, resolution)
                        .map_err(|e| failed(Diagnostic::error(e.to_string())))?;
                    looks.filled(name, part.role, &curves, &map)
                } else {
                    looks.lines(name, part.role, &curves)
                }
            }
            Value::Data(Data::Region(region)) => {
                looks.areas(name, part.role, &region.transformed(map).area, is_filled)
            }
            Value::Data(Data::Cutout(cutout)) => {
                // Cutouts are shapes: they are filled unless their outlines are asked for.
                let area = fretwork_fabricate::rounded(&transformed(&cutout.flat(), map), unit_mm)
                    .map_err(failed)?;
                looks.areas(name, part.role, &area, kind.draw != Some(Draw::Outline))
            }
            Value::Data(Data::Facade(facade)) => {
                let is_painted = kind
                    .draw
                    .map_or_else(|| is_picture(stage), |draw| draw == Draw::Filled);
                elevation(&facade, part.role, is_painted, map, looks)
                    .map_err(|e| failed(Diagnostic::error(e.to_string())))?
            }
            Value::Data(Data::Drawing(drawing)) if is_filled => looks
                .drawing(name, part.role, &drawing.transformed(map))
                .map_err(|e| failed(Diagnostic::error(e.to_string())))?,
            Value::Data(Data::Drawing(drawing)) => {
                looks.lines(name, part.role, &drawing.transformed(map).curves())
            }
            Value::Data(Data::Curve(curve)) => {
                looks.lines(name, part.role, &from_above(&curve).transformed(map))
            }
            _ => return Err(vec![stage.unsupported(&format!("drawing `{target}`"))]),
        };
        merge(&mut layers, more);
    }
    Ok(layers)
}

/// A curve of the world as it is seen from above, in the drawing plane.
fn from_above(curve: &SpaceCurve) -> Curves {
    let mut curves = Curves::new();
    let closing = curve.points().first().filter(|_| curve.is_closed());
    let flat = curve
        .points()
        .iter()
        .chain(closing)
        .map(|p| Point::new(p.x, -p.y));
    curves.push(flat, CurveLabels::default());
    curves
}

/// The polygons moved by `map`.
fn transformed(polygons: &[Polygon], map: &Affine) -> Vec<Polygon> {
    cutout::mapped(polygons, |p| map.apply(p))
}

/// Adds layers, each to the one of its name, role and look if there is one.
fn merge(layers: &mut Vec<Layer>, more: Vec<Layer>) {
    for layer in more {
        match layers
            .iter_mut()
            .find(|l| (&l.name, l.role, l.style) == (&layer.name, layer.role, layer.style))
        {
            Some(known) => known.items.extend(layer.items),
            None => layers.push(layer),
        }
    }
}
