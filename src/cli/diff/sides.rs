//! Two states of a project in one compiler: it reads one, then the other, and works out again only what differs. What its
//! artifacts are compared by is known here; the comparison itself is in `comparison`.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::arguments::Evaluation;
use crate::placed::{Placed, placed};
use crate::progress::Bar;
use crate::session::{Session, settings};
use crate::terminal;
use fretwork_diagnostic::{Diagnostic, render};
use fretwork_engine::{Artifact, Opened, ReadError, Report, Request, World, threads};

/// One of the two states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// The older one.
    Before,
    /// The newer one.
    After,
}

/// The files of both states, of which one is read.
pub struct Files {
    before: Arc<dyn World>,
    after: Arc<dyn World>,
    is_after: AtomicBool,
}

impl Files {
    /// Those of two worlds; the newer one is read first.
    pub fn new(before: Arc<dyn World>, after: Arc<dyn World>) -> Files {
        Files {
            before,
            after,
            is_after: AtomicBool::new(true),
        }
    }

    fn now(&self) -> &dyn World {
        match self.is_after.load(Ordering::SeqCst) {
            true => &*self.after,
            false => &*self.before,
        }
    }
}

impl World for Files {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.now().read(path)
    }

    fn open(&self, path: &str) -> Result<Opened, ReadError> {
        self.now().open(path)
    }

    fn names(&self, folder: &str) -> Vec<String> {
        self.now().names(folder)
    }
}

/// What a state was found to hold.
#[derive(Default)]
pub struct State {
    /// The specs.
    pub specs: Vec<String>,
    /// What it is called in messages; nothing for the work tree.
    pub rev: Option<String>,
    /// The artifacts that could be built, by their paths.
    pub artifacts: BTreeMap<String, Artifact>,
    /// The specs of the artifacts that were to be built, by their paths.
    pub wanted: BTreeMap<String, String>,
    /// The specs of which nothing was built.
    pub broken: BTreeSet<String>,
    /// What is wrong with it.
    pub errors: Vec<Placed>,
    /// The same for people.
    pub text: String,
    /// How many errors there are.
    pub count: usize,
}

/// The two states in one compiler.
pub struct Sides<'a> {
    /// The session, whose compiler reads `files`.
    pub session: Session,
    /// The files.
    pub files: Arc<Files>,
    /// How to evaluate.
    pub evaluation: &'a Evaluation,
}

