//! What a stage is given, and what it gives back.
//!
//! An [`Action`] is plain data: the definition of a node, the values of its inputs, the bytes of its
//! files. It can be written down, sent to another machine and run there, and the same action gives
//! the same value everywhere. How actions are put together, remembered and put in order is not known
//! here, and neither is what a stage computes.

pub mod check;
mod common;
mod content;
mod definition;
mod engine_choice;
mod files;
mod input;
mod origin;
mod value;
mod window;

pub use common::Common;
pub use content::{Content, HELD_LIMIT, Parts, PartsReader, Source, is_read_by_parts};
pub use definition::Definition;
pub use engine_choice::EngineChoice;
pub use files::{FILE_LIMIT, Files, ReadError, ReadLog, Reader, resolve, spellings};
pub use input::{Described, Input, Lines};
pub use origin::Origin;
pub use value::{Data, Memo, Value};
pub use window::Window;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_geometry::Region;
use fretwork_geometry::budget::{Allowance, Budget};
use fretwork_graph::NodeId;
use fretwork_language::kinds::artifacts::Format;
use fretwork_language::{Node, Ref, TypeSet, Wanted};

/// What a stage gives: a value with warnings, or errors and warnings.
pub type StageResult = Result<(Data, Vec<Diagnostic>), Vec<Diagnostic>>;

/// A piece of work: a node with everything that its value depends on.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Action {
    /// The node, its seed and its units.
    pub definition: Arc<Definition>,
    /// The values of the nodes that it names; of a facade also all symbols of the spec.
    pub values: BTreeMap<NodeId, Value>,
    /// The region that an arrangement is applied to. Its value is among `values`.
    pub region: Option<NodeId>,
    /// The format of an artifact's file.
    pub format: Option<Format>,
    /// What the file of an artifact says of where it comes from, unless it is to say nothing.
    pub origin: Option<Origin>,
    /// The part of the plane that an artifact shows, or that an arrangement is wanted in, if it is not the whole.
    pub window: Option<Window>,
    /// Which engines arrangements are drawn by.
    pub engine: EngineChoice,
    /// The files that the node names, and those that turn up while it is worked on.
    pub files: Files,
    /// What was put together from this action before, in this process.
    #[serde(skip)]
    pub memo: Memo,
    /// What it has in common with other windows of its artifact, where they are built together.
    #[serde(skip)]
    pub common: Option<Common>,
    /// What its stage may use. It can end the work, and has no part in its value.
    #[serde(skip)]
    pub budget: Budget,
}

impl Action {
    /// The value that `reference` means.
    pub fn input<T: Input>(&self, reference: &Ref<T>) -> T::Value {
        T::of(self.value(reference)).expect("the graph checks the types of references")
    }

    /// The value of the node that `reference` means, whatever its type.
    pub fn value<T: Wanted>(&self, reference: &Ref<T>) -> &Value {
        self.value_of(self.definition.target(reference))
    }

    /// The value of the node `id`.
    pub fn value_of(&self, id: &NodeId) -> &Value {
        self.values
            .get(id)
            .expect("an action holds the values of all nodes that it names")
    }

    /// The value of what `text` names where something of `wants` may stand, if it names something.
    pub fn named(&self, text: &Arc<str>, wants: TypeSet) -> Option<&Value> {
        self.definition
            .named(text, wants)
            .map(|id| self.value_of(id))
    }

    /// The region that an arrangement is applied to, if there is one.
    pub fn region(&self) -> Option<Arc<Region>> {
        let value = self.value_of(self.region.as_ref()?);
        Some(<fretwork_language::wants::Region as Input>::of(value).expect("a region is a region"))
    }

    /// The path and the bytes of a file that the node names.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn file(&self, name: &Arc<str>) -> Result<(Arc<str>, Arc<[u8]>), Vec<Diagnostic>> {
        let (path, content) = self.content(name)?;
        match content.whole() {
            Ok(bytes) => Ok((path, bytes)),
            Err(error) => Err(self.unreadable(&format!("cannot read `{name}`: {error}"))),
        }
    }

    /// The path of a file that the node names, and what is in it.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn content(&self, name: &Arc<str>) -> Result<(Arc<str>, &Content), Vec<Diagnostic>> {
        let path = &self.definition.files[name];
        let content = self.files.named(path);
        let content = content.ok_or_else(|| self.unreadable(&format!("cannot read `{name}`")))?;
        Ok((path.clone(), content))
    }

    fn unreadable(&self, message: &str) -> Vec<Diagnostic> {
        let error = Diagnostic::error(message).about(Code::File);
        vec![error.at(self.span(), "this file")]
    }

    /// The place of the node's name.
    pub fn span(&self) -> Span {
        self.definition.span()
    }

    /// What `work` gives, within the budget of one node.
    ///
    /// # Errors
    /// Those of `work`, and one when it needs more than the budget.
    pub fn within_budget<T>(
        &self,
        work: impl FnOnce() -> Result<T, Vec<Diagnostic>>,
    ) -> Result<T, Vec<Diagnostic>> {
        let allowance = match self.definition.node {
            Node::Shell(_) | Node::Analysis(_) => Allowance::VOXELS,
            _ => Allowance::PLAIN,
        };
        let result = self.budget.run_allowing(allowance, work);
        result.unwrap_or_else(|exceeded| {
            let error = Diagnostic::error(exceeded.to_string());
            let error = error.at(self.span(), "for this node");
            Err(vec![error.help(exceeded.help(self.budget.limits()))])
        })
    }

    /// The error for what cannot be evaluated yet.
    pub fn unsupported(&self, what: &str) -> Diagnostic {
        Diagnostic::error(format!("{what} is not supported yet")).at(self.span(), "needed here")
    }

    /// The action as bytes, with the files in it that `log` says were found while it ran. None where one of its files is
    /// too large to travel, or can no longer be read.
    pub fn to_bytes(&self, log: &ReadLog) -> Option<Vec<u8>> {
        let whole = Action {
            files: self.files.with_found(log),
            ..self.clone()
        };
        postcard::to_allocvec(&whole).ok()
    }

    /// The action with these bytes. It reads no other files than those that it holds.
    pub fn from_bytes(bytes: &[u8]) -> Option<Action> {
        postcard::from_bytes(bytes).ok()
    }
}
