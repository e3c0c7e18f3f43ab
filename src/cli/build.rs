//! `fretwork build`: artifacts of specs, written.

use std::collections::BTreeMap;
use std::time::Instant;

use serde::Serialize;

use super::arguments::{Build, Deny, DiagnosticFormat};
use super::artifacts::{Status, Update, Written};
use super::disk::DiskWorld;
use super::github;
use super::lock::{Complete, Lock};
use super::outcome::Outcome;
use super::output::Output;
use super::place::Place;
use super::placed::{Placed, placed};
use super::progress::Bar;
use super::sarif;
use super::session::{CacheAt, Session, settings};
use super::stale::Stale;
use super::terminal::{self, Failure, shortlist};
use super::timings::Trace;
use fretwork_diagnostic::{Code, Diagnostic, Severity};
use fretwork_engine::{
    Artifact, Cutting, NodeReport, Progress, Report, Request, Settings, Versions, output_folder,
    threads,
};

#[derive(Serialize)]
struct JsonReport<'a> {
    nodes: &'a [NodeReport],
    artifacts: &'a [Written],
    errors: Vec<Placed>,
    warnings: Vec<Placed>,
    /// How many more errors and warnings there are.
    #[serde(skip_serializing_if = "is_zero")]
    omitted: usize,
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

/// Builds once and prints what happened.
pub fn run(arguments: &Build, versions: Versions) -> Result<(), Failure> {
    let session = open(arguments, versions)?;
    let trace = arguments
        .timings
        .as_deref()
        .map(|path| Trace::at(session.world.root(), path));
    let trace = trace.transpose()?;
    let started = Instant::now();
    let outcome = build(&session, arguments)?;
    if let Some(trace) = trace {
        trace.write(&outcome.report)?;
    }
    print(&session, arguments, &outcome, started)?;
    if outcome.report.diagnostics.iter().any(Diagnostic::is_error) {
        Err(Failure::Build)
    } else {
        Ok(())
    }
}

/// The session of `build` and `watch`.
///
/// # Errors
/// As [`Session::open`], and when the lock cannot be read.
pub fn open(arguments: &Build, versions: Versions) -> Result<Session, Failure> {
    let evaluation = &arguments.evaluation;
    let cache = if evaluation.no_cache || is_proof(arguments)? {
        CacheAt::Nowhere
    } else {
        CacheAt::Folder(evaluation.cache_dir.as_deref(), versions)
    };
    let session = Session::open(&arguments.specs, cache)?;
    let session = session.with_engine(evaluation.engine.into());
    Ok(session.with_budget(evaluation.budget))
}

/// Whether all is to be computed anew: nothing but the files themselves says what `--locked` compares them with, and a
/// cache is no proof of what a spec gives.
fn is_proof(arguments: &Build) -> Result<bool, Failure> {
    if !arguments.locked {
        return Ok(false);
    }
    let world = Session::world_of(&arguments.specs)?;
    Ok(lock_of(arguments, &world)?.is_none())
}

/// The lock that a build is compared with. It speaks of the defaults of parameters only.
fn lock_of(arguments: &Build, world: &DiskWorld) -> Result<Option<Lock>, Failure> {
    if arguments.locked && arguments.evaluation.sets.is_empty() {
        Lock::load(world.root())
    } else {
        Ok(None)
    }
}

/// Evaluates what was asked for and brings the files up to date.
///
/// # Errors
/// When the command line asks for what is not there.
pub fn build(session: &Session, arguments: &Build) -> Result<Outcome, Failure> {
    let bar = Bar::new();
    let report = evaluate(session, arguments, &BTreeMap::new(), &bar);
    bar.finish();
    settle(session, arguments, report)
}

/// Brings the files up to date with a report.
///
/// # Errors
/// As [`build`].
pub fn settle(
    session: &Session,
    arguments: &Build,
    mut report: Report,
) -> Result<Outcome, Failure> {
    let mut output = Output::new(place(session, arguments)?);
    let is_refused = arguments.deny.is_some() && !report.diagnostics.is_empty();
    let artifacts: &[Artifact] = if is_refused { &[] } else { &report.artifacts };
    let lock = lock_of(arguments, &session.world)?;
    let update = Update::new(session, artifacts, &mut output);
    let (written, mut more) = if arguments.locked {
        update.compare()
    } else {
        update.write(arguments.overwrite)
    };
    more.extend(differences(&written, &output, lock.is_some()));
    // What failed is missing among the artifacts, and has been told.
    let has_failed = is_refused || report.diagnostics.iter().any(Diagnostic::is_error);
    let complete = if has_failed {
        Complete::Nothing
    } else {
        complete(arguments)
    };
    if let Some(lock) = lock {
        more.extend(lock.compare(artifacts, &session.specs, complete));
    }
    let stale = Stale {
        session,
        is_all: arguments.specs.is_empty(),
        is_own_folder: is_own_folder(arguments),
        artifacts,
    };
    if arguments.locked && complete != Complete::Nothing {
        match stale.orphans(&mut output) {
            Ok(orphans) => more.extend(orphans),
            Err(error) => more.push(error),
        }
    }
    let is_right = |more: &[Diagnostic]| !has_failed && !more.iter().any(Diagnostic::is_error);
    if arguments.prune && is_right(&more) {
        more.extend(stale.prune(&mut output).err());
    }
    if arguments.lock && is_right(&more) {
        Lock::renew(
            session.world.root(),
            &session.specs,
            artifacts,
            stale.is_all,
        )?;
    }
    report.diagnostics.extend(more);
    // Last, since artifacts are written from it.
    session.settle();
    Ok(Outcome { report, written })
}

