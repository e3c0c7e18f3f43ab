//! The actions of a spec as another machine would be given them.

use super::compile::Compiler;
use super::evaluate::{evaluate, is_function};
use super::gather;
use super::job::Job;
use super::settings::Settings;
use super::target::targets;
use fretwork_action::ReadLog;
use fretwork_store::Digest;

/// An action in bytes, and what it gives.
pub struct WrittenAction {
    /// The node, and the region that it is applied to.
    pub name: String,
    /// The action, with all files that it needs.
    pub bytes: Vec<u8>,
    /// The digest of its value.
    pub output: Digest,
}

impl Compiler {
    /// The actions of all jobs that the artifacts of a spec without errors need, in an order in which
    /// each comes after those whose values it holds. Functions are no actions of their own: they travel
    /// inside of those that apply them.
    pub fn actions(&self, spec: &str, settings: &Settings) -> Vec<WrittenAction> {
        let root = self.root(spec);
        let (targets, _) = targets(&self.database, root, settings);
        let (jobs, _) = self.plan(targets.into_iter().map(|target| target.job));
        jobs.iter().filter_map(|job| self.action(job)).collect()
    }

    fn action(&self, job: &Job) -> Option<WrittenAction> {
        let database = &self.database;
        let definition = job.definition(database)?;
        if is_function(&definition, job) {
            return None;
        }
        let output = evaluate(database, job).value?.digest;
        let action = gather::action(database, job, &definition)?;
        let log = ReadLog::default();
        // What it reads is known only after a run.
        fretwork_stage::run(&action, &log).ok()?;
        Some(WrittenAction {
            name: gather::name_of(&job.node, job.region.as_ref()),
            bytes: action.to_bytes(&log)?,
            output,
        })
    }
}
