//! What nodes read of those that they need, where that is not all of it: of a map's region its shapes, or one column of its
//! table; of a force profile what acts on a body. An edit of the rest ends here: what is read is the same as before.

use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::evaluate::{definition_digest, evaluate, value};
use super::job::Job;
use super::settings::Settings;
use super::value::Handle;
use super::written::Written;
use fretwork_action::{Action, Data, Definition, Value};
use fretwork_geometry::{Feature, Region};
use fretwork_graph::NodeId;
use fretwork_language::kinds::fields::Field;
use fretwork_language::kinds::regions::Region as Kind;
use fretwork_language::kinds::shells::Shell;
use fretwork_language::{Node, Section};
use fretwork_store::Digest;

/// What is read of a region with a table: its shapes and labels, and what the table says in one column, if in any.
type Column = Option<Arc<str>>;

/// What a node reads of one that it needs, where that is not all of it.
enum Part {
    /// Of a region.
    Shapes(Column),
    /// Of a force profile: the material, what holds a body and what acts on it, without what must hold.
    Forces,
}

/// What a node reads of one that it needs. None where that is all of it.
fn part_of(db: &dyn Db, reader: &Definition, need: &Job) -> Option<Part> {
    if need.node.section == Section::ForceProfiles {
        // Where a pattern follows the stress.
        let is_pattern = matches!(reader.node, Node::Shell(Shell::Pattern(_)));
        return is_pattern.then_some(Part::Forces);
    }
    if need.node.section != Section::Regions {
        return None;
    }
    let column = match &reader.node {
        Node::Partition(_) | Node::Arrangement(_) => None,
        Node::Field(Field::Attribute(column)) => Some(column.name.0.clone()),
        Node::Field(_) => None,
        _ => return None,
    };
    let has_table = matches!(need.definition(db)?.node, Node::Region(Kind::Geodata(_)));
    has_table.then_some(Part::Shapes(column))
}

/// The digest of what a node reads of one that it needs. None where that failed.
pub fn digest_read(db: &dyn Db, reader: &Definition, need: &Job) -> Option<Digest> {
    match part_of(db, reader, need) {
        Some(part) => Some(read(db, need, part)?.digest),
        None => Some(evaluate(db, need).value?.digest),
    }
}

/// What a node reads of one that it needs. None where that failed.
pub fn value_read(db: &dyn Db, reader: &Definition, need: &Job) -> Option<Value> {
    match part_of(db, reader, need) {
        Some(part) => read(db, need, part)?.get().cloned(),
        None => value(db, need),
    }
}

fn read(db: &dyn Db, need: &Job, part: Part) -> Option<Handle> {
    let (root, settings, node) = (need.root, need.settings.clone(), need.node.clone());
    match part {
        Part::Shapes(column) => read_shapes(db, root, settings, node, column),
        Part::Forces => read_forces(db, root, settings, node),
    }
}

fn whole(db: &dyn Db, root: SourceFile, settings: Settings, node: NodeId) -> Option<Value> {
    let job = Job {
        root,
        settings,
        node,
        region: None,
        window: None,
    };
    value(db, &job)
}

#[salsa::tracked(returns(clone))]
fn read_shapes(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    node: NodeId,
    column: Column,
) -> Option<Handle> {
    let Value::Data(Data::Region(region)) = whole(db, root, settings, node)? else {
        return None;
    };
    let data = Data::Region(Arc::new(only(&region, column.as_ref())));
    let digest = Written::of(&data, false).digest;
    Some(Handle::present(digest, Value::Data(data)))
}

#[salsa::tracked(returns(clone))]
fn read_forces(db: &dyn Db, root: SourceFile, settings: Settings, node: NodeId) -> Option<Handle> {
    let Value::Deferred(action) = whole(db, root, settings, node)? else {
        return None;
    };
    let Node::ForceProfile(profile) = &action.definition.node else {
        return None;
    };
    let definition = Definition {
        node: Node::ForceProfile(profile.forces()),
        ..Definition::clone(&action.definition)
    };
    let digest = definition_digest(&definition);
    let forces = Action {
        definition: Arc::new(definition),
        ..Action::clone(&action)
    };
    Some(Handle::present(digest, Value::Deferred(Arc::new(forces))))
}

/// The region with one column of its table at most. The names of all columns stay for whoever looks for one.
fn only(region: &Region, column: Option<&Arc<str>>) -> Region {
    let attributes = |feature: &Feature| {
        let all = feature.attributes.iter();
        all.filter(|(name, _)| Some(name) == column)
            .cloned()
            .collect()
    };
    let feature = |feature: &Feature| Feature {
        attributes: attributes(feature),
        ..feature.clone()
    };
    Region {
        features: region.features.iter().map(feature).collect(),
        columns: match column {
            Some(_) => region.columns.clone(),
            None => Vec::new(),
        },
        ..region.clone()
    }
}
