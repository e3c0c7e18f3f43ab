//! Shapes that values share: one or many, ranges, points, maps of names, constants or fields.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;

use super::scalar::{Expression, Label, Length, NonNegativeNumber, Number};
use super::types::wants;
use super::{Decode, Decoder, Ref, Tree};

/// The schema of a list of `T`, or an expression that gives one.
fn list_schema<T: JsonSchema>(g: &mut SchemaGenerator, at_least: usize, at_most: Option<usize>) -> Schema {
    let mut list = json_schema!({ "type": "array", "items": g.subschema_for::<T>() });
    if at_least > 0 {
        list.insert("minItems".into(), at_least.into());
    }
    if let Some(at_most) = at_most {
        list.insert("maxItems".into(), at_most.into());
    }
    json_schema!({ "anyOf": [list, g.subschema_for::<Expression>()] })
}

/// A list, may be empty.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
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
        let list = json_schema!({ "type": "array", "items": g.subschema_for::<T>(), "minItems": 1 });
        json_schema!({ "anyOf": [g.subschema_for::<T>(), list] })
    }
}

/// A value, or two between which one is drawn at random: `low <= high`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Range<T> {
    /// The least value.
    pub low: T,
    /// The greatest value; the same as `low` where nothing is drawn.
    pub high: T,
}

