//! Where files are written: a folder that is trusted, and plain names below it.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use fretwork_store::Folder;

/// A folder by its path. Inside of a project, whose files may come from strangers, no link is passed
/// on the way from the root; anywhere else the path is the caller's own, and its links are followed.
#[derive(Clone, Debug)]
pub struct Place {
    trusted: PathBuf,
    below: PathBuf,
}

impl Place {
    /// The folder `path` as the project at `root` sees it.
    ///
    /// # Errors
    /// When the current folder is not known.
    pub fn of(root: &Path, path: &Path) -> io::Result<Place> {
        let path = without_dots(&std::path::absolute(path)?);
        // The first that is the root, since one below it may be a link back to it.
        let mut above: Vec<&Path> = path.ancestors().collect();
        above.reverse();
        let is_root = |folder: &&Path| fs::canonicalize(folder).is_ok_and(|found| found == root);
        let trusted = above
            .into_iter()
            .find(is_root)
            .unwrap_or(&path)
            .to_path_buf();
        let below = path
            .strip_prefix(&trusted)
            .unwrap_or(Path::new(""))
            .to_path_buf();
        Ok(Place { trusted, below })
    }

    /// The folder that holds the file `path`, and the file's name.
    ///
    /// # Errors
    /// As [`Place::of`], and when `path` names no file.
    pub fn of_file(root: &Path, path: &Path) -> io::Result<(Place, String)> {
        let name = path.file_name().and_then(OsStr::to_str);
        let name = name.ok_or_else(|| io::Error::other("it has no name in UTF-8"))?;
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let place = Place::of(root, folder.unwrap_or(Path::new(".")))?;
        Ok((place, name.to_string()))
    }

    /// The folder `name` of a project.
    pub fn inside(root: &Path, name: &str) -> Place {
        Place {
            trusted: root.to_path_buf(),
            below: PathBuf::from(name),
        }
    }

    /// Its path.
    pub fn path(&self) -> PathBuf {
        self.trusted.join(&self.below)
    }

    /// Opens it.
    ///
    /// # Errors
    /// When it is missing, or no folder, or behind a link.
    pub fn open(&self) -> io::Result<Folder> {
        Folder::open(&self.trusted)?.descend(&self.below, false)
    }

    /// As [`Place::open`]; makes it where it is missing.
    ///
    /// # Errors
    /// When it cannot be made, is no folder, or is behind a link.
    pub fn make(&self) -> io::Result<Folder> {
        Folder::create(&self.trusted)?.descend(&self.below, true)
    }
}

/// `path` with every `..` taken together with the name before it.
pub fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        if component == Component::ParentDir {
            plain.pop();
        } else {
            plain.push(component);
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_in_the_project_is_reached_from_its_root() {
        let scratch = tempfile::tempdir().expect("a folder can be made");
        let root = fs::canonicalize(scratch.path()).expect("it is there");
        fs::create_dir_all(root.join("a")).expect("it is empty");
        for path in ["out", "a/../out", "./out"] {
            let place = Place::of(&root, &root.join(path)).expect("there is a current folder");
            assert_eq!(
                (place.trusted.as_path(), place.below.as_path()),
                (&*root, Path::new("out"))
            );
        }
        let outside =
            Place::of(&root.join("a"), &root.join("b")).expect("there is a current folder");
        assert_eq!(outside.trusted, root.join("b"));
    }

    #[test]
    #[cfg(unix)]
    fn a_link_back_to_the_root_is_a_link() {
        let scratch = tempfile::tempdir().expect("a folder can be made");
        let root = fs::canonicalize(scratch.path()).expect("it is there");
        std::os::unix::fs::symlink(".", root.join("out")).expect("the name is free");
        let place = Place::of(&root, &root.join("out")).expect("there is a current folder");
        assert!(place.open().is_err() && place.make().is_err());
    }
}
