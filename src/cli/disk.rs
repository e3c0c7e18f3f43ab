//! The project on disk: its root, its specs, its files. Nothing here writes.

use std::fs;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use super::disk_parts::DiskParts;
use fretwork_engine::{FILE_LIMIT, HELD_LIMIT, Opened, ReadError, World, is_read_by_parts};

/// A project on disk.
#[derive(Clone, Debug)]
pub struct DiskWorld {
    root: PathBuf,
}

impl DiskWorld {
    /// The project that holds `start` (a file or folder): the nearest ancestor with `.git` or
    /// `fretwork.toml`, or else the folder itself.
    ///
    /// # Errors
    /// When `start` does not exist.
    pub fn find(start: &Path) -> io::Result<DiskWorld> {
        let start = fs::canonicalize(start)?;
        let folder = if start.is_dir() {
            start.as_path()
        } else {
            start.parent().unwrap_or(&start)
        };
        let marked = |folder: &&Path| {
            [".git", "fretwork.toml"]
                .iter()
                .any(|m| folder.join(m).exists())
        };
        let root = folder.ancestors().find(marked).unwrap_or(folder);
        Ok(DiskWorld {
            root: root.to_path_buf(),
        })
    }

    /// The project's root, an absolute path without symbolic links.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The path of an existing file as the project names it.
    ///
    /// # Errors
    /// When it does not exist, is a folder, or lies outside the root.
    pub fn relative(&self, path: &Path) -> io::Result<String> {
        // The folder is made canonical but not the file, so that a spec that is a link keeps its name.
        let absolute = std::path::absolute(path)?;
        if fs::metadata(&absolute)?.is_dir() {
            return Err(io::Error::other("it is a folder"));
        }
        let folder = fs::canonicalize(absolute.parent().unwrap_or(&absolute))?;
        let full = folder.join(absolute.file_name().unwrap_or_default());
        let inside = full
            .strip_prefix(&self.root)
            .map_err(|_| self.lies_outside())?;
        to_text(inside).ok_or_else(|| io::Error::other("its name is not valid UTF-8"))
    }

    /// The specs that `path` names: the file, or every spec below the folder.
    ///
    /// # Errors
    /// When it does not exist, lies outside the root, or is a folder without specs.
    pub fn specs_at(&self, path: &Path) -> io::Result<Vec<String>> {
        if !fs::metadata(path)?.is_dir() {
            return Ok(vec![self.relative(path)?]);
        }
        let folder = fs::canonicalize(path)?;
        if !folder.starts_with(&self.root) {
            return Err(self.lies_outside());
        }
        match self.specs_below(&folder)? {
            found if found.is_empty() => Err(io::Error::other("there is no spec below it")),
            found => Ok(found),
        }
    }

    fn lies_outside(&self) -> io::Error {
        io::Error::other(format!(
            "it lies outside the project root {}",
            self.root.display()
        ))
    }

    /// Every `specs/**/*.yaml`, in order.
    ///
    /// # Errors
    /// When a folder cannot be read.
    pub fn specs(&self) -> io::Result<Vec<String>> {
        self.specs_below(&self.root.join("specs"))
    }

    /// Every `**/*.yaml` below a folder, in order. What is hidden is left out: editors and systems keep
    /// locks (`.#a.yaml`) and data of their own (`._a.yaml`) beside files.
    ///
    /// # Errors
    /// When a folder cannot be read.
    fn specs_below(&self, folder: &Path) -> io::Result<Vec<String>> {
        let mut found = Vec::new();
        let mut folders = vec![folder.to_path_buf()];
        while let Some(folder) = folders.pop() {
            let entries = match fs::read_dir(&folder) {
                Err(e) if e.kind() == io::ErrorKind::NotFound => continue,
                entries => entries?,
            };
            for entry in entries {
                let entry = entry?;
                let path = entry.path();
                if entry.file_name().as_encoded_bytes().starts_with(b".") {
                    continue;
                }
                if entry.file_type()?.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|e| e == "yaml" || e == "yml") {
                    found.extend(path.strip_prefix(&self.root).ok().and_then(to_text));
                }
            }
        }
        found.sort();
        Ok(found)
    }
}

fn to_text(path: &Path) -> Option<String> {
    let parts: Option<Vec<&str>> = path
        .components()
        .map(|c| match c {
            Component::Normal(part) => part.to_str(),
            _ => None,
        })
        .collect();
    Some(parts?.join("/"))
}

impl DiskWorld {
    /// The file at a path as the project names it, and how many bytes it has.
    fn file(&self, path: &str) -> Result<(PathBuf, u64), ReadError> {
        let full = fs::canonicalize(self.root.join(path)).map_err(read_error)?;
        if !full.starts_with(&self.root) {
            return Err(ReadError::Outside);
        }
        // Before it is opened: opening a pipe waits for somebody to write into it.
        let meta = fs::metadata(&full).map_err(read_error)?;
        if !meta.is_file() {
            return Err(ReadError::NotAFile);
        }
        Ok((full, meta.len()))
    }
}

