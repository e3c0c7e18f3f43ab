//! What is to be said of a shell that is no error: what has no effect, what could not be reached, what came out otherwise
//! than one would expect. How it is made is told in `shell`.

use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::shell::ShellMeasures;
use fretwork_geometry::voxel::{Voxel, VoxelSurface};
use fretwork_language::kinds::shells::{Orientation, PatternStep, WholeShell};
use fretwork_primitive::placement::thickness_side;
use fretwork_shell::finish::{Thickness, crowding};
use fretwork_shell::reinforce::{self, Settings};

use super::sheet::surface_of;
use super::verdict::pascals;

/// A pattern of which more than this part is solid has no holes to speak of.
const NEARLY_ALL: f64 = 0.98;
/// A pattern of which so much more of the surface is solid than at first, as a part of it, has lost what makes it one.
const GROWN: f64 = 0.25;
/// A normal that is this near to the vertical, by its part along it, belongs to a level place.
const LEVEL: f32 = 0.95;
/// A warning begins where a width lacks more than this, in voxels: what is left of it when it was widened, and its rounding.
const TOLD: f64 = 0.06;
/// A pattern of which less than this part of its exemplar's is solid is worth a word.
const SPARSE: f64 = 0.7;
/// Walls that run into one another on more than this part of a surface are worth a word.
const CROWDED: f64 = 0.1;

/// A warning at the shell.
pub fn warning(action: &Action, message: String) -> Diagnostic {
    Diagnostic::warning(message).at(action.span(), "in this shell")
}

/// What of a pattern has no effect: a direction that says nothing, zones that hold nothing.
pub fn idle(
    action: &Action,
    kind: &PatternStep,
    (surface, directions): (&VoxelSurface, Option<&Vec<[f32; 3]>>),
    keep: &[bool],
) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    let is_level = |normal: &[f32; 3]| normal[2].abs() > LEVEL;
    if let (Some(Orientation::Field(_)), Some(directions)) = (&kind.orientation, directions) {
        let is_zero = |v: &&[f32; 3]| v.iter().all(|part| part.abs() < 1e-6);
        let zero = directions.iter().filter(is_zero).count();
        if 2 * zero > directions.len() {
            let message = "the field of `orientation` is zero on most of the surface: the exemplar lies there in any direction";
            warnings.push(warning(action, message.into()));
        }
    }
    let level = surface.normals.iter().filter(|n| is_level(n)).count();
    if kind.orientation.is_none() && 2 * level > surface.normals.len() {
        let message = "most of the surface is level, so that no direction of it leads up: the exemplar lies in any";
        let help = "say where its top points: `orientation: { up: [0, 1, 0] }`";
        warnings.push(warning(action, message.into()).help(help));
    }
    if !kind.keep_solid.is_empty() && !keep.contains(&true) {
        let message = "`keep_solid` holds nothing of the surface".to_owned();
        warnings.push(warning(action, message));
    }
    warnings
}

/// What the loop could not reach.
pub fn told(
    action: &Action,
    surface: &VoxelSurface,
    made: &reinforce::Structure,
    settings: &Settings,
) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    if !made.done {
        let message = format!(
            "the pattern still asks for bridges after {}",
            match settings.max_iterations {
                1 => "a round".to_owned(),
                rounds => format!("{rounds} rounds"),
            }
        );
        let help = "raise `max_iterations`, `max_stress` or `geodesic_limit`";
        warnings.push(warning(action, message).help(help));
    } else if !made.holds {
        let message = format!(
            "no further bridge takes the stress of the pattern below `max_stress`: its model still has {}",
            pascals(made.max_stress.unwrap_or(0.0))
        );
        let help = "raise `max_stress` or `thickness`; what the finished body bears is said by its analysis";
        warnings.push(warning(action, message).help(help));
    }
    let place = |cell: &Voxel| {
        let at = surface.voxels.lattice.center(*cell);
        format!("({:.2}, {:.2}, {:.2})", at.x, at.y, at.z)
    };
    if let Some(cell) = made.bare.first() {
        let message = format!(
            "a part of the surface has nothing solid, near {}",
            place(cell)
        );
        warnings.push(warning(action, message).help("make the exemplar's `pixel_size` smaller"));
    }
    if let Some(cell) = made.unjoined.first() {
        let message = format!(
            "no way along the surface joins a piece of the pattern near {} to the rest",
            place(cell)
        );
        warnings.push(warning(action, message).help("choose a higher `resolution`"));
    }
    warnings
}

