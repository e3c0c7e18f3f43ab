//! Fields: scalar functions of the plane.

use super::{Stage, StageResult};
use crate::spec::kinds::fields::Field as Kind;

/// Puts the function together.
pub fn field(stage: &Stage<'_>, kind: &Kind) -> StageResult {
    Err(vec![stage.unsupported(&format!("the field `{}`", kind.kind()))])
}