impl Sides<'_> {
    /// The state that is read now.
    pub fn now(&self) -> Side {
        match self.files.is_after.load(Ordering::SeqCst) {
            true => Side::After,
            false => Side::Before,
        }
    }

    /// Reads this state from now on.
    pub fn turn(&mut self, to: Side) {
        if self.now() != to {
            self.files
                .is_after
                .store(to == Side::After, Ordering::SeqCst);
            self.session.compiler.refresh();
        }
    }

    /// The names of all parameters of `specs`.
    pub fn params(&self, specs: &[String]) -> BTreeSet<String> {
        let none = settings(&[]);
        let of = |spec: &String| self.session.compiler.params(spec, &none).0;
        let all = specs.iter().flat_map(of);
        all.map(|param| param.name).collect()
    }

    /// The paths that each name of a node or an artifact means.
    pub fn named(&self, specs: &[String]) -> BTreeMap<String, BTreeSet<String>> {
        let mut all: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        let compiler = &self.session.compiler;
        for spec in self.sound(specs) {
            for (path, names) in compiler.named_paths(&spec, &self.settings(specs)) {
                for name in names {
                    all.entry(name).or_default().insert(path.clone());
                }
            }
        }
        all
    }

    /// Builds the artifacts of the state that is read, of those at `only` if some are named.
    pub fn build(&self, state: &mut State, only: Option<&BTreeSet<String>>) {
        let is_meant = |path: &String| only.is_none_or(|only| only.contains(path));
        let report = self.sound_report(state, only);
        let errors = report.diagnostics.into_iter().filter(Diagnostic::is_error);
        let mut errors: Vec<Diagnostic> = errors.collect();
        errors.sort();
        errors.dedup();
        if !errors.is_empty() {
            let settings = self.settings(&state.specs);
            for spec in &state.specs {
                let paths = self.session.compiler.paths(spec, &settings).into_iter();
                let meant = paths.filter(is_meant).map(|path| (path, spec.clone()));
                state.wanted.extend(meant);
            }
        }
        let rev = state.rev.as_ref();
        for error in &mut errors {
            if let Some(rev) = rev {
                error.message = format!("at `{rev}`: {}", error.message);
            }
        }
        let artifacts = report.artifacts.into_iter();
        for artifact in artifacts.filter(|artifact| is_meant(&artifact.path)) {
            state
                .wanted
                .insert(artifact.path.clone(), artifact.spec.clone());
            state.artifacts.insert(artifact.path.clone(), artifact);
        }
        self.tell(state, &errors);
    }

    /// What building a state gives. What is wrong with one spec is no matter of the others.
    fn sound_report(&self, state: &mut State, only: Option<&BTreeSet<String>>) -> Report {
        let report = self.evaluate(&state.specs, only);
        let has_errors = report.diagnostics.iter().any(Diagnostic::is_error);
        if !has_errors || !report.artifacts.is_empty() {
            return report;
        }
        let sound = self.sound(&state.specs);
        let specs = state.specs.iter().cloned();
        state.broken = specs.filter(|spec| !sound.contains(spec)).collect();
        if sound.is_empty() || state.broken.is_empty() {
            return report;
        }
        let mut rest = self.evaluate(&sound, only);
        rest.diagnostics.extend(report.diagnostics);
        rest
    }

    fn tell(&self, state: &mut State, errors: &[Diagnostic]) {
        let shown: Vec<Diagnostic> = terminal::shortlist(errors).0.into_iter().cloned().collect();
        let sources = self.session.compiler.sources();
        state.text = render::render(&shown, &sources, terminal::has_colour());
        state.errors = placed(&self.session, shown.iter());
        state.count = errors.len();
    }

    /// The specs in which `check` finds no error.
    fn sound(&self, specs: &[String]) -> Vec<String> {
        let settings = self.settings(specs);
        let compiler = &self.session.compiler;
        let is_sound = |spec: &&String| {
            let known: BTreeSet<String> = self.params(std::slice::from_ref(*spec));
            let settings = settings.only(|name| known.contains(name));
            !compiler
                .check(spec, &settings)
                .iter()
                .any(Diagnostic::is_error)
        };
        specs.iter().filter(is_sound).cloned().collect()
    }

    /// The values of those parameters that some spec of the state has.
    fn settings(&self, specs: &[String]) -> fretwork_engine::Settings {
        let sets = &self.evaluation.sets;
        if sets.is_empty() {
            return settings(sets);
        }
        let known = self.params(specs);
        settings(sets).only(|name| known.contains(name))
    }

    fn evaluate(&self, specs: &[String], only: Option<&BTreeSet<String>>) -> Report {
        let compiler = &self.session.compiler;
        let settings = self.settings(specs);
        let only: Vec<String> = match only {
            None => Vec::new(),
            Some(only) => {
                let paths = specs
                    .iter()
                    .flat_map(|spec| compiler.paths(spec, &settings));
                let only: Vec<String> = paths.filter(|path| only.contains(path)).collect();
                if only.is_empty() {
                    return Report::default();
                }
                only
            }
        };
        let bar = Bar::new();
        let report = compiler.build(&Request {
            specs: specs.to_vec(),
            settings,
            only,
            windows: Vec::new(),
            threads: threads(self.evaluation.jobs.map(usize::from)),
            progress: &bar,
        });
        bar.finish();
        report
    }
}
