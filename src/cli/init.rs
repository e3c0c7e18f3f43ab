//! `fretwork init`: a small project that builds.

use std::fs;
use std::io;
use std::path::Path;

use super::arguments::{Ci, Init, Template};
use super::terminal::{self, Failure};
use fretwork_store::{Folder, Lasting};

/// The files of every new project.
const FILES: [(&str, &str); 2] = [
    (
        "fretwork.toml",
        "# This folder is the root of a fretwork project.\n",
    ),
    (".gitignore", "/out\n/.fretwork\n"),
];

/// What a new project begins with.
fn specs(template: Option<Template>) -> &'static [(&'static str, &'static str)] {
    match template {
        None => &[("specs/coaster.yaml", include_str!("init/coaster.yaml"))],
        Some(Template::Print) => &[("specs/lantern.yaml", include_str!("init/print.yaml"))],
        Some(Template::Laser) => &[("specs/sign.yaml", include_str!("init/laser.yaml"))],
        Some(Template::Texture) => &[
            ("specs/tile.yaml", include_str!("init/texture.yaml")),
            ("specs/tiles.star", include_str!("init/tiles.star")),
        ],
        Some(Template::Facade) => &[("specs/house.yaml", include_str!("init/facade.yaml"))],
        Some(Template::Band) => &[
            ("specs/cuff.yaml", include_str!("init/band.yaml")),
            ("specs/ornament.svg", include_str!("init/ornament.svg")),
        ],
    }
}

/// The workflow that builds a project on GitHub.
const WORKFLOW: (&str, &str) = (
    ".github/workflows/fretwork.yml",
    include_str!("init/github.yml"),
);

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
    let workflow = arguments.ci.map(|Ci::Github| WORKFLOW);
    let specs = specs(arguments.template).iter().copied();
    for (name, text) in FILES.into_iter().chain(specs).chain(workflow) {
        let path = folder.join(name);
        write(folder, Path::new(name), text)
            .map_err(|e| Failure::usage(format!("cannot write `{}`: {e}", path.display())))?;
    }
    terminal::print(&format!(
        "a project is in {0}; build it with
  cd {0} && fretwork build
then commit the digests of what it gives, which CI compares
  fretwork build --lock && git add fretwork.lock
  fretwork build --locked\n",
        folder.display()
    ))
}

fn write(folder: &Path, file: &Path, text: &str) -> io::Result<()> {
    let below = file.parent().unwrap_or(Path::new(""));
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let folder = Folder::create(folder)?.descend(below, true)?;
    folder.write(&name, &[text.as_bytes()], Lasting::UntilPowerFails)
}

fn is_occupied(folder: &Path) -> io::Result<bool> {
    match fs::read_dir(folder) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(false),
        entries => Ok(entries?.next().is_some()),
    }
}
