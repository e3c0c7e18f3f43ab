//! Solids: primitives and areas made thick, put together, combined; and other values as what a file of solids holds.

use std::sync::Arc;

use super::model::{Form, Thickness, give_look, model, overlap};
use fretwork_action::{Action, Data, StageResult, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Carrier, Cutout, Imprint, Mesh, Model, SurfaceMesh};
use fretwork_language::kinds::solids::{Assemble, Carve, Emboss, Part, Solid as Kind};
use fretwork_language::placement::SpacePlacement;
use fretwork_language::{Ref, wants};
use fretwork_primitive::placement::{space_maps, thickness_side};
use fretwork_solid::{Keep, Operation, Relief, SolidError};

type Made = Result<Model, Vec<Diagnostic>>;

/// Makes a solid of any kind.
pub fn solid(action: &Action, kind: &Kind) -> StageResult {
    let made = |mesh: Result<Mesh, SolidError>| mesh.map_err(|e| vec![failed(action, &e)]);
    let mut warnings = Vec::new();
    let model = match kind {
        Kind::Box(kind) => placed(
            action,
            made(fretwork_solid::cuboid(kind.size.0.into()))?,
            &kind.placement,
        ),
        Kind::Sphere(kind) => placed(
            action,
            made(fretwork_solid::ball(kind.radius.0, kind.segments.0))?,
            &kind.placement,
        ),
        Kind::Cylinder(kind) => placed(
            action,
            made(fretwork_solid::cylinder(
                kind.radius.0,
                kind.height.0,
                kind.segments.0,
            ))?,
            &kind.placement,
        ),
        Kind::Extrude(kind) => {
            let region = action.input(&kind.region);
            placed(
                action,
                made(fretwork_solid::extrude(&region.area, 0.0, kind.height.0))?,
                &kind.placement,
            )
        }
        Kind::Assemble(kind) => assembled(action, kind, &mut warnings)?,
        Kind::Union(of) => combined(action, Operation::Union, of, &mut warnings)?,
        Kind::Intersection(of) => combined(action, Operation::Intersection, of, &mut warnings)?,
        Kind::Difference(of) => combined(action, Operation::Difference, of, &mut warnings)?,
        Kind::Carve(kind) => carved(action, kind, &mut warnings)?,
        Kind::Emboss(kind) => embossed(action, kind, &mut warnings)?,
    };
    Ok((Data::Solid(Arc::new(model)), warnings))
}

/// A surface without a cutout, or with nothing but it. What was pressed into the surface needs no cutting.
fn carved(action: &Action, kind: &Carve, warnings: &mut Vec<Diagnostic>) -> Made {
    let (surface, cutout) = (action.input(&kind.surface), action.input(&kind.cutout));
    let side = thickness_side(kind.side);
    if let Carrier::Surface(imprint) = &cutout.carrier {
        let keep = keep(action, kind)?;
        let mesh = fretwork_solid::carve_imprint(&surface, imprint, keep, kind.thickness.0, side)
            .map_err(|e| vec![failed(action, &e)])?;
        let loose = loose_pieces(action, &mesh);
        warnings.extend(loose.map(|told| with_reach(told, kind, &surface, imprint)));
        if !kind.invert {
            warnings.extend(at_rim(action, kind, &surface, imprint));
        }
        return Ok(Model::of(action.definition.id.name.clone(), mesh));
    }
    if kind.invert {
        let error = Diagnostic::error(format!("`{}` was not made by `wrap`", kind.cutout.name));
        let at = action.definition.field_key(&["carve", "invert"]);
        return Err(vec![error.at(at, "only what is wrapped can be kept")]);
    }
    let made = on_surface(action, &kind.surface, &kind.cutout, |mesh, cutout| {
        fretwork_solid::carve(mesh, cutout, kind.thickness.0, side)
    })?;
    warnings.extend(loose_pieces(action, &made.mesh));
    let mut model = relief(action, (made.mesh, made.overlap), warnings);
    model.cut = Some(Arc::new(made.cut));
    Ok(model)
}

