//! The graph as text for other tools.

use std::fmt::Write as _;

use serde_json::json;

use super::{Linked, NodeId};

/// A text format of graphs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraphFormat {
    /// Graphviz.
    Dot,
    /// Mermaid flowchart.
    Mermaid,
    /// `{ "nodes": [ { "section", "name", "kind", "type" } ], "edges": [ { "from", "to" } ] }`.
    Json,
}

/// The graph in `format`. Edges run from what is needed to what needs it. `describe` gives the
/// kind and the type of a node.
pub fn export(
    linked: &Linked,
    format: GraphFormat,
    describe: impl Fn(&NodeId) -> (String, String),
) -> String {
    let ids: Vec<&NodeId> = linked.targets.keys().collect();
    let mut edges: Vec<(&NodeId, &NodeId)> = linked
        .targets
        .iter()
        .flat_map(|(to, from)| from.iter().flatten().map(move |from| (from, to)))
        .collect();
    edges.sort();
    edges.dedup();
    match format {
        GraphFormat::Dot => dot(&ids, &edges, describe),
        GraphFormat::Mermaid => mermaid(&ids, &edges, describe),
        GraphFormat::Json => json(&ids, &edges, describe),
    }
}

fn dot(
    ids: &[&NodeId],
    edges: &[(&NodeId, &NodeId)],
    describe: impl Fn(&NodeId) -> (String, String),
) -> String {
    let mut out = String::from("digraph spec {\n  rankdir=LR;\n  node [shape=box];\n");
    for id in ids {
        let (kind, _) = describe(id);
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "  {:?} [label={:?}];",
            id.to_string(),
            format!("{}\n{kind}", id.name)
        );
    }
    for (from, to) in edges {
        let _ = writeln!(out, "  {:?} -> {:?};", from.to_string(), to.to_string());
    }
    out + "}\n"
}

fn mermaid(
    ids: &[&NodeId],
    edges: &[(&NodeId, &NodeId)],
    describe: impl Fn(&NodeId) -> (String, String),
) -> String {
    let mut out = String::from("flowchart LR\n");
    let number = |id: &NodeId| {
        ids.binary_search(&id)
            .expect("edges run between nodes of the graph")
    };
    for (i, id) in ids.iter().enumerate() {
        let name = id.name.replace('"', "#quot;");
        let _ = writeln!(out, "  n{i}[\"{name}<br/>{}\"]", describe(id).0);
    }
    for (from, to) in edges {
        let _ = writeln!(out, "  n{} --> n{}", number(from), number(to));
    }
    out
}

fn json(
    ids: &[&NodeId],
    edges: &[(&NodeId, &NodeId)],
    describe: impl Fn(&NodeId) -> (String, String),
) -> String {
    let nodes: Vec<_> = ids
        .iter()
        .map(|id| {
            let (kind, provides) = describe(id);
            json!({ "section": id.section.name(), "name": *id.name, "kind": kind, "type": provides })
        })
        .collect();
    let edges: Vec<_> = edges
        .iter()
        .map(|(from, to)| json!({ "from": from.to_string(), "to": to.to_string() }))
        .collect();
    let graph = json!({ "nodes": nodes, "edges": edges });
    serde_json::to_string_pretty(&graph).expect("a JSON value can be written") + "\n"
}
