//! The values that expressions may name: parameters, derived values.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::modules::Module;
use super::program::{Located, Program, program};
use super::ruler::{Fonts, OwnLetters};
use super::settings::{Setting, Settings};
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_language::{DecodeContext, Map, Param, Piece, Tree, decode_map};
use fretwork_script::{Value, free_names};

/// Names and values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scope {
    /// Every parameter and derived value that has one.
    pub values: BTreeMap<Arc<str>, Value>,
    /// Names whose values are wrong; that has been said.
    pub failed: BTreeSet<Arc<str>>,
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
    /// How many elements the derived values have together.
    size: usize,
    /// Whether there were too many, which is said once.
    is_full: bool,
}

/// The scope of the spec whose root is `root`, under `settings`.
#[salsa::tracked(returns(clone))]
pub fn scope(db: &dyn Db, root: SourceFile, settings: Settings) -> Arc<Scope> {
    let program = program(db, root);
    let mut scope = of_params(&program, &settings);
    add_paper(db, root, &settings, &mut scope);
    scope.failed.extend(program.unread.names.iter().cloned());
    report_unknown(&program, &settings, &mut scope);
    add_lets(db, &program, "", &settings, &mut scope);
    Arc::new(scope)
}

/// The derived values of a module, or of the root where it has no name.
fn add_lets(db: &dyn Db, program: &Program, module: &str, settings: &Settings, scope: &mut Scope) {
    let own = program.lets.iter().filter(|l| *l.module == *module);
    let lets: Lets<'_> = own
        .map(|l| (l.item.0.clone(), (&l.file, &l.item.1)))
        .collect();
    for name in lets.keys() {
        add_let(db, name, &lets, settings, scope);
    }
}

/// The scope of a module, or of the root where it has no name.
pub fn scope_of(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    module: &Arc<str>,
) -> Arc<Scope> {
    if module.is_empty() {
        scope(db, root, settings)
    } else {
        module_scope(db, root, settings, module.clone())
    }
}

/// The scope of a module under `settings` of the root: its params have the values that it is used with.
#[salsa::tracked(returns(clone))]
pub fn module_scope(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    module: Arc<str>,
) -> Arc<Scope> {
    let program = program(db, root);
    let mut made = Scope::default();
    let Some(user) = program.modules.get(&module) else {
        return Arc::new(made);
    };
    let outer = scope_of(db, root, settings.clone(), &user.parent);
    let own = || program.params.iter().filter(|p| p.module == module);
    let given = add_given(db, &program, (&module, user), &outer, &mut made);
    let unread = program.unread.names.iter();
    let own_unread = unread.filter_map(|name| name.strip_prefix(&*module)?.strip_prefix('.'));
    made.failed.extend(own_unread.map(Arc::from));
    let none = Settings::default();
    own()
        .filter(|param| !given.contains(&param.item.name))
        .for_each(|param| add_param(param, &none, &mut made));
    add_paper(db, root, &settings, &mut made);
    add_lets(db, &program, &module, &none, &mut made);
    Arc::new(made)
}

/// Gives params of a module the values that it is used with, and tells which these are.
fn add_given(
    db: &dyn Db,
    program: &Program,
    (module, user): (&Arc<str>, &Module),
    outer: &Scope,
    made: &mut Scope,
) -> BTreeSet<Arc<str>> {
    let own = || program.params.iter().filter(|p| p.module == *module);
    let mut given = BTreeSet::new();
    for (name, tree) in &user.uses.with {
        given.insert(name.clone());
        let with: Arc<str> = "with".into();
        let path = [&user.uses.at[..], &[with, name.clone()]].concat();
        let Some(param) = own().find(|p| p.item.name == *name) else {
            let known: Vec<&str> = own().map(|p| &*p.item.name).collect();
            let unknown =
                Diagnostic::error(format!("the module `{module}` has no parameter `{name}`"))
                    .about(Code::Reference)
                    .at(Span::key(&user.user.0, &path), "");
            made.diagnostics.push(unknown.suggest(name, known));
            continue;
        };
        let value = evaluate_tree(db, tree, (&user.user.0, &path), outer).and_then(|value| {
            param
                .item
                .accept_from(&value, user.user.1, param.units)
                .map_err(|problem| {
                    let message = format!("parameter `{name}`: {problem}");
                    let declared = Span::key(&param.file, &["params".into(), name.clone()]);
                    let error = Diagnostic::error(message).at(Span::value(&user.user.0, &path), "");
                    vec![error.at(declared, "declared here")]
                })
        });
        match value {
            Ok(value) => {
                made.values.insert(name.clone(), to_value(&value));
            }
            Err(diagnostics) => {
                made.diagnostics.extend(diagnostics);
                made.failed.insert(name.clone());
            }
        }
    }
    given
}

