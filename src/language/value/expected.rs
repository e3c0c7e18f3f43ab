//! What the measures of a file are expected to be: exact counts, least values, ranges. Whether they are is found out where
//! the file is made.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::scalar::{Area, Length, Natural, Number, Pressure, Volume};
use super::super::{Decode, Decoder, Tree};
use super::measure::{Dimension, MEASURES};
use fretwork_diagnostic::{Code, Diagnostic};

/// A single value of a measure that is no count is met within this part of it.
const TOLERANCE: f64 = 1e-3;

/// What each measure is expected to be, by name, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Expectations(pub Vec<(Arc<str>, Expected)>);

/// What a measure is expected to be, in the spec's unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Expected {
    /// Whether it holds.
    Flag(bool),
    /// From here to there, both included; open where there is no number.
    Between(Option<f64>, Option<f64>),
    /// The corners of a box.
    Corners(Corners),
}

/// What the corners of a box are expected to be. Points have as many coordinates as were written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Corners {
    /// Its least corner has no lower coordinates than these.
    pub min: Option<Vec<f64>>,
    /// Its greatest corner has no higher coordinates than these.
    pub max: Option<Vec<f64>>,
    /// It is no larger than this.
    pub size: Option<Vec<f64>>,
    /// Whether it is just so, within the tolerance, rather than within.
    pub is_exact: bool,
    /// How far any coordinate may be off.
    pub tolerance: f64,
}

impl Decode for Expectations {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Expectations> {
        let Some(entries) = tree.as_map() else {
            return cx.mismatch("measures by name, as in `{ components: 1 }`", tree);
        };
        let read = |(name, value): &(Arc<str>, Tree)| {
            let expected = cx.at(name, |cx| expected(name, value, cx))?;
            Some((name.clone(), expected))
        };
        // All of them are read, so that every mistake is told.
        let all: Vec<_> = entries.iter().map(read).collect();
        all.into_iter().collect::<Option<_>>().map(Expectations)
    }

    fn absent() -> Option<Expectations> {
        Some(Expectations::default())
    }
}

fn expected(name: &str, tree: &Tree, cx: &mut Decoder) -> Option<Expected> {
    let Some(dimension) = Dimension::of(name).filter(|d| *d != Dimension::Table) else {
        let unknown = Diagnostic::error(format!("there is no measure `{name}` to be expected"));
        let known = MEASURES.iter().filter(|(_, d)| *d != Dimension::Table);
        cx.push(
            unknown
                .at(cx.key_span(), "")
                .suggest(name, known.map(|(name, _)| *name)),
        );
        return None;
    };
    match dimension {
        Dimension::Flag => match tree.plain() {
            Tree::Bool(flag) => Some(Expected::Flag(*flag)),
            _ => cx.mismatch("`true` or `false`", tree),
        },
        Dimension::Corners => corners(tree, cx).map(Expected::Corners),
        _ => between(name, dimension, tree, cx),
    }
}

/// A number as it is written for a measure of this dimension.
fn number(dimension: Dimension, tree: &Tree, cx: &mut Decoder) -> Option<f64> {
    match dimension {
        Dimension::Count => Natural::decode(tree, cx).map(|count| f64::from(count.0)),
        Dimension::Length => Length::decode(tree, cx).map(|length| length.0),
        Dimension::Area => Area::decode(tree, cx).map(|area| area.0),
        Dimension::Volume => Volume::decode(tree, cx).map(|volume| volume.0),
        Dimension::Pressure => Pressure::decode(tree, cx).map(|pressure| pressure.0),
        _ => Number::decode(tree, cx).map(|number| number.0),
    }
}

/// A number or a range. A single number is that count, the least width, or else the value within the tolerance.
fn between(name: &str, dimension: Dimension, tree: &Tree, cx: &mut Decoder) -> Option<Expected> {
    let (low, high) = match tree {
        Tree::List(ends) if ends.len() == 2 => {
            let mut end = |i: usize| match &ends[i] {
                Tree::Null => Some(None),
                tree => cx
                    .at(&i.to_string(), |cx| number(dimension, tree, cx))
                    .map(Some),
            };
            let (low, high) = (end(0), end(1));
            (low?, high?)
        }
        Tree::List(ends) => {
            return cx.error(format!(
                "a range is `[least, greatest]`, found a list of {}",
                ends.len()
            ));
        }
        Tree::Map(_) => of_map(dimension, tree, cx)?,
        _ => {
            let value = number(dimension, tree, cx)?;
            match dimension {
                Dimension::Count => (Some(value), Some(value)),
                _ if name == "min_width" => (Some(value), None),
                _ => around(value, value.abs() * TOLERANCE),
            }
        }
    };
    match (low, high) {
        (None, None) => cx.error("the range has no end: anything is in it"),
        (Some(low), Some(high)) if low > high => cx.error("the range ends before it begins"),
        _ => Some(Expected::Between(low, high)),
    }
}

fn around(value: f64, tolerance: f64) -> (Option<f64>, Option<f64>) {
    (Some(value - tolerance), Some(value + tolerance))
}

