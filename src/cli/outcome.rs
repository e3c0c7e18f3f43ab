//! What a build did, for those that print it.

use super::artifacts::Written;
use fretwork_engine::Report;

/// What a build did.
pub struct Outcome {
    /// What the compiler says.
    pub report: Report,
    /// What became of the artifacts.
    pub written: Vec<Written>,
}
