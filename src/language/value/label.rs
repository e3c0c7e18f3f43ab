//! Labels that partitions give to cells.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::scalar::{Label, NonNegativeNumber};
use super::super::{Decode, Decoder, Tree};
use super::{Named, OneOrMany};

/// A cycle of label sets: `[a, b]`, or `[[a, x], b]` where one cell has several labels.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct WeightedLabels(pub Vec<(Label, f64)>);

impl Decode for WeightedLabels {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<WeightedLabels> {
        if !matches!(tree, Tree::Map(_)) {
            let labels: OneLabelOrMany = OneLabelOrMany::decode(tree, cx)?;
            return Some(WeightedLabels(
                labels.0.into_iter().map(|label| (label, 1.0)).collect(),
            ));
        }
        let weights: Named<NonNegativeNumber> = Named::decode(tree, cx)?;
        let sum: f64 = weights.iter().map(|(_, weight)| weight.0).sum();
        if weights.is_empty() || (sum > 0.0 && sum.is_finite()) {
            return Some(WeightedLabels(
                weights
                    .0
                    .into_iter()
                    .map(|(name, weight)| (Label(name), weight.0))
                    .collect(),
            ));
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
