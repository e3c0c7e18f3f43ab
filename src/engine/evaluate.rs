//! One job evaluated: from the store when everything it depends on is as it was, by its stage
//! otherwise.

use std::sync::Arc;
use std::time::Instant;

use super::database::{Db, Provenance, SourceFile};
use super::definition::Definition;
use super::invariant;
use super::job::Job;
use super::settings::Settings;
use super::stage;
use super::target;
use super::value::{Data, Handle, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_graph::NodeId;
use fretwork_language::{Node, ValueType};
use fretwork_store::{ActionResult, Digest, Hasher};

/// What evaluating a job gave.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The value; none when the job or one that it needs failed.
    pub value: Option<Handle>,
    /// What its own stage had to say.
    pub diagnostics: Arc<[Diagnostic]>,
    /// What the value depends on, by name.
    pub inputs: Arc<[(String, Digest)]>,
}

impl PartialEq for Outcome {
    /// The inputs are for reports: a value that came out the same stops the rebuild.
    fn eq(&self, other: &Outcome) -> bool {
        self.value == other.value && self.diagnostics == other.diagnostics
    }
}

/// What a stage gives: a value and warnings, or errors and warnings.
pub type StageResult = Result<(Value, Vec<Diagnostic>), Vec<Diagnostic>>;

/// The value of a job.
pub fn evaluate(db: &dyn Db, job: &Job) -> Outcome {
    evaluated(
        db,
        job.root,
        job.settings.clone(),
        job.node.clone(),
        job.region.clone(),
    )
}

#[salsa::tracked(returns(clone))]
fn evaluated(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    node: NodeId,
    region: Option<NodeId>,
) -> Outcome {
    let job = Job {
        root,
        settings,
        node,
        region,
    };
    let failed = || Outcome {
        value: None,
        diagnostics: Arc::default(),
        inputs: Arc::default(),
    };
    let Some(definition) = job.definition(db) else {
        return failed();
    };
    let Some(inputs) = inputs(db, &job, &definition) else {
        return failed();
    };
    let key = action_key(db.version("cli"), &definition, &inputs);
    let inputs: Arc<[(String, Digest)]> = inputs.into();
    if is_function(&definition, &job) {
        // It is put together once here, so that its errors are told by the node that has them.
        let mut reads = stage::Reads::default();
        let result = stage::run(db, &job, &definition, &mut reads);
        let inputs = with_reads(&inputs, reads.known());
        return match depend(db, &definition, &reads).and(result) {
            Ok((value, diagnostics)) => {
                db.keep_function(&job, &value);
                Outcome {
                    value: Some(Handle::absent(key)),
                    diagnostics: diagnostics.into(),
                    inputs,
                }
            }
            Err(diagnostics) => Outcome {
                value: None,
                diagnostics: diagnostics.into(),
                inputs,
            },
        };
    }
    let started = Instant::now();
    if let Some((value, diagnostics, reads)) = stored(db, &key) {
        db.evaluated(&job, Provenance::Cached, started);
        let inputs = with_reads(
            &inputs,
            reads.iter().map(|(path, digest)| (path.as_str(), *digest)),
        );
        return Outcome {
            value: Some(value),
            diagnostics,
            inputs,
        };
    }
    let outcome = run(db, &job, &definition, &key, inputs);
    db.evaluated(&job, Provenance::Evaluated, started);
    outcome
}

/// The inputs and, after them, the files that the stage found by itself.
fn with_reads<'a>(
    inputs: &[(String, Digest)],
    reads: impl Iterator<Item = (&'a str, Digest)>,
) -> Arc<[(String, Digest)]> {
    let mut all = inputs.to_vec();
    for (path, digest) in reads {
        let name = format!("file {path}");
        if all.iter().all(|(known, _)| *known != name) {
            all.push((name, digest));
        }
    }
    all.into()
}

/// The value behind a job, loaded or, if the store has lost it, computed again. None when the job
/// failed.
pub fn value(db: &dyn Db, job: &Job) -> Option<Value> {
    let handle = evaluate(db, job).value?;
    let definition = job.definition(db)?;
    if is_function(&definition, job) {
        return function(db, job, &definition);
    }
    if let Some(value) = handle.get() {
        return Some(value.clone());
    }
    let is_file = matches!(definition.node, Node::Artifact(_));
    let stored = db.store().and_then(|s| s.blob(&handle.digest));
    if let Some(data) = stored.and_then(|bytes| Data::decode(bytes, is_file)) {
        return Some(handle.fill(Value::Data(data)).clone());
    }
    let mut reads = stage::Reads::default();
    let (value, _) = stage::run(db, job, &definition, &mut reads).ok()?;
    Some(handle.fill(value).clone())
}

/// The function that a job stands for. What is wrong with it is told where it is needed.
fn function(db: &dyn Db, job: &Job, definition: &Definition) -> Option<Value> {
    if let Some(known) = db.function(job) {
        return Some(known);
    }
    let (value, _) = stage::run(db, job, definition, &mut stage::Reads::default()).ok()?;
    db.keep_function(job, &value);
    Some(value)
}

/// Whether the job stands for a function, which is put together anew in every process.
fn is_function(definition: &Definition, job: &Job) -> bool {
    match definition.node.provides() {
        ValueType::Field | ValueType::Symbol | ValueType::Pattern | ValueType::Layer => true,
        ValueType::Arrangement => job.region.is_none(),
        _ => false,
    }
}

