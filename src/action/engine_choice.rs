//! Which engine draws arrangements. What they are is not known here.

use serde::{Deserialize, Serialize};

/// How the engine of an arrangement is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum EngineChoice {
    /// What is repeated is drawn once and copied.
    #[default]
    Auto,
    /// All is drawn by the general engine, to compare with or to find a fault.
    General,
}
