//! Whole specs: which jobs there are, running them, and what to tell about it.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use std::time::Instant;

use super::cache::Cache;
use super::database::{Database, Db as _, Event, Provenance, SourceFile};
use super::definition::{definition, linked};
use super::evaluate::{evaluate, value};
use super::explain;
use super::job::Job;
use super::once::told_once;
use super::overtaken::until_stopped;
use super::report::{Artifact, NodeReport, NodeStatus, Report, TraceSpan};
use super::schedule::{Plan, run};
use super::settings::Settings;
use super::sources::DatabaseSources;
use super::target::{Target, targets};
use super::target_paths::collisions;
use super::threads;
use super::windows::Cutting;
use super::world::World;
use fretwork_action::{Data, EngineChoice, Value};
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_geometry::budget::{Budget, Limits};
use fretwork_geometry::progress::{Steps, watched};
use fretwork_graph::{GraphFormat, NodeId, export};

/// Hears how a build goes on.
pub trait Progress: Sync {
    /// There are this many jobs.
    fn total(&self, jobs: usize);
    /// A job of this name has begun; it says in `steps` what it is doing.
    fn started(&self, name: &str, steps: &Arc<Steps>);
    /// A job of this name has ended.
    fn finished(&self, name: &str);
}

/// What to build.
pub struct Request<'a> {
    /// The specs, as paths from the project root.
    pub specs: Vec<String>,
    /// Values for parameters.
    pub settings: Settings,
    /// Artifacts, or nodes whose artifacts are meant; empty for all artifacts.
    pub only: Vec<String>,
    /// The parts of the plane to show; empty for the whole.
    pub windows: Vec<Cutting>,
    /// How many threads may work.
    pub threads: usize,
    /// Who hears of it.
    pub progress: &'a dyn Progress,
}

/// A compiler with everything that it has computed so far.
pub struct Compiler {
    pub(super) database: Database,
    /// Whether builds leave a record behind by which they are explained.
    is_recorded: bool,
}

/// The folder of a spec's artifacts below the output folder: its path under `specs/` without its
/// extension.
pub fn output_folder(spec: &str) -> String {
    let path = spec.strip_prefix("specs/").unwrap_or(spec);
    path.strip_suffix(".yaml")
        .or_else(|| path.strip_suffix(".yml"))
        .unwrap_or(path)
        .to_string()
}

impl Compiler {
    /// A compiler of the project `world`; with `checks_values` it looks for mistakes of its own in every
    /// value that it computes.
    pub fn new(world: Arc<dyn World>, cache: Option<Cache>, checks_values: bool) -> Compiler {
        Compiler {
            database: Database::new(world, cache, checks_values),
            is_recorded: true,
        }
    }

    /// The compiler whose builds are not explained afterwards: they answer a question, and what the last build did is
    /// still known.
    pub fn without_record(mut self) -> Compiler {
        self.is_recorded = false;
        self
    }

    /// The compiler with a budget of `factor` times as much work and memory for every node.
    pub fn with_budget(mut self, factor: f64) -> Compiler {
        self.database.limit(Limits::times(factor));
        self
    }

    /// The compiler that draws arrangements by some engine.
    pub fn with_engine(mut self, engine: EngineChoice) -> Compiler {
        self.database.choose(engine);
        self
    }

    /// Reads the known files again; gives the paths of those whose bytes changed.
    pub fn refresh(&mut self) -> Vec<Arc<str>> {
        self.database.refresh()
    }

    /// The paths of all files that were read or looked for.
    pub fn known_files(&self) -> Vec<Arc<str>> {
        self.database.known_files()
    }

