//! The files of an action: those that its node names, and those that scripts and models name in turn.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::content::Content;

/// The largest file that is held, in bytes.
pub const FILE_LIMIT: u64 = 1 << 30;

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Error)]
pub enum ReadError {
    /// There is none.
    #[error("there is no such file")]
    Missing,
    /// It lies outside the project root, perhaps behind a symbolic link.
    #[error("it lies outside the project root")]
    Outside,
    /// It is a folder or a device.
    #[error("it is not a file")]
    NotAFile,
    /// It is larger than [`FILE_LIMIT`].
    #[error("it is larger than {} MiB", FILE_LIMIT >> 20)]
    TooLarge,
    /// The system says so.
    #[error("{0}")]
    Io(String),
}

/// The files of a project, for what a stage finds while it runs. Paths are relative to the project
/// root, normal, with `/` between the parts.
pub trait Reader: Send + Sync {
    /// The bytes of a file.
    ///
    /// # Errors
    /// When there is no readable file inside the project root at `path`.
    fn read(&self, path: &str) -> Result<Arc<[u8]>, ReadError>;

    /// A number that is another one after any file has changed.
    fn revision(&self) -> u64;
}

/// The files that an action may read. Without a reader they are just those that it holds.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct Files {
    #[serde(with = "held")]
    held: BTreeMap<Arc<str>, Content>,
    #[serde(skip)]
    reader: Option<Arc<dyn Reader>>,
}

impl fmt::Debug for Files {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.held.keys()).finish()
    }
}

impl Files {
    /// The files `held`, and whatever `reader` finds.
    pub fn new(held: BTreeMap<Arc<str>, Content>, reader: Arc<dyn Reader>) -> Files {
        Files {
            held,
            reader: Some(reader),
        }
    }

    /// What is in a file that the node names.
    pub fn named(&self, path: &str) -> Option<&Content> {
        self.held.get(path)
    }

    /// The path and the bytes of a file that another file, `from`, names; noted in `log`.
    ///
    /// # Errors
    /// With a sentence on why it cannot be read.
    pub fn found(
        &self,
        name: &str,
        from: &str,
        log: &ReadLog,
    ) -> Result<(Arc<str>, Arc<[u8]>), String> {
        let path =
            resolve(from, name).ok_or_else(|| format!("`{name}` leaves the project root"))?;
        let bytes = match (&self.reader, self.held.get(&path)) {
            (Some(reader), _) => reader.read(&path),
            (None, Some(held)) => held.whole(),
            (None, None) => Err(ReadError::Missing),
        };
        log.note(&path, bytes.as_ref().ok());
        match bytes {
            Ok(bytes) => Ok((path, bytes)),
            Err(error) => Err(format!("cannot read `{path}`: {error}")),
        }
    }

    /// A number that is another one after any file has changed.
    pub fn revision(&self) -> u64 {
        self.reader.as_ref().map_or(0, |reader| reader.revision())
    }

    /// These files and those in `log`.
    pub fn with_found(&self, log: &ReadLog) -> Files {
        let mut all = self.clone();
        let found = log.entries().into_iter();
        all.held
            .extend(found.filter_map(|(path, bytes)| Some((path, Content::Bytes(bytes?)))));
        all
    }
}

/// The files that a stage has found and read by itself, and the bytes that it got; none where that
/// failed. Clones share what they note.
#[derive(Clone, Debug, Default)]
pub struct ReadLog(Arc<Mutex<BTreeMap<Arc<str>, Option<Arc<[u8]>>>>>);

impl ReadLog {
    /// Notes that `path` was read.
    pub fn note(&self, path: &Arc<str>, bytes: Option<&Arc<[u8]>>) {
        let mut log = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        log.insert(path.clone(), bytes.cloned());
    }

    /// Notes all that `other` holds.
    pub fn extend(&self, other: &ReadLog) {
        for (path, bytes) in other.entries() {
            self.note(&path, bytes.as_ref());
        }
    }

