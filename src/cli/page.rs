//! The page of a report as HTML: pictures with their files and measures, diagnostics with their source lines, the graph's
//! nodes. It needs no script and asks nothing of anybody.

use std::collections::BTreeMap;
use std::sync::Arc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};
use serde_json::Value;

use super::page_diff::Changes;
use super::placed::Placed;
use fretwork_diagnostic::Severity;
use fretwork_engine::{NodeReport, NodeStatus};

/// What every page begins with.
pub const HEAD: &str = "<!DOCTYPE html><html lang=\"en\" data-page=\"fretwork report\">";

/// No request leaves the page: pictures and style are in it.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";

/// What the page shows.
pub struct Page<'a> {
    /// Files by name.
    pub cards: Vec<Card>,
    /// What differs from a revision.
    pub changes: Option<Changes>,
    /// What is wrong or doubtful.
    pub findings: Vec<Finding>,
    /// The nodes of the build.
    pub nodes: &'a [NodeReport],
    /// Whether times are left out.
    pub is_stable: bool,
}

/// The files of one name.
pub struct Card {
    /// The spec that gives them.
    pub spec: String,
    /// Their path without its ending.
    pub name: String,
    /// What they look like.
    pub picture: Option<Picture>,
    /// Paths and sizes.
    pub files: Vec<(String, usize)>,
    /// The recipe of each file that names its origin, by its path.
    pub recipes: BTreeMap<String, Arc<str>>,
    /// Measures, if one of the files holds them.
    pub measures: Option<Value>,
}

/// A picture's file.
pub struct Picture {
    media: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

/// A diagnostic and its text for people.
pub struct Finding {
    /// Where it is.
    pub place: Placed,
    /// With source lines.
    pub text: String,
}

impl Picture {
    /// A PNG file.
    pub fn png(bytes: &[u8]) -> Picture {
        Picture {
            media: "image/png",
            bytes: bytes.to_vec(),
        }
    }

    /// An SVG file.
    pub fn svg(bytes: &[u8]) -> Picture {
        Picture {
            media: "image/svg+xml",
            bytes: bytes.to_vec(),
        }
    }

    fn uri(&self) -> String {
        format!(
            "data:{};base64,{}",
            self.media,
            STANDARD.encode(&self.bytes)
        )
    }
}

/// The page.
pub fn render(page: &Page<'_>) -> String {
    let errors = count(page, Severity::Error);
    let warnings = count(page, Severity::Warning);
    let content = html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta http-equiv="Content-Security-Policy" content=(POLICY);
            title { "fretwork report" }
            style { (PreEscaped(include_str!("page/style.css"))) }
        }
        body {
            header {
                h1 { "fretwork" }
                p {
                    (page.cards.iter().map(|card| card.files.len()).sum::<usize>()) " files, "
                    span.error[errors > 0] { (errors) " errors" } ", "
                    span.warning[warnings > 0] { (warnings) " warnings" }
                }
                nav {
                    @if !page.findings.is_empty() { a href="#findings" { "diagnostics" } " " }
                    @if page.changes.is_some() { a href="#changes" { "changes" } " " }
                    a href="#artifacts" { "artifacts" } " "
                    a href="#nodes" { "graph" }
                }
            }
            main {
                @if !page.findings.is_empty() {
                    section #findings {
                        h2 { "Diagnostics" }
                        @for finding in &page.findings { (shown_finding(finding)) }
                    }
                }
                @if let Some(changes) = &page.changes { (changes.section()) }
                section #artifacts {
                    h2 { "Artifacts" }
                    @for cards in page.cards.chunk_by(|a, b| a.spec == b.spec) {
                        h3 { (cards[0].spec) }
                        div.cards { @for card in cards { (shown_card(card)) } }
                    }
                }
                section #nodes {
                    h2 { "Graph" }
                    (nodes(page))
                }
            }
        }
    };
    format!("{HEAD}{}</html>\n", content.into_string())
}

fn count(page: &Page<'_>, severity: Severity) -> usize {
    let of = |finding: &&Finding| finding.place.severity == severity;
    page.findings.iter().filter(of).count()
}

fn shown_finding(finding: &Finding) -> Markup {
    let place = &finding.place;
    html! {
        details.finding data-diagnostic=(place.code) data-severity=(severity(place.severity)) open {
            summary {
                span.tag { (place.code) } " " (place.message)
            }
            pre { (finding.text.trim_end()) }
        }
    }
}

fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    }
}

fn shown_card(card: &Card) -> Markup {
    let name = card.name.rsplit('/').next().unwrap_or(&card.name);
    html! {
        article {
            @match &card.picture {
                Some(picture) => {
                    div.picture { img alt=(name) loading="lazy" src=(picture.uri()); }
                }
                None => div.picture.none { "no picture" },
            }
            h4 { (name) }
            ul {
                @for (path, bytes) in &card.files {
                    li data-artifact=(path) {
                        (path.rsplit('/').next().unwrap_or(path)) " " span.quiet { (size(*bytes)) }
                        @if let Some(recipe) = card.recipes.get(path) { " " code.quiet data-recipe=(recipe) title="recipe" { (recipe) } }
                    }
                }
            }
            @if let Some(Value::Object(measures)) = &card.measures {
                details {
                    summary { "measures" }
                    table {
                        @for (measure, value) in measures {
                            tr { th { (measure) } td { (value.to_string()) } }
                        }
                    }
                }
            }
        }
    }
}

fn size(bytes: usize) -> String {
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..1_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// The nodes of each spec, the slowest of which has the longest bar.
fn nodes(page: &Page<'_>) -> Markup {
    let longest = page.nodes.iter().map(|node| node.ms).fold(1.0, f64::max);
    html! {
        @for nodes in page.nodes.chunk_by(|a, b| a.spec == b.spec) {
            details {
                summary { (nodes[0].spec) " " span.quiet { (nodes.len()) " nodes" } }
                table.nodes {
                    @for node in nodes {
                        tr data-node=(node.name) data-status=(status(node.status)) {
                            th { (node.section) "." (node.name) }
                            td { (node.kind) }
                            @if !page.is_stable {
                                td { (status(node.status)) }
                                td.number { (format!("{:.1} ms", node.ms)) }
                                td.bar { meter min="0" max="1" value=(format!("{:.3}", node.ms / longest)) {} }
                            }
                        }
                    }
                }
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
