//! A revision of a project as its files: those of a tree of git. Links are followed inside of the project; what is not in the
//! repository is told for what it is.

use std::collections::BTreeMap;

use super::git::{Entry, Kind, Objects, Repository};
use crate::terminal::Failure;
use fretwork_engine::{ReadError, World};

/// So many links are followed on the way to a file.
const LINKS: usize = 40;
/// What a pointer of Git LFS begins with, and the most bytes that one has.
const POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";
const LONGEST_POINTER: usize = 1024;

/// The files of a revision.
pub struct Revision {
    entries: BTreeMap<String, Entry>,
    objects: Objects,
}

impl Revision {
    /// The files of the revision `rev`.
    ///
    /// # Errors
    /// When there is none of that name, or it cannot be read.
    pub fn of(repository: &Repository, rev: &str) -> Result<Revision, Failure> {
        let commit = repository.commit(rev)?;
        Ok(Revision {
            entries: repository.tree(&commit)?,
            objects: repository.objects(),
        })
    }

    /// Every `specs/**/*.yaml`, in order; what is hidden is left out, as on the disk.
    pub fn specs(&self) -> Vec<String> {
        let is_spec = |path: &&String| {
            let is_named = path.ends_with(".yaml") || path.ends_with(".yml");
            is_named && path.starts_with("specs/") && !path.split('/').any(|p| p.starts_with('.'))
        };
        self.entries.keys().filter(is_spec).cloned().collect()
    }

    /// Whether there is a file or a link at `path`.
    pub fn has(&self, path: &str) -> bool {
        self.entries.contains_key(path)
    }

    /// Where `path` leads to, as the object of a file.
    fn resolve(&self, path: &str) -> Result<&Entry, ReadError> {
        let mut path = path.to_string();
        for _ in 0..LINKS {
            match self.first_entry(&path) {
                None if self.is_folder(&path) => return Err(ReadError::NotAFile),
                None => return Err(ReadError::Missing),
                Some((at, entry)) => match entry.kind {
                    Kind::File if at == path.len() => return Ok(entry),
                    Kind::File => return Err(ReadError::Missing),
                    Kind::Submodule => {
                        let module = &path[..at];
                        let message = format!(
                            "it lies in the submodule `{module}`, which is another repository"
                        );
                        return Err(ReadError::Io(message));
                    }
                    Kind::Link => {
                        let target = self.objects.read(&entry.id)?;
                        path = followed(&path, at, &target).ok_or(ReadError::Outside)?;
                    }
                },
            }
        }
        Err(ReadError::Io("too many links lead to it".to_string()))
    }

    /// The first entry on the way to `path`, and how much of the path leads to it.
    fn first_entry(&self, path: &str) -> Option<(usize, &Entry)> {
        let ends = path.match_indices('/').map(|(at, _)| at);
        let mut ends = ends.chain([path.len()]);
        ends.find_map(|end| Some((end, self.entries.get(&path[..end])?)))
    }

    fn is_folder(&self, path: &str) -> bool {
        let below = format!("{path}/");
        let next = self.entries.range(below.clone()..).next();
        next.is_some_and(|(known, _)| known.starts_with(&below))
    }
}

/// The path when the link at its first `at` bytes is followed; none where that leaves the project.
fn followed(path: &str, at: usize, target: &[u8]) -> Option<String> {
    let target = std::str::from_utf8(target).ok()?;
    if target.starts_with('/') {
        return None;
    }
    let folder = path[..at].rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = Vec::new();
    let all = folder
        .split('/')
        .chain(target.split('/'))
        .chain(path[at..].split('/'));
    for part in all {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

impl World for Revision {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        let entry = self.resolve(path)?;
        let bytes = self.objects.read(&entry.id)?;
        if bytes.len() <= LONGEST_POINTER && bytes.starts_with(POINTER) {
            let message =
                "it is a pointer of Git LFS there, and the file itself is not in the repository";
            return Err(ReadError::Io(message.to_string()));
        }
        Ok(bytes)
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let below = match folder {
            "" => String::new(),
            folder => format!("{folder}/"),
        };
        let inside = self.entries.range(below.clone()..);
        let inside = inside.map_while(|(path, _)| path.strip_prefix(&below));
        let mut names: Vec<String> = inside
            .map(|path| path.split('/').next().unwrap_or(path).to_string())
            .collect();
        names.sort();
        names.dedup();
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_followed_inside_of_the_project() {
        for (path, at, target, found) in [
            ("a/b", 3, "c", Some("a/c")),
            ("a/b/d", 3, "../c/", Some("c/d")),
            ("a/b", 3, "../../c", None),
            ("a", 1, "/etc/passwd", None),
            ("a", 1, "./b//c", Some("b/c")),
        ] {
            let found = found.map(str::to_string);
            assert_eq!(followed(path, at, target.as_bytes()), found, "{target}");
        }
    }
}
