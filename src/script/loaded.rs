//! Scripts that are read: parsed with all that they load, run once to find errors, and run again
//! for every entry that is called, because what a script constructs depends on a seed.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use starlark::environment::{FrozenModule, Globals, Module};
use starlark::eval::{Evaluator, ReturnFileLoader};
use starlark::syntax::ast::{AstParameter, AstStmt, ParameterP, Stmt};
use starlark::syntax::{AstModule, Dialect};
use starlark::values::list::AllocList;
use starlark::values::{Heap, OwnedFrozenValue, Value as Script};

use super::convert::to_script;
use super::fault::{Fault, Sources};
use super::guard::Limits;
use super::language;
use super::library::{Host, Library};
use super::scope::Scope;
use super::session::{Scale, Session, prepare};
use super::value::Value;
use super::values::{Callable, CurvesValue, Operation};
use fretwork_diagnostic::{Diagnostic, Span, nearest};
use fretwork_geometry::{Curves, Seed};

const DIALECT: Dialect = Dialect {
    enable_top_level_stmt: true,
    enable_keyword_only_arguments: true,
    ..Dialect::Standard
};

/// How many files a script may load, directly or not.
const FILES: usize = 200;

/// The stack on which scripts are compiled, run and frozen. Freezing recurses into values as deep
/// as a script makes them, of which the heap limit allows some hundred thousand.
const STACK: usize = 512 << 20;

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
pub struct Loaded {
    globals: &'static Globals,
    /// In the order in which they are run; the script itself is the last.
    units: Vec<Unit>,
    sources: Sources,
    /// What the script and all that it loads share.
    pub library: Arc<Library>,
}

/// One file.
struct Unit {
    file: Arc<str>,
    ast: AstModule,
    /// Paths in its load statements, with the number of the unit.
    loads: Vec<(String, usize)>,
    /// Functions it defines, in order.
    functions: Vec<Definition>,
}

/// A function as it is defined.
struct Definition {
    name: String,
    /// Its parameters, and whether each has a default.
    parameters: Vec<(String, bool)>,
    /// Whether it takes arguments of any name.
    is_open: bool,
}

impl Definition {
    /// What is wrong with arguments of these names, if something is.
    fn refuses(&self, names: &[&str]) -> Option<Box<Fault>> {
        let known = || self.parameters.iter().map(|(name, _)| name.as_str());
        if let Some(unknown) = names
            .iter()
            .find(|name| !self.is_open && known().all(|known| known != **name))
        {
            let mut fault = Fault::new(format!("`{}` has no parameter `{unknown}`", self.name));
            let all: Vec<String> = known().map(|name| format!("`{name}`")).collect();
            fault.help(Some(match nearest(unknown, known()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if all.is_empty() => "it has none".to_string(),
                None => format!("it has {}", all.join(", ")),
            }));
            return Some(fault);
        }
        let missing = self
            .parameters
            .iter()
            .find(|(name, has_default)| !has_default && !names.contains(&name.as_str()));
        missing.map(|(name, _)| Fault::new(format!("`{}` needs an argument `{name}`", self.name)))
    }
}

/// What an entry gave: the value, and what keeps it alive.
pub struct Entered {
    /// The module that owns the value.
    pub module: FrozenModule,
    /// What the entry function gave.
    pub value: OwnedFrozenValue,
}

impl Loaded {
    /// Reads `text`, which is the file `file`, with what it loads through `host`, and runs it.
    pub fn read(
        globals: &'static Globals,
        file: &Arc<str>,
        text: &str,
        host: Arc<dyn Host>,
    ) -> Result<Loaded, Vec<Diagnostic>> {
        let mut reader = Reader {
            host: &*host,
            units: Vec::new(),
            known: BTreeMap::new(),
            sources: Sources::new(),
        };
        reader.read(file, text, &mut Vec::new())?;
        let Reader { units, sources, .. } = reader;
        let library = Arc::new(Library::new(host));
        let loaded = Loaded {
            globals,
            units,
            sources,
            library,
        };
        loaded.run(Seed::root(0), |_, _| Ok(()))?;
        Ok(loaded)
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
                Limits::ENTRY,
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
        let help = nearest(unknown, known).map(|name| format!("did you mean `{name}`?"));
        fault.help(help);
        fault
    }
}

