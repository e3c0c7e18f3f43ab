//! Shells in steps: the voxels of a surface, a first pattern on them, the pattern in one piece, and the
//! whole: a closed body with its strength.

use std::sync::Arc;

use super::force_profile::{Profile, profile, zone_help, zones};
use super::sheet::{crossing_of, surface_of};
use super::shell_remarks::{crowded, filled, idle, narrow, sparse, told, untested, warning};
use super::strength::analysed;
use super::verdict::verdict;
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::Bounds3;
use fretwork_geometry::shell::{Bridges, ShellMeasures, Step, Structure, solid_fraction};
use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Shell, Side};
use fretwork_language::kinds::shells::{
    Orientation, PatternStep, Shell as Kind, StructureStep, VoxelSize, VoxelsStep, WholeShell,
    step_of,
};
use fretwork_primitive::field::space_vectors;
use fretwork_primitive::placement::thickness_side;
use fretwork_shell::analyse::Zone;
use fretwork_shell::connect::{Pieces, SurfaceGraph, Touch, join_through_faces};
use fretwork_shell::finish::{
    Finished, Thickness, finish, least_width, reasons, rejoined, rim, widened, without_pinholes,
};
use fretwork_shell::orient::principal_directions;
use fretwork_shell::reinforce::{self, ReinforceError, Settings};
use fretwork_shell::synthesize::{Options, Synthesizer, feature_radius};
use fretwork_shell::voxelize::{pyramid, voxelize_in_detail};

/// Features are measured up to so many pitches more than the least that was asked for.
const MOST_FEATURE: f64 = 12.0;
/// Rounds of widening and joining.
const WIDENED: usize = 3;
/// How wide the bridges are on each side, in pitches, that join a body which fell apart as it was finished: one round
/// after the other.
const REJOINED: [f64; 6] = [1.0, 1.0, 1.5, 1.5, 2.0, 3.0];

/// Makes a shell, or a step on the way to it.
pub fn shell(action: &Action, kind: &Kind) -> StageResult {
    match kind {
        Kind::Voxels(kind) => voxels(action, kind),
        Kind::Pattern(kind) => pattern(action, kind),
        Kind::Structure(kind) => structure(action, kind),
        Kind::Whole(kind) => whole(action, kind),
    }
}

/// Something wrong with the shell.
fn failed(action: &Action, error: &dyn std::fmt::Display) -> Vec<Diagnostic> {
    vec![Diagnostic::error(error.to_string()).at(action.span(), "in this shell")]
}

fn done(step: Step, warnings: Vec<Diagnostic>) -> StageResult {
    Ok((Data::ShellStep(Arc::new(step)), warnings))
}

fn voxels(action: &Action, kind: &VoxelsStep) -> StageResult {
    let mesh = surface_of(action, &kind.surface)?;
    let pitch = match &kind.voxels {
        VoxelSize::Resolution(count) => mesh.bounds().longest_side() / f64::from(count.0),
        VoxelSize::Voxel(side) => side.0,
    };
    let made = voxelize_in_detail(&mesh, pitch).map_err(|e| failed(action, &e))?;
    let mut warnings: Vec<Diagnostic> = crossing_of(action, &kind.surface, &mesh)
        .into_iter()
        .collect();
    let (thin, all) = (made.thin.len(), made.surface.voxels.len());
    if 20 * thin > all {
        let cell = made.surface.voxels.cells[made.thin[0] as usize];
        let at = made.surface.voxels.lattice.center(cell);
        let message = format!(
            "{thin} of {all} voxels hold sides of the surface that face apart, one near ({:.3}, {:.3}, {:.3})",
            at.x, at.y, at.z
        );
        let told = warning(action, message);
        warnings.push(told.help("it is thinner than a voxel there: choose a higher `resolution`"));
    }
    done(Step::Voxels(made.surface), warnings)
}

/// What keeps a step and its result together.
const NAMED: &str = "a step is named after what it gives";

fn surface_in(step: &Step) -> &VoxelSurface {
    step.voxels().expect(NAMED)
}

