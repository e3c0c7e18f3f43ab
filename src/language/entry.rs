//! The entries of sections: their names, seeds and bodies.

use std::sync::Arc;

use super::document::Entry;
use super::scalar::{Integer, Letter, Text};
use super::value::{Named, NonEmpty};
use super::{Decode, DecodeContext, Decoder, Piece, Section, Tree, expression, split};
use fretwork_diagnostic::Diagnostic;

/// More files than this out of one artifact's `each` are refused.
const MAX_COMBINATIONS: usize = 10_000;

pub(super) fn read_section(
    section: Section,
    tree: &Tree,
    entries: &mut Vec<Entry>,
    cx: &mut Decoder,
) {
    let named = match tree {
        Tree::Map(named) => &**named,
        Tree::Null => &[],
        other => {
            cx.mismatch::<()>("a map of names", other);
            return;
        }
    };
    for (name, tree) in named {
        check_name(section, name, cx);
        entries.push(cx.at(name, |cx| {
            check_expressions(tree, cx);
            read_entry(section, name, tree, cx)
        }));
    }
}

fn read_entry(section: Section, name: &Arc<str>, tree: &Tree, cx: &mut Decoder) -> Entry {
    let mut entry = Entry {
        section,
        name: name.clone(),
        seed: None,
        doc: None,
        body: tree.clone(),
    };
    let Tree::Map(fields) = tree else {
        return entry;
    };
    if let Some(seed) = tree.get("seed") {
        entry.seed = cx.at("seed", |cx| read_seed(seed, cx));
    }
    if let Some(doc) = tree.get("doc") {
        entry.doc = cx.at("doc", |cx| Text::decode(doc, cx)).map(|doc| doc.0);
    }
    if entry.seed.is_some() || tree.get("seed").or(tree.get("doc")).is_some() {
        let rest = fields
            .iter()
            .filter(|(key, _)| !matches!(&**key, "seed" | "doc"));
        entry.body = Tree::map(rest.cloned());
    }
    entry
}

/// Names of entries are words; those of symbols letters, those of artifacts paths.
fn check_name(section: Section, name: &str, cx: &mut Decoder) {
    let word = |name: &str| {
        !name.is_empty()
            && name
                .chars()
                .all(|c| c.is_alphanumeric() || c == '_' || c == '-')
    };
    let problem = match section {
        Section::Artifacts => split(name)
            .err()
            .map(|_| "an expression in its name is not closed"),
        Section::Symbols => Letter::of(name)
            .is_none()
            .then_some("the name of a symbol is a single letter"),
        _ if word(name) => None,
        _ => Some("a name is made of letters, digits, `_` and `-`"),
    };
    if let Some(problem) = problem {
        let place = cx.key_span_of(name);
        cx.push(
            Diagnostic::error(format!("`{name}` cannot be a name here: {problem}")).at(place, ""),
        );
    }
}

/// A seed is a whole number, or an expression that gives one.
pub(super) fn read_seed(tree: &Tree, cx: &mut Decoder) -> Option<Tree> {
    match tree {
        Tree::Text(text) if super::has_expression(text) => {
            check_expressions(tree, cx);
            Some(tree.clone())
        }
        _ => seed_value(tree, cx).map(|_| tree.clone()),
    }
}

fn seed_value(tree: &Tree, cx: &mut Decoder) -> Option<u64> {
    let value = Integer::decode(tree, cx)?;
    match u64::try_from(value.0) {
        Ok(seed) => Some(seed),
        Err(_) => cx.error("a seed must not be below 0"),
    }
}

/// The seed of a file or an entry whose expression has been replaced by its value. The path of
/// `context` is that of the file (empty) or the entry.
///
/// # Errors
/// What is not a whole number, 0 or above.
pub fn decode_seed(tree: &Tree, context: &DecodeContext) -> Result<u64, Vec<Diagnostic>> {
    let mut cx = Decoder::new(context);
    let seed = cx.at("seed", |cx| seed_value(tree, cx));
    seed.ok_or(cx.diagnostics)
}

/// The combinations of values of an artifact's `each`: for every file its names and values.
pub type Combinations = Vec<Vec<(Arc<str>, Tree)>>;

/// All combinations of an artifact's `each` (whose own expressions have been replaced), the last
/// name changing fastest. One empty combination where nothing varies.
///
/// # Errors
/// What is not a map of names to lists, and more than 10,000 combinations.
pub fn decode_each(tree: &Tree, context: &DecodeContext) -> Result<Combinations, Vec<Diagnostic>> {
    let mut cx = Decoder::new(context);
    let each = cx.at("each", |cx| {
        let each: Named<NonEmpty<Tree>> = Named::decode(tree, cx)?;
        let total = each
            .iter()
            .map(|(_, values)| values.len())
            .fold(1, usize::saturating_mul);
        if total > MAX_COMBINATIONS {
            return cx.error(format!(
                "`each` asks for {total} files, more than {MAX_COMBINATIONS}"
            ));
        }
        Some(each)
    });
    let mut combinations: Combinations = vec![Vec::new()];
    for (name, values) in each.ok_or(cx.diagnostics)?.0 {
        let longer = |known: &Vec<(Arc<str>, Tree)>, value: &Tree| {
            known
                .iter()
                .cloned()
                .chain([(name.clone(), value.clone())])
                .collect()
        };
        combinations = combinations
            .iter()
            .flat_map(|known| values.iter().map(move |value| longer(known, value)))
            .collect();
    }
    Ok(combinations)
}

/// Reports expressions that are not closed, or empty.
pub(super) fn check_expressions(tree: &Tree, cx: &mut Decoder) {
    match tree {
        Tree::Text(text) => match split(text) {
            Ok(pieces) if pieces.contains(&Piece::Expression(String::new())) => {
                cx.push(expression::empty(cx.span()))
            }
            Ok(_) => {}
            Err(start) => {
                let span = cx.span();
                cx.push(expression::unclosed(text, start, span));
            }
        },
        Tree::List(items) => {
            for (n, item) in items.iter().enumerate() {
                cx.at(&n.to_string(), |cx| check_expressions(item, cx));
            }
        }
        Tree::Map(entries) => entries
            .iter()
            .for_each(|(key, value)| cx.at(key, |cx| check_expressions(value, cx))),
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => {}
    }
}
