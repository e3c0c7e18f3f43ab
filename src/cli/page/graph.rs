//! The nodes of a spec: what each needs, how its value was come by, and how long that took.

use maud::{Markup, html};

use super::super::exhibit::Edge;
use super::super::terminal::counted;
use super::content::Page;
use fretwork_engine::{NodeReport, NodeStatus};

/// The graph of a spec; nothing where no node of it was needed.
pub fn shown(page: &Page<'_>, spec: &str) -> Markup {
    let all = page.exhibit.nodes.iter();
    let nodes: Vec<&NodeReport> = all.filter(|node| node.spec == spec).collect();
    let longest = nodes.iter().map(|node| node.ms).fold(1.0, f64::max);
    html! {
        @if !nodes.is_empty() {
            details.graph data-keep={ "graph " (spec) } data-part={ "graph " (spec) } {
                summary { "Graph " span.quiet { (summary(page, &nodes)) } }
                div.scroll { table {
                    @for node in &nodes { (row(page, node, longest)) }
                } }
            }
        }
    }
}

fn summary(page: &Page<'_>, nodes: &[&NodeReport]) -> String {
    let count = counted(nodes.len(), "node");
    if page.is_stable {
        return count;
    }
    let ran = nodes.iter().filter(|node| node.was_evaluated()).count();
    let ms: f64 = nodes.iter().map(|node| node.ms).sum();
    format!("{count}, {ran} evaluated, {ms:.0} ms")
}

fn row(page: &Page<'_>, node: &NodeReport, longest: f64) -> Markup {
    let name = format!("{}.{}", node.section, node.name);
    let is_own = |edge: &&Edge| edge.spec == node.spec && edge.to == name;
    let needs: Vec<&str> = (page.exhibit.edges.iter().filter(is_own))
        .map(|edge| &*edge.from)
        .collect();
    html! {
        tr data-node=(node.name) data-id=(name) data-needs=(needs.join(" ")) data-status=(status(node.status)) tabindex="0" {
            th { span.quiet { (node.section) "." } (node.name) }
            td { (node.kind) }
            td.needs { @for (n, need) in needs.iter().enumerate() {
                @if n > 0 { ", " }
                (need.split_once('.').map_or(*need, |(_, name)| name))
            } }
            @if !page.is_stable {
                td { span.dot {} (status(node.status)) }
                td.number { (format!("{:.1} ms", node.ms)) }
                td.bar { meter min="0" max="1" value=(format!("{:.3}", node.ms / longest)) {} }
            }
        }
    }
}

fn status(status: NodeStatus) -> &'static str {
    match status {
        NodeStatus::Reused => "reused",
        NodeStatus::Cached => "cached",
        NodeStatus::Evaluated => "evaluated",
    }
}