/// The parameters of the root alone.
fn of_params(program: &Program, settings: &Settings) -> Scope {
    let mut scope = Scope::default();
    for param in program.own_params() {
        add_param(param, settings, &mut scope);
    }
    scope
}

/// The plane of the spec's map, if it is a map, and what is wrong with it. Its expressions see parameters, but
/// no derived values, which may be derived from the map's scale.
pub fn map(db: &dyn Db, root: SourceFile, settings: &Settings) -> (Option<Map>, Vec<Diagnostic>) {
    let program = program(db, root);
    let Some(tree) = &program.map else {
        return (None, Vec::new());
    };
    let context = DecodeContext {
        file: program.root.clone(),
        path: Vec::new(),
        file_units: program.units,
        spec_units: program.measure(),
        is_scaled: false,
        modules: Default::default(),
    };
    let scope = of_params(&program, settings);
    let read = evaluate_tree(db, tree, (&program.root, &["map".into()]), &scope)
        .and_then(|tree| decode_map(&tree, &context));
    let empty = || decode_map(&Tree::Null, &context).ok();
    read.map_or_else(
        |diagnostics| (empty(), diagnostics),
        |map| (Some(map), Vec::new()),
    )
}

/// Adds `paper_mm` where the map has a scale.
fn add_paper(db: &dyn Db, root: SourceFile, settings: &Settings, scope: &mut Scope) {
    let (map, diagnostics) = map(db, root, settings);
    let program = program(db, root);
    let mut own = program.lets.iter().filter(|l| l.module.is_empty());
    let has_own = own.any(|l| *l.item.0 == *PAPER);
    if has_own || scope.values.contains_key(PAPER) {
        return;
    }
    if let Some(metres) = map.and_then(|map| map.paper_mm()) {
        scope.values.insert(PAPER.into(), Value::Float(metres));
    } else if !diagnostics.is_empty() {
        scope.failed.insert(PAPER.into());
    }
}

/// The metres of one millimetre on paper, in maps with a scale. A parameter or derived value of that name takes its place.
const PAPER: &str = "paper_mm";

/// The value of a param under `settings`.
///
/// # Errors
/// What is wrong with it, in a sentence.
pub fn setting_of(located: &Located<Param>, settings: &Settings) -> Result<Tree, String> {
    let param = &located.item;
    match settings.get(&param.name) {
        None => Ok(param.default.clone()),
        Some(Setting::Text(text)) => param.parse(text, located.units),
        Some(Setting::Value(value)) => param.accept(value, located.units),
    }
}

fn add_param(located: &Located<Param>, settings: &Settings, scope: &mut Scope) {
    let param = &located.item;
    match setting_of(located, settings) {
        Ok(value) => {
            scope.values.insert(param.name.clone(), to_value(&value));
        }
        Err(problem) => {
            let span = Span::key(&located.file, &["params".into(), param.name.clone()]);
            let message = format!("parameter `{}`: {problem}", param.name);
            scope
                .diagnostics
                .push(Diagnostic::error(message).at(span, "declared here"));
            scope.failed.insert(param.name.clone());
        }
    }
}

