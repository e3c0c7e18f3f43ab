//! The store in a folder of this machine.
//!
//! Every file is written beside its place and renamed into it, so a reader sees the whole of it or
//! nothing, however many builds share the folder and wherever one is killed. What was damaged
//! afterwards fails its checksum when it is read, is removed, and counts as absent.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use serde::Serialize;

use super::{ActionResult, Digest};

/// Bumped when the files' format changes; older folders are left for [`LocalStore::collect`].
const FORMAT: &str = "v2";

/// How many results of one action are kept, for as many states of the files that it reads.
const MAX_RESULTS: usize = 16;

/// Temporary files older than this belong to a build that was killed.
const ABANDONED: Duration = Duration::from_secs(60 * 60);

/// An action cache and its blobs below one folder.
#[derive(Debug)]
pub struct LocalStore {
    root: PathBuf,
}

/// What the store holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StoreSize {
    /// Remembered computations.
    pub actions: usize,
    /// Values.
    pub blobs: usize,
    /// Bytes of all of them.
    pub bytes: u64,
}

struct Entry {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
}

impl LocalStore {
    /// The store below `folder`, which need not exist yet.
    pub fn new(folder: &Path) -> LocalStore {
        LocalStore {
            root: folder.join(FORMAT),
        }
    }

    /// What `key` gave, the newest result first: one for each state of the files that it read by
    /// itself.
    pub fn action(&self, key: &Digest) -> Vec<ActionResult> {
        let path = self.path("actions", key);
        let Ok(sealed) = fs::read(&path) else {
            return Vec::new();
        };
        let results = unseal(&sealed).and_then(|body| serde_json::from_slice(body).ok());
        results.unwrap_or_else(|| {
            discard(&path);
            Vec::new()
        })
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
            &self.path("actions", key),
            &[Digest::of(&body).as_bytes(), &body],
        )
    }

    /// The bytes with this digest, if they are here and whole.
    pub fn blob(&self, digest: &Digest) -> Option<Vec<u8>> {
        let path = self.path("blobs", digest);
        let bytes = fs::read(&path).ok()?;
        if Digest::of(&bytes) != *digest {
            discard(&path);
            return None;
        }
        Some(bytes)
    }

    /// Whether there is a file for this digest; it may be damaged.
    pub fn has_blob(&self, digest: &Digest) -> bool {
        self.path("blobs", digest).exists()
    }

    /// Keeps `bytes`, whose digest is `digest`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn put_blob(&self, digest: &Digest, bytes: &[u8]) -> io::Result<()> {
        let path = self.path("blobs", digest);
        // A file of another length is a damaged one; it is replaced.
        if fs::metadata(&path).is_ok_and(|m| m.len() == bytes.len() as u64) {
            Ok(())
        } else {
            self.write(&path, &[bytes])
        }
    }

    /// The text kept under `name`, which is not checked and may be absent.
    pub fn note(&self, name: &Digest) -> Option<Vec<u8>> {
        fs::read(self.path("notes", name)).ok()
    }

    /// Keeps a text under `name`, in place of the one before.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn put_note(&self, name: &Digest, bytes: &[u8]) -> io::Result<()> {
        self.write(&self.path("notes", name), &[bytes])
    }

    /// How much is stored.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn size(&self) -> io::Result<StoreSize> {
        let (actions, blobs) = (self.entries("actions")?, self.entries("blobs")?);
        let bytes = actions.iter().chain(&blobs).map(|e| e.bytes).sum();
        Ok(StoreSize {
            actions: actions.len(),
            blobs: blobs.len(),
            bytes,
        })
    }

    /// Reads everything, removes what is damaged, and says how many files that were.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn verify(&self) -> io::Result<usize> {
        let mut damaged = 0;
        for table in ["actions", "blobs"] {
            for entry in self.entries(table)? {
                let whole = digest_of_path(&entry.path).is_some_and(|digest| match table {
                    "actions" => !self.action(&digest).is_empty(),
                    _ => self.blob(&digest).is_some(),
                });
                if !whole {
                    discard(&entry.path);
                    damaged += 1;
                }
            }
        }
        Ok(damaged)
    }

    /// Removes files of killed builds and of older formats, then the entries that were used least
    /// recently until at most `keep` bytes remain. Gives the number of bytes removed.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn collect(&self, keep: u64) -> io::Result<u64> {
        let mut freed = self.remove_leftovers()?;
        let mut entries = self.entries("actions")?;
        entries.extend(self.entries("blobs")?);
        entries.sort_by(|a, b| b.used.cmp(&a.used).then_with(|| a.path.cmp(&b.path)));
        let mut total = 0;
        for entry in entries {
            total += entry.bytes;
            if total > keep {
                discard(&entry.path);
                freed += entry.bytes;
            }
        }
        Ok(freed)
    }

    /// Marks the entries of an action as used now, so that [`LocalStore::collect`] keeps them.
    pub fn touch(&self, key: &Digest, output: &Digest) {
        let now = SystemTime::now();
        for path in [self.path("actions", key), self.path("blobs", output)] {
            let stale = fs::metadata(&path)
                .and_then(|m| m.modified())
                .is_ok_and(|t| t + Duration::from_secs(86_400) < now);
            if stale && let Ok(file) = fs::File::options().append(true).open(&path) {
                // Only the order of eviction depends on it.
                let _ = file.set_modified(now);
            }
        }
    }

    fn path(&self, table: &str, digest: &Digest) -> PathBuf {
        let hex = digest.hex();
        self.root.join(table).join(&hex[..2]).join(&hex[2..])
    }

    fn write(&self, path: &Path, parts: &[&[u8]]) -> io::Result<()> {
        let folder = path
            .parent()
            .expect("every entry lies in a folder of the store");
        fs::create_dir_all(folder)?;
        let mut file = tempfile::Builder::new()
            .prefix(".tmp")
            .tempfile_in(folder)?;
        for part in parts {
            file.as_file_mut().write_all(part)?;
        }
        file.persist(path).map_err(|e| e.error)?;
        Ok(())
    }

    fn entries(&self, table: &str) -> io::Result<Vec<Entry>> {
        let mut entries = Vec::new();
        for folder in list(&self.root.join(table))? {
            for path in list(&folder)? {
                if is_temporary(&path) {
                    continue;
                }
                // Another build may have removed it since it was listed.
                if let Ok(meta) = fs::metadata(&path) {
                    let used = meta.modified().unwrap_or(SystemTime::UNIX_EPOCH);
                    entries.push(Entry {
                        path,
                        bytes: meta.len(),
                        used,
                    });
                }
            }
        }
        Ok(entries)
    }

    fn remove_leftovers(&self) -> io::Result<u64> {
        let mut freed = 0;
        for table in list(&self.root)? {
            for folder in list(&table)? {
                for path in list(&folder)?.into_iter().filter(|p| is_temporary(p)) {
                    let Ok(meta) = fs::metadata(&path) else {
                        continue;
                    };
                    if meta
                        .modified()
                        .is_ok_and(|t| t.elapsed().is_ok_and(|age| age > ABANDONED))
                    {
                        discard(&path);
                        freed += meta.len();
                    }
                }
            }
        }
        Ok(freed)
    }
}

