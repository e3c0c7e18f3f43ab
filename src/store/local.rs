//! The store in a folder of this machine.
//!
//! Every file is written beside its place and renamed into it, so a reader sees the whole of it or
//! nothing, however many builds share the folder and wherever one is killed. A file proves itself
//! when it is read: a value by its own digest, which is its name; what an action gave by a digest
//! of its key and its bytes, so that the file of another key is as wrong as a damaged one. What
//! proves wrong is removed and counts as absent. What cannot be read is left alone.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError, RwLock};
use std::time::{Duration, SystemTime};

use super::folder::{Folder, Kind, Lasting};
use super::{ActionResult, Digest, Hasher};

/// Bumped when the files' format changes; older folders are removed by [`LocalStore::collect`].
pub(super) const FORMAT: u32 = 3;

/// How many results of one action are kept, for as many states of the files that it reads.
const MAX_RESULTS: usize = 16;

/// An entry's time of last use is brought up to date when it is older than this. Shorter, and each
/// build writes to the folder for each of its nodes; longer, and what goes first is not what was used
/// least recently.
const USED_LATELY: Duration = Duration::from_secs(60);

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Table {
    /// What came out of computations.
    Actions,
    /// Values.
    Blobs,
    /// Texts about builds.
    Notes,
}

impl Table {
    pub const ALL: [Table; 3] = [Table::Actions, Table::Blobs, Table::Notes];

    pub fn name(self) -> &'static str {
        match self {
            Table::Actions => "actions",
            Table::Blobs => "blobs",
            Table::Notes => "notes",
        }
    }
}

/// An action cache and its blobs below one folder. Clones share what they know of it.
#[derive(Clone, Debug)]
pub struct LocalStore(pub(super) Arc<Shared>);

#[derive(Debug)]
pub(super) struct Shared {
    pub path: PathBuf,
    /// The folders of the tables that were opened.
    tables: [RwLock<Option<Arc<Folder>>>; 3],
    /// Bytes written since the size was last looked at.
    pub written: AtomicU64,
}

/// A file as it was found.
#[derive(Debug)]
pub(super) enum Found<T> {
    /// It is not there.
    Nothing,
    /// It is there and proves wrong; it was removed.
    Damaged,
    /// It is there and may not be read.
    Unreadable,
    /// It is there and proves itself.
    Whole(T),
}

impl<T> Found<T> {
    fn whole(self) -> Option<T> {
        match self {
            Found::Whole(value) => Some(value),
            Found::Nothing | Found::Damaged | Found::Unreadable => None,
        }
    }

    /// The same without the value.
    pub fn state(&self) -> Found<()> {
        match self {
            Found::Nothing => Found::Nothing,
            Found::Damaged => Found::Damaged,
            Found::Unreadable => Found::Unreadable,
            Found::Whole(_) => Found::Whole(()),
        }
    }
}

impl LocalStore {
    /// The store below `folder`, which need not exist yet. Links in the path of `folder` are followed;
    /// below it none is.
    pub fn new(folder: &Path) -> LocalStore {
        LocalStore(Arc::new(Shared {
            path: folder.to_path_buf(),
            tables: Default::default(),
            written: AtomicU64::new(0),
        }))
    }

    /// What `key` gave, the newest result first: one for each state of the files that it read by
    /// itself.
    pub fn action(&self, key: &Digest) -> Vec<ActionResult> {
        self.find_action(key).whole().unwrap_or_default()
    }

