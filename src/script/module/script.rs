//! Scripts that are read: parsed with all that they load, run once to find errors, and run again
//! for every entry that is called, because what a script constructs depends on a seed.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use starlark::environment::{FrozenModule, Globals, Module};
use starlark::eval::{Evaluator, ReturnFileLoader};
use starlark::values::list::AllocList;
use starlark::values::{Heap, OwnedFrozenValue, Value as Script};

use crate::convert::to_script;
use crate::fault::{Fault, Sources};
use crate::library::{Host, Library};
use crate::module::reader::{Reader, Unit};
use crate::sandbox::budget::Limits;
use crate::scale::Scale;
use crate::scope::Scope;
use crate::session::{Session, prepare};
use crate::value::Value;
use crate::values::curves::CurvesValue;
use crate::values::foreign::{Callable, Operation};
use fretwork_diagnostic::{Diagnostic, nearest};
use fretwork_geometry::budget::Meter;
use fretwork_geometry::{Curves, Seed};

/// The stack on which scripts are compiled, run and frozen. Freezing recurses into values as deep
/// as a script makes them, of which the heap limit allows some hundred thousand.
const STACK: usize = 512 << 20;

/// Held while a script has this stack: there is one of them in a process, whatever the number of threads.
static RUNNING: Mutex<()> = Mutex::new(());

/// What is handed to an entry function.
#[derive(Clone, Debug)]
pub enum Supplied {
    /// A number, a text or the like.
    Plain(Value),
    /// Curves as they are.
    Curves(Arc<Curves>),
    /// A function that Rust defines.
    Function(Arc<dyn Operation>),
    /// Several of these.
    List(Vec<Supplied>),
}

/// A script with all that it loads.
pub struct ScriptModule {
    globals: &'static Globals,
    /// In the order in which they are run; the script itself is the last.
    units: Vec<Unit>,
    sources: Sources,
    /// What the script and all that it loads share.
    pub library: Arc<Library>,
}

/// What an entry gave: the value, and what keeps it alive.
pub struct Entered {
    /// The module that owns the value.
    pub module: FrozenModule,
    /// What the entry function gave.
    pub value: OwnedFrozenValue,
}

impl ScriptModule {
    /// Reads `text`, which is the file `file`, with what it loads through `host`, and runs it.
    pub fn read(
        globals: &'static Globals,
        file: &Arc<str>,
        text: &str,
        host: Arc<dyn Host>,
    ) -> Result<ScriptModule, Vec<Diagnostic>> {
        let mut reader = Reader::new(&*host);
        reader.read(file, text, &mut Vec::new())?;
        let Reader { units, sources, .. } = reader;
        let library = Arc::new(Library::new(host));
        let module = ScriptModule {
            globals,
            units,
            sources,
            library,
        };
        module.run(Seed::root(0), |_, _| Ok(()))?;
        Ok(module)
    }

    /// The file that the script is.
    pub fn file(&self) -> &Arc<str> {
        &self.main().file
    }

    /// The diagnostic about a fault in this script.
    pub fn diagnostic(&self, fault: &Fault) -> Diagnostic {
        fault.diagnostic(self.file(), &self.sources)
    }

    fn main(&self) -> &Unit {
        self.units.last().expect("a script has a file")
    }

    /// The names of the functions that the script defines at its top, in order.
    pub fn functions(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.main().functions.iter().map(|f| f.name.as_str())
    }

    /// Runs the script and calls its function `entry` with `args`; constructions draw from `seed`.
    /// A name that means an arrangement stands for itself when there are no arguments.
    pub fn enter(
        &self,
        entry: &str,
        args: &[(Arc<str>, Supplied)],
        seed: Seed,
    ) -> Result<Entered, Vec<Diagnostic>> {
        let call = |main: &FrozenModule, session: &Session| self.call(main, session, entry, args);
        self.run(seed, call)
    }

    /// The function `entry` itself, for a script that is one mapper.
    pub fn function(&self, entry: &str, seed: Seed) -> Result<Entered, Vec<Diagnostic>> {
        self.run(seed, |main, _| {
            let value = main.get(entry).map_err(|_| self.missing(entry))?;
            Ok(Entered {
                module: main.clone(),
                value,
            })
        })
    }

