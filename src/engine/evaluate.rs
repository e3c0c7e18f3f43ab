//! One job evaluated: from the store when everything it depends on is as it was, by its stage
//! otherwise.

use std::sync::Arc;
use std::time::Instant;

use super::database::{Db, Provenance, SourceFile};
use super::gather;
use super::job::{Job, is_function_of_regions};
use super::origin;
use super::part_read::digest_read;
use super::settings::Settings;
use super::target;
use super::value::Handle;
use super::written::Written;
use fretwork_action::{
    Action, Common, Data, Definition, EngineChoice, ReadLog, StageResult, Value, Window, check,
};
use fretwork_diagnostic::Diagnostic;
use fretwork_graph::NodeId;
use fretwork_language::kinds::artifacts::Format;
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

impl Outcome {
    fn failed(diagnostics: Vec<Diagnostic>, inputs: Arc<[(String, Digest)]>) -> Outcome {
        Outcome {
            value: None,
            diagnostics: diagnostics.into(),
            inputs,
        }
    }
}

/// The name of the input that is the window.
const WINDOW: &str = "window";

/// What a job depends on, by name.
pub(super) type Inputs = Vec<(String, Digest)>;

/// The value of a job.
pub fn evaluate(db: &dyn Db, job: &Job) -> Outcome {
    evaluated(db, job.root, job.settings.clone(), Subject::of(job))
}

/// What of a spec is evaluated.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Subject {
    pub node: NodeId,
    pub region: Option<NodeId>,
    pub window: Option<Window>,
}

impl Subject {
    /// The subject of a job.
    pub fn of(job: &Job) -> Subject {
        Subject {
            node: job.node.clone(),
            region: job.region.clone(),
            window: job.window,
        }
    }

    /// Its job.
    pub fn job(self, root: SourceFile, settings: Settings) -> Job {
        Job {
            root,
            settings,
            node: self.node,
            region: self.region,
            window: self.window,
        }
    }
}

#[salsa::tracked(returns(clone))]
fn evaluated(db: &dyn Db, root: SourceFile, settings: Settings, subject: Subject) -> Outcome {
    db.budget().stop().check();
    let job = subject.job(root, settings);
    let failed = || Outcome::failed(Vec::new(), Arc::default());
    let Some(definition) = job.definition(db) else {
        return failed();
    };
    let Some(inputs) = inputs(db, &job, &definition) else {
        return failed();
    };
    let key = action_key(db, &definition, inputs.iter());
    let started = Instant::now();
    if !is_function(&definition, &job)
        && let Some((value, diagnostics, reads)) = stored(db, &key)
    {
        db.evaluated(&job, Provenance::Cached, started);
        let known = reads.iter();
        let reads = known.filter_map(|(path, digest)| Some((path.as_str(), (*digest)?)));
        return Outcome {
            value: Some(value),
            diagnostics,
            inputs: with_reads(inputs, reads),
        };
    }
    if db.budget().is_spent() {
        // The build fails whatever this gives, and the next one must not find that it was left undone.
        db.report_untracked_read();
        return failed();
    }
    let Some(mut action) = gather::action(db, &job, &definition) else {
        return failed();
    };
    action.common = common(db, &job, &definition, &inputs);
    if is_function(&definition, &job) {
        return prepare(db, action, &key, inputs);
    }
    if job.window.is_some() && job.is_near(db) && !job.is_tiled(db) {
        let log = ReadLog::default();
        let Some(result) = fretwork_stage::near(&action, &log) else {
            // Most of the whole would be drawn, which other windows can use.
            return evaluate(
                db,
                &Job {
                    window: None,
                    ..job
                },
            );
        };
        let outcome = remember(db, (&action, &key), inputs, (log, result));
        db.evaluated(&job, Provenance::Evaluated, started);
        return outcome;
    }
    let outcome = run(db, &action, &key, inputs);
    db.evaluated(&job, Provenance::Evaluated, started);
    outcome
}

/// What a window of an artifact has in common with others that are built with it, where they are cut of the same values.
fn common(db: &dyn Db, job: &Job, definition: &Definition, inputs: &Inputs) -> Option<Common> {
    let is_shared = job.window.is_some_and(Window::is_shared) && job.region.is_none();
    let is_same = |need: &Job| need.window.is_none();
    if !is_shared || !job.needs(db).iter().all(is_same) {
        return None;
    }
    let of_all = inputs.iter().filter(|(name, _)| name != WINDOW);
    Some(db.common(&action_key(db, definition, of_all)))
}

