//! Artifacts that hold solids: STL, 3MF, GLB.

use super::placement::space_maps;
use super::solid::model;
use super::{Stage, StageResult};
use crate::build::value::{Data, Value};
use crate::diagnostic::Diagnostic;
use crate::fabricate::{glb, stl, threemf};
use crate::geometry::Model;
use crate::spec::ValueType;
use crate::spec::kinds::artifacts::{Artifact, Content, Format};

/// Makes the bytes of a file of solids.
pub fn body(stage: &Stage<'_>, kind: &Artifact, format: Format) -> StageResult {
    let (model, warnings) = shown(stage, kind)?;
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

/// All that an artifact shows, in its places.
///
/// # Errors
/// When something of it has no volume.
pub fn shown(stage: &Stage<'_>, kind: &Artifact) -> Result<(Model, Vec<Diagnostic>), Vec<Diagnostic>> {
    let thickness = kind.thickness.map(|t| t.0);
    match &kind.content {
        Content::From(from) => Ok((model(stage, from, thickness)?, Vec::new())),
        Content::Parts(parts) => {
            let mut all = Model::default();
            for part in parts.iter() {
                let model = model(stage, &part.from, part.thickness.map(|t| t.0).or(thickness))?;
                space_maps(&part.placement).iter().for_each(|map| all.append(&model, map));
            }
            Ok((all, Vec::new()))
        }
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
        Diagnostic::warning(message)
            .at(stage.definition.span(), format!("{} in this artifact", ValueType::Surface.name()))
    })
}
