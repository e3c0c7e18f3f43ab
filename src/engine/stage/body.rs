//! Artifacts that hold solids: STL, 3MF, GLB, and pictures of them.

use super::artifact::{PICTURE_WIDTH, shown as value};
use super::facade::{self, Form};
use super::placement::space_maps;
use super::solid::model;
use super::{Stage, StageResult};
use crate::value::{Data, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::Color;
use fretwork_fabricate::format::{glb, stl, threemf};
use fretwork_fabricate::picture::solid::{self as solid_picture, View};
use fretwork_geometry::Model;
use fretwork_language::kinds::artifacts::{Artifact, Content, Format};
use fretwork_language::{Ref, Section, ValueType, wants};

/// From where things in space are seen, where the artifact does not say.
const VIEW: [f64; 3] = [1.0, -2.0, 1.2];

/// Makes the bytes of a file of solids.
pub fn body(stage: &Stage<'_>, kind: &Artifact, format: Format) -> StageResult {
    let form = if format == Format::Glb {
        Form::Scene
    } else {
        Form::Solid
    };
    let (model, warnings) = shown(stage, kind, form)?;
    let unit_mm = stage.definition.units.millimetres() * kind.scale.0;
    let written = match format {
        Format::Stl => stl::write(&model, unit_mm),
        Format::ThreeMf => threemf::write(&model, unit_mm),
        _ => glb::write(&model, unit_mm),
    };
    let bytes = written.map_err(|d| vec![d.at(stage.definition.span(), "in this artifact")])?;
    let mut warnings = warnings;
    if format != Format::Glb {
        warnings.extend(open_parts(stage, &model));
    }
    Ok((Value::Data(Data::File(bytes.into())), warnings))
}

/// Whether a picture shows its values in space rather than drawn: they are there, or a view is asked for.
pub fn is_spatial(stage: &Stage<'_>, kind: &Artifact) -> bool {
    let stands = |from: &Ref<wants::Product>| match value(stage, kind, from) {
        Value::Data(Data::Solid(_) | Data::Surface(_)) => true,
        Value::Data(Data::Facade(_)) => kind.view.is_some(),
        Value::Data(Data::Cutout(cutout)) => kind.view.is_some() || !cutout.is_in_place(),
        _ => false,
    };
    match &kind.content {
        Content::From(from) => stands(from),
        Content::Parts(parts) => parts.iter().any(|part| stands(&part.from)),
    }
}

/// Makes a picture of what an artifact shows in space, on white.
pub fn picture(stage: &Stage<'_>, kind: &Artifact) -> StageResult {
    let (model, warnings) = shown(stage, kind, Form::Scene)?;
    let view = View {
        width: kind.width.map_or(PICTURE_WIDTH, |width| width.0),
        direction: kind.view.map_or(VIEW, |view| view.0).into(),
        background: Some(Color([255; 3])),
    };
    let bytes = solid_picture::write(&model, &view)
        .map_err(|d| vec![d.at(stage.definition.span(), "in this artifact")])?;
    Ok((Value::Data(Data::File(bytes.into())), warnings))
}

/// All that an artifact shows, in its places.
///
/// # Errors
/// When something of it has no volume.
pub fn shown(
    stage: &Stage<'_>,
    kind: &Artifact,
    form: Form,
) -> Result<(Model, Vec<Diagnostic>), Vec<Diagnostic>> {
    let thickness = kind.thickness.map(|t| t.0);
    match &kind.content {
        Content::From(from) => {
            let mut warnings = Vec::new();
            Ok((part(stage, from, thickness, form, &mut warnings)?, warnings))
        }
        Content::Parts(parts) => {
            let (mut all, mut warnings) = (Model::default(), Vec::new());
            for part in parts.iter() {
                let thickness = part.thickness.map(|t| t.0).or(thickness);
                let model = self::part(stage, &part.from, thickness, form, &mut warnings)?;
                space_maps(&part.placement)
                    .iter()
                    .for_each(|map| all.append(&model, map));
            }
            Ok((all, warnings))
        }
    }
}

/// What a value is in space; facades look other than they are made.
fn part(
    stage: &Stage<'_>,
    from: &Ref<wants::Product>,
    thickness: Option<f64>,
    form: Form,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Model, Vec<Diagnostic>> {
    match stage.definition.target(from) {
        target if target.section == Section::Facades => match stage.input(from) {
            Value::Data(Data::Facade(facade)) => facade::model(stage, &facade, form, thickness),
            other => unreachable!("the graph checks types, and {other:?} is no facade"),
        },
        _ => model(stage, from, thickness, warnings),
    }
}

/// Warnings for parts that are not closed: surfaces may be open, but what is made of a file may then be anything.
fn open_parts(stage: &Stage<'_>, model: &Model) -> Option<Diagnostic> {
    let open = model.parts.iter().find_map(|part| {
        let error = model.bodies[part.body as usize].mesh.check_closed().err()?;
        Some((part, error))
    });
    open.map(|(part, error)| {
        let message = format!("`{}` has no inside: {error}", part.name);
        Diagnostic::warning(message).at(
            stage.definition.span(),
            format!("{} in this artifact", ValueType::Surface.name()),
        )
    })
}
