//! `fretwork check`: everything that can be known without evaluating.

use serde_json::json;

use super::arguments::{Check, Deny, Format};
use super::build::json_diagnostic;
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use crate::diagnostic::{Diagnostic, Severity};

/// Checks specs and prints what is wrong with them.
pub fn run(arguments: &Check) -> Result<(), Failure> {
    let session = Session::open(&arguments.specs, CacheAt::Nowhere)?;
    let settings = settings(&arguments.sets);
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    for spec in &session.specs {
        let found = session.compiler.check(spec, &settings);
        if !found.iter().any(Diagnostic::is_error) {
            diagnostics.extend(session.compiler.check_scripts(spec, &settings));
        }
        diagnostics.extend(found);
    }
    diagnostics.sort();
    diagnostics.dedup();
    if arguments.deny == Some(Deny::Warnings) {
        diagnostics.iter_mut().for_each(|d| d.severity = Severity::Error);
    }
    if arguments.format == Format::Json {
        let (errors, warnings): (Vec<_>, Vec<_>) = diagnostics.iter().partition(|d| d.is_error());
        let json = |list: Vec<&Diagnostic>| list.into_iter().map(|d| json_diagnostic(&session, d)).collect::<Vec<_>>();
        terminal::print_json(&json!({ "errors": json(errors), "warnings": json(warnings) }))?;
    } else {
        session.print(&diagnostics);
    }
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    if arguments.format == Format::Human {
        let n = session.specs.len();
        terminal::print(&format!("{n} spec{} checked\n", if n == 1 { "" } else { "s" }))?;
    }
    Ok(())
}
