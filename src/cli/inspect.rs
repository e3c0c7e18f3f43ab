//! `fretwork inspect`: the measures of one value.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::arguments::{Format, Inspect};
use super::clock::Clock;
use super::progress::Bar;
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use fretwork_diagnostic::Diagnostic;
use fretwork_engine::{InspectRequest, Versions, threads};
use fretwork_language::scalar::Unit;
use fretwork_language::value::shown_measure;

/// Evaluates a node and prints its measures, and how long the steps of shells and analyses took that ran for it.
pub fn run(arguments: &Inspect, versions: Versions) -> Result<(), Failure> {
    let evaluation = &arguments.evaluation;
    let cache = if evaluation.no_cache {
        CacheAt::Nowhere
    } else {
        CacheAt::Folder(evaluation.cache_dir.as_deref(), versions)
    };
    let (session, spec) = Session::of_one(&arguments.spec, cache)?;
    let session = session.with_engine(evaluation.engine.into());
    let session = session.with_budget(evaluation.budget);
    let bar = Bar::new();
    let clock = Clock::before(&bar);
    let request = InspectRequest {
        spec: &spec,
        node: &arguments.node,
        region: arguments.region.as_deref(),
        at: &arguments.at,
        window: arguments.window,
        settings: settings(&evaluation.sets),
        threads: threads(evaluation.jobs.map(usize::from)),
        progress: &clock,
    };
    let (measures, mut diagnostics) = session.compiler.inspect(&request);
    bar.finish();
    session.settle();
    diagnostics.extend(session.warnings.iter().cloned());
    session.print(&diagnostics);
    let Some(mut measures) = measures.filter(|_| !diagnostics.iter().any(Diagnostic::is_error))
    else {
        return Err(Failure::Build);
    };
    let times = clock.times();
    if arguments.format == Format::Json {
        if !times.is_empty() {
            measures["seconds"] = json!(times);
        }
        terminal::print_json(&measures)
    } else {
        let lines = times
            .iter()
            .map(|(job, seconds)| format!("{job} took {seconds} s\n"));
        terminal::print(&(table(&measures) + &lines.collect::<String>()))
    }
}

/// One line per measure, with its unit, and one per place that was asked; other lists of objects are counted rather than
/// shown.
fn table(measures: &Value) -> String {
    let mut out = String::new();
    let Value::Object(map) = measures else {
        return format!("{measures}\n");
    };
    let unit = map.get("units").and_then(Value::as_str);
    let unit = unit.and_then(Unit::from_word).unwrap_or(Unit::Millimetre);
    let width = map.keys().map(String::len).max().unwrap_or(0);
    for (name, value) in map.iter().filter(|(name, _)| *name != "units") {
        let shown = match value {
            Value::Array(places) if name == "at" => {
                for place in places {
                    let _ = writeln!(out, "{name:width$}  {}", found(place, unit));
                }
                continue;
            }
            Value::Array(items) if items.iter().any(Value::is_object) => {
                format!("{} in all", items.len())
            }
            value => shown_measure(name, value, unit),
        };
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{name:width$}  {shown}");
    }
    out
}

/// What is at a place: its coordinates, then all else by name.
fn found(place: &Value, unit: Unit) -> String {
    let number = |name: &str| place[name].as_f64().unwrap_or_default();
    let mut out = format!("({}, {})", number("x"), number("y"));
    let fields = place.as_object().into_iter().flatten();
    for (name, value) in fields.filter(|(name, _)| !["x", "y"].contains(&name.as_str())) {
        out += &format!("  {name} {}", shown_measure(name, value, unit));
    }
    out
}