/// A function is put together once where it is defined, so that its errors are told by the node that
/// has them.
fn prepare(db: &dyn Db, action: Action, key: &Digest, inputs: Inputs) -> Outcome {
    let log = ReadLog::default();
    let result = fretwork_stage::prepare(&action, &log);
    let key = with_found(key, &log);
    let (result, inputs) = settle(db, &action, &log, inputs, result);
    match result {
        Ok(warnings) => Outcome {
            value: Some(Handle::present(key, Value::Deferred(Arc::new(action)))),
            diagnostics: warnings.into(),
            inputs,
        },
        Err(diagnostics) => Outcome::failed(diagnostics, inputs),
    }
}

/// What stands for a function: its key and, where it has found files by itself, these.
fn with_found(key: &Digest, log: &ReadLog) -> Digest {
    let reads = digests(log);
    if reads.is_empty() {
        return *key;
    }
    let mut hasher = Hasher::new("function");
    hasher.part(key.as_bytes());
    for (path, digest) in reads {
        let content = digest.map_or(Vec::new(), |digest| digest.as_bytes().to_vec());
        hasher.part(path.as_bytes()).part(&content);
    }
    hasher.digest()
}

/// Makes the files that a stage has found inputs of the query that runs and of its outcome. The
/// result becomes an error when one of them is no longer what the stage got.
fn settle<T>(
    db: &dyn Db,
    action: &Action,
    log: &ReadLog,
    inputs: Inputs,
    result: Result<T, Vec<Diagnostic>>,
) -> (Result<T, Vec<Diagnostic>>, Arc<[(String, Digest)]>) {
    let reads = digests(log);
    let known = reads
        .iter()
        .filter_map(|(path, digest)| Some((&**path, (*digest)?)));
    let inputs = with_reads(inputs, known);
    (depend(db, &action.definition, &reads).and(result), inputs)
}

/// The paths that were read and the digests of their bytes; none where that failed.
fn digests(log: &ReadLog) -> Vec<(Arc<str>, Option<Digest>)> {
    let entries = log.entries().into_iter();
    entries
        .map(|(path, bytes)| (path, bytes.map(|bytes| Digest::of(&bytes))))
        .collect()
}

/// The inputs and, after them, the files that the stage found by itself.
fn with_reads<'a>(
    mut inputs: Inputs,
    reads: impl Iterator<Item = (&'a str, Digest)>,
) -> Arc<[(String, Digest)]> {
    for (path, digest) in reads {
        let name = format!("file {path}");
        if inputs.iter().all(|(known, _)| *known != name) {
            inputs.push((name, digest));
        }
    }
    inputs.into()
}

/// The value behind a job, loaded or, if the store has lost it, computed again. None when the job
/// failed.
pub fn value(db: &dyn Db, job: &Job) -> Option<Value> {
    let handle = evaluate(db, job).value?;
    if let Some(value) = handle.get() {
        return Some(value.clone());
    }
    let definition = job.definition(db)?;
    let stored = db.store().and_then(|s| s.blob(&handle.digest));
    if let Some(data) = stored.and_then(|bytes| Data::decode(bytes, definition.node.provides())) {
        return Some(handle.fill(Value::Data(data)).clone());
    }
    let action = gather::action(db, job, &definition)?;
    let (data, _) = fretwork_stage::run(&action, &ReadLog::default()).ok()?;
    Some(handle.fill(Value::Data(data)).clone())
}

/// Whether the job stands for a function, which is put together anew in every process.
pub fn is_function(definition: &Definition, job: &Job) -> bool {
    match definition.node.provides() {
        ValueType::Field
        | ValueType::ForceProfile
        | ValueType::Symbol
        | ValueType::Pattern
        | ValueType::Layer => true,
        ValueType::Arrangement => job.region.is_none() && is_function_of_regions(&definition.node),
        _ => false,
    }
}

/// Everything that the job depends on, by name. None when an input failed.
pub(super) fn inputs(db: &dyn Db, job: &Job, definition: &Definition) -> Option<Inputs> {
    let mut inputs = vec![("definition".to_string(), definition_digest(definition))];
    for path in definition.files.values() {
        let digest = db.file(path).content(db).as_ref().ok()?.digest;
        inputs.push((format!("file {path}"), digest));
    }
    if let Node::Artifact(_) = definition.node {
        let format = target::format(db, job.root, job.settings.clone(), job.node.clone())?;
        let extension = Format::EXTENSIONS[format as usize];
        inputs.push(("format".to_string(), Digest::of(extension.as_bytes())));
        if let Some(name) = origin::name(db, job, definition) {
            inputs.push(("origin".to_string(), name));
        }
    }
    if db.engine() != EngineChoice::Auto {
        inputs.push(("engine".to_string(), Digest::of(b"general")));
    }
    if let Some(window) = job.window {
        let numbers = [window.low(), window.high()].map(|corner| corner.map(f64::to_le_bytes));
        inputs.push((WINDOW.to_string(), Digest::of(&numbers.concat().concat())));
    }
    for need in job.needs(db) {
        let name = gather::name_of(&need.node, need.region.as_ref());
        inputs.push((name, digest_read(db, definition, &need)?));
    }
    Some(inputs)
}

