//! `fretwork params`: what a caller of a spec may set.

use std::fmt::Write as _;

use super::arguments::{Format, Params};
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use fretwork_diagnostic::{Diagnostic, shown};

/// Prints the parameters with their defaults, ranges and docs.
pub fn run(arguments: &Params) -> Result<(), Failure> {
    let (session, spec) = Session::of_one(&arguments.spec, CacheAt::Nowhere)?;
    let (params, diagnostics) = session.compiler.params(&spec, &settings(&arguments.sets));
    session.print(&diagnostics);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    if arguments.format == Format::Json {
        return terminal::print_json(&params);
    }
    let mut out = String::new();
    for param in &params {
        let mut facts = vec![param.param_type.clone()];
        facts.extend(param.min.as_ref().map(|min| format!("at least {min}")));
        facts.extend(param.max.as_ref().map(|max| format!("at most {max}")));
        if !param.choices.is_empty() {
            let choices: Vec<String> = param.choices.iter().map(ToString::to_string).collect();
            facts.push(format!("one of {}", choices.join(", ")));
        }
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "{} = {}  ({})",
            shown(&param.name),
            param.default,
            shown(&facts.join(", "))
        );
        if let Some(doc) = &param.doc {
            let _ = writeln!(out, "    {}", shown(doc));
        }
    }
    terminal::print(&out)
}