fn supply<'v>(value: &Supplied, heap: Heap<'v>) -> Script<'v> {
    match value {
        Supplied::Plain(value) => to_script(value, heap),
        Supplied::Curves(curves) => heap.alloc(CurvesValue(curves.clone())),
        Supplied::Function(operation) => heap.alloc(Callable::new(operation.clone(), Vec::new())),
        Supplied::List(items) => heap.alloc(AllocList(items.iter().map(|item| supply(item, heap)))),
    }
}

struct Reader<'a> {
    host: &'a dyn Host,
    units: Vec<Unit>,
    known: BTreeMap<Arc<str>, usize>,
    sources: Sources,
}

impl Reader<'_> {
    /// Reads `file` after what it loads; its number. `open` are the files whose loads are being read.
    fn read(
        &mut self,
        file: &Arc<str>,
        text: &str,
        open: &mut Vec<Arc<str>>,
    ) -> Result<usize, Vec<Diagnostic>> {
        if let Some(number) = self.known.get(file) {
            return Ok(*number);
        }
        let place = |start: usize, end: usize| Span::Bytes {
            file: file.clone(),
            start,
            end,
        };
        let guarded = language::read(file, text, &DIALECT)
            .map_err(|e| vec![Diagnostic::error(e.message).at(place(e.start, e.end), "")])?;
        open.push(file.clone());
        let mut loads = Vec::new();
        let mut errors = Vec::new();
        for load in guarded.plain.loads() {
            let (start, end) = (
                load.span.span.begin().get() as usize,
                load.span.span.end().get() as usize,
            );
            match self.load(load.module_id, file, open) {
                Ok(number) => loads.push((load.module_id.to_owned(), number)),
                Err(Failure::Here(message)) => {
                    errors.push(Diagnostic::error(message).at(place(start, end), ""))
                }
                Err(Failure::There(inner)) => errors.extend(inner),
            }
        }
        open.pop();
        if !errors.is_empty() {
            return Err(errors);
        }
        let functions = functions(guarded.plain.statement());
        self.sources.insert(file.to_string(), guarded.rewritten);
        self.units.push(Unit {
            file: file.clone(),
            ast: guarded.ast,
            loads,
            functions,
        });
        self.known.insert(file.clone(), self.units.len() - 1);
        Ok(self.units.len() - 1)
    }

    fn load(
        &mut self,
        path: &str,
        from: &Arc<str>,
        open: &mut Vec<Arc<str>>,
    ) -> Result<usize, Failure> {
        let (file, text) = self.host.script(path, from).map_err(Failure::Here)?;
        if let Some(first) = open.iter().position(|known| *known == file) {
            let mut circle: Vec<&str> = open[first..].iter().map(|f| &**f).collect();
            circle.push(&file);
            return Err(Failure::Here(format!(
                "scripts load one another in a circle: {}",
                circle.join(" → ")
            )));
        }
        if self.units.len() + open.len() > FILES {
            return Err(Failure::Here(format!(
                "more than {FILES} scripts are loaded"
            )));
        }
        self.read(&file, &text, open).map_err(Failure::There)
    }
}

/// Whether a load itself failed or the script that it loads.
enum Failure {
    Here(String),
    There(Vec<Diagnostic>),
}

/// What `def` statements at the top define, in order.
fn functions(statement: &AstStmt) -> Vec<Definition> {
    match &statement.node {
        Stmt::Statements(inner) => inner.iter().flat_map(functions).collect(),
        Stmt::Def(def) => {
            let parameter = |p: &AstParameter| match &p.node {
                ParameterP::Normal(name, _, default) => {
                    Some((name.node.ident.clone(), default.is_some()))
                }
                _ => None,
            };
            vec![Definition {
                name: def.name.node.ident.clone(),
                parameters: def.params.iter().filter_map(parameter).collect(),
                is_open: def
                    .params
                    .iter()
                    .any(|p| matches!(p.node, ParameterP::KwArgs(..))),
            }]
        }
        _ => Vec::new(),
    }
}
