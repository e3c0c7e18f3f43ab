//! What the tables of maps hold.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::{Decode, Decoder, Tree};

/// A value in a table: a text, a number, yes or no, or nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum TableValue {
    /// A whole number.
    Whole(i64),
    /// Another number.
    Number(f64),
    /// Yes or no.
    Truth(bool),
    /// A text.
    Text(Arc<str>),
    /// No value.
    Nothing,
}

impl Decode for TableValue {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<TableValue> {
        match tree.plain() {
            Tree::Int(value) => Some(TableValue::Whole(*value)),
            Tree::Float(value) => Some(TableValue::Number(value.get())),
            Tree::Bool(value) => Some(TableValue::Truth(*value)),
            Tree::Text(text) => Some(TableValue::Text(text.clone())),
            Tree::Null => Some(TableValue::Nothing),
            _ => cx.mismatch("a text, a number, true or false, or null", tree),
        }
    }
}

impl JsonSchema for TableValue {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "TableValue".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["string", "number", "boolean", "null"] })
    }
}
