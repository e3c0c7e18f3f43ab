//! Actions put together: a job's definition with the values of all that it needs and the bytes of its
//! files, so that a stage asks for nothing.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::database::Db;
use super::job::Job;
use super::origin;
use super::part_read::value_read;
use super::target;
use fretwork_action::{Action, Definition, Files, Memo, Value};
use fretwork_graph::NodeId;
use fretwork_language::{Node, Section};

/// The action of a job. None when a file cannot be read or an input has no value.
pub fn action(db: &dyn Db, job: &Job, definition: &Arc<Definition>) -> Option<Action> {
    let needs = job.needs(db).into_iter();
    let values = needs.map(|need| Some((need.node.clone(), value_read(db, definition, &need)?)));
    let format = match definition.node {
        Node::Artifact(_) => Some(target::format(
            db,
            job.root,
            job.settings.clone(),
            job.node.clone(),
        )?),
        _ => None,
    };
    Some(Action {
        definition: definition.clone(),
        values: values.collect::<Option<_>>()?,
        region: job.region.clone(),
        window: job.window,
        engine: db.engine(),
        format,
        origin: origin::origin(db, job, definition),
        files: files(db, definition)?,
        memo: Memo::default(),
        common: None,
        budget: db.budget().clone(),
    })
}

/// The action of a job without the values that would have to be evaluated: just the parts of a
/// facade, which are definitions. Enough to check scripts and patterns. None when a file cannot be
/// read or a part has errors.
pub fn outline(db: &dyn Db, job: &Job) -> Option<Action> {
    let definition = job.definition(db)?;
    let mut values = BTreeMap::new();
    for need in job.needs(db) {
        let is_part = matches!(
            need.node.section,
            Section::Symbols | Section::Patterns | Section::Layers
        );
        if is_part && (need.node.section != Section::Symbols || need.definition(db).is_some()) {
            values.insert(need.node.clone(), part(db, &need)?);
        }
    }
    Some(Action {
        values,
        region: None,
        window: None,
        engine: db.engine(),
        format: None,
        origin: None,
        files: files(db, &definition)?,
        memo: Memo::default(),
        common: None,
        budget: db.budget().clone(),
        definition,
    })
}

fn part(db: &dyn Db, job: &Job) -> Option<Value> {
    outline(db, job).map(|action| Value::Deferred(Arc::new(action)))
}

fn files(db: &dyn Db, definition: &Definition) -> Option<Files> {
    let content = |path: &Arc<str>| {
        let content = db.file(path).content(db).as_ref().ok()?;
        Some((path.clone(), content.content.clone()))
    };
    let held = definition
        .files
        .values()
        .map(content)
        .collect::<Option<_>>()?;
    Some(Files::new(held, db.reader()))
}

/// The name under which a need stands among the inputs of a job.
pub fn name_of(node: &NodeId, region: Option<&NodeId>) -> String {
    match region {
        Some(region) => format!("{node} on {region}"),
        None => node.to_string(),
    }
}
