//! What expressions may name, and the values of that.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_script::Value;

/// Names and values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scope {
    /// Every parameter and derived value that has one.
    pub values: BTreeMap<Arc<str>, Value>,
    /// Names whose values are wrong; that has been said.
    pub failed: BTreeSet<Arc<str>>,
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
    /// How many elements the derived values have together.
    pub(super) size: usize,
    /// Whether there were too many, which is said once.
    pub(super) is_full: bool,
}
