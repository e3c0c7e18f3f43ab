//! `fretwork check`: everything that can be known without evaluating.

use serde_json::json;

use super::arguments::{Check, Deny, DiagnosticFormat};
use super::github;
use super::placed::placed;
use super::sarif;
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure, shortlist};
use fretwork_diagnostic::{Diagnostic, Severity};

/// Checks specs and prints what is wrong with them.
pub fn run(arguments: &Check) -> Result<(), Failure> {
    let session = Session::open(&arguments.specs, CacheAt::Nowhere)?;
    let (each, mut diagnostics) = session
        .compiler
        .settings_of(&session.specs, &settings(&arguments.sets));
    for (spec, settings) in session.specs.iter().zip(&each) {
        diagnostics.extend(session.compiler.check(spec, settings));
        diagnostics.extend(session.compiler.check_scripts(spec, settings));
    }
    diagnostics.sort();
    diagnostics.dedup();
    if arguments.deny == Some(Deny::Warnings) {
        diagnostics
            .iter_mut()
            .for_each(|d| d.severity = Severity::Error);
    }
    print(&session, arguments.format, &diagnostics)?;
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    if arguments.format == DiagnosticFormat::Human {
        let specs = terminal::counted(session.specs.len(), "spec");
        terminal::print(&format!("{specs} checked\n"))?;
    }
    Ok(())
}

fn print(
    session: &Session,
    format: DiagnosticFormat,
    diagnostics: &[Diagnostic],
) -> Result<(), Failure> {
    match format {
        DiagnosticFormat::Human => session.print(diagnostics),
        DiagnosticFormat::Json => return print_json(session, diagnostics),
        DiagnosticFormat::Github => {
            session.print(diagnostics);
            terminal::print(&github::commands(&placed(session, diagnostics.iter())))?;
        }
        DiagnosticFormat::Sarif => {
            session.print(diagnostics);
            terminal::print_json(&sarif::log(&placed(session, diagnostics.iter())))?;
        }
    }
    Ok(())
}

fn print_json(session: &Session, diagnostics: &[Diagnostic]) -> Result<(), Failure> {
    let (shown, omitted) = shortlist(diagnostics);
    let of = |is_error: bool| {
        let of_one = shown.iter().filter(|d| d.is_error() == is_error);
        placed(session, of_one.copied())
    };
    let mut report = json!({ "errors": of(true), "warnings": of(false) });
    if omitted > 0 {
        report["omitted"] = omitted.into();
    }
    terminal::print_json(&report)
}