/// A warning about loose pieces, with how wide a frame has to be where it reaches the pattern from no rim or not from all.
fn with_reach(
    told: Diagnostic,
    kind: &Carve,
    surface: &SurfaceMesh,
    imprint: &Imprint,
) -> Diagnostic {
    match fretwork_solid::farthest_rim(surface, imprint) {
        Some(far) if kind.invert && far >= kind.frame.0 => told.help(format!(
            "`{}` is up to {far:.3} away from a rim; a `frame` wider than that reaches it",
            kind.cutout.name
        )),
        _ => told,
    }
}

/// What is left between a cutout and a rim is told where it is thinner than this part of the thickness.
const THIN: f64 = 0.02;

/// A warning where next to nothing is left between a cutout and a rim.
fn at_rim(
    action: &Action,
    kind: &Carve,
    surface: &SurfaceMesh,
    imprint: &Imprint,
) -> Option<Diagnostic> {
    let least = THIN * kind.thickness.0;
    let (at, away) = fretwork_solid::near_rim(surface, imprint, least)?;
    let message = format!(
        "`{}` comes within {away:.4} of a rim of the surface near ({:.3}, {:.3}, {:.3}), and next to nothing is left between them",
        kind.cutout.name, at.x, at.y, at.z
    );
    let warning = Diagnostic::warning(message).at(action.span(), "in this solid");
    Some(warning.help("move it away from the rim, or make it smaller"))
}

/// What `carve` keeps of a surface.
fn keep(action: &Action, kind: &Carve) -> Result<Keep, Vec<Diagnostic>> {
    match (kind.invert, kind.frame.0) {
        (true, frame) => Ok(Keep::Pattern { frame }),
        (false, 0.0) => Ok(Keep::Ground),
        (false, _) => {
            let error = Diagnostic::error("a frame holds what is kept with `invert: true`");
            let at = action.definition.field_key(&["carve", "frame"]);
            Err(vec![error.at(at, "there is no such here")])
        }
    }
}

/// A surface with a cutout standing out of it.
fn embossed(action: &Action, kind: &Emboss, warnings: &mut Vec<Diagnostic>) -> Made {
    let (surface, cutout) = (action.input(&kind.surface), action.input(&kind.cutout));
    if let Carrier::Surface(imprint) = &cutout.carrier {
        let mesh = fretwork_solid::emboss_imprint(&surface, imprint, kind.height.0)
            .map_err(|e| vec![failed(action, &e)])?;
        return Ok(Model::of(action.definition.id.name.clone(), mesh));
    }
    let made = on_surface(action, &kind.surface, &kind.cutout, |mesh, cutout| {
        fretwork_solid::emboss(mesh, cutout, kind.height.0)
    });
    made.map(|made| relief(action, made, warnings))
}

/// What `make` gives for a surface and a cutout on it.
fn on_surface<T>(
    action: &Action,
    surface: &Ref<wants::Surface>,
    cutout: &Ref<wants::Cutout>,
    make: impl Fn(&Mesh, &Cutout) -> Result<T, SolidError>,
) -> Result<T, Vec<Diagnostic>> {
    make(&action.input(surface), &action.input(cutout)).map_err(|e| vec![failed(action, &e)])
}

/// A warning where what is left of a surface falls apart.
fn loose_pieces(action: &Action, mesh: &Mesh) -> Option<Diagnostic> {
    let pieces = mesh
        .components()
        .iter()
        .filter(|piece| piece.volume() > 0.0)
        .count();
    (pieces > 1).then(|| {
        let diagnostic = Diagnostic::warning(format!(
            "what is left of the surface falls into {pieces} pieces"
        ));
        let diagnostic = diagnostic.at(action.span(), "in this solid");
        diagnostic.help(
            "a cutout without holes leaves no piece loose, and `frame` holds what is kept with `invert`",
        )
    })
}

fn relief(action: &Action, (mesh, fold): Relief, warnings: &mut Vec<Diagnostic>) -> Model {
    let name = &action.definition.id.name;
    warnings.extend(fold.map(|found| overlap(action, name, found)));
    Model::of(name.clone(), mesh)
}

