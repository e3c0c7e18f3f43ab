//! Which arrangements are drawn by tiles (rule E2). These take their inputs as functions: what is repeated is drawn once,
//! and no input has to be drawn on the whole region first.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::definition::definition;
use super::evaluate::value;
use super::job::Job;
use super::settings::Settings;
use fretwork_action::{Definition, EngineChoice, Value};
use fretwork_graph::NodeId;
use fretwork_language::kinds::arrangements::Arrangement;
use fretwork_language::kinds::partitions::{Partition, Stripes};
use fretwork_language::value::Varying;
use fretwork_language::{Node, ValueType};
use fretwork_stage::tiling::Engine;

/// An arrangement is put together of at most so many others. Where it is of more, each one is drawn and kept.
const NODES: usize = 64;

/// Whether a node is drawn by tiles where it is applied to a region that is large enough.
#[salsa::tracked]
pub fn is_tiled(db: &dyn Db, root: SourceFile, settings: Settings, node: NodeId) -> bool {
    if db.engine() == EngineChoice::General {
        return false;
    }
    let job = Job {
        root,
        settings,
        node,
        region: None,
        window: None,
    };
    if !may_be_tiled(db, &job) {
        return false;
    }
    match value(db, &job) {
        Some(Value::Deferred(action)) => {
            let engine = fretwork_stage::tiling::engine(&action);
            matches!(engine, Some(Engine::Tiled { .. }))
        }
        _ => false,
    }
}

/// Whether it is made of grids and stripes of plain numbers alone, as far as definitions tell.
fn may_be_tiled(db: &dyn Db, job: &Job) -> bool {
    let (mut open, mut seen) = (vec![job.node.clone()], BTreeSet::new());
    while let Some(node) = open.pop() {
        let of_node = definition(db, job.root, job.settings.clone(), node.clone());
        let Some(of_node) = of_node else {
            return false;
        };
        if !may_be_part(&of_node) {
            return false;
        }
        if seen.insert(node) {
            open.extend(arrangements(db, job, &of_node));
        }
        if seen.len() > NODES {
            return false;
        }
    }
    true
}

fn may_be_part(definition: &Arc<Definition>) -> bool {
    let is_constant = |lines: &Stripes| {
        let is_plain = |spacing: &Varying<_>| matches!(spacing, Varying::Constant(_));
        matches!(lines.angle, Varying::Constant(_)) && lines.spacing.iter().all(is_plain)
    };
    match &definition.node {
        Node::Partition(Partition::Grid(grid)) => {
            is_constant(&grid.across) && is_constant(&grid.along)
        }
        Node::Partition(Partition::Stripes(stripes)) => is_constant(&stripes.lines),
        Node::Arrangement(Arrangement::Connect(_) | Arrangement::Wrap(_)) => false,
        Node::Arrangement(_) => true,
        _ => false,
    }
}

/// What a node names that is no element: arrangements, and fields and regions, which end it.
fn arrangements(db: &dyn Db, job: &Job, of_node: &Definition) -> Vec<NodeId> {
    let is_element = |target: &&NodeId| {
        let named = definition(db, job.root, job.settings.clone(), (*target).clone());
        named.is_some_and(|named| named.node.provides() == ValueType::VectorExemplar)
    };
    let targets = of_node.targets().filter(|target| !is_element(target));
    targets.cloned().collect()
}
