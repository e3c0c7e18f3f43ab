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
    let said = action.input(&kind.force_profile).kind;
    let profile = profile(&said, &body.bounds());
    let found = analysed(action, &voxels, &profile, said.sweep.is_some())?;
    warnings.extend(verdict(action, &said, &profile, &found)?);
    Ok((Data::Analysis(Arc::new(found.strength)), warnings))
}
