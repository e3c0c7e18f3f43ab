//! Scripts, arrangements and mappers as callers see them.

use std::sync::{Arc, LazyLock};

use starlark::environment::{Globals, GlobalsBuilder, Module};
use starlark::eval::Evaluator;
use starlark::values::{Value, ValueLike};

use crate::function::{Applied, Arrangement, Manner};
use crate::script::argument::Argument;
use crate::script::mapping::{Items, Mapping, Reach, described};
use crate::script::operators::arguments::is_function;
use crate::script::parallel::Job;
use crate::script::place::Place;
use crate::script::{evaluation, operators, parallel, structure};
use crate::tiled::regularity::{Irregular, Regularity};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, PlanarMap, Region, Seed};
use fretwork_script::fault::Fault;
use fretwork_script::known::KnownCells;
use fretwork_script::module::{Entered, ScriptModule};
use fretwork_script::scope::Scope;
use fretwork_script::session::{CurvesValue, Scale, Session, prepare};
use fretwork_script::values::CellKind;
use fretwork_script::watch::Watch;
use fretwork_script::{Host, Limits};

/// What a script can call.
static GLOBALS: LazyLock<Globals> =
    LazyLock::new(|| GlobalsBuilder::standard().with(operators::register).build());

/// A script with the operators of element textures.
#[derive(Clone)]
pub struct Script(Arc<ScriptModule>);

impl Script {
    /// Reads `text`, which is the file `file` (its name in diagnostics, and what paths in it are
    /// relative to), with all that it loads, and runs it once.
    ///
    /// # Errors
    /// What does not parse, unknown names, circles of loads, and whatever goes wrong at the top of
    /// a script.
    pub fn compile(
        file: &Arc<str>,
        text: &str,
        host: Arc<dyn Host>,
    ) -> Result<Script, Vec<Diagnostic>> {
        ScriptModule::read(&GLOBALS, file, text, host).map(|loaded| Script(Arc::new(loaded)))
    }

    /// The names of the functions that it defines, in order.
    pub fn functions(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.0.functions()
    }

    /// What `entry(**args)` gives, an arrangement: something an operator constructed, or any
    /// function of one argument. All that is random in it follows from `seed`.
    ///
    /// # Errors
    /// No such entry (with the nearest one), an error in it, another result.
    pub fn arrangement(
        &self,
        entry: &str,
        args: &[(Arc<str>, Argument)],
        seed: Seed,
    ) -> Result<ScriptArrangement, Vec<Diagnostic>> {
        let program = self.enter(entry, args, seed, "an arrangement")?;
        Ok(ScriptArrangement {
            program,
            step: None,
        })
    }

    /// What `entry(**args)` gives, a mapper: a function of one cell.
    ///
    /// # Errors
    /// No such entry (with the nearest one), an error in it, another result.
    pub fn mapper(
        &self,
        entry: &str,
        args: &[(Arc<str>, Argument)],
        seed: Seed,
    ) -> Result<Mapper, Vec<Diagnostic>> {
        Ok(Mapper::of(self.enter(entry, args, seed, "a mapper")?))
    }

    /// The mapper that a script written in a spec is: the last function that it defines.
    ///
    /// # Errors
    /// A script without a function.
    pub fn inline_mapper(&self, seed: Seed) -> Result<Mapper, Vec<Diagnostic>> {
        let Some(name) = self.functions().next_back() else {
            let error = Diagnostic::error("this defines no mapper")
                .help("write `def mapper(cell): return …`");
            return Err(vec![error.at(Span::File(self.0.file().clone()), "")]);
        };
        let entered = self.0.function(name, seed)?;
        Ok(Mapper::of(self.program(entered, seed)))
    }

    /// Whether `entry` is defined.
    ///
    /// # Errors
    /// No such entry (with the nearest one).
    pub fn check_entry(&self, entry: &str) -> Result<(), Vec<Diagnostic>> {
        self.0.function(entry, Seed::root(0)).map(drop)
    }

    fn enter(
        &self,
        entry: &str,
        args: &[(Arc<str>, Argument)],
        seed: Seed,
        wanted: &str,
    ) -> Result<Arc<Program>, Vec<Diagnostic>> {
        let args: Vec<_> = args
            .iter()
            .map(|(name, value)| (name.clone(), value.supplied()))
            .collect();
        let entered = self.0.enter(entry, &args, seed)?;
        let value = entered.value.value();
        if !is_function(value) {
            let what = if value.downcast_ref::<CurvesValue>().is_some() {
                "curves (`lambda region: curves` is an arrangement)".to_owned()
            } else {
                described(value)
            };
            let error = Diagnostic::error(format!("`{entry}` gives {what}, not {wanted}"));
            return Err(vec![error.at(Span::File(self.0.file().clone()), "")]);
        }
        Ok(self.program(entered, seed))
    }

    fn program(&self, entered: Entered, seed: Seed) -> Arc<Program> {
        Arc::new(Program {
            loaded: self.0.clone(),
            entered,
            seed,
        })
    }
}

/// What an entry gave, with the script it came from.
struct Program {
    loaded: Arc<ScriptModule>,
    entered: Entered,
    seed: Seed,
}

impl Program {
    fn job(&self, scale: Scale, manner: Manner) -> Arc<Job> {
        let mut job = Job::new(self.loaded.clone(), self.entered.module.clone(), scale);
        let patch = match manner {
            Manner::Free => None,
            Manner::Regular(patch) => Some(patch),
        };
        job.patch = patch;
        job.watch = patch.map(|patch| Watch {
            allows_random: false,
            deep: patch.deep,
        });
        Arc::new(job)
    }