/// The ends of `{ min, max }` or of `{ value, tolerance }`.
fn of_map(
    dimension: Dimension,
    tree: &Tree,
    cx: &mut Decoder,
) -> Option<(Option<f64>, Option<f64>)> {
    known_keys(tree, &["min", "max", "value", "tolerance"], cx)?;
    let mut field = |name: &str| match tree.get(name) {
        None | Some(Tree::Null) => Some(None),
        Some(tree) => cx.at(name, |cx| number(dimension, tree, cx)).map(Some),
    };
    let (min, max) = (field("min")?, field("max")?);
    let (value, tolerance) = (field("value")?, field("tolerance")?);
    match (value, tolerance, min.or(max)) {
        (Some(value), Some(tolerance), None) if tolerance >= 0.0 => Some(around(value, tolerance)),
        (None, None, Some(_)) => Some((min, max)),
        _ => cx.error("write `{ min: 1, max: 2 }`, one of them, or `{ value: 2, tolerance: 0.1 }`"),
    }
}

/// An error where a map has other keys than these.
fn known_keys(tree: &Tree, known: &[&'static str], cx: &mut Decoder) -> Option<()> {
    let entries = tree.as_map().unwrap_or_default();
    let unknown = entries.iter().find(|(key, _)| !known.contains(&&**key));
    let Some((key, _)) = unknown else {
        return Some(());
    };
    let error = Diagnostic::error(format!("unknown field `{key}`"))
        .about(Code::Field)
        .at(cx.key_span_of(key), "");
    cx.push(error.suggest(key, known.iter().copied()));
    None
}

/// `[least corner, greatest corner]`, `[width, depth, height]`, or limits by name.
fn corners(tree: &Tree, cx: &mut Decoder) -> Option<Corners> {
    let mut corners = match tree {
        Tree::List(ends) if ends.len() == 2 && ends.iter().all(|e| e.as_list().is_some()) => {
            let mut end = |i: usize| cx.at(&i.to_string(), |cx| point(&ends[i], cx));
            let (min, max) = (end(0), end(1));
            Corners {
                min: Some(min?),
                max: Some(max?),
                is_exact: true,
                ..Corners::default()
            }
        }
        Tree::List(_) => Corners {
            size: Some(point(tree, cx)?),
            is_exact: true,
            ..Corners::default()
        },
        Tree::Map(_) => {
            known_keys(tree, &["min", "max", "size", "tolerance"], cx)?;
            let mut field = |name: &str| match tree.get(name) {
                None | Some(Tree::Null) => Some(None),
                Some(tree) => cx.at(name, |cx| point(tree, cx)).map(Some),
            };
            let (min, max, size) = (field("min"), field("max"), field("size"));
            Corners {
                min: min?,
                max: max?,
                size: size?,
                ..Corners::default()
            }
        }
        _ => {
            return cx.mismatch(
                "corners `[[0, 0, 0], [60, 60, 20]]`, a size `[60, 60, 20]`, or `{ max: [60, 60, 20] }`",
                tree,
            );
        }
    };
    let points: Vec<&Vec<f64>> = [&corners.min, &corners.max, &corners.size]
        .into_iter()
        .flatten()
        .collect();
    if points.is_empty() {
        return cx.error("there is no corner: add `min`, `max` or `size`");
    }
    if points.iter().any(|point| point.len() != points[0].len()) {
        return cx.error("the corners have different numbers of coordinates");
    }
    let extents = points.iter().flat_map(|point| point.iter());
    let largest = extents.fold(0.0f64, |most, x| most.max(x.abs()));
    corners.tolerance = match tree.get("tolerance") {
        Some(tree) => cx.at("tolerance", |cx| Length::decode(tree, cx))?.0,
        None => largest * TOLERANCE,
    };
    Some(corners)
}

fn point(tree: &Tree, cx: &mut Decoder) -> Option<Vec<f64>> {
    match tree.as_list() {
        Some(items) if matches!(items.len(), 2 | 3) => {
            let lengths: Vec<Length> = cx.items(items)?;
            Some(lengths.into_iter().map(|length| length.0).collect())
        }
        _ => cx.mismatch("two or three lengths", tree),
    }
}

impl JsonSchema for Expectations {
    fn schema_name() -> Cow<'static, str> {
        "Expectations".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "Measures by name, as `inspect` prints them, in the spec's units; those of a table as `safety_factor.p99`. A number is an exact count, the least \
            `min_width`, or the value within a thousandth; `[least, greatest]`, `{ min: 1, max: 2 }` and `{ value: 2, tolerance: 0.1 }` are \
            ranges. `bounds` are `[[0, 0, 0], [60, 60, 20]]`, a size `[60, 60, 20]`, or limits `{ min: [0, 0, 0], max: [60, 60, 20] }` and \
            `{ size: [60, 60, 20] }` that the object may not pass. A measure that has no value, as the safety factor of a body that nothing strains, \
            meets none of them.";
        let range = json_schema!({ "type": ["number", "string", "array", "object"] });
        let properties: serde_json::Map<String, serde_json::Value> = MEASURES
            .iter()
            .filter(|(_, dimension)| *dimension != Dimension::Table)
            .map(|(name, dimension)| {
                let schema = match dimension {
                    Dimension::Flag => json_schema!({ "type": "boolean" }),
                    Dimension::Corners => json_schema!({ "type": ["array", "object"] }),
                    _ => range.clone(),
                };
                ((*name).to_owned(), schema.to_value())
            })
            .collect();
        json_schema!({ "description": doc, "type": "object", "properties": properties, "additionalProperties": false })
    }
}