/// Which voxels lie in one of the zones.
fn within(surface: &VoxelSurface, zones: &[Zone], bounds: &Bounds3) -> Vec<bool> {
    let lattice = &surface.voxels.lattice;
    let holds = |p| zones.iter().any(|zone| zone.contains(p, bounds));
    let cells = surface.voxels.cells.iter();
    cells.map(|cell| holds(lattice.center(*cell))).collect()
}

/// How a pattern is synthesized, where each voxel has the given direction.
fn options(
    action: &Action,
    kind: &PatternStep,
    surface: &VoxelSurface,
    directions: Option<Vec<[f32; 3]>>,
) -> Result<Options, Vec<Diagnostic>> {
    let bounds = surface_of(action, &kind.surface)?.bounds();
    let default = Options::default();
    Ok(Options {
        seed: action.definition.seed,
        jitter: kind.jitter.0,
        keep: within(surface, &zones(kind.keep_solid.iter(), &bounds), &bounds),
        up: match &kind.orientation {
            Some(Orientation::Up(direction)) => direction.0.map(|part| part as f32),
            _ => default.up,
        },
        orientation: directions,
        is_axial: matches!(kind.orientation, Some(Orientation::Stress(_))),
    })
}

/// Where the exemplar's up points in each voxel, where that differs from place to place.
fn directions(
    action: &Action,
    kind: &PatternStep,
    surface: &VoxelSurface,
) -> Result<Option<Vec<[f32; 3]>>, Vec<Diagnostic>> {
    match &kind.orientation {
        None | Some(Orientation::Up(_)) => Ok(None),
        Some(Orientation::Field(field)) => {
            let vectors = space_vectors(&action.input(field))?;
            let lattice = &surface.voxels.lattice;
            let at = |cell: &_| vectors(lattice.center(*cell)).map(|part| part as f32);
            Ok(Some(surface.voxels.cells.iter().map(at).collect()))
        }
        Some(Orientation::Stress(name)) => {
            let thickness = Thickness {
                thickness: kind.thickness.map_or(0.0, |thickness| thickness.0),
                side: Side::Center,
            };
            let solid = vec![true; surface.voxels.len()];
            let mesh = surface_of(action, &kind.surface)?;
            let plain =
                finish(&mesh, surface, &solid, thickness).map_err(|e| failed(action, &e))?;
            let profile = profile(&action.input(name), &plain.mesh.bounds());
            let found = analysed(action, (&plain.voxels, &plain.weights), &profile, false)?;
            let graph = SurfaceGraph::new(surface);
            Ok(Some(principal_directions(
                &graph,
                (&plain.voxels, thickness.thickness),
                &found.stresses,
            )))
        }
    }
}

fn pattern(action: &Action, kind: &PatternStep) -> StageResult {
    let step = action.input(&kind.voxels);
    let surface = surface_in(&step);
    let exemplar = action.input(&kind.exemplar);
    let directions = directions(action, kind, surface)?;
    let options = options(action, kind, surface, directions.clone())?;
    let levels = pyramid(surface.clone());
    let made = Synthesizer::new(&levels, &exemplar, &options).map_err(|e| failed(action, &e))?;
    let warnings = idle(action, kind, (surface, directions.as_ref()), &options.keep);
    done(
        Step::Pattern {
            pattern: made.synthesize(),
            directions,
        },
        warnings,
    )
}

