//! Words, names of files, labels, letters.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::{Decode, Decoder, Tree};

/// Text. A number is taken as the text it is written as.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Text(pub Arc<str>);

impl Decode for Text {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Text> {
        match tree.to_text() {
            Some(text) => Some(Text(text)),
            None => cx.mismatch("text", tree),
        }
    }
}

impl JsonSchema for Text {
    fn schema_name() -> Cow<'static, str> {
        "Text".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "description": "Text; a number is taken as the text it is written as.", "type": ["string", "number", "boolean"] })
    }
}

/// A label of vertices, edges or faces: text that is not empty.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Label(pub Arc<str>);

impl Decode for Label {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Label> {
        match tree.to_text() {
            Some(text) if !text.is_empty() => Some(Label(text)),
            _ => cx.mismatch("a label", tree),
        }
    }
}

impl JsonSchema for Label {
    fn schema_name() -> Cow<'static, str> {
        "Label".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "description": "A label of vertices, edges or faces.", "type": ["string", "number"], "minLength": 1 })
    }
}

/// One letter, the name of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Letter(pub char);

impl Letter {
    /// The letter that `text` is.
    pub fn of(text: &str) -> Option<Letter> {
        let mut chars = text.chars();
        match (chars.next(), chars.next()) {
            (Some(letter), None) if letter.is_alphabetic() => Some(Letter(letter)),
            _ => None,
        }
    }
}

impl Decode for Letter {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Letter> {
        match tree.as_text().and_then(|text| Letter::of(text)) {
            Some(letter) => Some(letter),
            None => cx.mismatch("a single letter", tree),
        }
    }
}

impl JsonSchema for Letter {
    fn schema_name() -> Cow<'static, str> {
        "Letter".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let pattern = r"^.$|\$\{";
        json_schema!({ "description": "A single letter of any alphabet.", "type": "string", "pattern": pattern })
    }
}

/// A file, relative to the file that names it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FilePath(pub Arc<str>);

impl Decode for FilePath {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<FilePath> {
        let Some(path) = tree.as_text().filter(|path| !path.trim().is_empty()) else {
            return cx.mismatch("the path of a file", tree);
        };
        if path.contains(['\0', '\n']) {
            return cx.error("the path of a file is one line");
        }
        let span = cx.span();
        cx.files.push(super::super::FileUse {
            path: path.clone(),
            span,
        });
        Some(FilePath(path.clone()))
    }
}

impl JsonSchema for FilePath {
    fn schema_name() -> Cow<'static, str> {
        "File".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "The path of a file, relative to the file that names it; it must lie inside the project.";
        json_schema!({ "description": doc, "type": "string", "minLength": 1 })
    }
}