impl<T: Decode + Copy + PartialOrd> Decode for Range<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Range<T>> {
        let Some(ends) = tree.as_list() else {
            return T::decode(tree, cx).map(|value| Range { low: value, high: value });
        };
        if ends.len() != 2 {
            return cx.error(format!("a range is `[least, greatest]`, found a list of {}", ends.len()));
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
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Varying<T> {
    /// The same everywhere.
    Constant(T),
    /// The value of a field.
    Field(Ref<wants::Field>),
}

impl<T: Decode> Decode for Varying<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Varying<T>> {
        // A name does not begin as a number does.
        let is_name = |text: &str| text.trim_start().starts_with(|c: char| c.is_alphabetic() || c == '_');
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

/// A map of names in the order of the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Named<T>(pub Vec<(Arc<str>, T)>);

impl<T: Decode> Decode for Named<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Named<T>> {
        let entries = match tree {
            Tree::Map(entries) => &**entries,
            Tree::Null => &[],
            _ => return cx.mismatch("a map of names", tree),
        };
        let decoded: Vec<Option<(Arc<str>, T)>> =
            entries.iter().map(|(name, value)| Some((name.clone(), cx.at(name, |cx| T::decode(value, cx))?))).collect();
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

/// A cycle of label sets: `[a, b]`, or `[[a, x], b]` where one cell has several labels.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct LabelCycle(pub Vec<Vec<Label>>);

impl Decode for LabelCycle {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<LabelCycle> {
        match tree {
            Tree::List(items) => {
                let sets: Vec<OneLabelOrMany> = cx.items(items)?;
                Some(LabelCycle(sets.into_iter().map(|set| set.0).collect()))
            }
            one => Label::decode(one, cx).map(|label| LabelCycle(vec![vec![label]])),
        }
    }
}

impl JsonSchema for LabelCycle {
    fn schema_name() -> Cow<'static, str> {
        "LabelCycle".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let label = g.subschema_for::<Label>();
        let set = json_schema!({ "type": "array", "items": label });
        let list = json_schema!({ "type": "array", "items": { "anyOf": [label, set] } });
        let doc = "Labels that are given in turn: one, or a list that repeats; an item may be a list of several labels at once.";
        json_schema!({ "description": doc, "anyOf": [label, list] })
    }
}

/// The labels of one item of a cycle; may be none.
struct OneLabelOrMany(Vec<Label>);

impl Decode for OneLabelOrMany {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<OneLabelOrMany> {
        match tree {
            Tree::List(items) => cx.items(items).map(OneLabelOrMany),
            one => Label::decode(one, cx).map(|label| OneLabelOrMany(vec![label])),
        }
    }
}

impl JsonSchema for OneLabelOrMany {
    fn schema_name() -> Cow<'static, str> {
        "Labels".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        OneOrMany::<Label>::json_schema(g)
    }
}

/// Labels of which each cell gets one, with weights whose sum is above 0.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct WeightedLabels(pub Vec<(Label, f64)>);

impl Decode for WeightedLabels {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<WeightedLabels> {
        if !matches!(tree, Tree::Map(_)) {
            let labels: OneLabelOrMany = OneLabelOrMany::decode(tree, cx)?;
            return Some(WeightedLabels(labels.0.into_iter().map(|label| (label, 1.0)).collect()));
        }
        let weights: Named<NonNegativeNumber> = Named::decode(tree, cx)?;
        let sum: f64 = weights.iter().map(|(_, weight)| weight.0).sum();
        if weights.is_empty() || (sum > 0.0 && sum.is_finite()) {
            return Some(WeightedLabels(weights.0.into_iter().map(|(name, weight)| (Label(name), weight.0)).collect()));
        }
        cx.error("the weights must have a sum above 0")
    }
}

impl JsonSchema for WeightedLabels {
    fn schema_name() -> Cow<'static, str> {
        "WeightedLabels".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let weights = Named::<NonNegativeNumber>::json_schema(g);
        let doc = "Labels of which each cell gets one at random: a map of labels to weights, a list of equal chances, or one label.";
        let list = OneOrMany::<Label>::json_schema(g);
        json_schema!({ "description": doc, "anyOf": [weights, list] })
    }
}

/// Reads a list of `least` to `N` numbers of type `T`; the rest is `rest`.
fn numbers<T: Decode, const N: usize>(
    tree: &Tree,
    least: usize,
    what: &str,
    value: fn(T) -> f64,
    rest: f64,
    cx: &mut Decoder,
) -> Option<[f64; N]> {
    match tree.as_list() {
        Some(items) if (least..=N).contains(&items.len()) => {
            let mut out = [rest; N];
            let decoded: Vec<T> = cx.items(items)?;
            out.iter_mut().zip(decoded).for_each(|(slot, item)| *slot = value(item));
            Some(out)
        }
        Some(items) => cx.error(format!("expected {what}, found a list of {}", items.len())),
        None => cx.mismatch(what, tree),
    }
}

/// Defines a list of a fixed number of numbers.
macro_rules! tuple {
    ($(#[doc = $doc:literal])* $name:ident($n:literal), $item:ty, $least:literal, $what:literal) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
        #[serde(transparent)]
        pub struct $name(pub [f64; $n]);

        impl Decode for $name {
            fn decode(tree: &Tree, cx: &mut Decoder) -> Option<$name> {
                numbers::<$item, $n>(tree, $least, $what, |item| item.0, 0.0, cx).map($name)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(g: &mut SchemaGenerator) -> Schema {
                let mut schema = list_schema::<$item>(g, $least, Some($n));
                schema.insert("description".into(), super::record::prose(concat!($($doc, "\n"),*)).into());
                schema
            }
        }
    };
}

tuple!(
    /// A point or a step in the plane: `[x, y]`, lengths.
    PlanePoint(2), Length, 2, "a point `[x, y]`"
);
tuple!(
    /// A point or a step in space: `[x, y, z]`, lengths; without `z` it is 0.
    SpacePoint(3), Length, 2, "a point `[x, y, z]`"
);
tuple!(
    /// A vector of plain numbers, `[x, y, z]`.
    Vector(3), Number, 3, "a vector `[x, y, z]`"
);

/// A direction: a vector `[x, y, z]` that is not zero; its length does not matter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Direction(pub [f64; 3]);

impl Decode for Direction {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Direction> {
        let Vector(vector) = Vector::decode(tree, cx)?;
        if vector == [0.0; 3] { cx.error("a direction must not be zero") } else { Some(Direction(vector)) }
    }
}

impl JsonSchema for Direction {
    fn schema_name() -> Cow<'static, str> {
        "Direction".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let doc = "A direction: a vector `[x, y, z]` of plain numbers that is not zero; its length does not matter.";
        let mut schema = Vector::json_schema(g);
        schema.insert("description".into(), doc.into());
        schema
    }
}

/// How many pieces or holes there are to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Target {
    /// As many as come out.
    Any,
    /// This many.
    Exactly(u32),
}

impl Decode for Target {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Target> {
        match tree {
            Tree::Text(word) if &**word == "any" => Some(Target::Any),
            Tree::Int(n) if u32::try_from(*n).is_ok() => u32::try_from(*n).ok().map(Target::Exactly),
            Tree::Float(_) => super::scalar::Natural::decode(tree, cx).map(|n| Target::Exactly(n.0)),
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

/// The values that a script is called with, by name. A text that names an entry stands for its
/// value; other texts are texts.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
    match value {
        Tree::Text(text) => cx.reference(text, <wants::Argument as super::types::Wanted>::TYPES, false),
        Tree::Float(x) if !x.get().is_finite() => cx.error(format!("expected a finite number, found {}", x.get())),
        Tree::List(items) => {
            let done: Vec<Option<()>> = items
                .iter()
                .enumerate()
                .map(|(n, item)| cx.at(&n.to_string(), |cx| note_arguments(item, cx)))
                .collect();
            done.into_iter().collect()
        }
        Tree::Map(entries) => {
            let done: Vec<Option<()>> =
                entries.iter().map(|(key, item)| cx.at(key, |cx| note_arguments(item, cx))).collect();
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
