//! What a file says of its modules: `use: { box: parts/box.yaml, with: { width: 40 } }`.

use std::sync::Arc;

use super::document::Use;
use super::entry::check_expressions;
use super::scalar::FilePath;
use super::value::Named;
use super::{Decode, Decoder, Section, Tree};
use fretwork_diagnostic::{Diagnostic, Span};

/// The key of the values for the params of modules; no module has this name.
const WITH: &str = "with";

/// The modules of a file, by one map or a list of maps.
pub(super) fn read_uses(tree: &Tree, file: &Arc<str>, cx: &mut Decoder) -> Vec<Use> {
    let mut uses = Vec::new();
    let top: Vec<Arc<str>> = vec!["use".into()];
    match tree {
        Tree::Null => {}
        Tree::List(items) => {
            for (n, item) in items.iter().enumerate() {
                let n: Arc<str> = n.to_string().into();
                let at = [&top[..], std::slice::from_ref(&n)].concat();
                cx.at(&n, |cx| read_map(item, file, &at, &mut uses, cx));
            }
        }
        _ => read_map(tree, file, &top, &mut uses, cx),
    }
    uses
}

/// Modules that get the same values.
fn read_map(tree: &Tree, file: &Arc<str>, at: &[Arc<str>], uses: &mut Vec<Use>, cx: &mut Decoder) {
    let Some(fields) = tree.as_map() else {
        cx.mismatch::<()>("a map of names to files", tree);
        return;
    };
    let given = tree.get(WITH).map(|with| {
        cx.at(WITH, |cx| {
            check_expressions(with, cx);
            Named::<Tree>::decode(with, cx)
        })
    });
    let with = given.flatten().map_or(Vec::new(), |named| named.0);
    for (name, value) in fields.iter().filter(|(name, _)| **name != *WITH) {
        let place = cx.key_span_of(name);
        if let Some(problem) = problem(name, uses) {
            let message = format!("`{name}` cannot be the name of a module: {problem}");
            cx.push(Diagnostic::error(message).at(place, ""));
            continue;
        }
        let Some(path) = cx.at(name, |cx| FilePath::decode(value, cx)) else {
            continue;
        };
        let span = Span::value(file, &[at, std::slice::from_ref(name)].concat());
        if super::has_expression(&path.0) {
            let message = "the path of a module cannot hold expressions";
            cx.push(Diagnostic::error(message).at(span, ""));
            continue;
        }
        uses.push(Use {
            name: name.clone(),
            path: path.0.clone(),
            with: with.clone(),
            at: at.to_vec(),
            span,
        });
    }
}

/// Why a name cannot be that of a module after the modules `known`.
fn problem(name: &str, known: &[Use]) -> Option<&'static str> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(is_word) {
        Some("it is made of letters, digits, `_` and `-`")
    } else if Section::named(name).is_some() {
        Some("it is that of a section")
    } else if known.iter().any(|module| *module.name == *name) {
        Some("another one has it")
    } else {
        None
    }
}
