//! Names resolved into a typed, acyclic graph of nodes.
//!
//! What a node *is* stays in `spec/`; here it is an interface: what it provides and what it asks
//! for by name. No value is computed here.

mod cycle;
mod export;
mod resolve;

pub use export::{GraphFormat, export};
pub use resolve::{Interface, Linked, Unread, link};

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use fretwork_language::Section;

/// The name of a node: its section and its name in it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct NodeId {
    /// Where it is defined.
    pub section: Section,
    /// Its name there.
    pub name: Arc<str>,
}

impl NodeId {
    /// The module that it stands in, `lid` or `lid.hinge`, and its name there. Artifacts, whose names are paths, stand in none,
    /// and a single letter may be a point.
    pub fn split(&self) -> (&str, &str) {
        let parts = self.name.rsplit_once('.');
        let parts = parts.filter(|_| self.section != Section::Artifacts);
        parts
            .filter(|(module, own)| !module.is_empty() && !own.is_empty())
            .unwrap_or(("", &self.name))
    }

    /// Its name in its own file.
    pub fn own_name(&self) -> &str {
        self.split().1
    }
}

impl fmt::Display for NodeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.section.name(), self.name)
    }
}
