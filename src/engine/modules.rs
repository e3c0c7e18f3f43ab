//! Files as modules: what they are named, and through which places what is told of them is used. How they are merged is in
//! `program`, and what their params are in `scope`.

use std::sync::Arc;

use super::database::Database;
use super::evaluate::evaluate;
use super::job::Job;
use super::program::{Located, Program, program};
use fretwork_diagnostic::Diagnostic;
use fretwork_language::{Entry, Param, Unit, Use};

/// A file that is a module of another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Module {
    /// The module that uses it.
    pub parent: Arc<str>,
    /// The file that uses it, and the unit of plain lengths there.
    pub user: (Arc<str>, Unit),
    /// What it says.
    pub uses: Use,
}

/// The name that an entry of a module has elsewhere.
pub fn inside(module: &str, name: &Arc<str>) -> Arc<str> {
    if module.is_empty() {
        name.clone()
    } else {
        format!("{module}.{name}").into()
    }
}

impl Program {
    /// The parameters of the root, which a caller may set.
    pub fn own_params(&self) -> impl Iterator<Item = &Located<Param>> {
        self.params.iter().filter(|param| param.module.is_empty())
    }

    /// Adds to what is told of a module through which places it is used.
    pub fn through(&self, module: &str, diagnostic: Diagnostic) -> Diagnostic {
        let mut diagnostic = diagnostic;
        let mut name = module;
        while let Some(module) = self.modules.get(name) {
            let place = module.uses.span.clone();
            if diagnostic.labels.iter().all(|label| label.span != place) {
                diagnostic = diagnostic.at(place, format!("used as `{name}` here"));
            }
            name = &module.parent;
        }
        diagnostic
    }

    /// As [`Program::through`], for what is told of a file: the first module that it belongs to.
    pub fn through_file(&self, diagnostic: Diagnostic) -> Diagnostic {
        let file = diagnostic
            .labels
            .first()
            .map(|label| label.span.file().clone());
        let of_file = |located: &&Located<Entry>| Some(&located.file) == file.as_ref();
        match self.entries.values().find(of_file) {
            Some(located) => self.through(&located.module, diagnostic),
            None => diagnostic,
        }
    }
}

/// What evaluating a job had to say.
pub fn told(db: &Database, job: &Job) -> Vec<Diagnostic> {
    let said = evaluate(db, job).diagnostics;
    said.iter().map(|d| through(db, job, d.clone())).collect()
}

/// What is told of a node, with the places through which its module is used.
pub fn through(db: &Database, job: &Job, diagnostic: Diagnostic) -> Diagnostic {
    match job.node.split() {
        ("", _) => diagnostic,
        (module, _) => program(db, job.root).through(module, diagnostic),
    }
}
