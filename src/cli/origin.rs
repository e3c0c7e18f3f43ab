//! `fretwork origin`: what files say of where they come from, and whether the specs of today still give them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::arguments::{Evaluation, Format, Origin as Arguments};
use super::progress::Bar;
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use super::windows;
use fretwork_diagnostic::Diagnostic;
use fretwork_engine::{
    Cutting, Origin, Report, Request, Versions, World as _, output_folder, read_origin, threads,
};
use fretwork_store::Digest;

/// What a file is to the specs of today.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum State {
    /// They give these bytes.
    Current,
    /// It is made of what they say, and has other bytes.
    Edited,
    /// They make it of something else.
    Outdated,
    /// It names no origin, or none that is here and can be built.
    Unknown,
}

/// A file and its origin.
#[derive(Serialize)]
struct Found {
    file: String,
    state: State,
    origin: Option<Named>,
}

/// The names of an origin.
#[derive(Serialize)]
struct Named {
    spec: String,
    artifact: String,
    recipe: String,
}

/// Prints the origins of the files.
///
/// # Errors
/// When a file cannot be read, or one is not current.
pub fn run(arguments: &Arguments, versions: Versions) -> Result<(), Failure> {
    let mut projects = Projects {
        evaluation: &arguments.evaluation,
        versions,
        sessions: BTreeMap::new(),
    };
    let mut all = Vec::new();
    for file in &arguments.files {
        let bytes = fs::read(file)
            .map_err(|e| Failure::usage(format!("cannot read `{}`: {e}", file.display())))?;
        let origin = read_origin(&bytes);
        let state = match &origin {
            Some(origin) => projects.state(file, origin, &bytes)?,
            None => State::Unknown,
        };
        all.push(Found {
            file: file.display().to_string(),
            state,
            origin: origin.map(|origin| Named {
                spec: origin.spec,
                artifact: origin.artifact,
                recipe: origin.recipe,
            }),
        });
    }
    match arguments.format {
        Format::Json => terminal::print_json(&all)?,
        Format::Human => terminal::print(&all.iter().map(line).collect::<String>())?,
    }
    if all.iter().all(|found| found.state == State::Current) {
        Ok(())
    } else {
        Err(Failure::Build)
    }
}

fn line(found: &Found) -> String {
    let state = match found.state {
        State::Current => "current",
        State::Edited => "edited",
        State::Outdated => "outdated",
        State::Unknown => "unknown",
    };
    let file = fretwork_diagnostic::shown(&found.file);
    let Some(origin) = &found.origin else {
        return format!("{file}: {state}\n");
    };
    let names = format!("{} {} {}", origin.spec, origin.artifact, origin.recipe);
    format!("{file}: {state}, {}\n", fretwork_diagnostic::shown(&names))
}

/// The projects that files may come from, opened when they are needed.
struct Projects<'a> {
    evaluation: &'a Evaluation,
    versions: Versions,
    sessions: BTreeMap<PathBuf, Session>,
}

impl Projects<'_> {
    /// What `file` is: to the project of the current folder or, where that does not know it, to the one that it lies in.
    fn state(&mut self, file: &Path, origin: &Origin, bytes: &[u8]) -> Result<State, Failure> {
        let evaluation = self.evaluation;
        for place in [Path::new("."), file] {
            let session = self.session(place)?;
            if let Some(spec) = spec_of(session, origin) {
                return Ok(compared(
                    session,
                    evaluation,
                    (file, &spec),
                    (origin, bytes),
                ));
            }
        }
        Ok(State::Unknown)
    }

    fn session(&mut self, place: &Path) -> Result<&Session, Failure> {
        let world = Session::world_of(&[place.to_path_buf()])?;
        let root = world.root().to_path_buf();
        if !self.sessions.contains_key(&root) {
            let cache = match self.evaluation.no_cache {
                true => CacheAt::Nowhere,
                false => CacheAt::Folder(self.evaluation.cache_dir.as_deref(), self.versions),
            };
            let mut session = Session::of_world(world, Vec::new(), cache)?;
            session.compiler = session.compiler.without_record();
            let session = session
                .with_engine(self.evaluation.engine.into())
                .with_budget(self.evaluation.budget);
            self.sessions.insert(root.clone(), session);
        }
        Ok(&self.sessions[&root])
    }
}

/// The spec of a project that an origin names.
fn spec_of(session: &Session, origin: &Origin) -> Option<String> {
    let folder = &origin.spec;
    let named = ["specs/", ""]
        .into_iter()
        .flat_map(|place| ["yaml", "yml"].map(|extension| format!("{place}{folder}.{extension}")));
    let exact = named.filter(|spec| output_folder(spec) == *folder);
    let listed = session.world.specs().unwrap_or_default();
    let cut = listed
        .into_iter()
        .filter(|spec| origin.names(&output_folder(spec), &origin.artifact));
    exact
        .chain(cut)
        .find(|spec| session.world.read(spec).is_ok())
}

/// What `file` is to its `spec`.
fn compared(
    session: &Session,
    evaluation: &Evaluation,
    (file, spec): (&Path, &str),
    (origin, bytes): (&Origin, &[u8]),
) -> State {
    let folder = output_folder(spec);
    let settings = settings(&evaluation.sets);
    let below = |path: &String| {
        let name = path.strip_prefix(&folder)?.strip_prefix('/')?;
        origin.names(&folder, name).then(|| path.clone())
    };
    let paths = session.compiler.paths(spec, &settings);
    let Some(path) = paths.iter().find_map(below) else {
        return State::Unknown;
    };
    let bar = Bar::new();
    let report: Report = session.compiler.build(&Request {
        specs: vec![spec.to_string()],
        settings,
        windows: window(file, &path).into_iter().collect(),
        only: vec![path],
        threads: threads(evaluation.jobs.map(usize::from)),
        progress: &bar,
    });
    bar.finish();
    let Some(artifact) = report.artifacts.first() else {
        let errors = report.diagnostics.into_iter();
        session.print(&errors.filter(Diagnostic::is_error).collect::<Vec<_>>());
        return State::Unknown;
    };
    if session.compiler.recipe(artifact).as_deref() != Some(&*origin.recipe) {
        State::Outdated
    } else if artifact.digest == Digest::of(bytes) {
        State::Current
    } else {
        State::Edited
    }
}

/// The part of the plane that a file shows of the artifact at `path`, by its own path: `a/b/3/0/1.svg` is a tile of `a/b.svg`.
fn window(file: &Path, path: &str) -> Option<Cutting> {
    let name = path.rsplit_once('/').map_or(path, |(_, name)| name);
    let (stem, extension) = name.rsplit_once('.')?;
    let full = file.to_str()?.replace('\\', "/");
    let (_, part) = full.rsplit_once(&format!("/{stem}/"))?;
    let part = part.strip_suffix(extension)?.strip_suffix('.')?;
    let tile = windows::tiles(part).ok();
    tile.or_else(|| windows::window(&part.replace('_', ",")).ok())
}
