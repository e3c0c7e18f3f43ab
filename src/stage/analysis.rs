//! Analyses of bodies, and of what is a body once it has its thickness: filled with voxels, then as those.

use std::sync::Arc;

use super::force_profile::profile;
use super::model::{Form, Thickness, model, open_surface};
use super::strength::analysed;
use super::verdict::verdict;
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::refined;
use fretwork_geometry::shell::AnalysedBody;
use fretwork_geometry::voxel::Voxels;
use fretwork_geometry::{Mesh, counted};
use fretwork_language::kinds::analyses::Analysis as Kind;
use fretwork_shell::analyse::MemoryLimit;
use fretwork_shell::fill::{fill, fill_weights, overlap};
use fretwork_shell::weights::thin_part;

/// Analyses a body.
pub fn analysis(action: &Action, kind: &Kind) -> StageResult {
    let mut warnings = Vec::new();
    let body = model(
        action,
        &kind.of,
        Form::Solid,
        Thickness::new(kind.thickness, kind.side),
        &mut warnings,
    )?
    .merged();
    let failed =
        |message: String| vec![Diagnostic::error(message).at(action.span(), "in this analysis")];
    if let Err(error) = body.check_closed() {
        let told = failed(error.to_string()).remove(0);
        return Err(vec![open_surface(action.value(&kind.of), told, OPEN)]);
    }
    let voxels = fill(&body, kind.voxel.0).map_err(|e| failed(e.to_string()))?;
    let limit = MemoryLimit::default();
    limit
        .check_voxels(voxels.len())
        .map_err(|e| failed(e.to_string()))?;
    warnings.extend(coarse(action, kind, &voxels)?);
    warnings.extend(overlapping(action, &body, &voxels));
    let said = action.input(&kind.force_profile);
    let profile = profile(&said, &body.bounds());
    let said = said.kind;
    let weights = fill_weights(&body, &voxels);
    let found = analysed(action, (&voxels, &weights), &profile, said.sweep.is_some())?;
    warnings.extend(verdict(action, &said, &profile, &found)?);
    let mesh = refined(&body, EDGE * kind.voxel.0, MOST_TRIANGLES);
    let analysed = AnalysedBody {
        stress: found.at_corners(&mesh, &voxels),
        strength: found.strength,
        mesh,
    };
    Ok((Data::Analysis(Arc::new(analysed)), warnings))
}

/// What helps where a surface encloses nothing.
const OPEN: &str = "a surface becomes a body by a `thickness` beside `of`";
/// How long edges of a body that shows its stress are, at most, in voxels.
const EDGE: f64 = 2.0;
/// How many triangles it has, at most.
const MOST_TRIANGLES: usize = 2_000_000;
/// Which part of the voxels may stand where the body is thinner than three of them without a word: ends and corners do.
const THIN: f64 = 0.2;

/// A warning where parts of the body lie in one another.
fn overlapping(action: &Action, body: &Mesh, voxels: &Voxels) -> Option<Diagnostic> {
    let (count, at) = overlap(body, voxels)?;
    let message = format!(
        "parts of the body lie in one another, in {} of it, one near ({:.3}, {:.3}, {:.3}): what lies in several is analysed once, \
         as if they were united",
        counted(count, "voxel", "voxels"),
        at.x,
        at.y,
        at.z
    );
    let told = Diagnostic::warning(message).at(action.span(), "in this analysis");
    Some(told.help("`union` makes one solid of them; if they are to stay apart, move them"))
}

/// What is said where the voxels are too large for the body to bend as it does: an error where limits are required to hold.
fn coarse(
    action: &Action,
    kind: &Kind,
    voxels: &Voxels,
) -> Result<Option<Diagnostic>, Vec<Diagnostic>> {
    let part = thin_part(voxels);
    if part <= THIN {
        return Ok(None);
    }
    let message = format!(
        "{:.0} % of its voxels stand where the body is thinner than three of them: its bending is not that of what is made",
        100.0 * part
    );
    let is_required = action.input(&kind.force_profile).kind.require;
    let told = match is_required {
        true => Diagnostic::error(message),
        false => Diagnostic::warning(message),
    };
    let at = action.definition.field(&["voxel"]);
    let told = told
        .at(at, "too large for this body")
        .help("a wall wants three voxels or more across it");
    if is_required {
        return Err(vec![told]);
    }
    Ok(Some(told))
}
