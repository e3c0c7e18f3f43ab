//! What scripts are called with.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::types::wants;
use super::super::{Decode, Decoder, Tree};
use super::Named;

/// The values that a script is called with, by name. A text that names an entry stands for its
/// value; other texts are texts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Arguments(pub BTreeMap<Arc<str>, Tree>);

impl Decode for Arguments {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Arguments> {
        let Named(arguments): Named<Tree> = Named::decode(tree, cx)?;
        let mut fine = true;
        for (name, value) in &arguments {
            fine &= cx.at(name, |cx| note_arguments(value, cx)).is_some();
        }
        fine.then(|| Arguments(arguments.into_iter().collect()))
    }
}

/// Notes the texts in an argument as possible references, and refuses numbers that are not finite.
fn note_arguments(value: &Tree, cx: &mut Decoder) -> Option<()> {
    match value.plain() {
        Tree::Text(text) => cx.reference::<wants::Argument>(text, false),
        Tree::Float(x) if !x.get().is_finite() => {
            cx.error(format!("expected a finite number, found {}", x.get()))
        }
        Tree::List(items) => {
            let done: Vec<Option<()>> = items
                .iter()
                .enumerate()
                .map(|(n, item)| cx.at(&n.to_string(), |cx| note_arguments(item, cx)))
                .collect();
            done.into_iter().collect()
        }
        Tree::Map(entries) => {
            let done: Vec<Option<()>> = entries
                .iter()
                .map(|(key, item)| cx.at(key, |cx| note_arguments(item, cx)))
                .collect();
            done.into_iter().collect()
        }
        _ => Some(()),
    }
}

impl JsonSchema for Arguments {
    fn schema_name() -> Cow<'static, str> {
        "Arguments".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "The values that a script is called with, by name: numbers, texts, lists, maps, and names of exemplars, fields, \
            arrangements and regions, which stand for their values.";
        json_schema!({ "description": doc, "type": "object" })
    }
}
