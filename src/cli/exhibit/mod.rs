//! What a build gave, in the order in which pages and `state.json` show it: specs with their parameters, files by name with
//! what they look like, diagnostics with their source lines, the graph. How it is shown is of no concern here.

mod card;

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use serde_json::Value;

pub use card::{Card, Figure, File, Scope, Sort, measures, stem};

use card::cards;

use super::placed::{Placed, place};
use super::session::Session;
use fretwork_diagnostic::{Diagnostic, render};
use fretwork_engine::{NodeReport, ParamReport, Report, Settable, Settings};
use fretwork_graph::GraphFormat;

/// All that is shown of a build.
#[derive(Clone, Debug, Default)]
pub struct Exhibit {
    /// The specs, in order.
    pub specs: Vec<Spec>,
    /// What is wrong or doubtful.
    pub findings: Vec<Finding>,
    /// The nodes that were needed, by spec, section and name.
    pub nodes: Vec<NodeReport>,
    /// What needs what.
    pub edges: Vec<Edge>,
}

/// A spec.
#[derive(Clone, Debug)]
pub struct Spec {
    /// Its path from the project root.
    pub path: String,
    /// Its parameters with their values.
    pub params: Vec<ParamReport>,
    /// The same, to be asked whether they take a value.
    pub settable: Settable,
    /// Its files.
    pub cards: Vec<Card>,
}

/// A diagnostic and its text for people.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Where it is.
    pub place: Placed,
    /// With source lines.
    pub text: String,
}

/// A node that is needed, as `section.name`, and one that needs it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Edge {
    /// The spec.
    pub spec: String,
    /// What is needed.
    pub from: String,
    /// What needs it.
    pub to: String,
}

impl Exhibit {
    /// What is shown of `report`, whose specs had `settings`.
    pub fn of(
        session: &Session,
        report: &Report,
        settings: &dyn Fn(&str) -> Settings,
        scope: Scope,
    ) -> Exhibit {
        let mut cards = cards(session, &report.artifacts, scope);
        let spec = |path: &String| Spec {
            params: session.compiler.param_reports(path, &settings(path)),
            settable: session.compiler.settable(path),
            cards: cards.remove(path).unwrap_or_default(),
            path: path.clone(),
        };
        Exhibit {
            specs: session.specs.iter().map(spec).collect(),
            findings: findings(session, &report.diagnostics),
            nodes: report.nodes.clone(),
            edges: edges(session, &report.nodes, settings),
        }
    }

    /// Whether nothing is wrong.
    pub fn is_ok(&self) -> bool {
        !self.findings.iter().any(Finding::is_error)
    }

    /// Shows these diagnostics.
    pub fn tell(&mut self, session: &Session, diagnostics: &[Diagnostic]) {
        if self.findings.len() != diagnostics.len() {
            self.findings = findings(session, diagnostics);
        }
    }

    /// Takes the measures of `former` for what is the same.
    pub fn remember(&mut self, former: &Exhibit) {
        for spec in &mut self.specs {
            let Some(old) = former.specs.iter().find(|old| old.path == spec.path) else {
                continue;
            };
            for card in &mut spec.cards {
                let old = old.cards.iter().find(|old| old.is_same(card));
                if let Some(old) = old.filter(|_| card.measures.is_none()) {
                    card.measures = old.measures.clone();
                }
            }
        }
    }

    /// Keeps of `former` what a failed build could not make anew: files that are missing, and the graph where there is none.
    pub fn keep(&mut self, former: &Exhibit) {
        if self.nodes.is_empty() {
            self.nodes = former.nodes.clone();
            self.edges = former.edges.clone();
        }
        if self.specs.is_empty() {
            self.specs = former.specs.clone();
        }
        for spec in &mut self.specs {
            let Some(old) = former.specs.iter().find(|old| old.path == spec.path) else {
                continue;
            };
            if spec.params.is_empty() {
                spec.params = old.params.clone();
                spec.settable = old.settable.clone();
            }
            card::keep(&mut spec.cards, &old.cards);
        }
    }

    /// All files, in order.
    pub fn files(&self) -> impl Iterator<Item = (&Card, &File)> {
        let cards = self.specs.iter().flat_map(|spec| &spec.cards);
        cards.flat_map(|card| card.files.iter().map(move |file| (card, file)))
    }
}

impl Finding {
    /// A diagnostic with its text.
    pub fn of(diagnostic: &Diagnostic, sources: &dyn render::Sources) -> Finding {
        Finding {
            place: place(sources, diagnostic),
            text: render::render(std::slice::from_ref(diagnostic), sources, false),
        }
    }

    /// Whether it is an error.
    pub fn is_error(&self) -> bool {
        self.place.severity == fretwork_diagnostic::Severity::Error
    }
}

fn findings(session: &Session, diagnostics: &[Diagnostic]) -> Vec<Finding> {
    let sources = session.compiler.sources();
    let found = diagnostics.iter().map(|one| Finding::of(one, &sources));
    found.collect()
}

/// The edges between the nodes of a report.
fn edges(
    session: &Session,
    nodes: &[NodeReport],
    settings: &dyn Fn(&str) -> Settings,
) -> Vec<Edge> {
    let mut by_spec: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for node in nodes {
        let names = by_spec.entry(&node.spec).or_default();
        names.insert(format!("{}.{}", node.section, node.name));
    }
    let mut edges = Vec::new();
    for (spec, names) in by_spec {
        let text = session
            .compiler
            .graph(spec, &settings(spec), GraphFormat::Json);
        let graph: Value = serde_json::from_str(&text).unwrap_or_default();
        let all = graph["edges"].as_array().into_iter().flatten();
        edges.extend(all.filter_map(|edge| {
            let end = |key: &str| {
                let name = edge[key].as_str().unwrap_or_default();
                names.contains(name).then(|| name.to_string())
            };
            Some(Edge {
                spec: spec.to_string(),
                from: end("from")?,
                to: end("to")?,
            })
        }));
    }
    edges
}