    /// What was read so far, in order of the paths.
    pub fn entries(&self) -> Vec<(Arc<str>, Option<Arc<[u8]>>)> {
        let log = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        log.iter()
            .map(|(path, bytes)| (path.clone(), bytes.clone()))
            .collect()
    }
}

/// The ways to write the ending of a file that belongs to another one, whose ending is `own`: first as that is written, then in
/// small letters, in capitals, and in all other ways, as programs on systems that do not tell them apart leave them.
pub fn spellings(ending: &str, own: &str) -> Vec<String> {
    let (small, large) = (ending.to_ascii_lowercase(), ending.to_ascii_uppercase());
    let is_large = !own.is_empty() && own.chars().all(|c| !c.is_ascii_lowercase());
    let mut all = match is_large {
        true => vec![large, small],
        false => vec![small, large],
    };
    let choices = match ending.len() {
        letters @ 0..=MOST_LETTERS => 1u32 << letters,
        _ => 0,
    };
    let mixed = (0..choices).map(|choice| {
        let letter = |(i, c): (usize, char)| match choice >> i & 1 {
            1 => c.to_ascii_uppercase(),
            _ => c.to_ascii_lowercase(),
        };
        ending.chars().enumerate().map(letter).collect::<String>()
    });
    for spelling in mixed {
        if !all.contains(&spelling) {
            all.push(spelling);
        }
    }
    all
}

/// Longer endings are looked for in small letters and in capitals alone.
const MOST_LETTERS: usize = 4;

mod held {
    //! Files as plain byte strings, which a compact format copies in one piece.
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use serde::ser::{Error as _, SerializeMap as _};
    use serde::{Deserialize, Deserializer, Serializer};

    use crate::content::Content;

    type Held = BTreeMap<Arc<str>, Content>;

    pub fn serialize<S: Serializer>(held: &Held, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(held.len()))?;
        for (path, content) in held {
            let bytes = content.whole().map_err(S::Error::custom)?;
            map.serialize_entry(path, &crate::value::Bytes(&bytes))?;
        }
        map.end()
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Held, D::Error> {
        let held = BTreeMap::<Arc<str>, crate::value::ByteBuffer>::deserialize(deserializer)?;
        Ok(held
            .into_iter()
            .map(|(path, bytes)| (path, Content::Bytes(bytes.0.into())))
            .collect())
    }
}

/// The normal path of `relative`, as named in the file `from`; none where it leaves the root or is
/// absolute.
pub fn resolve(from: &str, relative: &str) -> Option<Arc<str>> {
    if relative.starts_with(['/', '\\'])
        || relative.contains(['\\', '\0'])
        || relative.get(1..2) == Some(":")
    {
        return None;
    }
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in relative.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    Some(parts.join("/").into())
}

#[cfg(test)]
mod tests {
    use super::{resolve, spellings};

    #[test]
    fn endings_are_looked_for_as_they_may_be_written() {
        let all = spellings("dbf", "shp");
        assert_eq!(all[..2], ["dbf", "DBF"]);
        assert_eq!(all.len(), 8);
        assert!(all.contains(&"Dbf".to_string()) && all.contains(&"dBF".to_string()));
        assert_eq!(spellings("dbf", "SHP")[..2], ["DBF", "dbf"]);
        assert_eq!(spellings("gpkg-wal", "gpkg").len(), 2);
    }

    #[test]
    fn paths_are_relative_to_the_file_that_names_them() {
        let cases = [
            ("assets/x.svg", "specs/assets/x.svg"),
            ("../x.svg", "x.svg"),
            ("./b/../c.svg", "specs/c.svg"),
        ];
        for (relative, path) in cases {
            assert_eq!(resolve("specs/a.yaml", relative).as_deref(), Some(path));
        }
        for outside in [
            "../../x.svg",
            "/etc/passwd",
            "a/../../../x",
            "C:/x",
            "..\\x",
            "a\0b",
        ] {
            assert_eq!(resolve("specs/a.yaml", outside), None, "{outside}");
        }
    }
}
