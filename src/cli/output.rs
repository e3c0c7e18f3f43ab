//! The output folder and what is in it now.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::place::Place;
use super::record::split;
use super::session::Session;
use fretwork_store::{Digest, Folder, Kind};

/// The folder that artifacts are written to.
pub struct Output {
    /// Where it is.
    pub place: Place,
    /// Opened once it was needed and is there.
    root: Option<Folder>,
    /// The folder below it that was opened last: artifacts come folder by folder, and not all folders
    /// may be open at once.
    last: Option<(String, Arc<Folder>)>,
}

/// A file as it is found in the output folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileFound {
    /// The digest of its bytes.
    pub digest: Digest,
    /// Its size.
    pub bytes: u64,
}

impl Output {
    /// The output folder at `place`.
    pub fn new(place: Place) -> Output {
        Output {
            place,
            root: None,
            last: None,
        }
    }

    /// The path of an artifact, for messages.
    pub fn path(&self, artifact: &str) -> PathBuf {
        self.place.path().join(artifact)
    }

    /// The folder itself.
    ///
    /// # Errors
    /// When it is missing and not to be made, or cannot be opened.
    pub fn root(&mut self, make: bool) -> io::Result<&Folder> {
        let root = match self.root.take() {
            Some(root) => root,
            None if make => self.place.make()?,
            None => self.place.open()?,
        };
        Ok(self.root.insert(root))
    }

    /// The folder at `below`.
    ///
    /// # Errors
    /// As [`Output::root`], and when a link is on the way.
    pub fn folder(&mut self, below: &str, make: bool) -> io::Result<Arc<Folder>> {
        if let Some((known, folder)) = &self.last
            && known == below
        {
            return Ok(folder.clone());
        }
        let folder = Arc::new(self.root(make)?.descend(Path::new(below), make)?);
        self.last = Some((below.to_string(), folder.clone()));
        Ok(folder)
    }

    /// The file at `path`; none where there is none.
    ///
    /// # Errors
    /// When something else stands there or on the way, or the file cannot be read.
    pub fn find(&mut self, path: &str) -> io::Result<Option<FileFound>> {
        let (below, name) = split(path);
        match self
            .folder(below, false)
            .and_then(|folder| folder.read(name))
        {
            Ok(bytes) => Ok(Some(FileFound {
                digest: Digest::of(&bytes),
                bytes: bytes.len() as u64,
            })),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Removes a file and the folders that this leaves empty.
    ///
    /// # Errors
    /// When the file cannot be removed.
    pub fn remove(&mut self, path: &str) -> io::Result<()> {
        let (mut below, name) = split(path);
        self.folder(below, false)?.remove_file(name)?;
        self.last = None;
        while !below.is_empty() {
            let (above, name) = split(below);
            let is_gone = self
                .folder(above, false)?
                .remove_empty(name)
                .unwrap_or(false);
            if !is_gone {
                break;
            }
            self.last = None;
            below = above;
        }
        Ok(())
    }

    /// The files below the folder `below` whose names satisfy `is_meant`, as paths from the output
    /// folder. No link is followed.
    ///
    /// # Errors
    /// When a folder cannot be read.
    pub fn list(
        &mut self,
        below: &str,
        is_meant: &dyn Fn(&str) -> bool,
    ) -> io::Result<Vec<String>> {
        let (mut found, mut open) = (Vec::new(), vec![below.to_string()]);
        while let Some(below) = open.pop() {
            let folder = match self.folder(&below, false) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                folder => folder?,
            };
            for name in folder.names()? {
                let path = format!("{below}/{name}");
                match folder.entry(&name)?.map(|entry| entry.kind) {
                    Some(Kind::Folder) => open.push(path),
                    Some(Kind::File) if is_meant(&name) => found.push(path),
                    _ => {}
                }
            }
        }
        found.sort();
        Ok(found)
    }
}

/// The files that a session has read or looked for: nothing writes or removes them.
pub struct Inputs(BTreeSet<PathBuf>);

impl Inputs {
    /// Those of `session`.
    pub fn of(session: &Session) -> Inputs {
        let files = session.compiler.known_files();
        let paths = files.iter().filter_map(|file| {
            let path = session.world.root().join(&**file);
            fs::canonicalize(path).ok()
        });
        Inputs(paths.collect())
    }

    /// Whether the file at `path` is one of them.
    pub fn has(&self, path: &Path) -> bool {
        fs::canonicalize(path).is_ok_and(|path| self.0.contains(&path))
    }
}
