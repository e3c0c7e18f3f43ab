//! The first pattern of a shell: what of it stays solid, where it points, and its synthesis.

use super::force_profile::{profile, zones};
use super::sheet::surface_of;
use super::shell_remarks::idle;
use super::shell_step::{done, failed, surface_in};
use super::strength::analysed;
use fretwork_action::{Action, Described, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::Bounds3;
use fretwork_geometry::shell::Step;
use fretwork_geometry::voxel::VoxelSurface;
use fretwork_language::kinds::force_profiles::ForceProfile;
use fretwork_language::kinds::shells::{Orientation, PatternStep};
use fretwork_primitive::field::space_vectors;
use fretwork_primitive::placement::thickness_side;
use fretwork_shell::analyse::Zone;
use fretwork_shell::connect::SurfaceGraph;
use fretwork_shell::finish::{Thickness, finish};
use fretwork_shell::orient::principal_directions;
use fretwork_shell::synthesize::{Options, SynthesizeError, Synthesizer};
use fretwork_shell::voxelize::pyramid;

/// Which voxels lie in one of the zones.
fn within(surface: &VoxelSurface, zones: &[Zone], bounds: &Bounds3) -> Vec<bool> {
    let lattice = &surface.voxels.lattice;
    let holds = |p| zones.iter().any(|zone| zone.contains(p, bounds));
    let cells = surface.voxels.cells.iter();
    cells.map(|cell| holds(lattice.center(*cell))).collect()
}

/// How a pattern is synthesized, where each voxel has the given direction.
pub fn options(
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
        Some(Orientation::Stress(profile)) => {
            let profile = action.input(profile);
            along_stress(action, kind, surface, &profile).map(Some)
        }
    }
}

/// The direction of the principal stress in the wall that the surface would be without a pattern (S5).
fn along_stress(
    action: &Action,
    kind: &PatternStep,
    surface: &VoxelSurface,
    said: &Described<ForceProfile>,
) -> Result<Vec<[f32; 3]>, Vec<Diagnostic>> {
    let (thickness, side) = kind
        .wall
        .as_ref()
        .expect("the orientation follows the stress in it");
    let wall = Thickness {
        thickness: thickness.0,
        side: thickness_side(*side),
    };
    let mesh = surface_of(action, &kind.surface)?;
    let solid = vec![true; surface.voxels.len()];
    let plain = finish(&mesh, surface, &solid, wall).map_err(|e| failed(action, &e))?;
    let profile = profile(said, &plain.mesh.bounds());
    let body = (&plain.voxels, &plain.weights[..]);
    let found = analysed(action, body, &profile, false)?;
    let graph = SurfaceGraph::new(surface);
    let of = (&plain.voxels, wall);
    Ok(principal_directions(&graph, of, &found.stresses))
}

/// Why there is no pattern: about its exemplar, in most cases.
fn unfit(action: &Action, kind: &PatternStep, error: &SynthesizeError) -> Vec<Diagnostic> {
    let is_exemplar = matches!(
        error,
        SynthesizeError::TooSmall { .. } | SynthesizeError::AllSolid | SynthesizeError::AllEmpty
    );
    if !is_exemplar {
        return failed(action, error);
    }
    let told = Diagnostic::error(error.to_string());
    let exemplar = action.definition.target(&kind.exemplar);
    let at = action.definition.field(&["exemplar"]);
    vec![told.at(at, format!("`{}`", exemplar.name))]
}

/// The first pattern on the voxels of a shell.
pub fn pattern(action: &Action, kind: &PatternStep) -> StageResult {
    let step = action.input(&kind.voxels);
    let surface = surface_in(&step);
    let exemplar = action.input(&kind.exemplar);
    let directions = directions(action, kind, surface)?;
    let options = options(action, kind, surface, directions.clone())?;
    let levels = pyramid(surface.clone());
    let made =
        Synthesizer::new(&levels, &exemplar, &options).map_err(|e| unfit(action, kind, &e))?;
    let warnings = idle(action, kind, (surface, directions.as_ref()), &options.keep);
    done(
        Step::Pattern {
            pattern: made.synthesize(),
            directions,
        },
        warnings,
    )
}
