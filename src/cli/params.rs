//! `fretwork params`: what a caller of a spec may set.

use std::fmt::Write as _;

use serde_json::Value;

use super::arguments::{Format, Params};
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use fretwork_diagnostic::{Diagnostic, shown};
use fretwork_language::value::shown_number;

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
        let value = |value: &Value| in_unit(value, param.unit);
        let mut facts = vec![param.param_type.clone()];
        if param.value != param.default {
            facts.push(format!("default {}", value(&param.default)));
        }
        facts.extend(
            param
                .min
                .as_ref()
                .map(|min| format!("at least {}", value(min))),
        );
        facts.extend(
            param
                .max
                .as_ref()
                .map(|max| format!("at most {}", value(max))),
        );
        if !param.choices.is_empty() {
            let choices: Vec<String> = param.choices.iter().map(value).collect();
            facts.push(format!("one of {}", choices.join(", ")));
        }
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "{} = {}  ({})",
            shown(&param.name),
            value(&param.value),
            shown(&facts.join(", "))
        );
        if let Some(doc) = &param.doc {
            let _ = writeln!(out, "    {}", shown(doc));
        }
    }
    terminal::print(&out)
}

/// A value as people see it: at most four decimals, and its unit.
fn in_unit(value: &Value, unit: Option<&str>) -> String {
    match (value.as_f64(), unit) {
        (Some(number), Some(unit)) => format!("{} {unit}", shown_number(number)),
        (Some(number), None) if !value.is_i64() => shown_number(number),
        _ => value.to_string(),
    }
}
