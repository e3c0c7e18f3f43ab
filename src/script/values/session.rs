//! The value through which natives find what belongs to the evaluation.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::sync::Arc;

use starlark::any::ProvidesStaticType;

use crate::fault::Note;
use crate::known::KnownCells;
use crate::label_cache::LabelCache;
use crate::library::Library;
use crate::sandbox::budget::Budget;
use crate::scale::Scale;
use crate::scope::Scope;
use crate::watch::Watch;
use fretwork_geometry::{Curves, PlanarMap, Point};

/// A drawing that a script has read.
pub(crate) struct Import {
    /// The script that names it.
    pub(crate) from: String,
    /// Its path from there.
    pub(crate) path: String,
    /// How far polylines may be from their curves, where the script says so.
    pub(crate) tolerance: Option<f64>,
    pub(crate) curves: Arc<Curves>,
}

/// What belongs to one evaluation; see [`session`](crate::session).
#[derive(ProvidesStaticType)]
pub struct Session {
    pub(crate) budget: Budget,
    pub(crate) library: Arc<Library>,
    pub(crate) scale: Scale,
    pub(crate) scope: RefCell<Scope>,
    pub(crate) maps: RefCell<Vec<Arc<PlanarMap>>>,
    pub(crate) imports: RefCell<Vec<Import>>,
    pub(crate) notes: RefCell<Vec<Note>>,
    pub(crate) labels: RefCell<LabelCache>,
    pub(crate) depth: Cell<usize>,
    pub(crate) watch: Option<Watch>,
    pub(crate) shift: Cell<Point>,
    /// What of the map that is mapped is known, if not all of it.
    pub(crate) known: Option<Arc<KnownCells>>,
    /// What the room that runs the evaluation needs to find again.
    pub(crate) job: Option<Arc<dyn Any + Send + Sync>>,
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session")
            .field("budget", &self.budget)
            .finish_non_exhaustive()
    }
}
