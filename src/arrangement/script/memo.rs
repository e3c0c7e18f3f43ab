//! What an evaluation makes of an arrangement, kept while it will be used again.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::rc::Rc;
use std::sync::Arc;

use starlark::values::Value;

use crate::script::construction::Construction;
use fretwork_geometry::{Curves, PlanarMap, PlanarMapError};

/// The curves of an arrangement on a region, and their planar map once it was wanted.
pub(crate) struct Made {
    pub curves: Arc<Curves>,
    map: OnceCell<Arc<PlanarMap>>,
}

impl Made {
    pub fn new(curves: Arc<Curves>) -> Made {
        Made {
            curves,
            map: OnceCell::new(),
        }
    }

    /// The planar map of the curves.
    pub fn map(&self, resolution: f64) -> Result<Arc<PlanarMap>, PlanarMapError> {
        if let Some(map) = self.map.get() {
            return Ok(map.clone());
        }
        let map = Arc::new(PlanarMap::build(&self.curves, resolution)?);
        Ok(self.map.get_or_init(|| map).clone())
    }
}

/// Arrangements that are used more than once below a root, by [`identity`].
#[derive(Default)]
pub(crate) struct Memo {
    entries: BTreeMap<u64, Entry>,
}

struct Entry {
    uses: usize,
    made: Option<Rc<Made>>,
}

/// What stands for a value where it is recognized again.
pub(crate) fn identity(value: Value<'_>) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.identity().hash(&mut hasher);
    hasher.finish()
}

impl Memo {
    /// Counts the uses of everything below `root`.
    pub fn of(root: Value<'_>) -> Memo {
        let mut entries: BTreeMap<u64, Entry> = BTreeMap::new();
        let mut open = vec![root];
        while let Some(value) = open.pop() {
            let entry = entries.entry(identity(value)).or_insert(Entry {
                uses: 0,
                made: None,
            });
            entry.uses += 1;
            if entry.uses == 1
                && let Some((node, operands)) = Construction::of(value)
            {
                open.extend(node.what.inputs(operands));
            }
        }
        entries.retain(|_, entry| entry.uses > 1);
        Memo { entries }
    }

    /// Whether `value` is used more than once.
    pub fn shares(&self, value: Value<'_>) -> bool {
        !self.entries.is_empty() && self.entries.contains_key(&identity(value))
    }

    /// What was made of `value`, if it was; after the last use it is forgotten.
    pub fn take(&mut self, value: Value<'_>) -> Option<Rc<Made>> {
        if self.entries.is_empty() {
            return None;
        }
        let key = identity(value);
        let entry = self.entries.get_mut(&key)?;
        let made = entry.made.clone()?;
        entry.uses -= 1;
        if entry.uses == 0 {
            self.entries.remove(&key);
        }
        Some(made)
    }

    /// Keeps what was made of `value` for its other uses.
    pub fn keep(&mut self, value: Value<'_>, made: &Rc<Made>) {
        if let Some(entry) = self.entries.get_mut(&identity(value)) {
            entry.uses -= 1;
            entry.made = Some(made.clone());
        }
    }
}
