//! Folders as paths, for systems without `openat`: every name is looked at before it is used. Somebody who puts a link there in between
//! is not noticed, but a link that was committed is.

#![cfg_attr(unix, allow(dead_code))]

use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use super::entry::{Entry, Kind};

/// A folder by its path.
#[derive(Debug)]
pub struct Handle(PathBuf);

impl Handle {
    pub fn open(path: &Path) -> io::Result<Handle> {
        // Links in it are followed once, and not again.
        let path = fs::canonicalize(path)?;
        if !path.is_dir() {
            return Err(io::ErrorKind::NotADirectory.into());
        }
        Ok(Handle(path))
    }

    pub fn copy(&self) -> io::Result<Handle> {
        Ok(Handle(self.0.clone()))
    }

    pub fn folder(&self, name: &str) -> io::Result<Handle> {
        match self.entry(name)?.kind {
            Kind::Folder => Ok(Handle(self.0.join(name))),
            _ => Err(io::ErrorKind::NotADirectory.into()),
        }
    }

    pub fn make_folder(&self, name: &str) -> io::Result<()> {
        fs::create_dir(self.0.join(name))
    }

    pub fn open_file(&self, name: &str) -> io::Result<File> {
        match self.entry(name)?.kind {
            Kind::File => File::open(self.0.join(name)),
            _ => Err(io::ErrorKind::InvalidInput.into()),
        }
    }

    pub fn new_file(&self, name: &str) -> io::Result<File> {
        File::options()
            .write(true)
            .create_new(true)
            .open(self.0.join(name))
    }

    pub fn entry(&self, name: &str) -> io::Result<Entry> {
        let meta = fs::symlink_metadata(self.0.join(name))?;
        Ok(Entry {
            kind: kind(&meta),
            bytes: meta.len(),
            modified: meta.modified().unwrap_or(UNIX_EPOCH),
        })
    }

    pub fn names(&self) -> io::Result<Vec<String>> {
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.0)? {
            names.extend(entry?.file_name().into_string().ok());
        }
        Ok(names)
    }

    pub fn rename(&self, from: &str, to: &str) -> io::Result<()> {
        fs::rename(self.0.join(from), self.0.join(to))
    }

    pub fn remove_file(&self, name: &str) -> io::Result<()> {
        match self.entry(name)?.kind {
            Kind::Folder => Err(io::ErrorKind::IsADirectory.into()),
            _ => fs::remove_file(self.0.join(name)),
        }
    }

    pub fn remove_folder(&self, name: &str) -> io::Result<()> {
        fs::remove_dir(self.0.join(name))
    }

    pub fn touch(&self, name: &str) -> io::Result<()> {
        let file = match self.entry(name)?.kind {
            Kind::File => File::options().append(true).open(self.0.join(name))?,
            _ => return Err(io::ErrorKind::InvalidInput.into()),
        };
        file.set_modified(SystemTime::now())
    }

    pub fn hold(&self) -> io::Result<Handle> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

fn kind(meta: &Metadata) -> Kind {
    match meta.file_type() {
        t if t.is_symlink() => Kind::Link,
        t if t.is_dir() => Kind::Folder,
        t if t.is_file() => Kind::File,
        _ => Kind::Other,
    }
}
