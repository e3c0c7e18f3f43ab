//! Where bytes come from. The one door between the compiler and the outside; the disk is behind
//! it in `cli/`, a map in tests.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use fretwork_action::{Parts, ReadError, Reader};

/// A file that was opened.
pub enum Opened {
    /// Its bytes.
    Bytes(Vec<u8>),
    /// A way to read parts of it.
    Parts(Arc<dyn Parts>),
}

/// The files of a project. Paths are relative to its root, normal, with `/` between the parts.
pub trait World: Send + Sync {
    /// The bytes of a file.
    ///
    /// # Errors
    /// When there is no readable file inside the project root at `path`.
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError>;

    /// The bytes of a file, or of a large raster a way to read parts of it.
    ///
    /// # Errors
    /// Those of [`World::read`].
    fn open(&self, path: &str) -> Result<Opened, ReadError> {
        self.read(path).map(Opened::Bytes)
    }

    /// The names of what is in a folder, in order; none where it cannot be read. Advice is made of
    /// them, never a value: they are no input.
    fn names(&self, folder: &str) -> Vec<String>;
}

/// A project in memory.
#[derive(Clone, Debug, Default)]
pub struct MemoryWorld {
    /// Path and bytes of every file.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl World for MemoryWorld {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.files.get(path).cloned().ok_or(ReadError::Missing)
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let inside = |path: &String| {
            let (parent, name) = path.rsplit_once('/').unwrap_or(("", path));
            (parent == folder).then(|| name.to_string())
        };
        self.files.keys().filter_map(inside).collect()
    }
}

/// What stages read while they run.
pub struct WorldReader {
    world: Arc<dyn World>,
    revision: AtomicU64,
}

impl WorldReader {
    /// A reader of `world`.
    pub fn new(world: Arc<dyn World>) -> WorldReader {
        WorldReader {
            world,
            revision: AtomicU64::new(0),
        }
    }

    /// Notes that a file has changed.
    pub fn changed(&self) {
        self.revision.fetch_add(1, Ordering::Relaxed);
    }
}

impl Reader for WorldReader {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, ReadError> {
        self.world.read(path).map(Arc::from)
    }

    fn revision(&self) -> u64 {
        self.revision.load(Ordering::Relaxed)
    }
}
