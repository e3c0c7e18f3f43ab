//! `fretwork watch`: builds, and builds again when a file that was read changes. With `--serve` see `serve`.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use super::arguments::Build;
use super::build;
use super::follow::{Follower, has_other_specs};
use super::terminal::{self, Failure};
use fretwork_engine::Versions;

/// Editors write a file in several steps; a build waits until nothing has happened for this long.
const QUIET: Duration = Duration::from_millis(80);
/// So often it is looked whether the folders are still the same.
const LOOK: Duration = Duration::from_secs(1);

/// Builds until the process is ended.
pub fn run(arguments: &Build, versions: Versions) -> Result<(), Failure> {
    let mut session = build::open(arguments, versions)?;
    let (sender, events) = channel();
    let mut follower = Follower::new(move |_| {
        // The receiver lives as long as the process.
        let _ = sender.send(());
    })?;
    loop {
        let started = Instant::now();
        let outcome = build::build(&session, arguments)?;
        build::print(&session, arguments, &outcome, started)?;
        follower.follow(&session, arguments)?;
        terminal::note("watching for changes; Ctrl+C ends");
        while session.compiler.refresh().is_empty() && !has_other_specs(&mut session, arguments)? {
            while !wait(&events)? && !follower.follow(&session, arguments)? {}
        }
    }
}

/// Waits for an event and then for quiet, but not for long; whether there was one.
fn wait(events: &Receiver<()>) -> Result<bool, Failure> {
    let gone = || Failure::usage("the file watcher has stopped");
    match events.recv_timeout(LOOK) {
        Ok(()) => {}
        Err(RecvTimeoutError::Timeout) => return Ok(false),
        Err(RecvTimeoutError::Disconnected) => return Err(gone()),
    }
    loop {
        match events.recv_timeout(QUIET) {
            Ok(()) => {}
            Err(RecvTimeoutError::Timeout) => return Ok(true),
            Err(RecvTimeoutError::Disconnected) => return Err(gone()),
        }
    }
}
