//! What stands in a file beside its sections: version, params, lets, includes.

use std::sync::Arc;

use super::document::{Document, Include, VERSION};
use super::entry::check_expressions;
use super::scalar::FilePath;
use super::value::{Named, OneOrMany};
use super::{Decode, Decoder, Param, Tree};
use fretwork_diagnostic::{Diagnostic, Span};

pub(super) fn check_version(tree: &Tree, file: &Arc<str>, diagnostics: &mut Vec<Diagnostic>) {
    let path = ["fretwork".into()];
    let error = match tree.get("fretwork").map(Tree::plain) {
        Some(Tree::Int(VERSION)) => return,
        None => Diagnostic::error("the file does not say which version of the language it is in")
            .at(Span::File(file.clone()), "")
            .help(format!("begin it with `fretwork: {VERSION}`")),
        Some(Tree::Int(other)) => Diagnostic::error(format!(
            "this fretwork reads version {VERSION} of the language, not {other}"
        ))
        .at(Span::value(file, &path), ""),
        Some(other) => Diagnostic::error(format!(
            "the version must be {VERSION}, not {}",
            other.describe()
        ))
        .at(Span::value(file, &path), ""),
    };
    diagnostics.push(error);
}

pub(super) fn read_params(tree: &Tree, cx: &mut Decoder) -> Vec<Param> {
    let named: Option<Named<Tree>> = Named::decode(tree, cx);
    let mut params = Vec::new();
    for (name, tree) in named.map_or(Vec::new(), |named| named.0) {
        check_variable(&name, cx);
        params.extend(cx.at(&name, |cx| Param::read(&name, &tree, cx)));
    }
    params
}

pub(super) fn read_lets(tree: &Tree, cx: &mut Decoder) -> Vec<(Arc<str>, Tree)> {
    let named: Option<Named<Tree>> = Named::decode(tree, cx);
    let lets = named.map_or(Vec::new(), |named| named.0);
    for (name, tree) in &lets {
        check_variable(name, cx);
        cx.at(name, |cx| check_expressions(tree, cx));
    }
    lets
}

/// No name is a param and a let.
pub(super) fn check_lets(document: &Document, cx: &mut Decoder) {
    for (name, _) in document
        .lets
        .iter()
        .filter(|(name, _)| document.params.iter().any(|param| param.name == *name))
    {
        let here = cx.at("let", |cx| cx.key_span_of(name));
        let there = cx.at("params", |cx| cx.key_span_of(name));
        cx.push(
            Diagnostic::error(format!("`{name}` is both a param and a let"))
                .at(here, "")
                .at(there, "the param"),
        );
    }
}

/// Params and lets are variables of expressions.
fn check_variable(name: &str, cx: &mut Decoder) {
    const TAKEN: [&str; 27] = [
        "and", "break", "continue", "def", "elif", "else", "for", "if", "in", "lambda", "load",
        "not", "or", "pass", "return", "while", "as", "assert", "class", "del", "except", "import",
        "is", "None", "True", "False", "pi",
    ];
    let mut chars = name.chars();
    let starts = chars
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    let problem = if !starts || !chars.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        "it must be letters, digits and `_`, without a digit at its start"
    } else if TAKEN.contains(&name) || name == "deg" {
        "the word has a meaning of its own in expressions"
    } else {
        return;
    };
    let place = cx.key_span_of(name);
    cx.push(Diagnostic::error(format!("`{name}` cannot be a variable: {problem}")).at(place, ""));
}

pub(super) fn read_includes(tree: &Tree, file: &Arc<str>, cx: &mut Decoder) -> Vec<Include> {
    let paths: Option<OneOrMany<FilePath>> = match tree {
        Tree::Null => None,
        Tree::List(items) if items.is_empty() => None,
        _ => OneOrMany::decode(tree, cx),
    };
    let single = !matches!(tree, Tree::List(_));
    let mut includes = Vec::new();
    for (n, path) in paths.iter().flat_map(|paths| paths.iter()).enumerate() {
        let steps: Vec<Arc<str>> = ["include".into()]
            .into_iter()
            .chain((!single).then(|| n.to_string().into()))
            .collect();
        let span = Span::value(file, &steps);
        if super::has_expression(&path.0) {
            cx.push(
                Diagnostic::error("the path of an include cannot hold expressions").at(span, ""),
            );
        } else {
            includes.push(Include {
                path: path.0.clone(),
                span,
            });
        }
    }
    includes
}
