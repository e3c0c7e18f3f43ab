//! The origin of an artifact: its spec, its name, and a digest of what it is made of. What stands for a function among
//! inputs is the version of its code too, of which a file says nothing; so functions are followed down to their own
//! definitions here.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::compile::{Compiler, output_folder};
use super::database::{Db, SourceFile};
use super::evaluate::{Subject, evaluate, value};
use super::gather::name_of;
use super::job::Job;
use super::report::Artifact;
use super::settings::Settings;
use super::target;
use super::window_digest::in_window;
use fretwork_action::{Data, Definition, Origin, Value, Window};
use fretwork_language::Node;
use fretwork_language::kinds::artifacts::Format;
use fretwork_stage::slack;
use fretwork_store::{Digest, Hasher};

/// How many of the digits of a digest a recipe has.
const DIGITS: usize = 32;

/// The origin of the artifact that `job` makes; none of another node, of an artifact that is to name none, and where an
/// input failed.
pub fn origin(db: &dyn Db, job: &Job, definition: &Definition) -> Option<Origin> {
    let (spec, artifact) = names(db, job, definition)?;
    let recipe = recipe(db, job, definition)?.hex();
    Some(Origin {
        spec: spec.into(),
        artifact: artifact.into(),
        recipe: recipe[..DIGITS].into(),
    })
}

/// What of its origin an artifact depends on besides its inputs, as a digest.
pub fn name(db: &dyn Db, job: &Job, definition: &Definition) -> Option<Digest> {
    let (spec, artifact) = names(db, job, definition)?;
    let mut hasher = Hasher::new("origin");
    hasher.part(spec.as_bytes()).part(artifact.as_bytes());
    Some(hasher.digest())
}

fn names(db: &dyn Db, job: &Job, definition: &Definition) -> Option<(String, String)> {
    match &definition.node {
        Node::Artifact(artifact) if artifact.provenance => {
            let name = target::name(db, job.root, job.settings.clone(), job.node.clone())?;
            Some((output_folder(job.root.path(db)), name.to_string()))
        }
        _ => None,
    }
}

/// The digest of the artifact's canonical parameters and its inputs' digests.
fn recipe(db: &dyn Db, job: &Job, definition: &Definition) -> Option<Digest> {
    let format = target::format(db, job.root, job.settings.clone(), job.node.clone())?;
    let parameters = (&definition.node, definition.units, &definition.map);
    let parameters = serde_json::to_vec(&parameters).expect("nodes hold plain data");
    let mut hasher = Hasher::new("recipe");
    hasher
        .part(&parameters)
        .part(Format::EXTENSIONS[format as usize].as_bytes());
    if definition.own_units != definition.units {
        hasher.part(definition.own_units.word().as_bytes());
    }
    if let Some(window) = job.window {
        let numbers = [window.low(), window.high()].map(|corner| corner.map(f64::to_le_bytes));
        hasher.part(&numbers.concat().concat());
    }
    for need in job.needs(db) {
        let name = name_of(&need.node, need.region.as_ref());
        let window = job.window.filter(|_| need.region.is_some());
        let meaning = match window.map(|window| seen(window, definition)) {
            Some(window) => shown(db, &need, window)?,
            None => meaning(db, &need)?,
        };
        hasher.part(name.as_bytes()).part(meaning.as_bytes());
    }
    Some(hasher.digest())
}

/// Where lines are looked for that an artifact shows in a window.
fn seen(window: Window, definition: &Definition) -> Window {
    match &definition.node {
        Node::Artifact(artifact) => window.grown(slack(definition, artifact)),
        _ => window,
    }
}

/// What stands for an arrangement of which a window is shown.
fn shown(db: &dyn Db, job: &Job, window: Window) -> Option<Digest> {
    match value(db, job)? {
        Value::Data(Data::Curves(curves)) => Some(in_window(&curves, window)),
        _ => meaning(db, job),
    }
}

/// What stands for the value of a job in recipes.
fn meaning(db: &dyn Db, job: &Job) -> Option<Digest> {
    // The definition of an input is not asked for: an edit of it that leaves the value as it was ends there.
    let value = evaluate(db, job).value?;
    match value.get() {
        Some(Value::Deferred(_)) => function(db, job.root, job.settings.clone(), Subject::of(job)),
        _ => Some(value.digest),
    }
}

/// What stands for a function: its definition, the files that it reads and what stands for its inputs, whichever code
/// and engine it is applied by.
#[salsa::tracked(returns(clone))]
fn function(db: &dyn Db, root: SourceFile, settings: Settings, subject: Subject) -> Option<Digest> {
    let job = subject.job(root, settings);
    let needs = job.needs(db).into_iter();
    let needs: BTreeMap<String, Job> = needs
        .map(|need| (name_of(&need.node, need.region.as_ref()), need))
        .collect();
    let mut hasher = Hasher::new("function of a recipe");
    for (name, digest) in evaluate(db, &job).inputs.iter() {
        let digest = match needs.get(name) {
            Some(need) => meaning(db, need)?,
            None if name == "engine" => continue,
            None => *digest,
        };
        hasher.part(name.as_bytes()).part(digest.as_bytes());
    }
    Some(hasher.digest())
}

impl Compiler {
    /// The digits that stand for what an artifact is made of; none where its file is to name no origin.
    pub fn recipe(&self, artifact: &Artifact) -> Option<Arc<str>> {
        let definition = artifact.job.definition(&self.database)?;
        let origin = origin(&self.database, &artifact.job, &definition)?;
        Some(origin.recipe)
    }
}
