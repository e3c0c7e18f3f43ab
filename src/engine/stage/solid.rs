//! Solids: primitives and areas made thick, put together, combined; and other values as what a file of solids holds.

use std::sync::Arc;

use super::facade::{self, Form};
use super::placement::space_maps;
use super::{Stage, StageResult};
use crate::value::{Data, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Cutout, Mesh, Model};
use fretwork_language::kinds::solids::{Assemble, Solid as Kind};
use fretwork_language::placement::SpacePlacement;
use fretwork_language::{Ref, Wanted, wants};
use fretwork_solid::{Operation, Overlap, Relief, SolidError};

type Made = Result<Model, Vec<Diagnostic>>;

/// Makes a solid of any kind.
pub fn solid(stage: &Stage<'_>, kind: &Kind) -> StageResult {
    let made = |mesh: Result<Mesh, SolidError>| mesh.map_err(|e| vec![failed(stage, &e)]);
    let mut warnings = Vec::new();
    let model = match kind {
        Kind::Box(kind) => placed(
            stage,
            made(fretwork_solid::cuboid(kind.size.0.into()))?,
            &kind.placement,
        ),
        Kind::Sphere(kind) => placed(
            stage,
            made(fretwork_solid::ball(kind.radius.0, kind.segments.0))?,
            &kind.placement,
        ),
        Kind::Cylinder(kind) => placed(
            stage,
            made(fretwork_solid::cylinder(
                kind.radius.0,
                kind.height.0,
                kind.segments.0,
            ))?,
            &kind.placement,
        ),
        Kind::Extrude(kind) => {
            let region = stage.region(&kind.region);
            placed(
                stage,
                made(fretwork_solid::extrude(&region.area, 0.0, kind.height.0))?,
                &kind.placement,
            )
        }
        Kind::Assemble(kind) => assembled(stage, kind, &mut warnings)?,
        Kind::Union(of) => combined(stage, Operation::Union, of, &mut warnings)?,
        Kind::Intersection(of) => combined(stage, Operation::Intersection, of, &mut warnings)?,
        Kind::Difference(of) => combined(stage, Operation::Difference, of, &mut warnings)?,
        Kind::Carve(kind) => {
            let made = on_surface(stage, &kind.surface, &kind.cutout, |mesh, cutout| {
                fretwork_solid::carve(mesh, cutout, kind.thickness.0)
            })?;
            warnings.extend(loose_pieces(stage, &made.0));
            relief(stage, made, &mut warnings)
        }
        Kind::Emboss(kind) => {
            let made = on_surface(stage, &kind.surface, &kind.cutout, |mesh, cutout| {
                fretwork_solid::emboss(mesh, cutout, kind.height.0)
            });
            made.map(|made| relief(stage, made, &mut warnings))?
        }
    };
    Ok((Value::Data(Data::Solid(Arc::new(model))), warnings))
}

/// What the node `reference` means as solids: cutouts are made `thickness` thick. Parts of a value that is one body have the
/// node's name. Where a cutout is bent too sharply for its thickness is told in `warnings`.
///
/// # Errors
/// When the value has no volume.
pub fn model<T: Wanted>(
    stage: &Stage<'_>,
    reference: &Ref<T>,
    thickness: Option<f64>,
    warnings: &mut Vec<Diagnostic>,
) -> Made {
    let target = stage.definition.target(reference);
    let name = &target.name;
    match stage.input(reference) {
        Value::Data(Data::Solid(model)) => Ok((*model).clone()),
        Value::Data(Data::Surface(mesh)) => Ok(Model::of(name.clone(), (*mesh).clone())),
        Value::Data(Data::Cutout(cutout)) => {
            let Some(thickness) = thickness else {
                let diagnostic =
                    Diagnostic::error(format!("`{target}` is a cutout and has no thickness"));
                let diagnostic = diagnostic.at(stage.definition.span(), "needed here");
                return Err(vec![diagnostic.help("add `thickness: 2` beside `from`")]);
            };
            let (mesh, fold) =
                fretwork_solid::thicken(&cutout, thickness).map_err(|e| vec![failed(stage, &e)])?;
            warnings.extend(fold.map(|found| overlap(stage, name, found)));
            Ok(Model::of(name.clone(), mesh))
        }
        Value::Data(Data::Facade(facade)) => facade::model(stage, &facade, Form::Solid, thickness),
        _ => Err(vec![stage.unsupported(&format!("`{target}` as a solid"))]),
    }
}