impl World for DiskWorld {
    fn open(&self, path: &str) -> Result<Opened, ReadError> {
        if is_read_by_parts(path) {
            let (full, size) = self.file(path)?;
            if size > HELD_LIMIT {
                let parts = DiskParts::open(&full).map_err(read_error)?;
                return Ok(Opened::Parts(Arc::new(parts)));
            }
        }
        self.read(path).map(Opened::Bytes)
    }

    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        let (full, size) = self.file(path)?;
        if size > FILE_LIMIT {
            return Err(ReadError::TooLarge);
        }
        let mut bytes = Vec::with_capacity(size as usize);
        fs::File::open(&full)
            .map_err(read_error)?
            .take(FILE_LIMIT + 1)
            .read_to_end(&mut bytes)
            .map_err(read_error)?;
        if bytes.len() as u64 > FILE_LIMIT {
            return Err(ReadError::TooLarge);
        }
        Ok(bytes)
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let Ok(full) = fs::canonicalize(self.root.join(folder)) else {
            return Vec::new();
        };
        let entries = fs::read_dir(&full)
            .ok()
            .filter(|_| full.starts_with(&self.root))
            .into_iter()
            .flatten();
        let mut names: Vec<String> = entries
            .filter_map(|e| e.ok()?.file_name().into_string().ok())
            .collect();
        names.sort();
        names
    }
}

fn read_error(error: io::Error) -> ReadError {
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => ReadError::Missing,
        io::ErrorKind::IsADirectory => ReadError::NotAFile,
        _ => ReadError::Io(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn project() -> (tempfile::TempDir, DiskWorld) {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("p/specs/deep")).unwrap();
        fs::write(folder.path().join("p/fretwork.toml"), "").unwrap();
        fs::write(folder.path().join("p/specs/deep/a.yaml"), "fretwork: 1").unwrap();
        fs::write(folder.path().join("secret"), "s").unwrap();
        let world = DiskWorld::find(&folder.path().join("p/specs/deep")).unwrap();
        (folder, world)
    }

    #[test]
    fn the_root_is_the_marked_ancestor() {
        let (folder, world) = project();
        assert_eq!(
            world.root(),
            fs::canonicalize(folder.path().join("p")).unwrap()
        );
        assert_eq!(world.specs().unwrap(), ["specs/deep/a.yaml"]);
        assert_eq!(
            world
                .relative(&folder.path().join("p/specs/../specs/deep/a.yaml"))
                .unwrap(),
            "specs/deep/a.yaml"
        );
        assert!(world.relative(&folder.path().join("secret")).is_err());
    }

    #[test]
    fn locks_and_backups_of_editors_are_no_specs() {
        let (folder, world) = project();
        let deep = folder.path().join("p/specs/deep");
        for name in [".#a.yaml", "._a.yaml", "a.yaml~", ".a.yaml.swp", "#a.yaml#"] {
            fs::write(deep.join(name), "").unwrap();
        }
        fs::create_dir(folder.path().join("p/specs/.cache")).unwrap();
        fs::write(folder.path().join("p/specs/.cache/b.yaml"), "").unwrap();
        assert_eq!(world.specs().unwrap(), ["specs/deep/a.yaml"]);
    }

    #[test]
    fn a_folder_stands_for_the_specs_below_it() {
        let (folder, world) = project();
        let specs = folder.path().join("p/specs");
        fs::create_dir(specs.join("empty")).unwrap();
        assert_eq!(world.specs_at(&specs).unwrap(), ["specs/deep/a.yaml"]);
        let file = specs.join("deep/a.yaml");
        assert_eq!(world.specs_at(&file).unwrap(), ["specs/deep/a.yaml"]);
        assert!(world.specs_at(&specs.join("empty")).is_err());
        assert!(world.specs_at(folder.path()).is_err());
    }

    #[test]
    #[cfg(unix)]
    fn a_link_out_of_the_root_is_not_followed() {
        let (folder, world) = project();
        std::os::unix::fs::symlink(folder.path().join("secret"), folder.path().join("p/link"))
            .unwrap();
        std::os::unix::fs::symlink(
            folder.path().join("p/specs/deep/a.yaml"),
            folder.path().join("p/inner"),
        )
        .unwrap();
        assert_eq!(world.read("link"), Err(ReadError::Outside));
        assert_eq!(world.read("inner").unwrap(), b"fretwork: 1");
        assert_eq!(world.read("none"), Err(ReadError::Missing));
        assert_eq!(world.names("specs/deep"), ["a.yaml"]);
        assert_eq!((world.names(".."), world.names("none")), (vec![], vec![]));
        assert_eq!(world.read("specs"), Err(ReadError::NotAFile));
    }
}
