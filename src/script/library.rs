//! What scripts read from elsewhere: elements and other scripts. A script sees files only through
//! a [`Host`], which knows what a path means and what may be read.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use fretwork_geometry::{Curves, budget};

/// The world around scripts. Paths are relative to the folder of the script that names them, which
/// is `from`.
pub trait Host: Send + Sync {
    /// The curves of the drawing at `path`, as polylines that are no farther from them than `tolerance`, if there is one, and else
    /// than nobody sees.
    ///
    /// # Errors
    /// A sentence that says why there are none.
    fn curves(&self, path: &str, from: &str, tolerance: Option<f64>)
    -> Result<Arc<Curves>, String>;

    /// The name and the text of the script at `path`. Of one file the name is always the same.
    ///
    /// # Errors
    /// A sentence that says why there is none.
    fn script(&self, path: &str, from: &str) -> Result<(Arc<str>, Arc<str>), String>;
}

/// What was read, by the script that names it, its path and the bits of its tolerance.
type Imports = BTreeMap<(String, String, Option<u64>), Result<Arc<Curves>, String>>;

/// A host that is asked once for each drawing.
pub struct Library {
    host: Arc<dyn Host>,
    imports: Mutex<Imports>,
}

impl Library {
    pub fn new(host: Arc<dyn Host>) -> Library {
        Library {
            host,
            imports: Mutex::default(),
        }
    }

    /// What there is for expressions: nothing.
    pub fn empty() -> Arc<Library> {
        Arc::new(Library::new(Arc::new(Nothing)))
    }

    /// The curves of the drawing at `path`, named in the script `from`, to a `tolerance`.
    pub fn curves(
        &self,
        path: &str,
        from: &str,
        tolerance: Option<f64>,
    ) -> Result<Arc<Curves>, String> {
        const UNPOISONED: &str = "no code panics while it holds the imports";
        let key = (
            from.to_owned(),
            path.to_owned(),
            tolerance.map(f64::to_bits),
        );
        if let Some(known) = self.imports.lock().expect(UNPOISONED).get(&key) {
            return known.clone();
        }
        // Not while the lock is held: reading may wait for work that wants an import itself.
        let read = budget::apart(|| self.host.curves(path, from, tolerance));
        self.imports
            .lock()
            .expect(UNPOISONED)
            .entry(key)
            .or_insert(read)
            .clone()
    }
}

struct Nothing;

impl Host for Nothing {
    fn curves(&self, path: &str, _: &str, _: Option<f64>) -> Result<Arc<Curves>, String> {
        Err(format!("`{path}` cannot be read here"))
    }

    fn script(&self, path: &str, _: &str) -> Result<(Arc<str>, Arc<str>), String> {
        Err(format!("`{path}` cannot be read here"))
    }
}
