//! A folder held open, below which nothing passes a symbolic link.
//!
//! A path such as `out/a/b.svg` is no proof of where a file lies: each folder in it may be a link that somebody has committed.
//! A [`Folder`] is a handle. What is opened, written or removed through it is named by one plain
//! name, and is refused when that name is a link. Nothing here knows what the files mean.

mod entry;
mod portable;
#[cfg(unix)]
mod unix;

use std::fmt;
use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

pub use entry::{Entry, Kind};
#[cfg(not(unix))]
use portable::Handle;
#[cfg(unix)]
use unix::Handle;

/// Files that are being written have this before a number; no artifact and no entry of a cache does.
const TEMPORARY: &str = ".fretwork-tmp-";

/// Temporary files older than this belong to a process that was killed.
const ABANDONED: Duration = Duration::from_secs(60 * 60);

/// A folder of more levels than this is not removed.
const DEEPEST: usize = 64;

/// A folder held open.
#[derive(Debug)]
pub struct Folder {
    handle: Handle,
    path: PathBuf,
}

impl Folder {
    /// The folder at `path`. Links in `path` itself are followed: the caller has chosen it.
    ///
    /// # Errors
    /// When it is not there or is no folder.
    pub fn open(path: &Path) -> io::Result<Folder> {
        Ok(Folder {
            handle: Handle::open(path)?,
            path: path.to_path_buf(),
        })
    }

    /// As [`Folder::open`]; makes the folder and those above it where they are missing.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn create(path: &Path) -> io::Result<Folder> {
        std::fs::create_dir_all(path)?;
        Folder::open(path)
    }

    /// Where it is, for messages.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder `name` in this one.
    ///
    /// # Errors
    /// When it is missing, is a link, or is no folder.
    pub fn folder(&self, name: &str) -> io::Result<Folder> {
        self.plain(name)?;
        match self.handle.folder(name) {
            Ok(handle) => Ok(Folder {
                handle,
                path: self.path.join(name),
            }),
            Err(error) => Err(self.explained(name, error)),
        }
    }

    /// As [`Folder::folder`]; makes it where it is missing.
    ///
    /// # Errors
    /// When it cannot be made, is a link, or is no folder.
    pub fn make_folder(&self, name: &str) -> io::Result<Folder> {
        match self.folder(name) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                match self.handle.make_folder(name) {
                    // Another process may have been quicker.
                    Err(error) if error.kind() != io::ErrorKind::AlreadyExists => Err(error),
                    _ => self.folder(name),
                }
            }
            result => result,
        }
    }

    /// The folder that the plain names of `path` lead to, one after the other; with `make`, those that
    /// are missing are made.
    ///
    /// # Errors
    /// As [`Folder::folder`] and [`Folder::make_folder`].
    pub fn descend(&self, path: &Path, make: bool) -> io::Result<Folder> {
        let mut folder = Folder {
            handle: self.handle.copy()?,
            path: self.path.clone(),
        };
        for component in path.components() {
            let Component::Normal(name) = component else {
                return Err(not_plain(&path.to_string_lossy()));
            };
            let name = name
                .to_str()
                .ok_or_else(|| not_plain(&path.to_string_lossy()))?;
            folder = if make {
                folder.make_folder(name)?
            } else {
                folder.folder(name)?
            };
        }
        Ok(folder)
    }

    /// What `name` is; none when there is nothing of that name.
    ///
    /// # Errors
    /// When the folder cannot be searched.
    pub fn entry(&self, name: &str) -> io::Result<Option<Entry>> {
        self.plain(name)?;
        match self.handle.entry(name) {
            Err(error) if is_absent(&error) => Ok(None),
            result => result.map(Some),
        }
    }

    /// The names in it that are valid UTF-8, in order.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn names(&self) -> io::Result<Vec<String>> {
        let mut names = self.handle.names()?;
        names.sort();
        Ok(names)
    }

    /// The bytes of the regular file `name`.
    ///
    /// # Errors
    /// When it is missing, cannot be read, or is anything else than a regular file.
    pub fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        self.plain(name)?;
        let mut file = (self.handle.open_file(name)).map_err(|e| self.explained(name, e))?;
        let meta = file.metadata()?;
        if !meta.is_file() {
            return Err(self.no_file(name));
        }
        let mut bytes = Vec::with_capacity(usize::try_from(meta.len()).unwrap_or(0));
        file.read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Puts bytes at `name` in one step: whoever looks sees the old file or the new one, whole.
    ///
    /// # Errors
    /// When it cannot be written, or when `name` is there and is no regular file. The old file is as it was.
    pub fn write(&self, name: &str, parts: &[&[u8]], lasting: Lasting) -> io::Result<()> {
        let temporary = self.stage(parts, lasting)?;
        self.commit(&temporary, name)
    }

    /// Writes bytes into a new file of another name, which [`Folder::commit`] or
    /// [`Folder::remove_file`] ends. Gives that name. Permissions are those of the umask.
    ///
    /// # Errors
    /// When it cannot be written; then no file stays.
    pub fn stage(&self, parts: &[&[u8]], lasting: Lasting) -> io::Result<String> {
        let (name, mut file) = self.new_file()?;
        let mut write = || {
            parts.iter().try_for_each(|part| file.write_all(part))?;
            match lasting {
                Lasting::OnDisk => file.sync_data(),
                Lasting::UntilPowerFails => Ok(()),
            }
        };
        write().inspect_err(|_| {
            // The first error says more than that of the removal would.
            let _ = self.handle.remove_file(&name);
        })?;
        Ok(name)
    }

    /// Gives a staged file its name. When that fails, the staged file is removed.
    ///
    /// # Errors
    /// When `name` is there and is no regular file, or cannot be replaced.
    pub fn commit(&self, temporary: &str, name: &str) -> io::Result<()> {
        let result = self.entry(name).and_then(|entry| match entry {
            Some(entry) if entry.kind != Kind::File => Err(self.no_file(name)),
            _ => self.handle.rename(temporary, name),
        });
        result.inspect_err(|_| {
            let _ = self.handle.remove_file(temporary);
        })
    }

    fn new_file(&self) -> io::Result<(String, File)> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        loop {
            let now = SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .unwrap_or_default();
            let (process, count) = (std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
            let name = format!(
                "{TEMPORARY}{process:08x}{:08x}{count:08x}",
                now.subsec_nanos()
            );
            match self.handle.new_file(&name) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                result => return Ok((name, result?)),
            }
        }
    }

    /// Removes the file or link `name` itself, never what a link leads to.
    ///
    /// # Errors
    /// When it cannot be removed; that it is gone already is no error.
    pub fn remove_file(&self, name: &str) -> io::Result<()> {
        self.plain(name)?;
        gone(self.handle.remove_file(name))
    }

    /// Removes the folder `name` if it is empty; whether it was.
    ///
    /// # Errors
    /// When `name` is a link or no folder.
    pub fn remove_empty(&self, name: &str) -> io::Result<bool> {
        let folder = self.folder(name)?;
        Ok(folder.names()?.is_empty() && gone(self.handle.remove_folder(name)).is_ok())
    }

    /// Removes `name` with all that is in it, following no link.
    ///
    /// # Errors
    /// When something cannot be removed, or lies more than 64 folders deep.
    pub fn remove_all(&self, name: &str) -> io::Result<()> {
        self.remove_levels(name, DEEPEST)
    }

    fn remove_levels(&self, name: &str, levels: usize) -> io::Result<()> {
        match self.entry(name)?.map(|entry| entry.kind) {
            None => Ok(()),
            Some(Kind::Folder) => {
                let below = levels
                    .checked_sub(1)
                    .ok_or_else(|| io::Error::other("too many folders lie in one another"))?;
                let folder = self.folder(name)?;
                for inner in folder.names()? {
                    folder.remove_levels(&inner, below)?;
                }
                gone(self.handle.remove_folder(name))
            }
            Some(_) => self.remove_file(name),
        }
    }

    /// Removes files that a killed process left half written, and gives the sum of their sizes.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn remove_abandoned(&self) -> io::Result<u64> {
        let mut freed = 0;
        for name in self.names()?.iter().filter(|name| is_temporary(name)) {
            let Some(entry) = self.entry(name)? else {
                continue;
            };
            let age = entry.modified.elapsed().unwrap_or_default();
            if entry.kind == Kind::File && age > ABANDONED && self.remove_file(name).is_ok() {
                freed += entry.bytes;
            }
        }
        Ok(freed)
    }

    /// Notes that `name` was used now.
    ///
    /// # Errors
    /// When its time cannot be set.
    pub fn touch(&self, name: &str) -> io::Result<()> {
        self.plain(name)?;
        self.handle.touch(name)
    }

    /// Waits until no other process holds this folder, and holds it until the guard is dropped. Where
    /// the system has no such locks, nothing is waited for.
    pub fn hold(&self) -> Held {
        Held {
            _handle: self.handle.hold().ok(),
        }
    }

    /// Refuses all that is more than one name.
    fn plain(&self, name: &str) -> io::Result<()> {
        let mut components = Path::new(name).components();
        let is_plain = matches!(components.next(), Some(Component::Normal(first)) if first == name)
            && components.next().is_none();
        if is_plain {
            Ok(())
        } else {
            Err(not_plain(name))
        }
    }

    /// The error for a `name` that is something else than was asked for, told as such.
    fn explained(&self, name: &str, error: io::Error) -> io::Error {
        let is_link = (self.handle.entry(name)).is_ok_and(|entry| entry.kind == Kind::Link);
        if is_link { self.no_file(name) } else { error }
    }

    fn no_file(&self, name: &str) -> io::Error {
        let kind = self
            .handle
            .entry(name)
            .map_or(Kind::Other, |entry| entry.kind);
        io::Error::other(Unexpected {
            path: self.path.join(name),
            kind,
        })
    }
}

