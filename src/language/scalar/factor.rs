//! Numbers that measure against something else: fractions, extents, densities, scales, ratios.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::super::{Decode, Decoder, Tree};
use super::number::finite;
use super::quantity::{as_it_is, pattern, quantity};
use super::unit::{FRACTIONS, split_number};
use super::{NonNegativeLength, number_schema};

/// A fraction from 0 to 1: `0.1` or `"10%"`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Fraction(pub f64);

impl Decode for Fraction {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Fraction> {
        let value = as_it_is(quantity(tree, FRACTION, FRACTIONS, cx)?, cx);
        if (0.0..=1.0).contains(&value) {
            return Some(Fraction(value));
        }
        let message = format!("expected {FRACTION}, found {}", tree.describe());
        match tree {
            Tree::Text(_) => cx.error(message),
            _ if value > 1.0 && value <= 100.0 => {
                cx.error_with(message, format!("did you mean \"{value}%\"?"))
            }
            _ => cx.error(message),
        }
    }
}

const FRACTION: &str = "a fraction from 0 to 1";

impl JsonSchema for Fraction {
    fn schema_name() -> Cow<'static, str> {
        "Fraction".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "A fraction from 0 to 1: `0.1` or `\"10%\"`.";
        number_schema(
            "number",
            doc,
            Some(&pattern("%")),
            &[("minimum", json!(0)), ("maximum", json!(1))],
        )
    }
}

/// A part of a whole, above 0 and at most 1: `0.6` or `"60%"`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PositiveFraction(pub f64);

impl Decode for PositiveFraction {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<PositiveFraction> {
        let value = Fraction::decode(tree, cx)?.0;
        if value > 0.0 {
            return Some(PositiveFraction(value));
        }
        cx.mismatch("a fraction above 0 and at most 1", tree)
    }
}

impl JsonSchema for PositiveFraction {
    fn schema_name() -> Cow<'static, str> {
        "PositiveFraction".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "A fraction above 0 and at most 1: `0.6` or `\"60%\"`.";
        let limits = [("exclusiveMinimum", json!(0)), ("maximum", json!(1))];
        number_schema("number", doc, Some(&pattern("%")), &limits)
    }
}

/// A part of an extent, or a length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Extent {
    /// This part of the whole, from 0 to 1.
    Fraction(f64),
    /// A length, not below 0, in the spec's unit.
    Length(f64),
}

impl Decode for Extent {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Extent> {
        const EXTENT: &str = "a fraction or a length with its unit";
        let in_percent = tree
            .as_text()
            .is_some_and(|text| text.trim_end().ends_with('%'));
        if in_percent {
            return Fraction::decode(tree, cx).map(|fraction| Extent::Fraction(fraction.0));
        }
        if let Tree::Text(_) = tree {
            return NonNegativeLength::decode(tree, cx).map(|length| Extent::Length(length.0));
        }
        let value = finite(tree, EXTENT, cx)?;
        if (0.0..=1.0).contains(&value) {
            return Some(Extent::Fraction(value));
        }
        let help = format!(
            "write \"{value}%\" or \"{value}{}\"",
            cx.file_units().word()
        );
        cx.error_with(
            format!("{value} is neither a fraction nor a length with its unit"),
            help,
        )
    }
}

impl JsonSchema for Extent {
    fn schema_name() -> Cow<'static, str> {
        "Extent".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "A part of the whole or a length: a fraction (`0.1`, `\"10%\"`) or text with a unit of length (`\"5mm\"`).";
        let limits = [("minimum", json!(0)), ("maximum", json!(1))];
        number_schema("number", doc, Some(&pattern("%|mm|cm|m|in")), &limits)
    }
}

/// A mean number of points per square of the spec's unit, above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Density(pub f64);

impl Decode for Density {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Density> {
        let value = finite(tree, "a density above 0", cx)?;
        // A length of 1 of the file is this long in the spec, so a square of it holds this much more.
        let side = cx.file_units().convert(1.0, cx.spec_units());
        let value = value / (side * side);
        let fits = value > 0.0 && value.is_finite();
        if fits {
            Some(Density(value))
        } else {
            cx.mismatch("a density above 0", tree)
        }
    }
}

impl JsonSchema for Density {
    fn schema_name() -> Cow<'static, str> {
        "Density".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "A density: the mean number of points per square of the file's unit, above 0.";
        number_schema("number", doc, None, &[("exclusiveMinimum", json!(0))])
    }
}

/// A factor above 0 by which lengths are multiplied.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Scale(pub f64);

impl Decode for Scale {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Scale> {
        const SCALE: &str = "a scale above 0 (`2`, \"50%\", \"1:200\" or \"1:25000\", without points between thousands)";
        let value = match tree {
            Tree::Text(text) => match scale_of_text(text) {
                Some(value) => value,
                None => return cx.mismatch(SCALE, tree),
            },
            _ => finite(tree, SCALE, cx)?,
        };
        let fits = value > 0.0 && value.is_finite();
        if fits {
            Some(Scale(value))
        } else {
            cx.mismatch(SCALE, tree)
        }
    }
}

fn scale_of_text(text: &str) -> Option<f64> {
    let (first, rest) = split_number(text)?;
    if rest == "%" {
        return Some(first / 100.0);
    }
    let rest = rest.strip_prefix(':')?;
    // `1:25.000` is 25 to some and 25 000 to others, of whom none means 25.
    let grouped = rest.trim().split('.').skip(1);
    if grouped.clone().count() > 0 && grouped.clone().all(|group| group.len() == 3) {
        return None;
    }
    match split_number(rest)? {
        (second, "") => Some(first / second),
        _ => None,
    }
}

impl JsonSchema for Scale {
    fn schema_name() -> Cow<'static, str> {
        "Scale".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let number = r"\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*";
        let doc = "A factor above 0: a number, a percentage (`\"50%\"`) or a ratio (`\"1:200\"`).";
        let pattern = format!("^{number}(%|:{number})$");
        number_schema(
            "number",
            doc,
            Some(&pattern),
            &[("exclusiveMinimum", json!(0))],
        )
    }
}

/// Poisson's ratio: above -1 and below 0.5.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PoissonRatio(pub f64);

impl Decode for PoissonRatio {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<PoissonRatio> {
        const RATIO: &str = "a number above -1 and below 0.5";
        let value = finite(tree, RATIO, cx)?;
        if -1.0 < value && value < 0.5 {
            Some(PoissonRatio(value))
        } else {
            cx.mismatch(RATIO, tree)
        }
    }
}

impl JsonSchema for PoissonRatio {
    fn schema_name() -> Cow<'static, str> {
        "PoissonRatio".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let limits = [
            ("exclusiveMinimum", json!(-1)),
            ("exclusiveMaximum", json!(0.5)),
        ];
        number_schema(
            "number",
            "Poisson's ratio: a number above -1 and below 0.5.",
            None,
            &limits,
        )
    }
}