    fn diagnostics(&self, fault: &Fault) -> Vec<Diagnostic> {
        vec![self.loaded.diagnostic(fault)]
    }

    /// The value that the entry gave, in an evaluation on the scale of `job`.
    fn run<T>(
        &self,
        job: &Arc<Job>,
        work: impl for<'v> FnOnce(Value<'v>, &mut Evaluator<'v, '_, '_>) -> starlark::Result<T>,
    ) -> Result<T, Vec<Diagnostic>> {
        // The operators outside of mappers hold larger things than a mapper may.
        let limits = Limits {
            points: 8 * Limits::RESULT,
            ..Limits::MAPPER.scaled()
        };
        let scope = Scope::entry(self.seed);
        let session = Session::new(
            limits,
            self.loaded.library.clone(),
            scope,
            job.scale,
            Some(job.clone()),
        )
        .watched(job.watch);
        let result = Module::with_temp_heap(|module| {
            let mut eval = Evaluator::new(&module);
            prepare(&mut eval, &session);
            let root = module.heap().access_owned_frozen_value(&self.entered.value);
            work(root, &mut eval).map_err(|e| Fault::of(&e))
        });
        result.map_err(|fault| {
            let mut fault = job.stashed().unwrap_or(fault);
            fault.notes.extend(session.take_notes());
            self.diagnostics(&fault)
        })
    }
}

/// A function from regions to curves that a script made.
#[derive(Clone)]
pub struct ScriptArrangement {
    program: Arc<Program>,
    step: Option<f64>,
}

impl ScriptArrangement {
    /// The same with positions rounded to `step`, where there is one, before they are hashed.
    pub fn in_steps(self, step: Option<f64>) -> ScriptArrangement {
        ScriptArrangement { step, ..self }
    }

    /// What is repeated in it on a region.
    pub(crate) fn regularity(&self) -> Result<Regularity, Irregular> {
        structure::regularity(self.program.entered.value.value())
    }

    /// The curves on `region`, not cropped to it; points nearer than `resolution` are one, also in
    /// the regions that arise inside. Mappers run on all threads of the current pool; the result is
    /// the same for any number of them.
    ///
    /// # Errors
    /// What goes wrong in the script or its operators, or uses up its [`Limits`].
    pub fn evaluate(&self, region: &Region, resolution: f64) -> Applied {
        self.evaluate_as(region, resolution, Manner::Free)
    }

    /// The same in a manner.
    pub(crate) fn evaluate_as(&self, region: &Region, resolution: f64, manner: Manner) -> Applied {
        let scale = Scale::of(region, resolution).in_steps(self.step);
        let place = Arc::new(region.clone());
        let program = &self.program;
        program.run(&program.job(scale, manner), |root, eval| {
            evaluation::evaluate(root, &Place::region_of(place), eval)
        })
    }
}

impl From<ScriptArrangement> for Arrangement {
    fn from(made: ScriptArrangement) -> Arrangement {
        Arrangement::with(made.regularity(), move |region, resolution, manner| {
            made.evaluate_as(region, resolution, manner)
        })
    }
}

/// A function of cells that a script made.
#[derive(Clone)]
pub struct Mapper {
    program: Arc<Program>,
    step: Option<f64>,
    reach: Reach,
}

impl Mapper {
    fn of(program: Arc<Program>) -> Mapper {
        Mapper {
            program,
            step: None,
            reach: Reach::Any,
        }
    }

    /// The same with positions rounded to `step`, where there is one, before they are hashed.
    pub fn in_steps(self, step: Option<f64>) -> Mapper {
        Mapper { step, ..self }
    }

    /// How far curves may leave the box of their cell.
    pub(crate) fn reach(&self) -> Reach {
        self.reach
    }

    /// The same, which fails where a curve leaves the box of its cell by more than `reach`.
    pub fn within(self, reach: Reach) -> Mapper {
        Mapper { reach, ..self }
    }

    /// The curves that the mapper gives for the cells of a task, one after another.
    ///
    /// # Errors
    /// What goes wrong in the mapper or uses up its [`Limits`].
    pub(crate) fn map_cells(
        &self,
        task: Task,
        region: &Region,
        resolution: f64,
    ) -> Result<Curves, Vec<Diagnostic>> {
        let scale = Scale::of(region, resolution).in_steps(self.step);
        let mut job = Job::new(
            self.program.loaded.clone(),
            self.program.entered.module.clone(),
            scale,
        );
        job.watch = task.watch;
        job.known = task.known;
        let job = Arc::new(job);
        let mapping = Mapping {
            kind: task.kind,
            map: task.map,
            items: task.items,
            seed: self.program.seed.name("map"),
            site: None,
            reach: self.reach,
        };
        self.program
            .run(&job, |root, _| match root.unpack_frozen() {
                Some(mapper) => parallel::map_in_parallel(&mapping, mapper, &job)
                    .map_err(|fault| job.stash(fault)),
                None => Err(fretwork_script::session::refuse("the mapper is not frozen")),
            })
    }
}

/// What a mapper is called on. Positions are hashed on the scale of the region that the map covers.
pub(crate) struct Task {
    pub kind: CellKind,
    pub map: Arc<PlanarMap>,
    pub items: Items,
    pub watch: Option<Watch>,
    /// What of the map is known, if not all of it.
    pub known: Option<Arc<KnownCells>>,
}