fn structure(action: &Action, kind: &StructureStep) -> StageResult {
    let (voxels, from) = (action.input(&kind.pattern.voxels), action.input(&kind.from));
    let surface = surface_in(&voxels);
    let (first, directions) = from.pattern().expect(NAMED);
    let exemplar = action.input(&kind.pattern.exemplar);
    let options = options(action, &kind.pattern, surface, directions.cloned())?;
    let levels = pyramid(surface.clone());
    let synthesizer =
        Synthesizer::new(&levels, &exemplar, &options).map_err(|e| failed(action, &e))?;
    let bounds = surface_of(action, &kind.pattern.surface)?.bounds();
    let profile = kind
        .force_profile
        .as_ref()
        .map(|name| profile(&action.input(name), &bounds));
    let metres = action.definition.units.millimetres() * 1e-3;
    let said = profile.as_ref();
    let profile = said.map(|profile| in_loop(profile, &bounds, metres));
    let graph = SurfaceGraph::new(surface);
    let settings = Settings {
        profile: profile.as_ref(),
        geodesic_limit: kind.geodesic_limit.map(|limit| limit.0),
        max_iterations: kind.max_iterations.0 as usize,
        seed: action.definition.seed,
        ..Settings::new(feature_radius(&exemplar), kind.thickness.0, graph.pitch())
    };
    let mut current = first.clone();
    let resynthesize = |forced: &[bool]| {
        let next = synthesizer.resynthesize(&current, forced);
        current = next.expect("the pattern is of this surface");
        current.solid.clone()
    };
    let start = (first.solid.clone(), &options.keep[..]);
    let made = reinforce::structure(&graph, start, &settings, |_| {}, resynthesize)
        .map_err(|error| vec![not_reinforced(action, said, &bounds, error)])?;
    let warnings = told(action, surface, &made, &settings);
    done(
        Step::Structure(Structure {
            fraction_before: first.solid_fraction(),
            solid: made.solid,
            iterations: made.iterations,
            is_done: made.done && made.holds,
            bridges: Bridges {
                connection: made.bridges.connection + made.plain,
                stress: made.bridges.stress,
                geodesic: made.bridges.geodesic,
            },
        }),
        warnings,
    )
}

/// Why a pattern cannot be reinforced, at the supports or the load that it is about.
fn not_reinforced(
    action: &Action,
    profile: Option<&Profile>,
    bounds: &Bounds3,
    error: ReinforceError,
) -> Diagnostic {
    let told = Diagnostic::error(error.to_string());
    let told = match (error, profile) {
        (ReinforceError::NotSupported { .. }, Some(profile)) => {
            profile.at_supports(told).help(zone_help(bounds))
        }
        (ReinforceError::LoadOutside { load }, Some(profile)) => {
            profile.at_load(load, told).help(zone_help(bounds))
        }
        _ => told,
    };
    told.at(action.span(), "in this shell")
}

/// A profile as the loop takes it.
fn in_loop<'a>(profile: &'a Profile, bounds: &'a Bounds3, metres: f64) -> reinforce::Profile<'a> {
    let zone = |zone: &'a Zone| -> reinforce::Zone<'a> { Box::new(|p| zone.contains(p, bounds)) };
    let load = |(place, force): &'a (Zone, [f64; 3])| reinforce::Load {
        zone: zone(place),
        force: (*force).into(),
    };
    reinforce::Profile {
        material: profile.material,
        metres,
        gravity: profile.gravity.into(),
        supports: profile.supports.iter().map(zone).collect(),
        loads: profile.loads.iter().map(load).collect(),
        max_stress: Some(profile.max_stress),
    }
}

fn whole(action: &Action, kind: &WholeShell) -> StageResult {
    let name = &action.definition.id.name;
    let [voxels, first, held] = Kind::STEPS.map(|step| action.input(&step_of(name, step)));
    let surface = surface_in(&voxels);
    let (first, _) = first.pattern().expect(NAMED);
    let structure = held.structure().expect(NAMED);
    let graph = SurfaceGraph::new(surface);
    let rim = rim(&surface_of(action, &kind.surface)?.mesh, surface);
    let solid = wide_enough(&graph, &rim, structure, kind);
    let (solid, finished) = finished(action, kind, (&graph, surface, &rim), solid)?;
    one_piece(action, &graph, &finished)?;
    let measures = measures((&graph, &rim), structure, &solid, kind);
    // The analysis needs all the memory that there is.
    drop(graph);
    let mut made = Shell {
        measures: ShellMeasures {
            components: finished.pieces,
            exemplar_fraction: action.input(&kind.exemplar).solid_fraction(),
            ..measures
        },
        stress: Vec::new(),
        reasons: reasons(
            surface,
            &finished.mesh,
            [&first.solid, &structure.solid, &solid],
        ),
        mesh: finished.mesh,
    };
    let mut warnings = filled(action, kind, made.measures.fraction);
    warnings.extend(narrow(action, kind, &made.measures));
    warnings.extend(sparse(action, &made.measures));
    warnings.extend(crowded(action, kind, surface));
    warnings.extend(untested(action, kind));
    if let Some(reference) = kind.force_profile.as_ref().filter(|_| kind.analysis) {
        let said = action.input(reference);
        let profile = profile(&said, &made.mesh.bounds());
        let said = said.kind;
        let analysis = analysed(
            action,
            (&finished.voxels, &finished.weights),
            &profile,
            said.sweep.is_some(),
        )?;
        warnings.extend(verdict(action, &said, &profile, &analysis)?);
        made.stress = analysis.at_corners(&made.mesh, &finished.voxels);
        made.measures.strength = Some(analysis.strength);
    }
    Ok((Data::Shell(Arc::new(made)), warnings))
}