/// A warning where nothing of the pattern is left, or where much more of the surface is solid than the pattern was at first.
pub fn filled(action: &Action, kind: &WholeShell, measures: &ShellMeasures) -> Vec<Diagnostic> {
    let [before, after] = measures.fraction;
    let is_filled = after >= NEARLY_ALL && before < NEARLY_ALL;
    if !is_filled && after - before <= GROWN {
        return Vec::new();
    }
    let percent = |part: f64| format!("{:.0} %", 100.0 * part);
    let message = match is_filled {
        true => format!(
            "the pattern is filled: {} of the surface were solid, {:.1} % are",
            percent(before),
            100.0 * after
        ),
        false => format!(
            "the pattern is much fuller than its picture: {} of the surface is solid, {} of it was at first, and of the exemplar {} is",
            percent(after),
            percent(before),
            percent(measures.exemplar_fraction)
        ),
    };
    let help = match (is_filled, kind.min_feature.0 > 0.0) {
        (true, true) => {
            "its gaps are finer than `min_feature`: make that smaller, or `pixel_size` larger"
        }
        (false, true) => {
            "its strands are finer than `min_feature`: make that smaller, or `pixel_size` larger"
        }
        (_, false) => "make `pixel_size` larger, or `max_stress` or `geodesic_limit`",
    };
    vec![warning(action, message).help(help)]
}

/// A warning where a feature is narrower than it was asked to be, by more than its width can be told.
pub fn narrow(action: &Action, kind: &WholeShell, measures: &ShellMeasures) -> Option<Diagnostic> {
    let (asked, found) = (kind.min_feature.0, measures.min_feature);
    if found + TOLD * measures.voxel >= asked {
        return None;
    }
    let near = measures.min_feature_at.map_or_else(String::new, |at| {
        format!(", near ({:.2}, {:.2}, {:.2})", at.x, at.y, at.z)
    });
    let message =
        format!("the narrowest feature is about {found:.3} wide{near}: {asked} was asked for");
    let help = format!(
        "where pieces were joined at last, voxels smaller than {:.3} help; where the surface ends, it has no more room",
        measures.voxel
    );
    Some(warning(action, message).help(help))
}

/// A warning where much less of the surface shows the pattern than of its exemplar.
pub fn sparse(action: &Action, measures: &ShellMeasures) -> Option<Diagnostic> {
    let ([before, _], exemplar) = (measures.fraction, measures.exemplar_fraction);
    if before >= SPARSE * exemplar {
        return None;
    }
    let message = format!(
        "the pattern has less than its exemplar: {:.1} % of the surface are solid, {:.1} % of the exemplar",
        100.0 * before,
        100.0 * exemplar
    );
    let help = "single figures far apart find no place: make `pixel_size` smaller, or the exemplar so that it tiles";
    Some(warning(action, message).help(help))
}

/// A warning where walls from opposite sides of a body run into one another.
pub fn crowded(action: &Action, kind: &WholeShell, surface: &VoxelSurface) -> Option<Diagnostic> {
    let thickness = Thickness {
        thickness: kind.thickness.0,
        side: thickness_side(kind.side),
    };
    let mesh = surface_of(action, &kind.surface).ok()?;
    let (part, at) = crowding(&mesh, surface, thickness)?;
    if part < CROWDED {
        return None;
    }
    let message = format!(
        "the wall is thicker than there is room for on {:.0} % of the surface, near ({:.2}, {:.2}, {:.2}) for example: it runs into \
         the wall across from it",
        100.0 * part,
        at.x,
        at.y,
        at.z
    );
    Some(warning(action, message).help("make `thickness` smaller"))
}

/// A warning where limits that must hold are not looked at.
pub fn untested(action: &Action, kind: &WholeShell) -> Option<Diagnostic> {
    let profile = kind.force_profile.as_ref().filter(|_| !kind.analysis)?;
    let told = || {
        let message = format!(
            "`{}` requires limits, and `analysis: false` leaves out what tells whether they hold",
            profile.name
        );
        warning(action, message).help("take out `analysis: false` where it counts")
    };
    action.input(profile).kind.require.then(told)
}
