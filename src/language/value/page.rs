//! Sizes of paper.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::scalar::OutputLength;
use super::super::{Decode, Decoder, Tree};
use fretwork_diagnostic::{Diagnostic, nearest};

/// Width and height of a page in millimetres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PageSize(pub [f64; 2]);

/// The names of sizes, upright, in millimetres.
const NAMED: &[(&str, [f64; 2])] = &[
    ("A0", [841.0, 1189.0]),
    ("A1", [594.0, 841.0]),
    ("A2", [420.0, 594.0]),
    ("A3", [297.0, 420.0]),
    ("A4", [210.0, 297.0]),
    ("A5", [148.0, 210.0]),
    ("A6", [105.0, 148.0]),
    ("letter", [215.9, 279.4]),
    ("legal", [215.9, 355.6]),
    ("tabloid", [279.4, 431.8]),
];

impl Decode for PageSize {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<PageSize> {
        match tree {
            Tree::Text(text) => named(text, cx),
            Tree::List(items) if items.len() == 2 => {
                let sides: Vec<OutputLength> = cx.items(items)?;
                match sides[..] {
                    [width, height] if width.0 > 0.0 && height.0 > 0.0 => {
                        Some(PageSize([width.0, height.0]))
                    }
                    _ => cx.error("a page must be wider and higher than 0"),
                }
            }
            _ => cx.mismatch(
                "a size of paper such as `A3 landscape`, or `[width, height]`",
                tree,
            ),
        }
    }
}

/// A size by its name, which `landscape` or `portrait` may follow.
fn named(text: &str, cx: &mut Decoder) -> Option<PageSize> {
    let mut words = text.split_whitespace();
    let name = words.next().unwrap_or_default();
    let Some((_, [width, height])) = NAMED.iter().find(|(n, _)| n.eq_ignore_ascii_case(name))
    else {
        let known: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
        let error = Diagnostic::error(format!("no size of paper is called `{name}`"));
        // Of two letters every size is one letter away.
        let near = nearest(name, known.iter().copied()).filter(|_| name.chars().count() > 2);
        let help = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("known are {}, and `[width, height]`", known.join(", ")),
        };
        let span = cx.span();
        cx.push(error.at(span, "").help(help));
        return None;
    };
    match (words.next(), words.next()) {
        (None | Some("portrait"), None) => Some(PageSize([*width, *height])),
        (Some("landscape"), None) => Some(PageSize([*height, *width])),
        _ => cx.error("after the size of a paper stands `landscape` or `portrait` or nothing"),
    }
}

impl JsonSchema for PageSize {
    fn schema_name() -> Cow<'static, str> {
        "PageSize".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let names: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
        let doc = format!(
            "A size of paper by its name ({}), upright or with `landscape` after it: `A3 landscape`; or `[width, height]` on the output.",
            names.join(", ")
        );
        let side = g.subschema_for::<OutputLength>();
        let text = json_schema!({ "type": "string", "minLength": 1 });
        let list = json_schema!({ "type": "array", "items": side, "minItems": 2, "maxItems": 2 });
        json_schema!({ "description": doc, "anyOf": [text, list] })
    }
}
