//! The value through which natives find what belongs to the evaluation.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::sync::Arc;

use starlark::any::ProvidesStaticType;

use crate::geometry::{Curves, PlanarMap};
use crate::script::fault::Note;
use crate::script::guard::Budget;
use crate::script::label_cache::LabelCache;
use crate::script::library::Library;
use crate::script::scope::Scope;
use crate::script::session::Scale;

/// What belongs to one evaluation; see [`session`](crate::script::session).
#[derive(ProvidesStaticType)]
pub(crate) struct Session {
    pub(in crate::script) budget: Budget,
    pub(in crate::script) library: Arc<Library>,
    pub(in crate::script) scale: Scale,
    pub(in crate::script) scope: RefCell<Scope>,
    pub(in crate::script) maps: RefCell<Vec<Arc<PlanarMap>>>,
    pub(in crate::script) imports: RefCell<Vec<(String, String, Arc<Curves>)>>,
    pub(in crate::script) notes: RefCell<Vec<Note>>,
    pub(in crate::script) labels: RefCell<LabelCache>,
    pub(in crate::script) depth: Cell<usize>,
    /// What the room that runs the evaluation needs to find again.
    pub(in crate::script) job: Option<Arc<dyn Any + Send + Sync>>,
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session")
            .field("budget", &self.budget)
            .finish_non_exhaustive()
    }
}