/// Everything that the job depends on, by name. None when an input failed.
fn inputs(db: &dyn Db, job: &Job, definition: &Definition) -> Option<Vec<(String, Digest)>> {
    let mut inputs = vec![("definition".to_string(), definition_digest(definition))];
    for path in definition.files.values() {
        let digest = db.file(path).content(db).as_ref().ok()?.digest;
        inputs.push((format!("file {path}"), digest));
    }
    if let Node::Artifact(_) = definition.node {
        let format = target::format(db, job.root, job.settings.clone(), job.node.clone())?;
        inputs.push(("format".to_string(), Digest::of(format.as_bytes())));
    }
    for need in job.needs(db) {
        let name = match &need.region {
            Some(region) => format!("{} on {region}", need.node),
            None => need.node.to_string(),
        };
        inputs.push((name, evaluate(db, &need).value?.digest));
    }
    Some(inputs)
}

fn definition_digest(definition: &Definition) -> Digest {
    let node: &Node = &definition.node;
    let fields = serde_json::to_vec(&(node, definition.seed, definition.units))
        .expect("nodes hold plain data");
    let mut hasher = Hasher::new("definition");
    hasher
        .part(definition.id.section.name().as_bytes())
        .part(node.kind_name().as_bytes())
        .part(&fields);
    // Diagnostics, which are remembered with the value, name the entry and its file.
    hasher
        .part(definition.id.name.as_bytes())
        .part(definition.file.as_bytes())
        .digest()
}

fn action_key(version: &str, definition: &Definition, inputs: &[(String, Digest)]) -> Digest {
    let mut hasher = Hasher::new("action");
    hasher
        .part(version.as_bytes())
        .part(definition.node.kind_name().as_bytes());
    for (name, digest) in inputs {
        hasher.part(name.as_bytes()).part(digest.as_bytes());
    }
    hasher.digest()
}

/// The remembered outcome of an action and the files that it read by itself, if those are as they were.
fn stored(db: &dyn Db, key: &Digest) -> Option<(Handle, Arc<[Diagnostic]>, Vec<(String, Digest)>)> {
    let store = db.store()?;
    let holds = |(path, digest): &(String, Digest)| {
        db.file(&Arc::from(path.as_str()))
            .content(db)
            .as_ref()
            .is_ok_and(|c| c.digest == *digest)
    };
    let is_valid =
        |result: &ActionResult| result.reads.iter().all(holds) && store.has_blob(&result.output);
    let result = store.action(key).into_iter().find(is_valid)?;
    let diagnostics: Vec<Diagnostic> = serde_json::from_slice(&result.note).ok()?;
    store.touch(key, &result.output);
    Some((
        Handle::absent(result.output),
        diagnostics.into(),
        result.reads,
    ))
}

/// Makes the files that a stage has read inputs of the query that runs.
///
/// # Errors
/// When one is not what the stage got: what came out belongs to no state of the project.
fn depend(
    db: &dyn Db,
    definition: &Definition,
    reads: &stage::Reads,
) -> Result<(), Vec<Diagnostic>> {
    let is_other = |(path, digest): &(&Arc<str>, Option<Digest>)| {
        db.file(path)
            .content(db)
            .as_ref()
            .ok()
            .map(|content| content.digest)
            != *digest
    };
    // All of them are asked for, whatever the first says.
    match reads.paths().filter(is_other).last() {
        None => Ok(()),
        Some((path, _)) => {
            let message = format!("`{path}` changed during the build");
            Err(vec![
                Diagnostic::error(message).at(definition.span(), "read by this"),
            ])
        }
    }
}

/// Runs the stage and remembers what came out.
fn run(
    db: &dyn Db,
    job: &Job,
    definition: &Definition,
    key: &Digest,
    inputs: Arc<[(String, Digest)]>,
) -> Outcome {
    let mut reads = stage::Reads::default();
    let result = stage::run(db, job, definition, &mut reads);
    let inputs = with_reads(&inputs, reads.known());
    let (value, diagnostics) = match depend(db, definition, &reads).and(result) {
        Ok((value, diagnostics)) => (value, diagnostics),
        Err(diagnostics) => {
            return Outcome {
                value: None,
                diagnostics: diagnostics.into(),
                inputs,
            };
        }
    };
    if db.checks_values()
        && let Err(problem) = invariant::check(&value)
    {
        let mistake = Diagnostic::error(format!("a mistake of the compiler: {problem}"));
        let diagnostics = [mistake.at(definition.span(), "the value of this is unsound")];
        return Outcome {
            value: None,
            diagnostics: diagnostics.into(),
            inputs,
        };
    }
    let Value::Data(data) = &value else {
        return Outcome {
            value: Some(Handle::present(*key, value)),
            diagnostics: diagnostics.into(),
            inputs,
        };
    };
    let bytes = data.encode();
    let digest = Digest::of(&bytes);
    if let Some(store) = db.store() {
        let note = serde_json::to_vec(&diagnostics).expect("diagnostics hold plain data");
        let result = ActionResult {
            reads: reads.into_pairs(),
            output: digest,
            note,
        };
        if let Err(error) = store
            .put_blob(&digest, &bytes)
            .and_then(|()| store.put_action(key, result))
        {
            db.store_failed(error);
        }
    }
    Outcome {
        value: Some(Handle::present(digest, value)),
        diagnostics: diagnostics.into(),
        inputs,
    }
}
