//! `fretwork explain`: why a node was evaluated or not.

use std::fmt::Write as _;

use super::arguments::{Explain, Format};
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use fretwork_diagnostic::{Diagnostic, shown};
use fretwork_engine::{Explanation, Versions};

/// Prints what the last build did with a node, and what it depends on.
pub fn run(arguments: &Explain, versions: Versions) -> Result<(), Failure> {
    let cache = CacheAt::Folder(arguments.cache_dir.as_deref(), versions);
    let (session, spec) = Session::of_one(&arguments.spec, cache)?;
    let settings = settings(&arguments.sets);
    let compiler = &session.compiler;
    let (explanations, diagnostics) = compiler.explain(&spec, &arguments.node, &settings);
    session.print(&diagnostics);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    if arguments.format == Format::Json {
        return terminal::print_json(&explanations);
    }
    terminal::print(&explanations.iter().map(text).collect::<String>())
}

fn text(explanation: &Explanation) -> String {
    let mut out = format!(
        "{}: {}\n",
        shown(&explanation.job),
        shown(&explanation.summary)
    );
    if let Some(engine) = &explanation.engine {
        // Writing to a String cannot fail.
        let _ = writeln!(out, "  {}", shown(engine));
    }
    for input in &explanation.inputs {
        let change = match (&input.before, &input.digest) {
            (Some(before), now) if before == now => String::new(),
            (Some(before), _) => format!("  changed, was {}", before.short()),
            (None, _) if explanation.had_before => "  new".to_string(),
            (None, _) => String::new(),
        };
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "  {} {}{change}",
            input.digest.short(),
            shown(&input.name)
        );
    }
    out
}
