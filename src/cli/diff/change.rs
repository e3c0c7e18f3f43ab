//! An artifact before and after a change.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use fretwork_engine::difference::{Amounts, Overlay};

/// What has become of an artifact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It was or is not built.
    Failed,
    /// Its geometry is another one.
    Changed,
    /// It is new.
    Added,
    /// There is none any more.
    Removed,
    /// It has other bytes and the same geometry.
    Redrawn,
    /// It has the same bytes.
    Same,
}

impl Status {
    /// All of them, from what is looked at first.
    pub const ALL: [Status; 6] = [
        Status::Failed,
        Status::Changed,
        Status::Added,
        Status::Removed,
        Status::Redrawn,
        Status::Same,
    ];

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Status::Failed => "failed",
            Status::Changed => "changed",
            Status::Added => "added",
            Status::Removed => "removed",
            Status::Redrawn => "redrawn",
            Status::Same => "same",
        }
    }

    /// Whether the object is another one.
    pub fn differs(self) -> bool {
        matches!(self, Status::Changed | Status::Added | Status::Removed)
    }
}

/// An artifact before and after.
#[derive(Debug, Serialize)]
pub struct Change {
    /// Its path below the output folder.
    pub path: String,
    /// Its spec.
    pub spec: String,
    /// What has become of it.
    pub status: Status,
    /// The measures that changed, before and after.
    pub measures: BTreeMap<String, [Value; 2]>,
    /// How much was added and removed.
    pub geometry: Option<Amounts>,
    /// The paths of its pictures.
    pub pictures: Vec<String>,
    /// What it looks like.
    #[serde(skip)]
    pub overlay: Option<Overlay>,
}
