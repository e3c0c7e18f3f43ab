//! The expressions of a tree, and their values in its place.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::values::Scope;
use crate::database::Db;
use crate::ruler::{Fonts, OwnLetters};
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_language::Tree;
use fretwork_script::{Value, free_names};

/// `tree`, which stands at `place`, a path in a file, with its expressions replaced by their values.
///
/// # Errors
/// One diagnostic for each expression that fails; those that fail only because a name they use has
/// failed before are silent.
pub fn evaluate_tree(
    db: &dyn Db,
    tree: &Tree,
    place: (&Arc<str>, &[Arc<str>]),
    scope: &Scope,
) -> Result<Tree, Vec<Diagnostic>> {
    evaluate_lettered(db, tree, place, scope, OwnLetters::default())
}

/// The same in an entry with letters of its own.
///
/// # Errors
/// As [`evaluate_tree`].
pub fn evaluate_lettered(
    db: &dyn Db,
    tree: &Tree,
    (file, path): (&Arc<str>, &[Arc<str>]),
    scope: &Scope,
    own: OwnLetters,
) -> Result<Tree, Vec<Diagnostic>> {
    let mut fonts = Fonts::new(db, file, own);
    let mut follow_ups = BTreeSet::new();
    let (mut left, mut is_full) = (LARGEST_VALUE, false);
    let mut value_of = |text: &str, at: &[Arc<str>]| {
        if is_full {
            let silent = Diagnostic::error("there are too many elements already");
            follow_ups.insert(silent.clone());
            return Err(silent);
        }
        fonts
            .evaluate(text, &scope.values)
            .map(|value| to_tree(&value))
            .map_err(|error| {
                let diagnostic = Diagnostic::error(error.message)
                    .about(Code::Script)
                    .at(Span::value(file, at), "in this expression");
                let diagnostic = error.help.into_iter().fold(diagnostic, Diagnostic::help);
                let names = free_names(text).unwrap_or_default();
                if names
                    .iter()
                    .any(|name| scope.failed.contains(name.as_str()))
                {
                    follow_ups.insert(diagnostic.clone());
                }
                diagnostic
            })
            .and_then(|tree| match left.checked_sub(size(&tree)) {
                Some(rest) => {
                    left = rest;
                    Ok(tree)
                }
                None => {
                    is_full = true;
                    let message = format!("the value has more than {LARGEST_VALUE} elements");
                    Err(Diagnostic::error(message)
                        .at(Span::value(file, at), "with this expression"))
                }
            })
    };
    let mut at = path.to_vec();
    fretwork_language::substitute(tree, file, &mut at, &mut value_of).map_err(|mut diagnostics| {
        diagnostics.retain(|d| !follow_ups.contains(d));
        diagnostics
    })
}

/// The expressions of one value may give so many elements together.
const LARGEST_VALUE: usize = 1 << 20;

/// How many elements a value has with all that is in it; a text counts one for every eight bytes.
pub fn size(tree: &Tree) -> usize {
    match tree {
        Tree::Text(text) => 1 + text.len() / 8,
        Tree::List(items) => items.iter().map(size).fold(1, usize::saturating_add),
        Tree::Map(entries) => {
            let values = entries
                .iter()
                .map(|(key, value)| key.len() / 8 + size(value));
            values.fold(1, usize::saturating_add)
        }
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => 1,
    }
}

/// The value that a tree is in expressions.
pub fn to_value(tree: &Tree) -> Value {
    match tree {
        Tree::Null => Value::None,
        Tree::Bool(b) => Value::Bool(*b),
        Tree::Int(n) => Value::Int(*n),
        Tree::Float(x) => Value::Float(x.get()),
        Tree::Written(_) => to_value(tree.plain()),
        Tree::Text(text) => Value::Text(text.clone()),
        Tree::List(items) => Value::List(items.iter().map(to_value).collect()),
        Tree::Map(entries) => Value::Dict(
            entries
                .iter()
                .map(|(k, v)| (Value::Text(k.clone()), to_value(v)))
                .collect(),
        ),
    }
}

fn to_tree(value: &Value) -> Tree {
    match value {
        Value::None => Tree::Null,
        Value::Bool(b) => Tree::Bool(*b),
        Value::Int(n) => Tree::Int(*n),
        Value::Float(x) => Tree::from(*x),
        Value::Text(text) => Tree::Text(text.clone()),
        Value::List(items) => Tree::list(items.iter().map(to_tree)),
        Value::Dict(entries) => {
            let key = |k: &Value| to_tree(k).to_text().unwrap_or_default();
            Tree::map(entries.iter().map(|(k, v)| (key(k), to_tree(v))))
        }
    }
}