fn report_unknown(program: &Program, settings: &Settings, scope: &mut Scope) {
    let known: Vec<&str> = program.own_params().map(|p| &*p.item.name).collect();
    let mut lets = program.lets.iter().filter(|l| l.module.is_empty());
    let own_lets: BTreeSet<&str> = lets.by_ref().map(|l| &*l.item.0).collect();
    let is_let = |name: &str| own_lets.contains(name);
    for (name, setting) in settings.entries() {
        let is_known = known.contains(&name) || program.unread.names.contains(name);
        if is_known || (is_let(name) && matches!(setting, Setting::Value(_))) {
            continue;
        }
        let unknown =
            Diagnostic::error(format!("the spec has no parameter `{name}`")).about(Code::Reference);
        let unknown = match (name.split_once('.'), &known[..]) {
            (Some((module, own)), _) => unknown.help(format!(
                "parameters of a module are given where it is used: `use: {{ {module}: FILE, with: {{ {own}: … }} }}`"
            )),
            (None, []) => unknown.help("it declares none"),
            (None, known) => unknown.help(format!("its parameters are {}", known.join(", "))),
        };
        scope
            .diagnostics
            .push(unknown.suggest(name, known.iter().copied()));
    }
}

type Lets<'a> = BTreeMap<Arc<str>, (&'a Arc<str>, &'a Tree)>;

/// A `let` whose value waits for those that it names.
struct Open {
    name: Arc<str>,
    /// The names that it reads and that were not looked at yet.
    needed: Vec<Arc<str>>,
}

/// All derived values of a spec together may have so many elements; see [`size`]. With what the interpreter makes of them
/// that is some hundred megabytes.
const LARGEST: usize = 1 << 22;

/// The expressions of one value may give so many elements together.
const LARGEST_VALUE: usize = 1 << 20;

/// How many elements a value has with all that is in it; a text counts one for every eight bytes.
fn size(tree: &Tree) -> usize {
    match tree {
        Tree::Text(text) => 1 + text.len() / 8,
        Tree::List(items) => items.iter().map(size).fold(1, usize::saturating_add),
        Tree::Map(entries) => {
            let values = entries
                .iter()
                .map(|(key, value)| key.len() / 8 + size(value));
            values.fold(1, usize::saturating_add)
        }
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => 1,
    }
}

/// Evaluates a `let` after those that it names. A stack on the heap: chains of lets may be long.
fn add_let(db: &dyn Db, name: &Arc<str>, lets: &Lets<'_>, settings: &Settings, scope: &mut Scope) {
    let mut open: Vec<Open> = Vec::new();
    let mut is_open = BTreeSet::new();
    let mut next = Some(name.clone());
    loop {
        if let Some(name) = next.take() {
            if is_open.contains(&name) {
                scope.diagnostics.push(cycle_of_lets(&open, &name, lets));
                scope.failed.insert(name);
            } else if !scope.values.contains_key(&name) && !scope.failed.contains(&name) {
                if let Some(Setting::Value(value)) =
                    settings.get(&name).filter(|_| lets.contains_key(&name))
                {
                    scope.values.insert(name, to_value(value));
                } else if let Some((_, tree)) = lets.get(&name) {
                    let mut needed = BTreeSet::new();
                    collect_names(tree, &mut needed);
                    is_open.insert(name.clone());
                    open.push(Open {
                        name,
                        needed: needed.into_iter().rev().collect(),
                    });
                }
            }
        }
        let Some(top) = open.last_mut() else { return };
        next = top.needed.pop();
        if next.is_none() {
            is_open.remove(&top.name);
            evaluate_let(db, &top.name, lets, scope);
            open.pop();
        }
    }
}