/// The mesh in all the places of `placement`, named after the node.
fn placed(action: &Action, mesh: Mesh, placement: &SpacePlacement) -> Model {
    let mut model = Model::default();
    let maps = space_maps(placement);
    if let [map] = &maps[..] {
        model.push(action.definition.id.name.clone(), mesh.transformed(map));
        return model;
    }
    let body = model.add_body(fretwork_geometry::mesh::Body::plain(mesh));
    for map in &maps {
        model.place(action.definition.id.name.clone(), body, *map);
    }
    model
}

fn assembled(action: &Action, kind: &Assemble, warnings: &mut Vec<Diagnostic>) -> Made {
    let mut all = Model::default();
    for part in kind.parts.iter() {
        let mut part_model = model(
            action,
            &part.from,
            Form::Solid,
            Thickness::new(part.thickness, part.side),
            warnings,
        )?;
        let mut bodies = part_model
            .bodies
            .iter()
            .filter_map(|body| body.mesh.check_closed().err());
        if let Some(error) = bodies.next() {
            let message = format!(
                "`{}` cannot be a part: {error}",
                action.definition.target(&part.from)
            );
            return Err(vec![
                Diagnostic::error(message).at(action.span(), "in this solid"),
            ]);
        }
        give_look(&mut part_model, &part.look);
        space_maps(&part.placement)
            .iter()
            .for_each(|map| all.append(&part_model, map));
    }
    if kind.union {
        warnings.extend(lost_look(action, kind));
        united(action, Operation::Union, &[all.merged()])
    } else {
        Ok(all)
    }
}

/// The warning that parts which become one body have looks of their own.
fn lost_look(action: &Action, kind: &Assemble) -> Option<Diagnostic> {
    let looks = |part: &Part| part.look.color.is_some() || part.look.material.is_some();
    let at = kind.parts.iter().position(looks)?;
    let field = match kind.parts[at].look.color {
        Some(_) => "color",
        None => "material",
    };
    let place = action
        .definition
        .field(&["assemble", "parts", &at.to_string(), field]);
    let warning = Diagnostic::warning("parts that become one body have no looks of their own");
    Some(
        warning
            .at(place, "has no effect")
            .help("leave `union` out to keep them apart"),
    )
}

fn combined(
    action: &Action,
    operation: Operation,
    of: &[Ref<wants::Solid>],
    warnings: &mut Vec<Diagnostic>,
) -> Made {
    if operation == Operation::Intersection
        && let Some(made) = intersected_cuts(action, of)
    {
        return made;
    }
    let mut meshes = Vec::with_capacity(of.len());
    for reference in of {
        let mesh = model(
            action,
            reference,
            Form::Solid,
            Thickness::default(),
            warnings,
        )?
        .merged();
        if let Err(error) = mesh.check_closed() {
            let message = format!(
                "`{}` cannot be combined: {error}",
                action.definition.target(reference)
            );
            return Err(vec![
                Diagnostic::error(message).at(action.span(), "in this solid"),
            ]);
        }
        meshes.push(mesh);
    }
    united(action, operation, &meshes)
}

/// What is in all of some solids, made at once; none where they are no cuts of one whole.
fn intersected_cuts(action: &Action, of: &[Ref<wants::Solid>]) -> Option<Made> {
    let cut = |reference| match action.value(reference) {
        Value::Data(Data::Solid(model)) => model.cut.as_deref(),
        _ => None,
    };
    let cuts: Option<Vec<_>> = of.iter().map(cut).collect();
    let made = fretwork_solid::intersect_cuts(&cuts?)?;
    Some(match made {
        Ok((mesh, cut)) => {
            let mut model = Model::of(action.definition.id.name.clone(), mesh);
            model.cut = Some(Arc::new(cut));
            Ok(model)
        }
        Err(error) => Err(vec![failed(action, &error)]),
    })
}

fn united(action: &Action, operation: Operation, meshes: &[Mesh]) -> Made {
    let mesh = fretwork_solid::combine(operation, meshes).map_err(|e| vec![failed(action, &e)])?;
    Ok(Model::of(action.definition.id.name.clone(), mesh))
}

fn failed(action: &Action, error: &SolidError) -> Diagnostic {
    let told = Diagnostic::error(error.to_string()).at(action.span(), "in this solid");
    error.help().into_iter().fold(told, Diagnostic::help)
}
