//! `fretwork build`: artifacts of specs, written.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;

use super::arguments::{Build, Deny, Format};
use super::artifacts::{self, Status, Written};
use super::progress::Bar;
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use super::timings;
use fretwork_diagnostic::{Diagnostic, Severity};
use fretwork_engine::{NodeReport, Report, Request, Versions, output_folder, threads};

#[derive(Serialize)]
struct JsonReport<'a> {
    nodes: &'a [NodeReport],
    artifacts: &'a [Written],
    errors: Vec<JsonDiagnostic>,
    warnings: Vec<JsonDiagnostic>,
}

/// A diagnostic as `--format json` prints it.
#[derive(Serialize)]
pub struct JsonDiagnostic {
    message: String,
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
}

/// What a build did.
pub struct Outcome {
    /// What the compiler says.
    pub report: Report,
    /// What became of the artifacts.
    pub written: Vec<Written>,
}

/// Builds once and prints what happened.
pub fn run(arguments: &Build, versions: Versions) -> Result<(), Failure> {
    let session = open(arguments, versions)?;
    let started = Instant::now();
    let outcome = build(&session, arguments)?;
    if let Some(path) = &arguments.timings {
        let trace = timings::trace(&outcome.report);
        super::disk::write_atomically(path, trace.as_bytes())
            .map_err(|e| Failure::usage(format!("cannot write `{}`: {e}", path.display())))?;
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
/// As [`Session::open`], and when stale files would be looked for in a folder that is no spec's.
pub fn open(arguments: &Build, versions: Versions) -> Result<Session, Failure> {
    if arguments.prune && is_own_folder(arguments) {
        let message = "`--prune` removes files from folders that belong to specs, and `--out` with one spec names any folder";
        return Err(Failure::usage(message.to_string()));
    }
    let evaluation = &arguments.evaluation;
    let cache = if evaluation.no_cache {
        CacheAt::Nowhere
    } else {
        CacheAt::Folder(evaluation.cache_dir.as_deref(), versions)
    };
    Session::open(&arguments.specs, cache)
}

/// Evaluates what was asked for and brings the files up to date.
///
/// # Errors
/// When the command line asks for what is not there.
pub fn build(session: &Session, arguments: &Build) -> Result<Outcome, Failure> {
    let bar = Bar::new();
    let request = Request {
        specs: session.specs.clone(),
        settings: settings(&arguments.evaluation.sets),
        only: arguments.only.clone(),
        threads: threads(arguments.evaluation.jobs.map(usize::from)),
        progress: &bar,
    };
    let mut report = session.compiler.build(&request);
    bar.finish();
    if arguments.deny == Some(Deny::Warnings) {
        report
            .diagnostics
            .iter_mut()
            .for_each(|d| d.severity = Severity::Error);
    }
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| session.world.root().join("out"));
    if is_own_folder(arguments) {
        let folder = output_folder(&session.specs[0]) + "/";
        for artifact in &mut report.artifacts {
            artifact.path = artifact
                .path
                .strip_prefix(&folder)
                .unwrap_or(&artifact.path)
                .to_string();
        }
    }
    let (mut written, mut unwritten) = (Vec::new(), Vec::new());
    if arguments.deny.is_none() || report.diagnostics.is_empty() {
        for artifact in &report.artifacts {
            match artifacts::update(&session.compiler, artifact, &out, arguments.locked) {
                Ok(w) => written.push(w),
                Err(why) => unwritten.push(why),
            }
        }
    }
    report.diagnostics.extend(artifacts::report(unwritten));
    report.diagnostics.extend(written.iter().filter_map(|w| {
        let wrong = match w.status {
            Status::Different => "is not what the spec gives",
            Status::Missing => "is missing",
            Status::Written | Status::Unchanged => return None,
        };
        let error = Diagnostic::error(format!("`{}` {wrong}", out.join(&w.path).display()));
        Some(error.help("build without `--locked`, and commit the file if the change is meant"))
    }));
    if arguments.prune && !report.diagnostics.iter().any(Diagnostic::is_error) {
        let keep = written.iter().map(|w| out.join(&w.path)).collect();
        report.diagnostics.extend(prune(session, &out, &keep).err());
    }
    Ok(Outcome { report, written })
}

/// Whether the output folder is that of one spec alone: one spec and a folder were named.
fn is_own_folder(arguments: &Build) -> bool {
    arguments.out.is_some() && arguments.specs.len() == 1
}

/// Removes the stale artifacts of the session's specs.
fn prune(session: &Session, out: &Path, keep: &BTreeSet<PathBuf>) -> Result<(), Diagnostic> {
    let failed = |e: io::Error| Diagnostic::error(format!("cannot remove stale artifacts: {e}"));
    let folder = |spec: &String| out.join(output_folder(spec));
    let folders: BTreeSet<PathBuf> = session.specs.iter().map(folder).collect();
    let all: BTreeSet<PathBuf> = session
        .world
        .specs()
        .map_err(failed)?
        .iter()
        .map(folder)
        .collect();
    let others = all.difference(&folders).cloned().collect();
    for path in artifacts::prune(&artifacts::Pruning {
        folders,
        others,
        keep,
    })
    .map_err(failed)?
    {
        terminal::note(&format!("removed {}", path.display()));
    }
    Ok(())
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
    if arguments.format == Format::Json {
        let of = |is_error: bool| {
            json_diagnostics(
                session,
                diagnostics.iter().filter(|d| d.is_error() == is_error),
            )
        };
        return terminal::print_json(&JsonReport {
            nodes: &outcome.report.nodes,
            artifacts: &outcome.written,
            errors: of(true),
            warnings: of(false),
        });
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
        "{} written, {} unchanged; {ran} of {} nodes evaluated in {:.2} s\n",
        count(Status::Written),
        count(Status::Unchanged),
        outcome.report.nodes.len(),
        started.elapsed().as_secs_f64()
    );
    terminal::print(&summary)
}

/// Diagnostics with their places looked up, in order of file and position.
pub fn json_diagnostics<'a>(
    session: &Session,
    diagnostics: impl Iterator<Item = &'a Diagnostic>,
) -> Vec<JsonDiagnostic> {
    let mut found: Vec<JsonDiagnostic> = diagnostics.map(|d| json_diagnostic(session, d)).collect();
    found.sort_by(|a, b| {
        (&a.file, a.line, a.column, &a.message).cmp(&(&b.file, b.line, b.column, &b.message))
    });
    found
}

fn json_diagnostic(session: &Session, diagnostic: &Diagnostic) -> JsonDiagnostic {
    let span = diagnostic.labels.first().map(|l| &l.span);
    let sources = session.compiler.sources();
    let position = span.and_then(|s| fretwork_diagnostic::render::position(s, &sources));
    JsonDiagnostic {
        message: diagnostic.message.clone(),
        file: span.map(|s| s.file().to_string()),
        line: position.map(|p| p.0),
        column: position.map(|p| p.1),
    }
}
