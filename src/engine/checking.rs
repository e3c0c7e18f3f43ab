//! What is wrong with a spec and can be known without a build.

use std::collections::HashSet;

use super::compile::{Compiler, sorted};
use super::definition::{check, linked};
use super::gather::outline;
use super::job::Job;
use super::labels::idle_labels;
use super::modules::through;
use super::output::check_output;
use super::program::program;
use super::scope::unused_params;
use super::settings::Settings;
use super::support::unsupported;
use super::target::targets;
use fretwork_diagnostic::Diagnostic;

impl Compiler {
    /// Everything that is wrong with a spec and can be known without evaluating it, sorted.
    pub fn check(&self, spec: &str, settings: &Settings) -> Vec<Diagnostic> {
        let root = self.root(spec);
        let mut diagnostics = (*check(&self.database, root, settings.clone())).clone();
        let (targets, more) = targets(&self.database, root, settings);
        diagnostics.extend(more);
        let mut checked = HashSet::from([settings]);
        for target in &targets {
            diagnostics.extend(check_output(&self.database, target));
            if checked.insert(&target.job.settings) {
                diagnostics.extend(
                    check(&self.database, root, target.job.settings.clone())
                        .iter()
                        .cloned(),
                );
            }
        }
        // Jobs can be planned only where nothing is wrong: nodes in a circle have no order.
        if !diagnostics.iter().any(Diagnostic::is_error) {
            let (jobs, _) = self.plan(targets.into_iter().map(|target| target.job));
            let needed = jobs.iter().filter_map(|job| job.definition(&self.database));
            diagnostics.extend(needed.filter_map(|definition| unsupported(&definition)));
        }
        if !diagnostics.iter().any(Diagnostic::is_error) {
            diagnostics.extend(unused_params(&program(&self.database, root)));
        }
        self.sources().without_repeats(sorted(diagnostics))
    }

    /// What is wrong with the scripts, formulas, drawings and labels of the nodes of a spec that have no other errors. A
    /// build finds it when it needs them.
    pub fn check_scripts(&self, spec: &str, settings: &Settings) -> Vec<Diagnostic> {
        let root = self.root(spec);
        let nodes = linked(&self.database, root, settings.clone());
        let jobs = nodes.targets.keys().map(|id| Job {
            root,
            settings: settings.clone(),
            node: id.clone(),
            region: None,
            window: None,
        });
        let mut diagnostics = Vec::new();
        for job in jobs {
            // That a file cannot be read has been told already: there is no outline then.
            if let Some(action) = outline(&self.database, &job) {
                let wrong = fretwork_stage::check(&action).into_iter();
                diagnostics.extend(wrong.map(|d| through(&self.database, &job, d)));
            }
            diagnostics.extend(idle_labels(&self.database, &job));
        }
        sorted(diagnostics)
    }
}
