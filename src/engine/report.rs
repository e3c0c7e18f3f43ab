//! What a build tells its caller.

use std::time::Duration;

use serde::Serialize;

use super::job::Job;
use fretwork_diagnostic::Diagnostic;
use fretwork_store::Digest;

/// How the value of a node was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum NodeStatus {
    /// It was in memory, or is a function, which is evaluated where it is applied.
    Reused,
    /// It came from the store.
    Cached,
    /// It was computed.
    Evaluated,
}

/// A node of a build.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeReport {
    /// The spec.
    pub spec: String,
    /// The section.
    pub section: String,
    /// The name in its section.
    pub name: String,
    /// The kind.
    pub kind: String,
    /// The costliest way in which a value of it was come by: it may have been applied to several
    /// regions or under several parameters.
    pub status: NodeStatus,
    /// The time of all of them, in milliseconds.
    pub ms: f64,
}

impl NodeReport {
    /// Whether its stage ran.
    pub fn was_evaluated(&self) -> bool {
        self.status == NodeStatus::Evaluated
    }
}

/// An artifact that was built and not yet written.
#[derive(Clone, Debug)]
pub struct Artifact {
    /// The spec that names it, as a path from the project root.
    pub spec: String,
    /// Path below the output folder.
    pub path: String,
    /// The digest of its bytes.
    pub digest: Digest,
    /// The job that gives its bytes.
    pub(super) job: Job,
}

/// When a job ran, for traces.
#[derive(Clone, Debug, Serialize)]
pub struct TraceSpan {
    /// The node.
    pub name: String,
    /// Its kind.
    pub kind: String,
    /// How its value was come by.
    pub status: NodeStatus,
    /// The number of the thread.
    pub thread: usize,
    /// Since the build began.
    pub start: Duration,
    /// How long it took.
    pub time: Duration,
}

/// What a build did.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The nodes that artifacts needed, by spec, section and name.
    pub nodes: Vec<NodeReport>,
    /// The artifacts that could be built.
    pub artifacts: Vec<Artifact>,
    /// Everything that is wrong, sorted, each once.
    pub diagnostics: Vec<Diagnostic>,
    /// What ran when.
    pub spans: Vec<TraceSpan>,
}

/// A parameter, as `fretwork params` prints it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParamReport {
    /// Its name.
    pub name: String,
    /// The name of its type.
    #[serde(rename = "type")]
    pub param_type: String,
    /// The unit of its default and its limits; none for what has no unit.
    pub unit: Option<&'static str>,
    /// What it is under the settings, in the file's units.
    pub value: serde_json::Value,
    /// Its default, in the file's units.
    pub default: serde_json::Value,
    /// The least value, in the file's units.
    pub min: Option<serde_json::Value>,
    /// The greatest value, in the file's units.
    pub max: Option<serde_json::Value>,
    /// The only values, if they are listed.
    pub choices: Vec<serde_json::Value>,
    /// What it is for.
    pub doc: Option<String>,
}