    /// Runs all units in order, then `last` on the module of the script itself.
    fn run<T: Send>(
        &self,
        seed: Seed,
        last: impl FnOnce(&FrozenModule, &Session) -> Result<T, Box<Fault>> + Send,
    ) -> Result<T, Vec<Diagnostic>> {
        let work = || {
            let session = Session::new(
                Limits::ENTRY.scaled(),
                self.library.clone(),
                Scope::entry(seed),
                Scale::unit(),
                None,
            );
            let mut modules: Vec<FrozenModule> = Vec::new();
            for unit in &self.units {
                let module = self
                    .run_unit(unit, &modules, &session)
                    .map_err(|fault| (fault, unit.file.clone()))?;
                modules.push(module);
            }
            let main = modules.last().expect("a script has a file");
            last(main, &session).map_err(|fault| (fault, self.file().clone()))
        };
        // Nothing that a script calls waits for another script, so this ends.
        let _alone = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        let meter = Meter::current();
        let work = || meter.during(work);
        let result = std::thread::scope(|scope| {
            let thread = std::thread::Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, work);
            let thread = thread.map_err(|e| {
                (
                    Fault::new(format!("no thread for the script: {e}")),
                    self.file().clone(),
                )
            })?;
            thread
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        });
        result
            .map_err(|(fault, file)| vec![self.suggesting(fault).diagnostic(&file, &self.sources)])
    }

    fn run_unit(
        &self,
        unit: &Unit,
        modules: &[FrozenModule],
        session: &Session,
    ) -> Result<FrozenModule, Box<Fault>> {
        let known: HashMap<&str, &FrozenModule> = unit
            .loads
            .iter()
            .map(|(path, number)| (path.as_str(), &modules[*number]))
            .collect();
        let loader = ReturnFileLoader { modules: &known };
        Module::with_temp_heap(|module| {
            let mut eval = Evaluator::new(&module);
            prepare(&mut eval, session);
            eval.set_loader(&loader);
            eval.eval_module(unit.ast.clone(), self.globals)
                .map_err(|e| Fault::of(&e))?;
            drop(eval);
            module
                .freeze()
                .map_err(|e| Fault::new(e.err_msg.to_string()))
        })
    }

    fn call(
        &self,
        main: &FrozenModule,
        session: &Session,
        entry: &str,
        args: &[(Arc<str>, Supplied)],
    ) -> Result<Entered, Box<Fault>> {
        let function = main.get(entry).map_err(|_| self.missing(entry))?;
        let module = Module::with_temp_heap(|module| {
            let function = module.heap().access_owned_frozen_value(&function);
            let value = if args.is_empty() && Callable::from_value(function).is_some() {
                function
            } else {
                let names: Vec<&str> = args.iter().map(|(name, _)| &**name).collect();
                let definition = self.main().functions.iter().rfind(|f| f.name == entry);
                if let Some(fault) = definition.and_then(|definition| definition.refuses(&names)) {
                    return Err(fault);
                }
                let named: Vec<(&str, Script)> = args
                    .iter()
                    .map(|(name, value)| (&**name, supply(value, module.heap())))
                    .collect();
                let mut eval = Evaluator::new(&module);
                prepare(&mut eval, session);
                eval.eval_function(function, &[], &named)
                    .map_err(|e| Fault::of(&e))?
            };
            module.set("entered", value);
            module
                .freeze()
                .map_err(|e| Fault::new(e.err_msg.to_string()))
        })?;
        let value = module
            .get("entered")
            .map_err(|e| Fault::new(e.to_string()))?;
        Ok(Entered { module, value })
    }

    fn missing(&self, entry: &str) -> Box<Fault> {
        let near = nearest(entry, self.functions());
        let help = near.map(|name| format!("did you mean `{name}`?"));
        let mut fault = Fault::new(format!("`{}` defines no `{entry}`", self.file()));
        fault.help(help);
        fault
    }

    /// The same fault with the nearest known name where it is about an unknown one.
    fn suggesting(&self, mut fault: Box<Fault>) -> Box<Fault> {
        let unknown = fault
            .message
            .strip_prefix("unknown name `")
            .and_then(|rest| rest.strip_suffix('`'));
        let Some(unknown) = unknown.filter(|_| fault.help.is_none()) else {
            return fault;
        };
        let globals: Vec<&str> = self
            .globals
            .iter()
            .map(|g| g.0)
            .filter(|name| !name.starts_with('_'))
            .collect();
        let known = globals.into_iter().chain(self.functions());
        let help = match nearest(unknown, known) {
            Some(name) => format!("did you mean `{name}`?"),
            None => "`fretwork schema --functions` lists the functions that there are".to_owned(),
        };
        fault.help(Some(help));
        fault
    }
}

fn supply<'v>(value: &Supplied, heap: Heap<'v>) -> Script<'v> {
    match value {
        Supplied::Plain(value) => to_script(value, heap),
        Supplied::Curves(curves) => heap.alloc(CurvesValue::fixed(curves.clone())),
        Supplied::Function(operation) => heap.alloc(Callable::new(operation.clone(), Vec::new())),
        Supplied::List(items) => heap.alloc(AllocList(items.iter().map(|item| supply(item, heap)))),
    }
}