fn evaluate_let(db: &dyn Db, name: &Arc<str>, lets: &Lets<'_>, scope: &mut Scope) {
    let Some((file, tree)) = lets.get(name) else {
        return;
    };
    let path = ["let".into(), name.clone()];
    match evaluate_tree(db, tree, (file, &path), scope) {
        Ok(value) => {
            scope.size += size(&value);
            if scope.size > LARGEST {
                let message = format!("the values of `let` have more than {LARGEST} elements");
                let error =
                    Diagnostic::error(message).at(Span::key(file, &path), "too many with this");
                if !std::mem::replace(&mut scope.is_full, true) {
                    scope.diagnostics.push(error);
                }
                scope.failed.insert(name.clone());
                return;
            }
            scope.values.insert(name.clone(), to_value(&value));
        }
        Err(diagnostics) => {
            scope.diagnostics.extend(diagnostics);
            scope.failed.insert(name.clone());
        }
    }
}

/// The error for the innermost open `let` naming `name`, which is open.
fn cycle_of_lets(open: &[Open], name: &Arc<str>, lets: &Lets<'_>) -> Diagnostic {
    let start = open.iter().position(|o| o.name == *name).unwrap_or(0);
    let cycle: Vec<&Arc<str>> = open[start..]
        .iter()
        .map(|o| &o.name)
        .chain([name])
        .collect();
    let path: Vec<&str> = cycle.iter().map(|n| &***n).collect();
    let message = format!("a cycle of derived values: {}", path.join(" → "));
    cycle
        .windows(2)
        .fold(Diagnostic::error(message), |diagnostic, step| {
            match lets.get(step[0]) {
                Some((file, _)) => {
                    let span = Span::value(file, &["let".into(), step[0].clone()]);
                    diagnostic.at(span, format!("`{}` needs `{}`", step[0], step[1]))
                }
                None => diagnostic,
            }
        })
}

/// Warnings for the params of the root file that no expression of the spec names. Those of included files
/// may serve other specs.
pub fn unused_params(program: &Program) -> Vec<Diagnostic> {
    let mut used = BTreeSet::new();
    program
        .seed
        .iter()
        .for_each(|seed| collect_names(seed, &mut used));
    let of_root = program.seeds.iter().filter(|own| own.module.is_empty());
    of_root.for_each(|own| collect_names(&own.seed, &mut used));
    program
        .map
        .iter()
        .for_each(|map| collect_names(map, &mut used));
    for located in &program.lets {
        collect_names(&located.item.1, &mut used);
    }
    for (id, located) in &program.entries {
        collect_names(&Tree::Text(id.name.clone()), &mut used);
        collect_names(&located.item.body, &mut used);
        located
            .item
            .seed
            .iter()
            .for_each(|seed| collect_names(seed, &mut used));
    }
    for module in program.modules.values().filter(|m| m.parent.is_empty()) {
        let with = module.uses.with.iter();
        with.for_each(|(_, tree)| collect_names(tree, &mut used));
    }
    let own = program.own_params().filter(|p| p.file == program.root);
    let unused = own.filter(|param| !used.contains(&param.item.name));
    let warning = |param: &Located<Param>| {
        let name = &param.item.name;
        let span = Span::key(&param.file, &["params".into(), name.clone()]);
        Diagnostic::warning(format!("no expression uses the parameter `{name}`"))
            .at(span, "")
            .help(format!(
                "write `\"${{{name}}}\"` where its value belongs, or take it out"
            ))
    };
    unused.map(warning).collect()
}

/// The names that the expressions of `tree` read. An expression that cannot be parsed has none; it
/// is reported when it is evaluated.
fn collect_names(tree: &Tree, names: &mut BTreeSet<Arc<str>>) {
    match tree {
        Tree::Text(text) => {
            for piece in fretwork_language::split(text).unwrap_or_default() {
                if let Piece::Expression(expression) = piece {
                    names.extend(
                        free_names(&expression)
                            .unwrap_or_default()
                            .into_iter()
                            .map(Arc::from),
                    );
                }
            }
        }
        Tree::List(items) => items.iter().for_each(|item| collect_names(item, names)),
        Tree::Map(entries) => entries
            .iter()
            .for_each(|(_, value)| collect_names(value, names)),
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => {}
    }
}