    /// The texts that diagnostics point into.
    pub fn sources(&self) -> DatabaseSources<'_> {
        DatabaseSources::new(&self.database)
    }

    pub(super) fn root(&self, spec: &str) -> SourceFile {
        self.database.file(&Arc::from(spec))
    }

    /// The graph of a spec without errors, as text.
    pub fn graph(&self, spec: &str, settings: &Settings, format: GraphFormat) -> String {
        let root = self.root(spec);
        let linked = linked(&self.database, root, settings.clone());
        export(&linked, format, |id| {
            let definition = definition(&self.database, root, settings.clone(), id.clone());
            definition.map_or_else(Default::default, |d| {
                (
                    d.node.kind_name().to_string(),
                    d.node.provides().name().to_string(),
                )
            })
        })
    }

    /// Builds the artifacts asked for. Nothing is built when a spec has errors that `check` finds.
    pub fn build(&self, request: &Request<'_>) -> Report {
        self.build_with(request, &BTreeMap::new())
    }

    /// As [`Compiler::build`], with settings for some specs of their own in front of those of the request.
    pub fn build_with(&self, request: &Request<'_>, own: &BTreeMap<String, Settings>) -> Report {
        let (mut each, mut diagnostics) = self.settings_of(&request.specs, &request.settings);
        for (spec, settings) in request.specs.iter().zip(&mut each) {
            if let Some(own) = own.get(spec) {
                *settings = settings.and(own);
            }
        }
        let mut all = Vec::new();
        for (spec, settings) in request.specs.iter().zip(&each) {
            diagnostics.extend(self.check(spec, settings));
            all.extend(targets(&self.database, self.root(spec), settings).0);
        }
        diagnostics.extend(collisions(&all));
        let mut targets = self.chosen(all, &request.only, &mut diagnostics);
        if !diagnostics.iter().any(Diagnostic::is_error) {
            targets = self.cut(targets, &request.windows, &mut diagnostics);
            diagnostics.extend(collisions(&targets));
        }
        if diagnostics.iter().any(Diagnostic::is_error) {
            let specs = request.specs.iter().zip(&each);
            diagnostics
                .extend(specs.flat_map(|(spec, settings)| self.check_scripts(spec, settings)));
            return Report {
                diagnostics: sorted(diagnostics),
                ..Report::default()
            };
        }
        let (jobs, plan) = self.plan(targets.iter().map(|t| t.job.clone()));
        self.database.budget().begin(request.specs.len());
        let events = self.run(&jobs, &plan, request);
        if let Some(error) = spent(self.database.budget(), &request.specs) {
            return Report {
                diagnostics: vec![error],
                ..Report::default()
            };
        }
        diagnostics.extend(told_once(&self.database, &jobs));
        diagnostics.extend(self.database.take_store_error().map(unwritten));
        // What is tried out by somebody is not the build that `explain` speaks of.
        if own.is_empty() && self.is_recorded {
            explain::record(&self.database, &jobs, &events);
        }
        let artifacts = targets.into_iter();
        Report {
            artifacts: artifacts.filter_map(|t| self.artifact(t)).collect(),
            nodes: self.node_reports(&jobs, &events),
            spans: self.trace(&events),
            diagnostics: sorted(diagnostics),
        }
    }

    /// The artifact of a target, if it could be made.
    fn artifact(&self, target: Target) -> Option<Artifact> {
        let digest = evaluate(&self.database, &target.job).value?.digest;
        Some(Artifact {
            spec: target.job.root.path(&self.database).to_string(),
            path: target.path,
            digest,
            job: target.job,
        })
    }

    /// The bytes of an artifact.
    ///
    /// # Errors
    /// When they are neither in memory nor in the store and can no longer be computed.
    pub fn bytes(&self, artifact: &Artifact) -> Result<Arc<[u8]>, Diagnostic> {
        match value(&self.database, &artifact.job) {
            Some(Value::Data(Data::File(bytes))) => Ok(bytes),
            _ => Err(Diagnostic::error(format!(
                "the bytes of `{}` are lost; a file changed during the build",
                artifact.path
            ))),
        }
    }

    /// The targets that `only` means: those with that name or path, and those that need a node of
    /// that name.
    fn chosen(
        &self,
        all: Vec<Target>,
        only: &[String],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Vec<Target> {
        if only.is_empty() {
            return all;
        }
        let mut names = BTreeSet::new();
        let mut chosen = Vec::new();
        for target in all {
            let own = self.names(&target);
            if only.iter().any(|o| own.contains(o)) {
                chosen.push(target);
            }
            names.extend(own);
        }
        for unknown in only.iter().filter(|o| !names.contains(*o)) {
            let diagnostic =
                Diagnostic::error(format!("no artifact is named or needs `{unknown}`"))
                    .about(Code::Reference);
            diagnostics.push(diagnostic.suggest(unknown, names.iter().map(String::as_str)));
        }
        chosen
    }

    /// The names by which a target can be meant: its own, and those of the nodes that it needs.
    pub(super) fn names(&self, target: &Target) -> BTreeSet<String> {
        let (jobs, _) = self.plan([target.job.clone()]);
        let nodes = jobs.iter();
        let mut names: BTreeSet<String> = nodes
            .flat_map(|j| [j.node.to_string(), j.node.name.to_string()])
            .collect();
        names.insert(target.path.clone());
        names.extend(target.path.rsplit('/').next().map(str::to_string));
        names
    }

    /// The jobs of `targets` and of all that they need, each after those it needs.
    pub(super) fn plan(&self, targets: impl IntoIterator<Item = Job>) -> (Vec<Job>, Plan) {
        let mut planner = Planner {
            database: &self.database,
            numbers: HashMap::new(),
            jobs: Vec::new(),
            plan: Plan::default(),
        };
        for target in targets {
            planner.add(&target);
        }
        (planner.jobs, planner.plan)
    }

    pub(super) fn run(&self, jobs: &[Job], plan: &Plan, request: &Request<'_>) -> Vec<Event> {
        request.progress.total(jobs.len());
        // Elements of what may be drawn by tiles are evaluated when the jobs are planned.
        let planned = self.database.take_events().into_iter();
        let mut events: Vec<Event> = planned.filter(|e| jobs.contains(&e.job)).collect();
        let threads = threads::available(request.threads);
        run(&self.database, plan, threads, |database, number| {
            let name = jobs[number].node.to_string();
            let steps = Arc::default();
            request.progress.started(&name, &steps);
            until_stopped(database, || {
                watched(&steps, || evaluate(database, &jobs[number]));
            });
            request.progress.finished(&name);
        });
        self.database.forget_commons();
        self.database.budget().stop().check();
        events.extend(self.database.take_events());
        events
    }

    fn node_reports(&self, jobs: &[Job], events: &[Event]) -> Vec<NodeReport> {
        let mut reports: BTreeMap<(Arc<str>, NodeId), (NodeStatus, f64)> = BTreeMap::new();
        let key = |job: &Job| (job.root.path(&self.database).clone(), job.node.clone());
        // A node without a value was tried and failed, which is an event, or was never tried.
        for job in jobs
            .iter()
            .filter(|job| evaluate(&self.database, job).value.is_some())
        {
            reports.entry(key(job)).or_insert((NodeStatus::Reused, 0.0));
        }
        for event in events {
            let report = reports
                .entry(key(&event.job))
                .or_insert((NodeStatus::Reused, 0.0));
            report.0 = report.0.max(status(event.provenance));
            report.1 += event.time.as_secs_f64() * 1e3;
        }
        let kinds: HashMap<_, _> = jobs.iter().map(|j| (key(j), self.kind(j))).collect();
        let report =
            |((spec, id), (status, ms)): ((Arc<str>, NodeId), (NodeStatus, f64))| NodeReport {
                kind: kinds
                    .get(&(spec.clone(), id.clone()))
                    .cloned()
                    .unwrap_or_default(),
                spec: spec.to_string(),
                section: id.section.name().to_string(),
                name: id.name.to_string(),
                status,
                ms: (ms * 1e3).round() / 1e3,
            };
        reports.into_iter().map(report).collect()
    }

    fn trace(&self, events: &[Event]) -> Vec<TraceSpan> {
        let began = events
            .iter()
            .map(|e| e.started)
            .min()
            .unwrap_or_else(Instant::now);
        let span = |event: &Event| TraceSpan {
            name: event.job.node.to_string(),
            kind: self.kind(&event.job),
            status: status(event.provenance),
            thread: event.thread,
            start: event.started.saturating_duration_since(began),
            time: event.time,
        };
        events.iter().map(span).collect()
    }

    fn kind(&self, job: &Job) -> String {
        job.definition(&self.database)
            .map_or_else(String::new, |d| d.node.kind_name().to_string())
    }
}

