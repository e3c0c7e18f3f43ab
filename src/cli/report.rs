//! `fretwork report`: one page about the specs, which needs nothing else to be read. What it looks like is in
//! `page`.

use super::arguments::Report as Arguments;
use super::diff::comparison::{Comparison, Wanted};
use super::exhibit::{Exhibit, Scope};
use super::own_file::OwnFile;
use super::page::{self, Page};
use super::page_diff::Changes;
use super::progress::Bar;
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use fretwork_diagnostic::Diagnostic;
use fretwork_engine::{Request, Versions, threads};

/// Evaluates the specs and writes the page.
pub fn run(arguments: &Arguments, versions: Versions) -> Result<(), Failure> {
    let evaluation = &arguments.evaluation;
    let cache = if evaluation.no_cache {
        CacheAt::Nowhere
    } else {
        CacheAt::Folder(evaluation.cache_dir.as_deref(), versions)
    };
    let session = Session::open(&arguments.specs, cache)?.with_budget(evaluation.budget);
    let shown = arguments
        .out
        .clone()
        .unwrap_or_else(|| "out/report.html".into());
    let path = match &arguments.out {
        Some(path) => path.clone(),
        None => session.world.root().join(&shown),
    };
    let file = OwnFile::at(session.world.root(), &path, page::HEAD, "report")?;
    let comparison = against(arguments, versions)?;
    let bar = Bar::new();
    let request = Request {
        specs: session.specs.clone(),
        settings: settings(&evaluation.sets),
        only: Vec::new(),
        windows: Vec::new(),
        threads: threads(evaluation.jobs.map(usize::from)),
        progress: &bar,
    };
    let report = session.compiler.build(&request);
    bar.finish();
    let given = settings(&evaluation.sets);
    let exhibit = Exhibit::of(&session, &report, &|_| given.clone(), Scope::Still);
    let text = page::render(&Page {
        exhibit: &exhibit,
        changes: comparison.as_ref().map(Changes::of),
        live: None,
        is_stable: arguments.stable,
    });
    file.write(&text)?;
    session.settle();
    session.print(&report.diagnostics);
    terminal::note(&format!("wrote {} ({} bytes)", shown.display(), text.len()));
    // What is wrong with the work tree has been printed.
    let before = comparison.map(|comparison| comparison.told[0].clone());
    let (text, count) = before.unwrap_or_default();
    terminal::print_errors(&text, count);
    if count > 0 || report.diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    Ok(())
}

/// What differs from the revision that is named.
fn against(arguments: &Arguments, versions: Versions) -> Result<Option<Comparison>, Failure> {
    let Some(rev) = &arguments.against else {
        return Ok(None);
    };
    let wanted = Wanted {
        before: rev,
        after: None,
        specs: &arguments.specs,
        only: &[],
        evaluation: &arguments.evaluation,
    };
    Comparison::of(&wanted, versions).map(Some)
}
