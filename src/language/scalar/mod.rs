//! The scalars of the language: numbers with and without units, words, names of files, colours.
//!
//! Each is a type of its own, so that a length cannot pass for an angle. None holds NaN, an
//! infinity or a negative zero.

mod color;
mod factor;
mod force;
mod number;
mod quantity;
mod text;
mod unit;

pub use color::Color;
pub use factor::{Density, Extent, Fraction, PoissonRatio, PositiveFraction, Scale};
pub use force::{ForceVector, Gravity};
pub use number::{Count, Integer, Natural, NonNegativeNumber, Number, PositiveNumber};
pub use quantity::{
    Angle, Area, Force, Length, MassDensity, NonNegativeLength, OutputLength, PositiveLength,
    Pressure, Volume,
};
pub use text::{FilePath, Label, Letter, Text};
pub use unit::Unit;

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::Value;

/// Text that holds an expression; it may stand wherever a scalar or a list may.
pub struct Expression;

impl JsonSchema for Expression {
    fn schema_name() -> Cow<'static, str> {
        "Expression".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Text with `${…}` in it: Starlark's expressions over the file's `params` and `let`, `pi`, `deg` (= pi/180) \
                and the math functions, which take radians. `text_width(text, [size], [font], [letter_spacing])` is the width of the longest line \
                of a text, in the unit of the file; what is left out is as in the `text` of the same entry, or else size 10 and plain \
                letters; `font` is a path as in `text`. Text that is one `${…}` and nothing else keeps the type of its value.",
            "type": "string",
            "pattern": EXPRESSION_PATTERN,
        })
    }
}

/// What an expression looks like, as part of a JSON Schema pattern.
const EXPRESSION_PATTERN: &str = r"\$\{";

/// The schema of a number that may also be text: an expression, or what `pattern` allows.
fn number_schema(kind: &str, doc: &str, pattern: Option<&str>, limits: &[(&str, Value)]) -> Schema {
    let pattern = match pattern {
        Some(pattern) => format!("{pattern}|{EXPRESSION_PATTERN}"),
        None => EXPRESSION_PATTERN.to_owned(),
    };
    let mut schema = json_schema!({ "description": super::record::prose(doc), "type": [kind, "string"], "pattern": pattern });
    for (limit, value) in limits {
        schema.insert((*limit).to_owned(), value.clone());
    }
    schema
}
