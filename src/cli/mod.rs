//! The command line: one file per command. The only printing, and the only reading and writing of
//! the project's files.

mod arguments;
mod artifacts;
mod build;
mod cache;
mod check;
mod completions;
mod disk;
mod explain;
mod graph;
mod init;
mod inspect;
mod params;
mod progress;
mod schema;
mod session;
mod terminal;
mod timings;
mod watch;

use std::process::ExitCode;

use clap::Parser as _;

use arguments::{Arguments, Command};
use terminal::Failure;

/// Runs the command that the process was called with. Exit code 0: done; 1: the spec or the build
/// is wrong; 2: the command line is.
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.command {
        Command::Build(a) => build::run(a),
        Command::Check(a) => check::run(a),
        Command::Watch(a) => watch::run(a),
        Command::Graph(a) => graph::run(a),
        Command::Explain(a) => explain::run(a),
        Command::Inspect(a) => inspect::run(a),
        Command::Params(a) => params::run(a),
        Command::Schema(a) => schema::run(a),
        Command::Init(a) => init::run(a),
        Command::Cache(a) => cache::run(a),
        Command::Completions(a) => completions::run(a),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Build) => ExitCode::from(1),
        Err(Failure::Usage(message)) => {
            terminal::note(&format!("fretwork: {message}"));
            ExitCode::from(2)
        }
    }
}
