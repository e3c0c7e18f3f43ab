//! Elements by id, label and condition.

use std::collections::HashMap;

use roxmltree::{Document, Node};

use super::document::{INKSCAPE, name};
use super::report::{Report, tag_range};
use fretwork_diagnostic::Diagnostic;

/// Whether the element's conditions hold for a program that knows no extensions.
pub fn passes(node: Node) -> bool {
    let english = |list: &str| list.split(',').any(|l| l.trim().starts_with("en"));
    node.attribute("requiredExtensions")
        .is_none_or(|e| e.trim().is_empty())
        && node.attribute("systemLanguage").is_none_or(english)
}

/// `data-label`, else `inkscape:label`.
pub fn explicit_label<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    node.attribute("data-label")
        .or(node.attribute((INKSCAPE, "label")))
}

/// Every element with an `id`; the first of an id counts.
pub fn ids<'a, 'input>(document: &'a Document<'input>) -> HashMap<&'a str, Node<'a, 'input>> {
    let mut ids = HashMap::new();
    for node in document.descendants() {
        if let Some(id) = node.attribute("id") {
            ids.entry(id).or_insert(node);
        }
    }
    ids
}

/// The element to read alone.
pub fn find<'a, 'input>(
    document: &'a Document<'input>,
    id: &str,
    report: &mut Report,
) -> Result<Node<'a, 'input>, Diagnostic> {
    let named = |by: &dyn Fn(Node<'a, 'input>) -> Option<&'a str>| -> Vec<Node<'a, 'input>> {
        document
            .descendants()
            .filter(|n| name(*n).is_some() && by(*n) == Some(id))
            .collect()
    };
    let mut hits = named(&|n| n.attribute("id"));
    if hits.is_empty() {
        hits = named(&|n| n.attribute("data-label"));
    }
    if hits.is_empty() {
        hits = named(&|n| n.attribute((INKSCAPE, "label")));
    }
    let Some(&first) = hits.first() else {
        let names = document
            .descendants()
            .flat_map(|n| [n.attribute("id"), explicit_label(n)])
            .flatten();
        let error = Diagnostic::error(format!("no element `{id}` is in the drawing"));
        let error = error.at(report.span(tag_range(document.root_element())), "");
        return Err(error.suggest(id, sorted(names)));
    };
    if hits.len() > 1 {
        let message = format!("{} elements are named `{id}`", hits.len());
        report.warn(tag_range(first), message, "the first is taken");
    }
    Ok(first)
}

/// The distinct names in order.
pub fn sorted<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names: Vec<&str> = names.collect();
    names.sort_unstable();
    names.dedup();
    names
}
