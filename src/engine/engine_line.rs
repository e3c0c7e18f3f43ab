//! What is said about how an arrangement is drawn (rule E7).

use super::compile::Compiler;
use super::evaluate::value;
use super::job::Job;
use super::settings::Settings;
use fretwork_action::Value;
use fretwork_diagnostic::Span;
use fretwork_diagnostic::render::position;
use fretwork_geometry::Point;
use fretwork_graph::NodeId;
use fretwork_language::ValueType;
use fretwork_stage::tiling::{Engine, engine};

impl Compiler {
    /// A line on how the arrangement `node` of a spec is drawn, given as `name` or `section.name`. None for other nodes.
    pub(super) fn engine_of(&self, spec: &str, node: &str, settings: &Settings) -> Option<String> {
        let root = self.root(spec);
        let linked = super::definition::linked(&self.database, root, settings.clone());
        let is_meant = |id: &&NodeId| *id.name == *node || id.to_string() == node;
        let ids = linked.targets.keys().filter(is_meant);
        let job = |id: &NodeId| Job {
            root,
            settings: settings.clone(),
            node: id.clone(),
            region: None,
            window: None,
        };
        let is_arrangement = |job: &Job| {
            let definition = job.definition(&self.database);
            definition.is_some_and(|d| d.node.provides() == ValueType::Arrangement)
        };
        let job = ids.map(job).find(is_arrangement)?;
        let Some(Value::Deferred(action)) = value(&self.database, &job) else {
            return None;
        };
        Some(match engine(&action)? {
            Engine::Tiled {
                periods: [v, w],
                cells,
            } => {
                let shown = |p: Point| format!("({}, {})", rounded(p.x), rounded(p.y));
                format!(
                    "engine: tiled, period {} and {}, {cells} cells a tile",
                    shown(v),
                    shown(w)
                )
            }
            Engine::General(why) => {
                // What lies in several nodes is told at the one that puts them together.
                let place = self.place(&why.span.unwrap_or_else(|| action.span()));
                format!("engine: general, because {} ({place})", why.text)
            }
        })
    }

    /// A place as file and line.
    fn place(&self, span: &Span) -> String {
        let file = span.file();
        match position(span, &self.sources()) {
            Some((line, _)) => format!("{file}:{line}"),
            None => file.to_string(),
        }
    }
}

/// A coordinate for people.
fn rounded(x: f64) -> f64 {
    let rounded = libm::round(x * 1e6) / 1e6;
    // Adding 0 turns a negative zero into the other.
    rounded + 0.0
}
