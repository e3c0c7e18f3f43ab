//! Where bytes come from. The one door between the compiler and the outside; the disk is behind
//! it in `cli/`, a map in tests.

use std::collections::BTreeMap;
use std::sync::Arc;

use thiserror::Error;

/// The largest file that is read, in bytes.
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

/// The files of a project. Paths are relative to its root, normal, with `/` between the parts.
pub trait World: Send + Sync {
    /// The bytes of a file.
    ///
    /// # Errors
    /// When there is no readable file inside the project root at `path`.
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError>;

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
    use super::resolve;

    #[test]
    fn paths_are_relative_to_the_file_that_names_them() {
        assert_eq!(
            resolve("specs/a.yaml", "assets/x.svg").as_deref(),
            Some("specs/assets/x.svg")
        );
        assert_eq!(
            resolve("specs/a.yaml", "../x.svg").as_deref(),
            Some("x.svg")
        );
        assert_eq!(
            resolve("specs/a.yaml", "./b/../c.svg").as_deref(),
            Some("specs/c.svg")
        );
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