/// What `make` gives for a surface and a cutout on it.
fn on_surface(
    stage: &Stage<'_>,
    surface: &Ref<wants::Surface>,
    cutout: &Ref<wants::Cutout>,
    make: impl Fn(&Mesh, &Cutout) -> Result<Relief, SolidError>,
) -> Result<Relief, Vec<Diagnostic>> {
    match (stage.input(surface), stage.input(cutout)) {
        (Value::Data(Data::Surface(mesh)), Value::Data(Data::Cutout(cutout))) => {
            make(&mesh, &cutout).map_err(|e| vec![failed(stage, &e)])
        }
        other => unreachable!("the graph checks types, and {other:?} are no surface and no cutout"),
    }
}

/// A warning where what is left of a surface falls apart.
fn loose_pieces(stage: &Stage<'_>, mesh: &Mesh) -> Option<Diagnostic> {
    let pieces = mesh
        .components()
        .iter()
        .filter(|piece| piece.volume() > 0.0)
        .count();
    (pieces > 1).then(|| {
        let diagnostic = Diagnostic::warning(format!(
            "what is left of the surface falls into {pieces} pieces"
        ));
        let diagnostic = diagnostic.at(stage.definition.span(), "in this solid");
        diagnostic.help("a cutout without holes (`holes: 0`) leaves no piece loose")
    })
}

fn relief(stage: &Stage<'_>, (mesh, fold): Relief, warnings: &mut Vec<Diagnostic>) -> Model {
    let name = &stage.definition.id.name;
    warnings.extend(fold.map(|found| overlap(stage, name, found)));
    Model::of(name.clone(), mesh)
}

fn overlap(stage: &Stage<'_>, name: &str, overlap: Overlap) -> Diagnostic {
    let (at, why, help) = match overlap {
        Overlap::Fold(at) => (
            at,
            "it is bent too sharply for its height and thickness",
            "make it thinner or lower, or smooth the curve",
        ),
        Overlap::Crossing(at) => (
            at,
            "parts of its curve pass nearer to each other than its height and thickness allow",
            "make it thinner or lower, or lead the curve farther round itself",
        ),
    };
    let place = format!("near ({:.3}, {:.3}, {:.3})", at.x, at.y, at.z);
    Diagnostic::warning(format!("`{name}` overlaps itself {place}: {why}"))
        .at(stage.definition.span(), "in this solid")
        .help(help)
}

/// The mesh in all the places of `placement`, named after the node.
fn placed(stage: &Stage<'_>, mesh: Mesh, placement: &SpacePlacement) -> Model {
    let mut model = Model::default();
    let maps = space_maps(placement);
    if let [map] = &maps[..] {
        model.push(stage.definition.id.name.clone(), mesh.transformed(map));
        return model;
    }
    let body = model.add_body(fretwork_geometry::mesh::Body { mesh, uv: None });
    for map in &maps {
        model.place(stage.definition.id.name.clone(), body, *map);
    }
    model
}

fn assembled(stage: &Stage<'_>, kind: &Assemble, warnings: &mut Vec<Diagnostic>) -> Made {
    let mut all = Model::default();
    for part in kind.parts.iter() {
        let part_model = model(stage, &part.from, part.thickness.map(|t| t.0), warnings)?;
        let mut bodies = part_model
            .bodies
            .iter()
            .filter_map(|body| body.mesh.check_closed().err());
        if let Some(error) = bodies.next() {
            let message = format!(
                "`{}` cannot be a part: {error}",
                stage.definition.target(&part.from)
            );
            return Err(vec![
                Diagnostic::error(message).at(stage.definition.span(), "in this solid"),
            ]);
        }
        space_maps(&part.placement)
            .iter()
            .for_each(|map| all.append(&part_model, map));
    }
    if kind.union {
        united(stage, Operation::Union, &[all.merged()])
    } else {
        Ok(all)
    }
}

fn combined(
    stage: &Stage<'_>,
    operation: Operation,
    of: &[Ref<wants::Solid>],
    warnings: &mut Vec<Diagnostic>,
) -> Made {
    let mut meshes = Vec::with_capacity(of.len());
    for reference in of {
        let mesh = model(stage, reference, None, warnings)?.merged();
        if let Err(error) = mesh.check_closed() {
            let message = format!(
                "`{}` cannot be combined: {error}",
                stage.definition.target(reference)
            );
            return Err(vec![
                Diagnostic::error(message).at(stage.definition.span(), "in this solid"),
            ]);
        }
        meshes.push(mesh);
    }
    united(stage, operation, &meshes)
}

fn united(stage: &Stage<'_>, operation: Operation, meshes: &[Mesh]) -> Made {
    let mesh = fretwork_solid::combine(operation, meshes).map_err(|e| vec![failed(stage, &e)])?;
    Ok(Model::of(stage.definition.id.name.clone(), mesh))
}

fn failed(stage: &Stage<'_>, error: &SolidError) -> Diagnostic {
    Diagnostic::error(error.to_string()).at(stage.definition.span(), "in this solid")
}
