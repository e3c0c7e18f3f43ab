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

/// What is read of a region with a table, or of a force profile.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Its shapes and labels.
    Shapes,
    /// These, and what the table says in a column.
    Column(Arc<str>),
    /// The material, what holds a body and what acts on it, without what must hold.
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
    let part = match &reader.node {
        Node::Partition(_) | Node::Arrangement(_) => Part::Shapes,
        Node::Field(Field::Attribute(column)) => Part::Column(column.name.0.clone()),
        Node::Field(_) => Part::Shapes,
        _ => return None,
    };
    let has_table = matches!(need.definition(db)?.node, Node::Region(Kind::Geodata(_)));
    has_table.then_some(part)
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
    read_part(
        db,
        need.root,
        need.settings.clone(),
        need.node.clone(),
        part,
    )
}

#[salsa::tracked(returns(clone))]
fn read_part(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    node: NodeId,
    part: Part,
) -> Option<Handle> {
    let job = Job {
        root,
        settings,
        node,
        region: None,
        window: None,
    };
    match value(db, &job)? {
        Value::Data(Data::Region(region)) => {
            let data = Data::Region(Arc::new(only(&region, &part)));
            let digest = Written::of(&data, false).digest;
            Some(Handle::present(digest, Value::Data(data)))
        }
        Value::Deferred(action) => {
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
        Value::Data(_) => None,
    }
}

/// The region with nothing but a part of what its table says. The names of the columns stay for whoever looks for one.
fn only(region: &Region, part: &Part) -> Region {
    let attributes = |feature: &Feature| match part {
        Part::Shapes | Part::Forces => Vec::new(),
        Part::Column(name) => {
            let all = feature.attributes.iter();
            all.filter(|(column, _)| column == name).cloned().collect()
        }
    };
    let feature = |feature: &Feature| Feature {
        attributes: attributes(feature),
        ..feature.clone()
    };
    let columns = match part {
        Part::Shapes | Part::Forces => Vec::new(),
        Part::Column(_) => region.columns.clone(),
    };
    Region {
        features: region.features.iter().map(feature).collect(),
        columns,
        ..region.clone()
    }
}
