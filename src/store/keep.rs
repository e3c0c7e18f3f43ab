//! How much a store holds, whether it is whole, and keeping it at a size. Only what has the name of
//! an entry is ever removed: whatever else somebody has put into the folder stays.

use std::io;
use std::sync::atomic::Ordering;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use super::Digest;
use super::folder::{Folder, Kind, Lasting};
use super::local::{FORMAT, Found, LocalStore, Table};

/// The name of the file that says how much there is.
const USAGE: &str = "usage";

/// The files are counted anew when that was last done so many seconds ago: builds that run at the same time lose
/// some of what the others add.
const COUNT_LASTS: u64 = 24 * 60 * 60;

/// What the store holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StoreSize {
    /// Remembered computations.
    pub actions: usize,
    /// Values.
    pub blobs: usize,
    /// Bytes of all files.
    pub bytes: u64,
}

/// What reading all of a store has found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Verification {
    /// Entries that did not prove themselves and were removed.
    pub damaged: usize,
    /// Entries that this user may not read. They were left alone.
    pub unreadable: usize,
}

/// An entry of a table, or what stands in its place.
struct Listed {
    table: Table,
    name: String,
    kind: Kind,
    bytes: u64,
    used: SystemTime,
}

impl LocalStore {
    /// How much is stored.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn size(&self) -> io::Result<StoreSize> {
        let entries = self.entries()?;
        let count = |table| {
            entries
                .iter()
                .filter(|e| e.table == table && e.kind == Kind::File)
                .count()
        };
        Ok(StoreSize {
            actions: count(Table::Actions),
            blobs: count(Table::Blobs),
            bytes: entries.iter().map(|e| e.bytes).sum(),
        })
    }

    /// Reads everything and removes what is damaged.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn verify(&self) -> io::Result<Verification> {
        let mut verification = Verification::default();
        for entry in self.entries()? {
            let Some(digest) = Digest::from_hex(&entry.name) else {
                continue;
            };
            let found = match entry.table {
                Table::Actions => self.find_action(&digest).state(),
                Table::Blobs => self.find_blob(&digest).state(),
                Table::Notes => self.find_sealed(Table::Notes, &digest).state(),
            };
            match found {
                Found::Damaged => verification.damaged += 1,
                Found::Unreadable => verification.unreadable += 1,
                Found::Nothing | Found::Whole(()) => {}
            }
        }
        Ok(verification)
    }

    /// Removes files of killed builds and of older formats, then the entries that were used least
    /// recently until at most `keep` bytes remain. Gives the number of bytes removed.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn collect(&self, keep: u64) -> io::Result<u64> {
        let mut freed = self.remove_older_formats()?;
        for table in Table::ALL {
            if let Some(folder) = present(self.table(table).map(Some))? {
                freed += folder.remove_abandoned()?;
            }
        }
        let mut entries = self.entries()?;
        entries.sort_by(|a, b| b.used.cmp(&a.used).then_with(|| a.name.cmp(&b.name)));
        let mut total = 0;
        for entry in entries {
            total += entry.bytes;
            if total > keep && self.table(entry.table)?.remove_all(&entry.name).is_ok() {
                freed += entry.bytes;
            }
        }
        Ok(freed)
    }

    /// Keeps the store at `limit` bytes: when more was written than that, the entries that were used
    /// least recently go, until a tenth of the limit is free again. Costs one small file when there is
    /// room.
    ///
    /// # Errors
    /// When the folder cannot be read or written; the next build tries it again.
    pub fn settle(&self, limit: u64) -> io::Result<()> {
        let written = self.0.written.swap(0, Ordering::Relaxed);
        let Some(root) = present(self.root().map(Some))? else {
            return Ok(());
        };
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default()
            .as_secs();
        let known = usage(&root).filter(|(_, counted)| now.abs_diff(*counted) < COUNT_LASTS);
        let (mut total, mut counted) = match known {
            Some((total, counted)) => (total.saturating_add(written), counted),
            None => (self.size()?.bytes, now),
        };
        if total > limit {
            // Entries that were written twice have been counted twice.
            total = self.size()?.bytes;
            if total > limit {
                total = total.saturating_sub(self.collect(limit - limit / 10)?);
            }
            counted = now;
        }
        if known != Some((total, counted)) {
            let text = format!("{total} {counted}\n");
            root.write(USAGE, &[text.as_bytes()], Lasting::UntilPowerFails)?;
        }
        Ok(())
    }

    /// All that has the name of an entry.
    fn entries(&self) -> io::Result<Vec<Listed>> {
        let mut entries = Vec::new();
        for table in Table::ALL {
            let Some(folder) = present(self.table(table).map(Some))? else {
                continue;
            };
            for name in folder.names()?.into_iter().filter(|name| is_entry(name)) {
                // Another build may have removed it since it was listed.
                if let Some(entry) = folder.entry(&name)? {
                    entries.push(Listed {
                        table,
                        kind: entry.kind,
                        bytes: if entry.kind == Kind::File {
                            entry.bytes
                        } else {
                            0
                        },
                        used: entry.modified,
                        name,
                    });
                }
            }
        }
        Ok(entries)
    }

    /// Removes the entries of older formats, which lie in folders named after the first two digits of
    /// their digests, and the folders that this leaves empty.
    fn remove_older_formats(&self) -> io::Result<u64> {
        let Some(cache) = present(Folder::open(&self.0.path).map(Some))? else {
            return Ok(0);
        };
        let mut freed = 0;
        for format in (1..FORMAT).map(|number| format!("v{number}")) {
            let Ok(root) = cache.folder(&format) else {
                continue;
            };
            for table in Table::ALL {
                if let Ok(folder) = root.folder(table.name()) {
                    freed += remove_older_table(&folder)?;
                    root.remove_empty(table.name())?;
                }
            }
            cache.remove_empty(&format)?;
        }
        Ok(freed)
    }
}

fn remove_older_table(table: &Folder) -> io::Result<u64> {
    let mut freed = 0;
    for first in table.names()?.iter().filter(|name| is_hex(name, 2)) {
        let Ok(folder) = table.folder(first) else {
            continue;
        };
        let is_ours = |name: &&String| is_hex(name, 62) || is_older_temporary(name);
        for name in folder.names()?.iter().filter(is_ours) {
            let Some(entry) = folder.entry(name)? else {
                continue;
            };
            if entry.kind == Kind::File && folder.remove_file(name).is_ok() {
                freed += entry.bytes;
            }
        }
        table.remove_empty(first)?;
    }
    Ok(freed)
}

/// The bytes that there were, and the second at which they were counted.
fn usage(root: &Folder) -> Option<(u64, u64)> {
    let text = String::from_utf8(root.read(USAGE).ok()?).ok()?;
    let (total, counted) = text.trim_end().split_once(' ')?;
    Some((total.parse().ok()?, counted.parse().ok()?))
}

/// That there is nothing is no error.
fn present<T>(result: io::Result<Option<T>>) -> io::Result<Option<T>> {
    match result {
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
            ) =>
        {
            Ok(None)
        }
        result => result,
    }
}

fn is_entry(name: &str) -> bool {
    is_hex(name, 64)
}

fn is_hex(name: &str, digits: usize) -> bool {
    name.len() == digits && name.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
}

fn is_older_temporary(name: &str) -> bool {
    let rest = name.strip_prefix(".tmp").unwrap_or_default();
    rest.len() == 6 && rest.bytes().all(|b| b.is_ascii_alphanumeric())
}
