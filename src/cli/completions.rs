//! `fretwork completions`: scripts for shells.

use clap::CommandFactory as _;

use super::arguments::{Arguments, Completions};
use super::terminal::{self, Failure};

/// Prints the completion script of a shell.
pub fn run(arguments: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(
        arguments.shell,
        &mut Arguments::command(),
        "fretwork",
        &mut script,
    );
    terminal::print(&String::from_utf8_lossy(&script))
}
