//! Lists and maps of one type.

use std::borrow::Cow;
use std::ops::Deref;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::scalar::Expression;
use super::super::{Decode, Decoder, Tree};

/// A list, may be empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct List<T>(pub Vec<T>);

impl<T: Decode> Decode for List<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<List<T>> {
        match tree.as_list() {
            Some(items) => cx.items(items).map(List),
            None => cx.mismatch("a list", tree),
        }
    }
}

impl<T> Deref for List<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T: JsonSchema> JsonSchema for List<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("ListOf{}", T::schema_name()).into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        list_schema::<T>(g, 0, None)
    }
}

/// A list of at least one item.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct NonEmpty<T>(pub Vec<T>);

impl<T: Decode> Decode for NonEmpty<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<NonEmpty<T>> {
        match tree.as_list() {
            Some([]) => cx.error("expected at least one item, found an empty list"),
            Some(items) => cx.items(items).map(NonEmpty),
            None => cx.mismatch("a list", tree),
        }
    }
}

impl<T> Deref for NonEmpty<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T: JsonSchema> JsonSchema for NonEmpty<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("NonEmptyListOf{}", T::schema_name()).into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        list_schema::<T>(g, 1, None)
    }
}

/// One value, or a list of at least one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct OneOrMany<T>(pub Vec<T>);

impl<T: Decode> Decode for OneOrMany<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<OneOrMany<T>> {
        match tree {
            Tree::List(_) => NonEmpty::decode(tree, cx).map(|list: NonEmpty<T>| OneOrMany(list.0)),
            one => T::decode(one, cx).map(|one| OneOrMany(vec![one])),
        }
    }
}

impl<T> Deref for OneOrMany<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T: JsonSchema> JsonSchema for OneOrMany<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("OneOrMany{}", T::schema_name()).into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let list =
            json_schema!({ "type": "array", "items": g.subschema_for::<T>(), "minItems": 1 });
        json_schema!({ "anyOf": [g.subschema_for::<T>(), list] })
    }
}

/// A map of names in the order of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Named<T>(pub Vec<(Arc<str>, T)>);

impl<T: Decode> Decode for Named<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Named<T>> {
        let entries = match tree {
            Tree::Map(entries) => &**entries,
            Tree::Null => &[],
            _ => return cx.mismatch("a map of names", tree),
        };
        let decoded: Vec<Option<(Arc<str>, T)>> = entries
            .iter()
            .map(|(name, value)| Some((name.clone(), cx.at(name, |cx| T::decode(value, cx))?)))
            .collect();
        decoded.into_iter().collect::<Option<_>>().map(Named)
    }
}

impl<T> Deref for Named<T> {
    type Target = [(Arc<str>, T)];
    fn deref(&self) -> &[(Arc<str>, T)] {
        &self.0
    }
}

impl<T: JsonSchema> JsonSchema for Named<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("MapOf{}", T::schema_name()).into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "object", "additionalProperties": g.subschema_for::<T>() })
    }
}

/// The schema of a list of `T`, or an expression that gives one.
pub(super) fn list_schema<T: JsonSchema>(
    g: &mut SchemaGenerator,
    at_least: usize,
    at_most: Option<usize>,
) -> Schema {
    let mut list = json_schema!({ "type": "array", "items": g.subschema_for::<T>() });
    if at_least > 0 {
        list.insert("minItems".into(), at_least.into());
    }
    if let Some(at_most) = at_most {
        list.insert("maxItems".into(), at_most.into());
    }
    json_schema!({ "anyOf": [list, g.subschema_for::<Expression>()] })
}