    /// Remembers what `key` gave. Its blob must have been put before.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn put_action(&self, key: &Digest, result: ActionResult) -> io::Result<()> {
        let mut results = self.action(key);
        results.retain(|known| known.reads != result.reads);
        results.insert(0, result);
        results.truncate(MAX_RESULTS);
        let body = serde_json::to_vec(&results).map_err(io::Error::other)?;
        self.write(
            Table::Actions,
            key,
            &[seal(Table::Actions, key, &body).as_bytes(), &body],
        )
    }

    /// The bytes with this digest, if they are here and whole.
    pub fn blob(&self, digest: &Digest) -> Option<Vec<u8>> {
        self.find_blob(digest).whole()
    }

    /// Whether there is a file for this digest; it may be damaged.
    pub fn has_blob(&self, digest: &Digest) -> bool {
        let entry = self
            .table(Table::Blobs)
            .and_then(|blobs| blobs.entry(&digest.hex()));
        entry.is_ok_and(|entry| entry.is_some_and(|entry| entry.kind == Kind::File))
    }

    /// Keeps bytes, whose digest is `digest`, given in pieces.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn put_blob(&self, digest: &Digest, pieces: &[&[u8]]) -> io::Result<()> {
        let len: usize = pieces.iter().map(|piece| piece.len()).sum();
        let known = self
            .table(Table::Blobs)
            .and_then(|blobs| blobs.entry(&digest.hex()));
        // A file of another length is a damaged one; it is replaced.
        match known {
            Ok(Some(entry)) if entry.kind == Kind::File && entry.bytes == len as u64 => Ok(()),
            _ => self.write(Table::Blobs, digest, pieces),
        }
    }

    /// The text kept under `name`, if it is here and whole.
    pub fn note(&self, name: &Digest) -> Option<Vec<u8>> {
        self.find_sealed(Table::Notes, name).whole()
    }

    /// Keeps a text under `name`, in place of the one before.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn put_note(&self, name: &Digest, bytes: &[u8]) -> io::Result<()> {
        self.write(
            Table::Notes,
            name,
            &[seal(Table::Notes, name, bytes).as_bytes(), bytes],
        )
    }

    /// Marks the entries of an action as used now, so that [`LocalStore::collect`] keeps them.
    pub fn touch(&self, key: &Digest, output: &Digest) {
        let now = SystemTime::now();
        for (table, digest) in [(Table::Actions, key), (Table::Blobs, output)] {
            let (Ok(folder), name) = (self.table(table), digest.hex()) else {
                continue;
            };
            let is_stale = |entry: super::folder::Entry| entry.modified + USED_LATELY < now;
            if folder
                .entry(&name)
                .is_ok_and(|entry| entry.is_some_and(is_stale))
            {
                // Only the order of removal depends on it.
                let _ = folder.touch(&name);
            }
        }
    }

    pub(super) fn find_action(&self, key: &Digest) -> Found<Vec<ActionResult>> {
        match self.find_sealed(Table::Actions, key) {
            Found::Nothing => Found::Nothing,
            Found::Damaged => Found::Damaged,
            Found::Unreadable => Found::Unreadable,
            Found::Whole(body) => match serde_json::from_slice(&body) {
                Ok(results) => Found::Whole(results),
                Err(_) => self.damaged(Table::Actions, key),
            },
        }
    }

    pub(super) fn find_blob(&self, digest: &Digest) -> Found<Vec<u8>> {
        match self.read(Table::Blobs, digest) {
            Found::Whole(bytes) if Digest::of(&bytes) != *digest => {
                self.damaged(Table::Blobs, digest)
            }
            found => found,
        }
    }

    /// The body of a file that begins with the digest of its name and its body.
    pub(super) fn find_sealed(&self, table: Table, name: &Digest) -> Found<Vec<u8>> {
        match self.read(table, name) {
            Found::Whole(mut bytes) => {
                let body = bytes.split_off(bytes.len().min(32));
                if *seal(table, name, &body).as_bytes() == *bytes {
                    Found::Whole(body)
                } else {
                    self.damaged(table, name)
                }
            }
            found => found,
        }
    }

    fn read(&self, table: Table, digest: &Digest) -> Found<Vec<u8>> {
        let name = digest.hex();
        let Ok(folder) = self.table(table) else {
            return Found::Nothing;
        };
        match folder.read(&name) {
            Ok(bytes) => Found::Whole(bytes),
            Err(_) => match folder.entry(&name) {
                Ok(Some(entry)) if entry.kind == Kind::File => Found::Unreadable,
                // A folder, a link or a pipe has an entry's name.
                Ok(Some(_)) => self.damaged(table, digest),
                _ => Found::Nothing,
            },
        }
    }

    /// Removes what stands in the place of an entry. That may fail because somebody else has just done
    /// it, which is as good.
    fn damaged<T>(&self, table: Table, digest: &Digest) -> Found<T> {
        if let Ok(folder) = self.table(table) {
            let _ = folder.remove_all(&digest.hex());
        }
        Found::Damaged
    }

    fn write(&self, table: Table, digest: &Digest, parts: &[&[u8]]) -> io::Result<()> {
        let name = digest.hex();
        let put = |folder: &Folder| {
            if folder
                .entry(&name)?
                .is_some_and(|entry| entry.kind != Kind::File)
            {
                folder.remove_all(&name)?;
            }
            folder.write(&name, parts, Lasting::UntilPowerFails)
        };
        let result = match self.made_table(table).and_then(|folder| put(&folder)) {
            // The folder was removed while it was held open.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                self.forget(table);
                self.made_table(table).and_then(|folder| put(&folder))
            }
            result => result,
        };
        let bytes = parts.iter().map(|part| part.len() as u64).sum();
        self.0.written.fetch_add(bytes, Ordering::Relaxed);
        result
    }

    /// The folder of this format, if there is one.
    pub(super) fn root(&self) -> io::Result<Folder> {
        Folder::open(&self.0.path)?.folder(&format!("v{FORMAT}"))
    }

    /// The folder of a table, if there is one.
    pub(super) fn table(&self, table: Table) -> io::Result<Arc<Folder>> {
        self.opened(table, || self.root()?.folder(table.name()))
    }

    fn made_table(&self, table: Table) -> io::Result<Arc<Folder>> {
        let make = || {
            let root = Folder::create(&self.0.path)?.make_folder(&format!("v{FORMAT}"))?;
            root.make_folder(table.name())
        };
        self.opened(table, make)
    }

    fn opened(
        &self,
        table: Table,
        open: impl Fn() -> io::Result<Folder>,
    ) -> io::Result<Arc<Folder>> {
        let slot = &self.0.tables[table as usize];
        let known = slot.read().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(folder) = known {
            return Ok(folder);
        }
        let folder = Arc::new(open()?);
        *slot.write().unwrap_or_else(PoisonError::into_inner) = Some(folder.clone());
        Ok(folder)
    }

    /// Lets go of a table's folder, which is opened anew when it is next needed.
    pub(super) fn forget(&self, table: Table) {
        let slot = &self.0.tables[table as usize];
        *slot.write().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// What stands before the body of the entry `name`.
fn seal(table: Table, name: &Digest, body: &[u8]) -> Digest {
    let mut hasher = Hasher::new("fretwork store");
    hasher
        .part(table.name().as_bytes())
        .part(name.as_bytes())
        .part(body)
        .digest()
}

#[cfg(test)]
mod tests;