/// The error when all nodes together took more than the budget. It is the only one: which of them were left undone
/// depends on their order.
pub(super) fn spent(budget: &Budget, specs: &[String]) -> Option<Diagnostic> {
    if !budget.is_spent() {
        return None;
    }
    let error = Diagnostic::error(budget.message());
    let error = match specs {
        [only] => error.at(Span::File(only.as_str().into()), ""),
        _ => error,
    };
    Some(error.help(budget.help()))
}

/// The warning of a cache that takes nothing.
fn unwritten(error: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::warning(format!("the cache cannot be written: {error}"))
        .about(Code::Output)
        .help("nothing is lost but time; choose another folder with `--cache-dir`")
}

fn status(provenance: Provenance) -> NodeStatus {
    match provenance {
        Provenance::Evaluated => NodeStatus::Evaluated,
        Provenance::Cached => NodeStatus::Cached,
    }
}

pub(super) fn sorted(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.sort();
    diagnostics.dedup();
    diagnostics
}

struct Planner<'a> {
    database: &'a Database,
    numbers: HashMap<Job, usize>,
    jobs: Vec<Job>,
    plan: Plan,
}

impl Planner<'_> {
    /// Adds `job` after all that it needs. A stack on the heap: chains of nodes may be long.
    fn add(&mut self, job: &Job) {
        let mut stack = vec![(job.clone(), job.needs(self.database), 0)];
        while let Some((job, needs, next)) = stack.last_mut() {
            if self.numbers.contains_key(job) {
                stack.pop();
            } else if let Some(need) = needs.get(*next).cloned() {
                *next += 1;
                if !self.numbers.contains_key(&need) {
                    let of_need = need.needs(self.database);
                    stack.push((need, of_need, 0));
                }
            } else {
                let needs = needs.iter().map(|n| self.numbers[n]).collect();
                self.numbers.insert(job.clone(), self.jobs.len());
                self.jobs.push(job.clone());
                self.plan.needs.push(needs);
                stack.pop();
            }
        }
    }
}
