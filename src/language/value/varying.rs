//! Values that are not fixed: drawn from a range, read from a field, left to what comes out.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::scalar::Natural;
use super::super::types::wants;
use super::super::{Decode, Decoder, Ref, Tree};

/// A value, or two between which one is drawn at random: `low <= high`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Range<T> {
    /// The least value.
    pub low: T,
    /// The greatest value; the same as `low` where nothing is drawn.
    pub high: T,
}

impl<T: Decode + Copy + PartialOrd> Decode for Range<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Range<T>> {
        let Some(ends) = tree.as_list() else {
            return T::decode(tree, cx).map(|value| Range {
                low: value,
                high: value,
            });
        };
        if ends.len() != 2 {
            return cx.error(format!(
                "a range is `[least, greatest]`, found a list of {}",
                ends.len()
            ));
        }
        match *cx.items(ends)? {
            [low, high] if low <= high => Some(Range { low, high }),
            _ => cx.error("the range ends before it begins"),
        }
    }
}

impl<T: JsonSchema> JsonSchema for Range<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("RangeOf{}", T::schema_name()).into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let ends = json_schema!({ "type": "array", "items": g.subschema_for::<T>(), "minItems": 2, "maxItems": 2 });
        json_schema!({ "anyOf": [g.subschema_for::<T>(), ends] })
    }
}

/// A constant, or a field that is read where the value is needed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Varying<T> {
    /// The same everywhere.
    Constant(T),
    /// The value of a field.
    Field(Ref<wants::Field>),
}

impl<T: Decode> Decode for Varying<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Varying<T>> {
        // A name does not begin as a number does.
        let is_name = |text: &str| {
            text.trim_start()
                .starts_with(|c: char| c.is_alphabetic() || c == '_')
        };
        match tree {
            Tree::Text(text) if is_name(text) => Ref::decode(tree, cx).map(Varying::Field),
            _ => T::decode(tree, cx).map(Varying::Constant),
        }
    }
}

impl<T: JsonSchema> JsonSchema for Varying<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Varying{}", T::schema_name()).into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [g.subschema_for::<T>(), g.subschema_for::<Ref<wants::Field>>()] })
    }
}

/// How many pieces or holes there are to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Target {
    /// As many as come out.
    Any,
    /// This many.
    Exactly(u32),
}

impl Decode for Target {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Target> {
        match tree.plain() {
            Tree::Text(word) if &**word == "any" => Some(Target::Any),
            Tree::Int(n) if u32::try_from(*n).is_ok() => {
                u32::try_from(*n).ok().map(Target::Exactly)
            }
            Tree::Float(_) => Natural::decode(tree, cx).map(|n| Target::Exactly(n.0)),
            _ => cx.mismatch("a whole number or `any`", tree),
        }
    }
}

impl JsonSchema for Target {
    fn schema_name() -> Cow<'static, str> {
        "Target".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number that must come out exactly, or `any`.",
            "type": ["integer", "string"], "minimum": 0, "pattern": r"^any$|\$\{",
        })
    }
}
