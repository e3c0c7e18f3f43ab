//! What a script is handed, as a spec writes it: plain values, and names of nodes that stand for
//! the nodes' values.

use std::sync::Arc;

use crate::from_spec::context::Context;
use crate::from_spec::named::Named;
use crate::script::argument::Argument;
use fretwork_language::value::Arguments;
use fretwork_language::{Tree, Wanted as _, wants};
use fretwork_script::Value;

/// The values of a script's arguments, in the order in which they are written. A text that names a node
/// stands for the value of that node.
pub(crate) fn arguments(arguments: &Arguments, context: &Context<'_>) -> Vec<(Arc<str>, Argument)> {
    arguments
        .0
        .iter()
        .map(|(name, tree)| (name.clone(), argument(tree, context)))
        .collect()
}

/// The value of an argument: text that names a node stands for the node's value.
fn argument(tree: &Tree, context: &Context<'_>) -> Argument {
    match tree {
        Tree::Text(text) => match context.inputs.argument(text, wants::Argument::TYPES) {
            Some(Named::Element(curves)) => Argument::Curves(curves),
            Some(Named::Field(field)) => Argument::Field(field),
            Some(Named::Arrangement(arrangement)) => Argument::Arrangement(arrangement),
            None => Argument::Value(plain(tree)),
        },
        Tree::List(items) => {
            Argument::List(items.iter().map(|item| argument(item, context)).collect())
        }
        tree => Argument::Value(plain(tree)),
    }
}

/// The value of a tree as scripts and expressions see it. Texts that name something stay texts.
fn plain(tree: &Tree) -> Value {
    match tree {
        Tree::Null => Value::None,
        Tree::Bool(b) => Value::Bool(*b),
        Tree::Int(n) => Value::Int(*n),
        Tree::Float(x) => Value::Float(x.get()),
        Tree::Written(_) => plain(tree.plain()),
        Tree::Text(text) => Value::Text(text.clone()),
        Tree::List(items) => Value::List(items.iter().map(plain).collect()),
        Tree::Map(entries) => Value::Dict(
            entries
                .iter()
                .map(|(k, v)| (Value::Text(k.clone()), plain(v)))
                .collect(),
        ),
    }
}
