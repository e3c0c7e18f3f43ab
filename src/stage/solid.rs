//! Solids: primitives and areas made thick, put together, combined; and other values as what a file of solids holds.

use std::sync::Arc;

use super::model::{Form, Thickness, give_look, model, open_surface, overlap};
use fretwork_action::{Action, Data, StageResult, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Carrier, Cutout, Imprint, Mesh, Model, SurfaceMesh};
use fretwork_language::kinds::solids::{Assemble, Carve, Emboss, Part, Solid as Kind};
use fretwork_language::placement::SpacePlacement;
use fretwork_language::{Ref, wants};
use fretwork_primitive::placement::{space_maps, thickness_side};
use fretwork_solid::{AtCutout, Carving, Keep, Operation, Relief, SolidError};

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

/// A surface without cutouts, or with nothing but them.
fn carved(action: &Action, kind: &Carve, warnings: &mut Vec<Diagnostic>) -> Made {
    let surface = action.input(&kind.surface);
    let cutouts = cutouts(action, &kind.cutout);
    let carving = Carving {
        keep: keep(action, kind)?,
        thickness: kind.thickness.0,
        side: thickness_side(kind.side),
        depth: kind.depth.map(|depth| depth.0),
    };
    let made = fretwork_solid::carve(&surface, &borrowed(&cutouts), &carving)
        .map_err(|error| vec![carving_failed(action, kind, &error)])?;
    if let Some(told) = loose_pieces(action, &made.mesh) {
        warnings.push(with_reach(told, kind, &surface, &cutouts));
    }
    if !kind.invert && kind.depth.is_none() {
        let near = |(name, cutout): (&Ref<_>, &Arc<Cutout>)| match &cutout.carrier {
            Carrier::Surface(imprint) => at_rim(action, (kind, &name.name), &surface, imprint),
            _ => None,
        };
        warnings.extend(kind.cutout.iter().zip(&cutouts).filter_map(near));
    }
    let mut model = relief(action, (made.mesh, made.overlap), warnings);
    model.cut = made.cut.map(Arc::new);
    Ok(model)
}

/// The cutouts that an entry names.
fn cutouts(action: &Action, named: &[Ref<wants::Cutout>]) -> Vec<Arc<Cutout>> {
    named
        .iter()
        .map(|reference| action.input(reference))
        .collect()
}

fn borrowed(cutouts: &[Arc<Cutout>]) -> Vec<&Cutout> {
    cutouts.iter().map(|cutout| &**cutout).collect()
}

/// What is wrong with a carving: with its depth, with one of several cutouts, or with all of it.
fn carving_failed(action: &Action, kind: &Carve, failed: &AtCutout) -> Diagnostic {
    if let SolidError::Through { .. } = failed.error {
        let told = Diagnostic::error(failed.error.to_string());
        let told = told.at(action.definition.field(&["carve", "depth"]), "too deep");
        return failed.error.help().into_iter().fold(told, Diagnostic::help);
    }
    cutout_failed(action, ("carve", kind.cutout.len()), failed)
}

/// What is wrong, at the cutout that it is about where there are several.
fn cutout_failed(action: &Action, (kind, count): (&str, usize), at: &AtCutout) -> Diagnostic {
    let Some(number) = at.cutout.filter(|_| count > 1) else {
        return failed(action, &at.error);
    };
    let place = [kind, "cutout", &number.to_string()];
    let told = Diagnostic::error(at.error.to_string());
    let told = told.at(action.definition.field(&place), "this cutout");
    at.error.help().into_iter().fold(told, Diagnostic::help)
}

/// A warning about loose pieces, with how wide a frame has to be where it reaches the pattern from no rim or not from all.
fn with_reach(
    told: Diagnostic,
    kind: &Carve,
    surface: &SurfaceMesh,
    cutouts: &[Arc<Cutout>],
) -> Diagnostic {
    let (
        Some(name),
        [
            Cutout {
                carrier: Carrier::Surface(imprint),
                ..
            },
        ],
    ) = (kind.cutout.first(), &borrowed(cutouts)[..])
    else {
        return told;
    };
    match fretwork_solid::farthest_rim(surface, imprint) {
        Some(far) if kind.invert && far >= kind.frame.0 => told.help(format!(
            "`{}` is up to {far:.3} away from a rim; a `frame` wider than that reaches it",
            name.name
        )),
        _ => told,
    }
}

/// What is left between a cutout and a rim is told where it is thinner than this part of the thickness.
const THIN: f64 = 0.02;

/// A warning where next to nothing is left between a cutout and a rim.
fn at_rim(
    action: &Action,
    (kind, name): (&Carve, &str),
    surface: &SurfaceMesh,
    imprint: &Imprint,
) -> Option<Diagnostic> {
    let least = THIN * kind.thickness.0;
    let (at, away) = fretwork_solid::near_rim(surface, imprint, least)?;
    let message = format!(
        "`{name}` comes within {away:.4} of a rim of the surface near ({:.3}, {:.3}, {:.3}), and next to nothing is left between them",
        at.x, at.y, at.z
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

/// A surface with cutouts standing out of it.
fn embossed(action: &Action, kind: &Emboss, warnings: &mut Vec<Diagnostic>) -> Made {
    let surface = action.input(&kind.surface);
    let cutouts = cutouts(action, &kind.cutout);
    let made = fretwork_solid::emboss(&surface, &borrowed(&cutouts), kind.height.0);
    let of = ("emboss", kind.cutout.len());
    let made = made.map_err(|error| vec![cutout_failed(action, of, &error)])?;
    Ok(relief(action, made, warnings))
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
            let told = Diagnostic::error(message).at(action.span(), "in this solid");
            let help = "a surface becomes a body by a `thickness` beside `from`";
            return Err(vec![open_surface(action.value(&part.from), told, help)]);
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
            let told = Diagnostic::error(message).at(action.span(), "in this solid");
            let help = "a surface becomes a body by `assemble: { parts: [{ from: NAME, thickness: 2 }] }`, or by `carve`";
            return Err(vec![open_surface(action.value(reference), told, help)]);
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
