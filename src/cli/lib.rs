//! The command line: one file per command. The only printing, and the only reading and writing of
//! the project's files.

// The command line reads the disk.
#![allow(clippy::disallowed_methods)]

mod arguments;
mod artifacts;
mod build;
mod cache;
mod cache_folder;
mod check;
mod clock;
mod completions;
mod diff;
mod disk;
mod disk_parts;
mod exhibit;
mod explain;
mod follow;
mod github;
mod graph;
mod init;
mod inspect;
mod lock;
mod origin;
mod outcome;
mod output;
mod own_file;
mod page;
mod page_diff;
mod params;
mod place;
mod placed;
mod progress;
mod record;
mod report;
mod sarif;
mod schema;
mod serve;
mod session;
mod stale;
mod terminal;
mod timings;
mod watch;
mod windows;

use std::process::ExitCode;
#[cfg(unix)]
use std::sync::Arc;

use clap::Parser as _;
use fretwork_engine::Versions;

use arguments::{Arguments, Command};
use terminal::Failure;

/// Runs the command that the process was called with. `versions` are those of the rooms, under which
/// results are remembered. Exit code 0: done; 1: the spec or the build
/// is wrong; 2: the command line is; 3: artifacts differ, where that was asked.
pub fn run(versions: Versions) -> ExitCode {
    let arguments = Arguments::parse();
    outlive_full_files();
    let result = match &arguments.command {
        Command::Build(a) => build::run(a, versions),
        Command::Check(a) => check::run(a),
        Command::Watch(a) if a.serve => serve::run(a, versions),
        Command::Watch(a) => watch::run(&a.build, versions),
        Command::Report(a) => report::run(a, versions),
        Command::Diff(a) => diff::run(a, versions),
        Command::Origin(a) => origin::run(a, versions),
        Command::Graph(a) => graph::run(a),
        Command::Explain(a) => explain::run(a, versions),
        Command::Inspect(a) => inspect::run(a, versions),
        Command::Params(a) => params::run(a),
        Command::Schema(a) => schema::run(a),
        Command::Init(a) => init::run(a),
        Command::Cache(a) => cache::run(a),
        Command::Completions(a) => completions::run(a),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Build) => ExitCode::from(1),
        Err(Failure::Differs) => ExitCode::from(3),
        Err(Failure::Usage(message)) => {
            terminal::note(&format!("fretwork: {message}"));
            ExitCode::from(2)
        }
    }
}

/// A file that becomes longer than the system allows is an error of writing it, not the end of the process.
#[cfg(unix)]
fn outlive_full_files() {
    // Without it, such a file ends the process, as it does for most programs.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

#[cfg(not(unix))]
fn outlive_full_files() {}
