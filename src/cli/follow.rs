//! Following the files of a project for ever: the folders in which they stand are watched, so that an editor may put new files
//! in the place of old ones, and a folder that has been replaced, or has gone and come back, is watched anew.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};

use super::arguments::Build;
use super::session::Session;
use super::terminal::Failure;

/// Watches folders.
pub struct Follower {
    watcher: RecommendedWatcher,
    watched: BTreeMap<PathBuf, Identity>,
}

/// What tells a folder from another one that took its place.
type Identity = (u64, u64);

impl Follower {
    /// A follower that tells `hear` which paths something has happened to.
    ///
    /// # Errors
    /// When the system gives no watcher.
    pub fn new(hear: impl Fn(&[PathBuf]) + Send + 'static) -> Result<Follower, Failure> {
        let watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            // Reading a file is an event too, and one that the build itself causes.
            if let Ok(event) = event
                && !event.kind.is_access()
            {
                hear(&event.paths);
            }
        });
        Ok(Follower {
            watcher: watcher.map_err(|e| failed(&e))?,
            watched: BTreeMap::new(),
        })
    }

    /// Watches the folders of all that a session has read or looked for. Whether there is one that was not watched before.
    ///
    /// # Errors
    /// When a folder that is there cannot be watched.
    pub fn follow(&mut self, session: &Session, arguments: &Build) -> Result<bool, Failure> {
        let mut is_new = false;
        // The folder of all specs comes first: what lies below it is then followed too.
        if arguments.specs.is_empty() {
            let specs = session.world.root().join("specs");
            is_new |= self.add(specs, RecursiveMode::Recursive)?;
        }
        for folder in folders(session) {
            is_new |= self.add(folder, RecursiveMode::NonRecursive)?;
        }
        Ok(is_new)
    }

    fn add(&mut self, folder: PathBuf, mode: RecursiveMode) -> Result<bool, Failure> {
        let now = identity(&folder);
        let before = self.watched.get(&folder).copied();
        if now == before {
            return Ok(false);
        }
        if before.is_some() {
            // The system has forgotten it already when the folder is gone.
            let _ = self.watcher.unwatch(&folder);
            self.watched.remove(&folder);
        }
        let Some(now) = now else {
            return Ok(true);
        };
        match self.watcher.watch(&folder, mode) {
            // It may have gone meanwhile, and will be looked for again.
            Err(_) if !folder.is_dir() => Ok(true),
            Err(error) => Err(failed(&error)),
            Ok(()) => {
                self.watched.insert(folder, now);
                Ok(true)
            }
        }
    }
}

fn failed(error: &notify::Error) -> Failure {
    Failure::usage(format!("cannot watch the project: {error}"))
}

/// The folders of all files that were read or looked for.
fn folders(session: &Session) -> BTreeSet<PathBuf> {
    let files = session.compiler.known_files();
    files
        .iter()
        .filter_map(|f| session.world.root().join(&**f).parent().map(PathBuf::from))
        .collect()
}

#[cfg(unix)]
fn identity(folder: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt as _;
    let meta = fs::metadata(folder).ok().filter(fs::Metadata::is_dir)?;
    Some((meta.dev(), meta.ino()))
}

#[cfg(not(unix))]
fn identity(folder: &Path) -> Option<Identity> {
    let meta = fs::metadata(folder).ok().filter(fs::Metadata::is_dir)?;
    let created = meta.created().ok()?;
    let since = created.duration_since(std::time::UNIX_EPOCH).ok()?;
    Some((since.as_secs(), u64::from(since.subsec_nanos())))
}

/// Looks for the specs again where all of the project are meant; whether they are others.
///
/// # Errors
/// When the folder of specs cannot be read.
pub fn has_other_specs(session: &mut Session, arguments: &Build) -> Result<bool, Failure> {
    if !arguments.specs.is_empty() {
        return Ok(false);
    }
    let specs = session
        .world
        .specs()
        .map_err(|e| Failure::usage(format!("cannot list the specs: {e}")))?;
    let is_other = specs != session.specs;
    session.specs = specs;
    Ok(is_other)
}
