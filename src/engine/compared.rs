//! What a caller asks of a compiler to compare two states of a project: which files there are, by which names they are meant,
//! and what each is compared by. The states themselves are a matter of the world that the compiler reads.

use std::collections::BTreeSet;

use super::compile::Compiler;
use super::gather;
use super::report::Artifact;
use super::settings::Settings;
use super::target::targets;
use fretwork_stage::compared::{Compared, compared};

impl Compiler {
    /// The paths below the output folder of the files that a spec stands for, as far as they can be told.
    pub fn paths(&self, spec: &str, settings: &Settings) -> Vec<String> {
        let (targets, _) = targets(&self.database, self.root(spec), settings);
        targets.into_iter().map(|target| target.path).collect()
    }

    /// As [`Compiler::paths`], with the names by which [`Request::only`](super::Request::only) means each file. The spec has no
    /// errors that [`Compiler::check`] finds.
    pub fn named_paths(&self, spec: &str, settings: &Settings) -> Vec<(String, BTreeSet<String>)> {
        let (targets, _) = targets(&self.database, self.root(spec), settings);
        let named = targets.into_iter().map(|target| {
            let names = self.names(&target);
            (target.path, names)
        });
        named.collect()
    }

    /// What an artifact is compared by with another state of it.
    pub fn compared(&self, artifact: &Artifact) -> Compared {
        let definition = artifact.job.definition(&self.database);
        let action = definition
            .and_then(|definition| gather::action(&self.database, &artifact.job, &definition));
        action.map_or_else(Compared::default, |action| compared(&action))
    }
}