/// `tree`, which stands at `place`, a path in a file, with its expressions replaced by their values.
///
/// # Errors
/// One diagnostic for each expression that fails; those that fail only because a name they use has
/// failed before are silent.
pub fn evaluate_tree(
    db: &dyn Db,
    tree: &Tree,
    place: (&Arc<str>, &[Arc<str>]),
    scope: &Scope,
) -> Result<Tree, Vec<Diagnostic>> {
    evaluate_lettered(db, tree, place, scope, OwnLetters::default())
}

/// The same in an entry with letters of its own.
///
/// # Errors
/// As [`evaluate_tree`].
pub fn evaluate_lettered(
    db: &dyn Db,
    tree: &Tree,
    (file, path): (&Arc<str>, &[Arc<str>]),
    scope: &Scope,
    own: OwnLetters,
) -> Result<Tree, Vec<Diagnostic>> {
    let mut fonts = Fonts::new(db, file, own);
    let mut follow_ups = BTreeSet::new();
    let (mut left, mut is_full) = (LARGEST_VALUE, false);
    let mut value_of = |text: &str, at: &[Arc<str>]| {
        if is_full {
            let silent = Diagnostic::error("there are too many elements already");
            follow_ups.insert(silent.clone());
            return Err(silent);
        }
        fonts
            .evaluate(text, &scope.values)
            .map(|value| to_tree(&value))
            .map_err(|error| {
                let diagnostic = Diagnostic::error(error.message)
                    .about(Code::Script)
                    .at(Span::value(file, at), "in this expression");
                let diagnostic = error.help.into_iter().fold(diagnostic, Diagnostic::help);
                let names = free_names(text).unwrap_or_default();
                if names
                    .iter()
                    .any(|name| scope.failed.contains(name.as_str()))
                {
                    follow_ups.insert(diagnostic.clone());
                }
                diagnostic
            })
            .and_then(|tree| match left.checked_sub(size(&tree)) {
                Some(rest) => {
                    left = rest;
                    Ok(tree)
                }
                None => {
                    is_full = true;
                    let message = format!("the value has more than {LARGEST_VALUE} elements");
                    Err(Diagnostic::error(message)
                        .at(Span::value(file, at), "with this expression"))
                }
            })
    };
    let mut at = path.to_vec();
    fretwork_language::substitute(tree, file, &mut at, &mut value_of).map_err(|mut diagnostics| {
        diagnostics.retain(|d| !follow_ups.contains(d));
        diagnostics
    })
}

fn to_value(tree: &Tree) -> Value {
    match tree {
        Tree::Null => Value::None,
        Tree::Bool(b) => Value::Bool(*b),
        Tree::Int(n) => Value::Int(*n),
        Tree::Float(x) => Value::Float(x.get()),
        Tree::Written(_) => to_value(tree.plain()),
        Tree::Text(text) => Value::Text(text.clone()),
        Tree::List(items) => Value::List(items.iter().map(to_value).collect()),
        Tree::Map(entries) => Value::Dict(
            entries
                .iter()
                .map(|(k, v)| (Value::Text(k.clone()), to_value(v)))
                .collect(),
        ),
    }
}

fn to_tree(value: &Value) -> Tree {
    match value {
        Value::None => Tree::Null,
        Value::Bool(b) => Tree::Bool(*b),
        Value::Int(n) => Tree::Int(*n),
        Value::Float(x) => Tree::from(*x),
        Value::Text(text) => Tree::Text(text.clone()),
        Value::List(items) => Tree::list(items.iter().map(to_tree)),
        Value::Dict(entries) => {
            let key = |k: &Value| to_tree(k).to_text().unwrap_or_default();
            Tree::map(entries.iter().map(|(k, v)| (key(k), to_tree(v))))
        }
    }
}
