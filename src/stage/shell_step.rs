//! What the steps of a shell have in common: how they are read, how they end.

use std::sync::Arc;

use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::shell::Step;
use fretwork_geometry::voxel::VoxelSurface;

/// Something wrong with the shell.
pub fn failed(action: &Action, error: &dyn std::fmt::Display) -> Vec<Diagnostic> {
    vec![Diagnostic::error(error.to_string()).at(action.span(), "in this shell")]
}

/// A step that is done, with what is to be said of it.
pub fn done(step: Step, warnings: Vec<Diagnostic>) -> StageResult {
    Ok((Data::ShellStep(Arc::new(step)), warnings))
}

/// What keeps a step and its result together.
pub const NAMED: &str = "a step is named after what it gives";

/// The voxels that a step gives.
pub fn surface_in(step: &Step) -> &VoxelSurface {
    step.voxels().expect(NAMED)
}