pub(super) fn definition_digest(definition: &Definition) -> Digest {
    let node: &Node = &definition.node;
    let fields = (node, definition.seed, definition.units, &definition.map);
    let fields = serde_json::to_vec(&fields).expect("nodes hold plain data");
    let mut hasher = Hasher::new("definition");
    hasher
        .part(definition.id.section.name().as_bytes())
        .part(node.kind_name().as_bytes())
        .part(&fields);
    if definition.own_units != definition.units {
        hasher.part(definition.own_units.word().as_bytes());
    }
    // Diagnostics, which are remembered with the value, name the entry and its file.
    hasher
        .part(definition.id.name.as_bytes())
        .part(definition.file.as_bytes())
        .digest()
}

/// The name of an action: what is done, by which version of the code, to what.
pub(super) fn action_key<'a>(
    db: &dyn Db,
    definition: &Definition,
    inputs: impl Iterator<Item = &'a (String, Digest)>,
) -> Digest {
    let source = fretwork_stage::source_of(&definition.node);
    let mut hasher = Hasher::new("action");
    hasher
        .part(db.version(source).as_bytes())
        .part(definition.node.kind_name().as_bytes());
    for (name, digest) in inputs {
        hasher.part(name.as_bytes()).part(digest.as_bytes());
    }
    hasher.digest()
}

/// The remembered outcome of an action and the files that it looked for by itself, if those are as they were: what was
/// missing then is missing now.
pub(super) fn stored(
    db: &dyn Db,
    key: &Digest,
) -> Option<(Handle, Arc<[Diagnostic]>, Vec<(String, Option<Digest>)>)> {
    let store = db.store()?;
    let holds = |(path, digest): &(String, Option<Digest>)| {
        let content = db.file(&Arc::from(path.as_str())).content(db).as_ref().ok();
        content.map(|content| content.digest) == *digest
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
    reads: &[(Arc<str>, Option<Digest>)],
) -> Result<(), Vec<Diagnostic>> {
    let is_other = |(path, digest): &&(Arc<str>, Option<Digest>)| {
        let content = db.file(path).content(db).as_ref().ok();
        content.map(|content| content.digest) != *digest
    };
    // All of them are asked for, whatever the first says.
    match reads.iter().filter(is_other).last() {
        None => Ok(()),
        Some((path, _)) => {
            let error = Diagnostic::error(format!("`{path}` changed during the build"));
            Err(vec![error.at(definition.span(), "read by this")])
        }
    }
}

/// Runs the stage and remembers what came out.
pub(super) fn run(db: &dyn Db, action: &Action, key: &Digest, inputs: Inputs) -> Outcome {
    let log = ReadLog::default();
    let result = fretwork_stage::run(action, &log);
    remember(db, (action, key), inputs, (log, result))
}

/// Remembers what came out of a stage, and what it read.
fn remember(
    db: &dyn Db,
    (action, key): (&Action, &Digest),
    inputs: Inputs,
    (log, result): (ReadLog, StageResult),
) -> Outcome {
    let (result, inputs) = settle(db, action, &log, inputs, result);
    let (data, diagnostics) = match result {
        Ok(made) => made,
        Err(diagnostics) => return Outcome::failed(diagnostics, inputs),
    };
    if db.checks_values()
        && let Err(problem) = check::check(&data)
    {
        let mistake = Diagnostic::error(format!("a mistake of the compiler: {problem}"));
        let mistake = mistake.at(action.span(), "the value of this is unsound");
        return Outcome::failed(vec![mistake], inputs);
    }
    let written = Written::of(&data, db.store().is_some());
    db.budget().keep(written.len);
    let digest = written.digest;
    if let Some(store) = db.store() {
        let reads = digests(&log).into_iter();
        let result = ActionResult {
            reads: reads
                .map(|(path, digest)| (path.to_string(), digest))
                .collect(),
            output: digest,
            note: serde_json::to_vec(&diagnostics).expect("diagnostics hold plain data"),
        };
        let kept = store
            .put_blob(&digest, &written.pieces(&data))
            .and_then(|()| store.put_action(key, result));
        if let Err(error) = kept {
            db.store_failed(error);
        }
    }
    Outcome {
        value: Some(Handle::present(digest, Value::Data(data))),
        diagnostics: diagnostics.into(),
        inputs,
    }
}