/// Something else stands where a file or a folder is wanted. [`io::Error`]s hold it as their source.
#[derive(Debug)]
pub struct Unexpected {
    /// Where.
    pub path: PathBuf,
    /// What it is.
    pub kind: Kind,
}

impl Unexpected {
    /// What `error` says about it, if that is what went wrong.
    pub fn of(error: &io::Error) -> Option<&Unexpected> {
        error.get_ref()?.downcast_ref()
    }
}

impl fmt::Display for Unexpected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is {}", self.path.display(), self.kind.describe())
    }
}

impl std::error::Error for Unexpected {}

/// Whether bytes are on the disk when they have been written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lasting {
    /// They are, whatever happens to the machine.
    OnDisk,
    /// The system writes them when it likes: it is enough that no process sees half of them.
    UntilPowerFails,
}

/// Holds a folder against other processes while it lives.
#[derive(Debug)]
pub struct Held {
    _handle: Option<Handle>,
}

fn is_temporary(name: &str) -> bool {
    let number = name.strip_prefix(TEMPORARY).unwrap_or_default();
    number.len() == 24 && number.bytes().all(|b| b.is_ascii_hexdigit())
}

fn is_absent(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
    )
}

/// That somebody else has just removed it is as good.
fn gone(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        result => result,
    }
}

fn not_plain(name: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::InvalidInput,
        format!("`{name}` is no plain name"),
    )
}

#[cfg(all(test, unix))]
mod tests;
