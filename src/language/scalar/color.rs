//! Colours.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::{Decode, Decoder, Tree};

/// Red, green, blue, alpha, as sRGB bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Color(pub [u8; 4]);

impl Decode for Color {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Color> {
        const HELP: &str = "write \"#rrggbb\" in quotes, or a CSS name such as `teal`";
        let Tree::Text(text) = tree else {
            let message = format!("expected a colour, found {}", tree.describe());
            return cx.error_with(message, HELP);
        };
        match text.trim().parse::<svgtypes::Color>() {
            Ok(c) => Some(Color([c.red, c.green, c.blue, c.alpha])),
            Err(_) => cx.error_with(format!("{} is not a colour", tree.describe()), HELP),
        }
    }
}

impl JsonSchema for Color {
    fn schema_name() -> Cow<'static, str> {
        "Color".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "A colour: `\"#rrggbb\"`, in quotes because `#` starts a comment, or a CSS colour such as `teal`.";
        json_schema!({ "description": doc, "type": "string", "minLength": 1 })
    }
}
