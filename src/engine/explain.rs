//! Why a node was evaluated: a small record of the last build, kept beside the action cache.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::compile::Compiler;
use super::database::{Database, Db as _, Event, Provenance};
use super::definition::linked;
use super::evaluate::evaluate;
use super::job::Job;
use super::settings::Settings;
use super::shell_step;
use fretwork_diagnostic::{Code, Diagnostic, nearest};
use fretwork_graph::NodeId;
use fretwork_store::{Digest, Hasher};

/// What a build knew of a job.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    status: Status,
    inputs: Vec<(String, Digest)>,
    /// The inputs in the build before, if the job was part of it.
    before: Option<Vec<(String, Digest)>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Status {
    Evaluated,
    Cached,
    Reused,
}

type Record = BTreeMap<String, Entry>;

/// What the last build did with a job, and what the job depends on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// The node, and the region that it was applied to.
    pub job: String,
    /// One sentence.
    pub summary: String,
    /// How an arrangement is drawn: by tiles, or why not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub engine: Option<String>,
    /// Whether the build before the last one knew the job.
    pub had_before: bool,
    /// What it depends on.
    pub inputs: Vec<InputChange>,
}

/// Something that a job depends on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InputChange {
    /// Its name: `definition`, a file, another node.
    pub name: String,
    /// The digest of its value in the last build.
    pub digest: Digest,
    /// The digest in the build before, if there was one.
    pub before: Option<Digest>,
}

/// The name of the record of a spec in the store.
fn record_name(spec: &str) -> Digest {
    Hasher::new("record of the last build")
        .part(spec.as_bytes())
        .digest()
}

fn load(database: &Database, spec: &str) -> Record {
    let bytes = database.store().and_then(|s| s.note(&record_name(spec)));
    // A record of another version or a damaged one is as good as none.
    bytes
        .and_then(|b| serde_json::from_slice(&b).ok())
        .unwrap_or_default()
}

fn job_name(job: &Job) -> String {
    let values: Vec<String> = job
        .settings
        .each_values()
        .map(|(name, value)| format!(" with {name} = {value}"))
        .collect();
    match &job.region {
        Some(region) => format!("{} on {region}{}", job.node, values.concat()),
        None => format!("{}{}", job.node, values.concat()),
    }
}

/// Records what a build did with its jobs, beside what the builds before it said of other jobs.
pub fn record(database: &Database, jobs: &[Job], events: &[Event]) {
    if database.store().is_none() {
        return;
    }
    let mut by_spec: BTreeMap<&Arc<str>, Vec<&Job>> = BTreeMap::new();
    for job in jobs {
        by_spec
            .entry(job.root.path(database))
            .or_default()
            .push(job);
    }
    for (spec, jobs) in by_spec {
        let old = load(database, spec);
        let mut record = old.clone();
        for job in jobs {
            let name = job_name(job);
            let inputs = evaluate(database, job).inputs.to_vec();
            let status = events
                .iter()
                .find(|e| e.job == *job)
                .map_or(Status::Reused, |e| match e.provenance {
                    Provenance::Evaluated => Status::Evaluated,
                    Provenance::Cached => Status::Cached,
                });
            let before = old.get(&name).map(|entry| entry.inputs.clone());
            record.insert(
                name,
                Entry {
                    status,
                    inputs,
                    before,
                },
            );
        }
        if record != old {
            let bytes = serde_json::to_vec(&record).expect("a record holds plain data");
            if let Some(Err(error)) = database
                .store()
                .map(|s| s.put_note(&record_name(spec), &bytes))
            {
                database.store_failed(error);
            }
        }
    }
}

impl Compiler {
    /// What the last build did with a node or a step of a shell, given as `name` or `section.name`, once for each region
    /// that it was applied to and each value of its parameters.
    pub fn explain(
        &self,
        spec: &str,
        node: &str,
        settings: &Settings,
    ) -> (Vec<Explanation>, Vec<Diagnostic>) {
        let mut diagnostics = self.check(spec, settings);
        let linked = linked(&self.database, self.root(spec), settings.clone());
        let steps = linked.targets.keys().flat_map(shell_step::steps);
        let nodes: Vec<NodeId> = linked.targets.keys().cloned().chain(steps).collect();
        let ids: Vec<String> = nodes.iter().map(ToString::to_string).collect();
        let bare = nodes.iter().map(|id| &*id.name);
        let names = bare.chain(ids.iter().map(String::as_str));
        if !names.clone().any(|n| n == node) {
            let unknown =
                Diagnostic::error(format!("the spec has no node `{node}`")).about(Code::Reference);
            let near = nearest(node, names).map(str::to_string);
            diagnostics.push(match near {
                Some(name) => unknown.help(format!("did you mean `{name}`?")),
                None => unknown,
            });
            return (Vec::new(), diagnostics);
        }
        let is_meant = |job: &str| {
            let id = job.split(' ').next().unwrap_or(job);
            id == node || id.split_once('.').is_some_and(|(_, name)| name == node)
        };
        let record = load(&self.database, spec);
        let meant = record.into_iter().filter(|(job, _)| is_meant(job));
        let engine = self.engine_of(spec, node, settings);
        let explained = |(job, entry): (String, Entry)| Explanation {
            engine: engine.clone(),
            ..explanation(job, entry)
        };
        let mut explanations: Vec<Explanation> = meant.map(explained).collect();
        if explanations.is_empty() && engine.is_some() {
            // How it would be drawn is known without a build.
            explanations.push(Explanation {
                job: node.to_string(),
                summary: "not built yet, or only without the cache".to_string(),
                engine,
                had_before: false,
                inputs: Vec::new(),
            });
        }
        if explanations.is_empty() {
            let help =
                "no artifact needs it, or nothing was built yet, or the cache was switched off";
            diagnostics.push(Diagnostic::error(format!("`{node}` has not been built")).help(help));
        }
        (explanations, diagnostics)
    }
}

fn explanation(job: String, entry: Entry) -> Explanation {
    let before: Option<BTreeMap<&String, &Digest>> = entry
        .before
        .as_ref()
        .map(|b| b.iter().map(|(n, d)| (n, d)).collect());
    let changed: Vec<&str> = match &before {
        None => Vec::new(),
        Some(before) => entry
            .inputs
            .iter()
            .filter(|(n, d)| before.get(n) != Some(&d))
            .map(|(n, _)| n.as_str())
            .collect(),
    };
    let because = match (&before, &changed[..]) {
        (None, _) => "it was not part of the build before".to_string(),
        (Some(_), []) => "nothing that it depends on has changed".to_string(),
        (Some(_), changed) => format!("{} changed", changed.join(", ")),
    };
    let summary = match (entry.status, changed.is_empty() && before.is_some()) {
        (Status::Evaluated, true) => {
            "evaluated, although nothing changed: its result was not in the cache".to_string()
        }
        (Status::Evaluated, false) => format!("evaluated, because {because}"),
        (Status::Cached, _) => format!("taken from the cache: {because}, and the result was known"),
        (Status::Reused, _) => format!("not evaluated: {because}"),
    };
    let inputs = entry.inputs.iter().map(|(name, digest)| InputChange {
        name: name.clone(),
        digest: *digest,
        before: before.as_ref().and_then(|b| b.get(name)).copied().copied(),
    });
    Explanation {
        summary,
        engine: None,
        had_before: before.is_some(),
        inputs: inputs.collect(),
        job,
    }
}