fn list(folder: &Path) -> io::Result<Vec<PathBuf>> {
    match fs::read_dir(folder) {
        Err(e)
            if matches!(
                e.kind(),
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
            ) =>
        {
            Ok(Vec::new())
        }
        Err(e) => Err(e),
        Ok(entries) => {
            let mut paths = entries
                .map(|e| e.map(|e| e.path()))
                .collect::<io::Result<Vec<_>>>()?;
            paths.sort();
            Ok(paths)
        }
    }
}

fn is_temporary(path: &Path) -> bool {
    path.file_name()
        .is_some_and(|n| n.to_string_lossy().starts_with(".tmp"))
}

fn digest_of_path(path: &Path) -> Option<Digest> {
    let folder = path.parent()?.file_name()?.to_str()?;
    Digest::from_hex(&format!("{folder}{}", path.file_name()?.to_str()?))
}

/// Removing a file may fail because somebody else has just done it, which is as good.
fn discard(path: &Path) {
    let _ = fs::remove_file(path);
}

/// The body of a file that begins with the digest of its body.
fn unseal(sealed: &[u8]) -> Option<&[u8]> {
    let (sum, body) = sealed.split_at_checked(32)?;
    (Digest::of(body).as_bytes() == sum).then_some(body)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn store() -> (tempfile::TempDir, LocalStore) {
        let folder = tempfile::tempdir().unwrap();
        let store = LocalStore::new(folder.path());
        (folder, store)
    }

    fn put(store: &LocalStore, text: &str) -> (Digest, Digest) {
        let (key, output) = (
            Digest::of(format!("key {text}").as_bytes()),
            Digest::of(text.as_bytes()),
        );
        store.put_blob(&output, text.as_bytes()).unwrap();
        store
            .put_action(
                &key,
                ActionResult {
                    reads: Vec::new(),
                    output,
                    note: b"n".to_vec(),
                },
            )
            .unwrap();
        (key, output)
    }

    #[test]
    fn what_was_put_is_found_again() {
        let (_folder, store) = store();
        let (key, output) = put(&store, "value");
        assert_eq!(store.action(&key)[0].output, output);
        assert_eq!(store.blob(&output).unwrap(), b"value");
        assert_eq!(store.action(&output), []);
        assert_eq!(store.size().unwrap().blobs, 1);
    }

    #[test]
    fn a_result_is_kept_for_each_state_of_the_files_that_were_read() {
        let (_folder, store) = store();
        let result = |state: u8| {
            let reads = vec![("lib.star".to_string(), Digest::of(&[state]))];
            ActionResult {
                reads,
                output: Digest::of(&[state, state]),
                note: Vec::new(),
            }
        };
        let key = Digest::of(b"key");
        for state in [1, 2, 1] {
            store.put_action(&key, result(state)).unwrap();
        }
        assert_eq!(store.action(&key), [result(1), result(2)]);
        for state in 0..=u8::MAX {
            store.put_action(&key, result(state)).unwrap();
        }
        assert_eq!(store.action(&key).len(), MAX_RESULTS);
    }

    #[test]
    fn every_damaged_byte_and_every_truncation_is_detected_and_dropped() {
        let (_folder, store) = store();
        let (key, output) = put(&store, "value");
        for (table, digest) in [("actions", key), ("blobs", output)] {
            let path = store.path(table, &digest);
            let whole = fs::read(&path).unwrap();
            let found = || {
                if table == "actions" {
                    !store.action(&digest).is_empty()
                } else {
                    store.blob(&digest).is_some()
                }
            };
            for i in 0..whole.len() {
                let mut damaged = whole.clone();
                damaged[i] ^= 1;
                fs::write(&path, damaged).unwrap();
                assert!(!found() && !path.exists(), "{table}: byte {i} flipped");
                fs::write(&path, &whole[..i]).unwrap();
                assert!(!found() && !path.exists(), "{table}: cut at {i}");
            }
            fs::write(&path, &whole).unwrap();
            assert!(found());
        }
    }

    #[test]
    fn verify_removes_what_is_damaged_and_keeps_the_rest() {
        let (_folder, store) = store();
        let (_, damaged) = put(&store, "one");
        let (_, whole) = put(&store, "two");
        fs::write(store.path("blobs", &damaged), "eno").unwrap();
        assert_eq!(store.verify().unwrap(), 1);
        assert!(store.has_blob(&whole) && !store.has_blob(&damaged));
        assert_eq!(store.verify().unwrap(), 0);
    }

    #[test]
    fn collecting_keeps_what_was_used_last() {
        let (_folder, store) = store();
        let (_, old) = put(&store, "old value");
        let past = SystemTime::now() - Duration::from_secs(1_000_000);
        fs::File::options()
            .append(true)
            .open(store.path("blobs", &old))
            .unwrap()
            .set_modified(past)
            .unwrap();
        let (_, new) = put(&store, "new value");
        let size = store.size().unwrap().bytes;
        assert_eq!(store.collect(size - 1).unwrap(), 9);
        assert!(store.has_blob(&new) && !store.has_blob(&old));
        assert!(store.collect(0).unwrap() > 0);
        assert_eq!(store.size().unwrap(), StoreSize::default());
    }

    #[test]
    fn a_damaged_blob_of_the_right_length_is_not_kept_when_put_again_after_a_read() {
        let (_folder, store) = store();
        let (_, output) = put(&store, "value");
        fs::write(store.path("blobs", &output), "eulav").unwrap();
        assert_eq!(store.blob(&output), None);
        store.put_blob(&output, b"value").unwrap();
        assert_eq!(store.blob(&output).unwrap(), b"value");
    }
}
