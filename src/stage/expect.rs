//! Whether the measures of an artifact are what its spec expects.

use std::sync::Arc;

use serde_json::{Map, Value as Json};

use super::model::Form;
use super::shown::{page_bounds, shown_model};
use fretwork_action::{Action, Data, Value};
use fretwork_artifact::{measure, measure_drawn};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_language::kinds::artifacts::{Artifact, Content, Format};
use fretwork_language::value::{Corners, Dimension, Expected, shown_measure, shown_number};
use fretwork_primitive::placement::plane_maps;

/// Measures are compared within this part of their size beside what the spec allows: they are rounded numbers.
const ROUNDING: f64 = 1e-9;

/// Errors for all measures that are not as expected, each at its line.
///
/// # Errors
/// When the measures cannot be taken.
pub fn check_expected(
    action: &Action,
    kind: &Artifact,
    format: Format,
) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    if kind.expect.0.is_empty() {
        return Ok(Vec::new());
    }
    let measures = measures(action, kind, format)?;
    let unit = action.definition.units;
    let failure = |(name, expected): &(Arc<str>, Expected)| {
        let dimension = Dimension::of(name).unwrap_or(Dimension::Number);
        let found = named(&measures, name);
        let message = match found {
            None => format!("what is shown has no measure `{name}`"),
            Some(Json::Null) => {
                let wanted = unmet(expected, &Json::Null, &dimension.unit(unit))?;
                format!("there is no `{name}`{}, and {wanted}", because(name))
            }
            Some(found) => {
                let wanted = unmet(expected, found, &dimension.unit(unit))?;
                let shown = shown_measure(name, found, unit);
                format!("`{name}` is {shown}, and {wanted}")
            }
        };
        let error = Diagnostic::error(message).at(place(action, name), "expected here");
        Some(if found.is_some() {
            error
        } else {
            let names: Vec<String> = measures.keys().map(|name| format!("`{name}`")).collect();
            error.help(format!("it has {}", names.join(", ")))
        })
    };
    Ok(kind.expect.0.iter().filter_map(failure).collect())
}

/// Why a measure has no value, as far as its name says so.
fn because(name: &str) -> &'static str {
    match name.contains("safety_factor.") {
        true => ", as nothing strains the body",
        false => "",
    }
}

/// The measure of this name; one of a table has the names of the tables that it is in before its own.
fn named<'a>(measures: &'a Map<String, Json>, name: &str) -> Option<&'a Json> {
    let mut names = name.split('.');
    let first = measures.get(names.next()?)?;
    names.try_fold(first, |table, own| table.get(own))
}

/// The place where a measure is expected.
fn place(action: &Action, name: &str) -> Span {
    let id = &action.definition.id;
    let path = [id.section.name(), &id.name, "expect", name].map(Arc::from);
    Span::value(&action.definition.file, &path)
}

/// The measures of what an artifact shows and, where its format holds bodies, of the body: its corners, and all that the value itself has not.
pub(super) fn measures(
    action: &Action,
    kind: &Artifact,
    format: Format,
) -> Result<Map<String, Json>, Vec<Diagnostic>> {
    let bounds = page_bounds(action, kind);
    let span = action.span();
    let is_map = action.definition.map.is_some();
    let is_body = matches!(format, Format::Stl | Format::ThreeMf | Format::Glb);
    // A surface is measured as the body that it becomes by its thickness.
    let is_surface = match &kind.content {
        Content::From(from) => matches!(action.value(from), Value::Data(Data::Surface(_))),
        Content::Parts(_) => false,
    };
    let mut measures = match &kind.content {
        Content::From(from) => measure(action.value(from), bounds, is_map, &span)?,
        Content::Parts(_) if is_body || format == Format::Json => Json::Object(Map::new()),
        Content::Parts(parts) => {
            let placed = parts.iter().map(|part| {
                let maps = plane_maps(&part.placement);
                (action.value(&part.from), maps)
            });
            measure_drawn(&placed.collect::<Vec<_>>(), bounds, is_map, &span)?
        }
    };
    if is_body || measures.as_object().is_some_and(Map::is_empty) {
        let (model, _) = shown_model(action, kind, Form::Solid)?;
        let body = measure(&Value::Data(Data::Solid(model.into())), None, is_map, &span)?;
        if let (Json::Object(own), Json::Object(body)) = (&mut measures, body) {
            for (name, value) in body {
                if name == "bounds" || is_surface || !own.contains_key(&name) {
                    own.insert(name, value);
                }
            }
        }
    }
    match measures {
        Json::Object(measures) => Ok(measures),
        _ => Ok(Map::new()),
    }
}

/// What is expected, in words, where `found` is not that.
fn unmet(expected: &Expected, found: &Json, unit: &str) -> Option<String> {
    let number = |x: f64| format!("{} {unit}", shown_number(x)).trim_end().to_owned();
    match expected {
        Expected::Flag(flag) => {
            (found.as_bool() != Some(*flag)).then(|| format!("{flag} is expected"))
        }
        Expected::Between(low, high) => {
            let holds = |found: f64| {
                let slack = ROUNDING * found.abs();
                low.is_none_or(|low| found >= low - slack)
                    && high.is_none_or(|high| found <= high + slack)
            };
            if found.as_f64().is_some_and(holds) {
                return None;
            }
            Some(match (*low, *high) {
                (Some(low), Some(high)) if low == high => format!("{} is expected", number(low)),
                (Some(low), Some(high)) => {
                    format!("{} to {} is expected", number(low), number(high))
                }
                (Some(low), None) => format!("at least {} is expected", number(low)),
                (None, high) => format!("at most {} is expected", number(high.unwrap_or(0.0))),
            })
        }
        Expected::Corners(corners) => off(corners, found, unit),
    }
}

/// What is expected of the corners, in words, where `found` is not that.
fn off(corners: &Corners, found: &Json, unit: &str) -> Option<String> {
    let corner = |i: usize| -> Vec<f64> {
        let numbers = found[i].as_array().into_iter().flatten();
        numbers.filter_map(Json::as_f64).collect()
    };
    let (least, greatest) = (corner(0), corner(1));
    let size: Vec<f64> = greatest.iter().zip(&least).map(|(b, a)| b - a).collect();
    let limits = [
        (&corners.min, &least, -1.0, "a least corner"),
        (&corners.max, &greatest, 1.0, "a greatest corner"),
        (&corners.size, &size, 1.0, "a size"),
    ];
    for (wanted, is, sign, what) in limits {
        let Some(wanted) = wanted else { continue };
        // Of a body in space its extents in the plane may be asked for alone.
        let within = |(wanted, is): (&f64, &f64)| {
            let beyond = (is - wanted) * sign;
            beyond <= corners.tolerance && (!corners.is_exact || beyond >= -corners.tolerance)
        };
        if wanted.len() > is.len() || !wanted.iter().zip(is).all(within) {
            let limit = match (corners.is_exact, sign > 0.0) {
                (true, _) => "",
                (false, true) => " of at most",
                (false, false) => " of at least",
            };
            return Some(format!("{what}{limit} {} is expected", list(wanted, unit)));
        }
    }
    None
}

fn list(numbers: &[f64], unit: &str) -> String {
    let numbers: Vec<String> = numbers.iter().map(|x| shown_number(*x)).collect();
    format!("[{}] {unit}", numbers.join(", "))
}