/// The body of the solid voxels, and those with the bridges that it has needed to become one piece.
fn finished(
    action: &Action,
    kind: &WholeShell,
    (graph, surface, rim): (&SurfaceGraph<'_>, &VoxelSurface, &[bool]),
    mut solid: Vec<bool>,
) -> Result<(Vec<bool>, Finished), Vec<Diagnostic>> {
    let thickness = Thickness {
        thickness: kind.thickness.0,
        side: thickness_side(kind.side),
    };
    let mesh = surface_of(action, &kind.surface)?;
    let make =
        |solid: &[bool]| finish(&mesh, surface, solid, thickness).map_err(|e| failed(action, &e));
    let mut finished = make(&solid)?;
    for radius in REJOINED {
        let parts = (&finished, thickness);
        let Some(joined) = rejoined(graph, surface, &solid, parts, radius) else {
            break;
        };
        solid = widened(graph, (&joined, rim), kind.min_feature.0 / graph.pitch());
        finished = make(&solid)?;
    }
    Ok((solid, finished))
}

/// The solid voxels with those that narrow features lack and those of gaps that are too narrow, joined through faces.
fn wide_enough(
    graph: &SurfaceGraph<'_>,
    rim: &[bool],
    structure: &Structure,
    kind: &WholeShell,
) -> Vec<bool> {
    let width = kind.min_feature.0 / graph.pitch();
    let mut solid = structure.solid.clone();
    // What joins may be narrow again.
    for _ in 0..WIDENED {
        solid = without_pinholes(graph, &widened(graph, (&solid, rim), width));
        let joints = join_through_faces(graph, &solid);
        for voxel in joints.iter().flatten() {
            solid[*voxel as usize] = true;
        }
        if joints.is_empty() {
            break;
        }
    }
    solid
}

/// What can be said of a pattern before it is a body.
fn measures(
    (graph, rim): (&SurfaceGraph<'_>, &[bool]),
    structure: &Structure,
    solid: &[bool],
    kind: &WholeShell,
) -> ShellMeasures {
    let least = kind.min_feature.0 / graph.pitch();
    ShellMeasures {
        voxels: solid.len(),
        solid_voxels: solid.iter().filter(|solid| **solid).count(),
        voxel: graph.pitch(),
        iterations: structure.iterations,
        is_done: structure.is_done,
        bridges: structure.bridges,
        fraction: [structure.fraction_before, solid_fraction(solid)],
        min_feature: least_width(graph, (solid, rim), (least, least + MOST_FEATURE))
            * graph.pitch(),
        ..ShellMeasures::default()
    }
}

/// An error where the body falls apart although the surface does not.
fn one_piece(
    action: &Action,
    graph: &SurfaceGraph,
    finished: &Finished,
) -> Result<(), Vec<Diagnostic>> {
    let parts = Pieces::of(graph, Touch::Corner, |_| true).len();
    if finished.pieces <= parts {
        return Ok(());
    }
    let at = finished.loose[0];
    let message = format!(
        "the shell falls into {} pieces, one near ({:.3}, {:.3}, {:.3})",
        finished.pieces, at.x, at.y, at.z
    );
    let error = Diagnostic::error(message).at(action.span(), "in this shell");
    Err(vec![error.help(
        "choose a higher `resolution`, or a larger `min_feature`",
    )])
}
