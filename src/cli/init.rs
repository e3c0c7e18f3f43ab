//! `fretwork init`: a small project that builds.

use std::fs;
use std::io;
use std::path::Path;

use super::arguments::Init;
use super::disk::write_atomically;
use super::terminal::{self, Failure};

/// The files of a new project.
const FILES: [(&str, &str); 3] = [
    (
        "fretwork.toml",
        "# This folder is the root of a fretwork project.\n",
    ),
    (".gitignore", "/out\n/.fretwork\n"),
    ("specs/coaster.yaml", include_str!("init/coaster.yaml")),
];

/// Makes the project.
pub fn run(arguments: &Init) -> Result<(), Failure> {
    let folder = &arguments.folder;
    if is_occupied(folder)
        .map_err(|e| Failure::usage(format!("cannot read `{}`: {e}", folder.display())))?
    {
        return Err(Failure::usage(format!(
            "`{}` is not empty",
            folder.display()
        )));
    }
    for (name, text) in FILES {
        let path = folder.join(name);
        write_atomically(&path, text.as_bytes())
            .map_err(|e| Failure::usage(format!("cannot write `{}`: {e}", path.display())))?;
    }
    terminal::print(&format!(
        "a project is in {0}; build it with\n  cd {0} && fretwork build\n",
        folder.display()
    ))
}

fn is_occupied(folder: &Path) -> io::Result<bool> {
    match fs::read_dir(folder) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(false),
        entries => Ok(entries?.next().is_some()),
    }
}
