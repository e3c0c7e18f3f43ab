//! `fretwork watch`: builds, and builds again when a file that was read changes.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use notify::{RecursiveMode, Watcher as _};

use super::arguments::Build;
use super::build;
use super::session::Session;
use super::terminal::{self, Failure};
use fretwork_engine::Versions;

/// Editors write a file in several steps; a build waits until nothing has happened for this long.
const QUIET: Duration = Duration::from_millis(80);

/// Builds until the process is ended.
pub fn run(arguments: &Build, versions: Versions) -> Result<(), Failure> {
    let mut session = build::open(arguments, versions)?;
    let (sender, events) = channel();
    let failed = |e: notify::Error| Failure::usage(format!("cannot watch the project: {e}"));
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
        // Reading a file is an event too, and one that the build itself causes.
        if event.is_ok_and(|e| !e.kind.is_access()) {
            // The receiver lives as long as the process.
            let _ = sender.send(());
        }
    })
    .map_err(failed)?;
    let mut watched = BTreeSet::new();
    loop {
        let started = Instant::now();
        let outcome = build::build(&session, arguments)?;
        build::print(&session, arguments, &outcome, started)?;
        let mut follow = |folder: PathBuf, mode| {
            if !watched.contains(&folder) && folder.is_dir() {
                watcher.watch(&folder, mode).map_err(failed)?;
                watched.insert(folder);
            }
            Ok(())
        };
        // The folder of all specs comes first: what lies below it is then followed too.
        if arguments.specs.is_empty() {
            follow(session.world.root().join("specs"), RecursiveMode::Recursive)?;
        }
        folders(&session)
            .into_iter()
            .try_for_each(|folder| follow(folder, RecursiveMode::NonRecursive))?;
        terminal::note("watching for changes; Ctrl+C ends");
        while session.compiler.refresh().is_empty() && !has_other_specs(&mut session, arguments)? {
            wait(&events)?;
        }
    }
}

/// Looks for the specs again where all of the project are meant; whether they are others.
fn has_other_specs(session: &mut Session, arguments: &Build) -> Result<bool, Failure> {
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

/// The folders of all files that were read or looked for.
fn folders(session: &Session) -> BTreeSet<PathBuf> {
    let files = session.compiler.known_files();
    files
        .iter()
        .filter_map(|f| session.world.root().join(&**f).parent().map(PathBuf::from))
        .collect()
}

/// Waits for an event and then for quiet.
fn wait(events: &Receiver<()>) -> Result<(), Failure> {
    let gone = || Failure::usage("the file watcher has stopped");
    events.recv().map_err(|_| gone())?;
    loop {
        match events.recv_timeout(QUIET) {
            Ok(()) => {}
            Err(RecvTimeoutError::Timeout) => return Ok(()),
            Err(RecvTimeoutError::Disconnected) => return Err(gone()),
        }
    }
}
