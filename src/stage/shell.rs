//! Shells in steps: the voxels of a surface, a first pattern on them (`shell_pattern`), the pattern in one piece, and the
//! whole: a closed body with its strength (`shell_body`).

use super::force_profile::{Profile, profile, zone_help};
use super::sheet::{crossing_of, surface_of};
use super::shell_body::whole;
use super::shell_pattern::{options, pattern};
use super::shell_remarks::{told, warning};
use super::shell_step::{NAMED, done, failed, surface_in};
use fretwork_action::{Action, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::Bounds3;
use fretwork_geometry::shell::{Bridges, Step, Structure};
use fretwork_language::kinds::shells::{Shell as Kind, StructureStep, VoxelSize, VoxelsStep};
use fretwork_shell::analyse::Zone;
use fretwork_shell::connect::SurfaceGraph;
use fretwork_shell::reinforce::{self, ReinforceError, Settings};
use fretwork_shell::synthesize::{Synthesizer, feature_radius};
use fretwork_shell::voxelize::{pyramid, voxelize_in_detail};

/// Makes a shell, or a step on the way to it.
pub fn shell(action: &Action, kind: &Kind) -> StageResult {
    match kind {
        Kind::Voxels(kind) => voxels(action, kind),
        Kind::Pattern(kind) => pattern(action, kind),
        Kind::Structure(kind) => structure(action, kind),
        Kind::Whole(kind) => whole(action, kind),
    }
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
