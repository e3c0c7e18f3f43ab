//! Analyses of bodies that are no shells of patterns: filled with voxels, then as those.

use std::sync::Arc;

use super::force_profile::profile;
use super::model::{Form, Thickness, model};
use super::strength::analysed;
use super::verdict::verdict;
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_language::kinds::analyses::Analysis as Kind;
use fretwork_shell::fill::fill;

/// Analyses a body.
pub fn analysis(action: &Action, kind: &Kind) -> StageResult {
    let mut warnings = Vec::new();
    let body = model(
        action,
        &kind.of,
        Form::Solid,
        Thickness::default(),
        &mut warnings,
    )?
    .merged();
    let failed =
        |message: String| vec![Diagnostic::error(message).at(action.span(), "in this analysis")];
    body.check_closed().map_err(|e| failed(e.to_string()))?;
    let voxels = fill(&body, kind.voxel.0).map_err(|e| failed(e.to_string()))?;
    warnings.extend(coarse(
        action,
        voxels.len() as f64 * kind.voxel.0.powi(3),
        body.volume(),
    ));
    let said = action.input(&kind.force_profile).kind;
    let profile = profile(&said, &body.bounds());
    let found = analysed(action, &voxels, &profile, said.sweep.is_some())?;
    warnings.extend(verdict(action, &said, &profile, &found)?);
    Ok((Data::Analysis(Arc::new(found.strength)), warnings))
}

/// By which part the voxels of a body may hold more or less than it without a word.
const OFF: f64 = 0.2;

/// A warning where the voxels hold another volume than the body: it is thinner than a few of them.
fn coarse(action: &Action, voxels: f64, body: f64) -> Option<Diagnostic> {
    let part = voxels / body.max(f64::MIN_POSITIVE);
    if (part - 1.0).abs() <= OFF {
        return None;
    }
    let message = format!(
        "its voxels hold {:.0} % of the body's volume: what is analysed is not what is made",
        100.0 * part
    );
    let at = action.definition.field(&["voxel"]);
    let warning = Diagnostic::warning(message).at(at, "too large for this body");
    Some(warning.help("a wall wants three voxels or more across it"))
}