/// Evaluates the artifacts that were asked for, with their paths below the output folder; `own` are settings of some specs
/// in front of those of the command line.
pub fn evaluate(
    session: &Session,
    arguments: &Build,
    own: &BTreeMap<String, Settings>,
    progress: &dyn Progress,
) -> Report {
    let request = Request {
        specs: session.specs.clone(),
        settings: settings(&arguments.evaluation.sets),
        only: arguments.only.clone(),
        windows: windows(arguments),
        threads: threads(arguments.evaluation.jobs.map(usize::from)),
        progress,
    };
    let mut report = session.compiler.build_with(&request, own);
    report.diagnostics.extend(session.warnings.iter().cloned());
    if arguments.deny == Some(Deny::Warnings) {
        let all = report.diagnostics.iter_mut();
        all.for_each(|diagnostic| diagnostic.severity = Severity::Error);
    }
    if is_own_folder(arguments) {
        for artifact in &mut report.artifacts {
            let folder = output_folder(&artifact.spec) + "/";
            if let Some(path) = artifact.path.strip_prefix(&folder) {
                artifact.path = path.to_string();
            }
        }
    }
    report
}

/// The parts of the plane that are asked for.
fn windows(arguments: &Build) -> Vec<Cutting> {
    let all = arguments.windows.iter().chain(&arguments.tiles);
    all.cloned().collect()
}

/// Where the artifacts go.
fn place(session: &Session, arguments: &Build) -> Result<Place, Failure> {
    let root = session.world.root();
    match &arguments.out {
        None => Ok(Place::inside(root, "out")),
        Some(out) => Place::of(root, out)
            .map_err(|e| Failure::usage(format!("cannot find `{}`: {e}", out.display()))),
    }
}

/// The errors for files that are not what they should be. Where there is a lock, files need not be there.
fn differences(written: &[Written], output: &Output, is_locked: bool) -> Vec<Diagnostic> {
    let error = |one: &Written| {
        let wrong = match one.status {
            Status::Different => "is not what the spec gives",
            Status::Missing if !is_locked => "is missing",
            Status::Missing | Status::Written | Status::Unchanged => return None,
        };
        let message = format!("`{}` {wrong}", output.path(&one.path).display());
        let help = "build without `--locked`, and commit the file if the change is meant";
        Some(Diagnostic::error(message).about(Code::Output).help(help))
    };
    written.iter().filter_map(error).collect()
}

/// Of what a build of these arguments gives all artifacts.
fn complete(arguments: &Build) -> Complete {
    let is_whole = arguments.only.is_empty() && windows(arguments).is_empty();
    match (is_whole, arguments.specs.is_empty()) {
        (false, _) => Complete::Nothing,
        (true, false) => Complete::Specs,
        (true, true) => Complete::Project,
    }
}

/// Whether the output folder is that of one spec alone: one spec and a folder were named.
fn is_own_folder(arguments: &Build) -> bool {
    arguments.out.is_some() && arguments.specs.len() == 1
}

/// Prints the outcome of a build in the format asked for.
///
/// # Errors
/// When standard output cannot be written.
pub fn print(
    session: &Session,
    arguments: &Build,
    outcome: &Outcome,
    started: Instant,
) -> Result<(), Failure> {
    let diagnostics = &outcome.report.diagnostics;
    match arguments.format {
        DiagnosticFormat::Human => {}
        DiagnosticFormat::Json => return print_json(session, outcome),
        DiagnosticFormat::Github => {
            session.print(diagnostics);
            terminal::print(&github::commands(&placed(session, diagnostics.iter())))?;
            github::summarize(outcome, started.elapsed());
            return Ok(());
        }
        DiagnosticFormat::Sarif => {
            session.print(diagnostics);
            return terminal::print_json(&sarif::log(&placed(session, diagnostics.iter())));
        }
    }
    session.print(diagnostics);
    if outcome.report.nodes.is_empty() && diagnostics.iter().any(Diagnostic::is_error) {
        return Ok(());
    }
    for w in outcome
        .written
        .iter()
        .filter(|w| w.status == Status::Written)
    {
        terminal::note(&format!("wrote {} ({} bytes)", w.path, w.bytes));
    }
    let count = |status| {
        outcome
            .written
            .iter()
            .filter(|w| w.status == status)
            .count()
    };
    let ran = outcome
        .report
        .nodes
        .iter()
        .filter(|n| n.was_evaluated())
        .count();
    let summary = format!(
        "{} written, {} unchanged; {ran} of {} evaluated in {:.2} s\n",
        count(Status::Written),
        count(Status::Unchanged),
        terminal::counted(outcome.report.nodes.len(), "node"),
        started.elapsed().as_secs_f64()
    );
    terminal::print(&summary)
}

fn print_json(session: &Session, outcome: &Outcome) -> Result<(), Failure> {
    let (diagnostics, omitted) = shortlist(&outcome.report.diagnostics);
    let of = |is_error: bool| {
        let of_one = diagnostics.iter().filter(|d| d.is_error() == is_error);
        placed(session, of_one.copied())
    };
    terminal::print_json(&JsonReport {
        nodes: &outcome.report.nodes,
        artifacts: &outcome.written,
        errors: of(true),
        warnings: of(false),
        omitted,
    })
}
