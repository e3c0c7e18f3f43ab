//! From an entry's text to a typed node whose references and files are resolved.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::gather::outline;
use super::job::Job;
use super::lettering::own_letters;
use super::map_system::shared;
use super::modules::inside;
use super::program::{OwnSeed, entry, outside, program, unreadable};
use super::scope::{Scope, evaluate_lettered, evaluate_tree, map, scope, scope_of};
use super::settings::Settings;
use super::shell_step;
use fretwork_action::{Definition, resolve};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::Seed;
use fretwork_graph::{Interface, Linked, NodeId, link};
use fretwork_language::scalar::Text;
use fretwork_language::{
    self, DecodeContext, Decoded, FileUse, Map, Node, Reference, Section, Tree, TypeSet, Unit,
};
use fretwork_primitive::plane;
use fretwork_stage::description;

/// An entry after its expressions were evaluated and its fields read.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// What reading gave.
    pub decoded: Decoded,
    /// The key of its random values.
    pub seed: Seed,
    /// The file that it stands in.
    pub file: Arc<str>,
    /// The unit of what the file does not say one of: in maps that of the plane.
    pub units: Unit,
}

/// The entry `id`, read under `settings`.
#[salsa::tracked(returns(clone))]
pub fn read(db: &dyn Db, root: SourceFile, settings: Settings, id: NodeId) -> Option<Arc<Reading>> {
    let located = entry(db, root, id.clone())?;
    let basis = basis(db, root, settings.clone());
    let path = [Arc::from(id.section.name()), located.item.name.clone()];
    let context = DecodeContext {
        file: located.file.clone(),
        path: path.to_vec(),
        file_units: located.units,
        spec_units: basis.units,
        is_scaled: basis.map.as_ref().is_some_and(|map| map.scale.is_some()),
        modules: located.modules.clone(),
    };
    // A file of an `each` does not hold the values of all others: that would be a square of their number.
    let is_one_of_each = settings.each_values().next().is_some();
    let scope = scope_of(db, root, settings.clone(), &located.module);
    let body = located.item.body.clone();
    let body = match &body {
        Tree::Map(fields) if is_one_of_each => {
            let others = fields.iter().filter(|(key, _)| **key != *"each");
            Tree::map(others.cloned())
        }
        _ => body,
    };
    let own = own_letters(db, &body, &context, &scope);
    let decoded = match evaluate_lettered(db, &body, (&located.file, &path), &scope, own) {
        Ok(body) => {
            let mut decoded = fretwork_language::decode(id.section, &body, &context);
            advise_quotes(&mut decoded, &body, &path, &scope);
            decoded
        }
        Err(diagnostics) => Decoded {
            node: None,
            references: Vec::new(),
            files: Vec::new(),
            diagnostics,
        },
    };
    // An edit of the seed is none of a node that draws no random values.
    let root_seed = Seed::root(match &located.seed {
        _ if !id.section.is_random() => 0,
        Some(own) => seed_of(db, root, settings, own.clone()).0,
        None => basis.seed,
    });
    let mut reading = Reading {
        decoded,
        seed: root_seed.name(&located.item.name),
        file: located.file.clone(),
        units: basis.map.as_ref().map_or(located.units, |_| basis.units),
    };
    if let Some(seed) = &located.item.seed {
        match seed_value(db, seed, &context, &scope) {
            Ok(seed) => reading.seed = root_seed.number(seed.cast_signed()),
            Err(diagnostics) => reading.decoded.diagnostics.extend(diagnostics),
        }
    }
    Some(Arc::new(reading))
}

/// Adds advice to errors about a text that is the bare name of a param or a derived value.
fn advise_quotes(decoded: &mut Decoded, body: &Tree, entry: &[Arc<str>], scope: &Scope) {
    for diagnostic in decoded.diagnostics.iter_mut().filter(|d| d.is_error()) {
        let Some(Span::Name { path, .. }) = diagnostic.labels.first().map(|label| &label.span)
        else {
            continue;
        };
        let inside = path.strip_prefix(entry).unwrap_or_default();
        let text = body.at(inside).and_then(Tree::as_text);
        let is_variable =
            |text: &&Arc<str>| scope.values.contains_key(*text) || scope.failed.contains(*text);
        if let Some(name) = text.filter(is_variable) {
            let help = format!("write `\"${{{name}}}\"` for the value of `{name}`");
            diagnostic.help = Some(help);
        }
    }
}

fn seed_value(
    db: &dyn Db,
    seed: &Tree,
    context: &DecodeContext,
    scope: &Scope,
) -> Result<u64, Vec<Diagnostic>> {
    let path: Vec<Arc<str>> = context
        .path
        .iter()
        .cloned()
        .chain(["seed".into()])
        .collect();
    fretwork_language::decode_seed(
        &evaluate_tree(db, seed, (&context.file, &path), scope)?,
        context,
    )
}

/// The seed of a file that is included or used as a module, and what is wrong with it.
#[salsa::tracked(returns(clone))]
fn seed_of(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    own: Arc<OwnSeed>,
) -> (u64, Vec<Diagnostic>) {
    let program = program(db, root);
    let context = DecodeContext {
        file: own.file.clone(),
        path: Vec::new(),
        file_units: program.units,
        spec_units: program.measure(),
        is_scaled: false,
        modules: Arc::default(),
    };
    let scope = scope_of(db, root, settings, &own.module);
    match seed_value(db, &own.seed, &context, &scope) {
        Ok(seed) => (seed, Vec::new()),
        Err(diagnostics) => (0, diagnostics),
    }
}

/// The facts about the root file that every entry depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// The unit in which values are measured.
    pub units: Unit,
    /// The plane, if it is that of a map.
    pub map: Option<Map>,
    /// The seed of the file.
    pub seed: u64,
    /// What is wrong with the map and the seed.
    pub diagnostics: Vec<Diagnostic>,
}

/// The units, the map and the seed of a spec, apart from its entries.
#[salsa::tracked(returns(clone))]
pub fn basis(db: &dyn Db, root: SourceFile, settings: Settings) -> Arc<Basis> {
    let program = program(db, root);
    let context = DecodeContext {
        file: root.path(db).clone(),
        path: Vec::new(),
        file_units: program.units,
        spec_units: program.measure(),
        is_scaled: false,
        modules: Arc::default(),
    };
    let (map, mut diagnostics) = map(db, root, &settings);
    let own = program.seed.as_ref().unwrap_or(&Tree::Int(0));
    let (seed, more) = match seed_value(db, own, &context, &scope(db, root, settings)) {
        Ok(seed) => (seed, Vec::new()),
        Err(diagnostics) => (0, diagnostics),
    };
    diagnostics.extend(more);
    diagnostics.extend(map.as_ref().and_then(|map| unusable(map, root.path(db))));
    Arc::new(Basis {
        units: program.measure(),
        map,
        seed,
        diagnostics,
    })
}

/// What is wrong with the coordinate system that a map names.
fn unusable(map: &Map, file: &Arc<str>) -> Option<Diagnostic> {
    let text = map.crs.as_ref()?;
    let error = plane::of_map(&text.0).err()?;
    let span = Span::value(file, &["map".into(), "crs".into()]);
    Some(plane::unusable(&error, span))
}

/// The graph of the spec under `settings`.
#[salsa::tracked(returns(clone))]
pub fn linked(db: &dyn Db, root: SourceFile, settings: Settings) -> Arc<Linked> {
    let mut interfaces = BTreeMap::new();
    let program = program(db, root);
    for (id, located) in &program.entries {
        let Some(reading) = read(db, root, settings.clone(), id.clone()) else {
            continue;
        };
        let interface = Interface {
            provides: reading
                .decoded
                .node
                .as_ref()
                .map_or(id.section.types(), |n| TypeSet::of(&[n.provides()])),
            references: named_in(&located.module, &reading.decoded.references),
            span: located.span(),
        };
        interfaces.insert(id.clone(), interface);
    }
    let mut linked = link(&interfaces, &program.unread);
    if !program.modules.is_empty() {
        let told = std::mem::take(&mut linked.diagnostics).into_iter();
        linked.diagnostics = told.map(|d| program.through_file(d)).collect();
    }
    Arc::new(linked)
}

/// References of an entry of a module, by the names that the nodes have in the program.
fn named_in(module: &Arc<str>, references: &[Reference]) -> Vec<Reference> {
    let named = |reference: &Reference| Reference {
        name: inside(module, &reference.name),
        ..reference.clone()
    };
    references.iter().map(named).collect()
}

/// The definition of the node `id`, where its entry has no errors and the names it uses exist.
#[salsa::tracked(returns(clone))]
pub fn definition(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    id: NodeId,
) -> Option<Arc<Definition>> {
    if let Some((whole, step)) = shell_step::split(&id) {
        return shell_step::definition(&*definition(db, root, settings, whole)?, id, &step);
    }
    let reading = read(db, root, settings.clone(), id.clone())?;
    let node = reading.decoded.node.clone()?;
    let linked = linked(db, root, settings.clone());
    let targets = linked.targets.get(&id)?;
    let mut inputs = BTreeMap::new();
    for (reference, target) in reading.decoded.references.iter().zip(targets) {
        match target {
            Some(target) => {
                inputs.insert((text_of(reference), reference.wants), target.clone());
            }
            None if reference.required => return None,
            None => {}
        }
    }
    if let Node::Shell(_) = node {
        inputs.extend(shell_step::inputs(&id));
    }
    let files = reading.decoded.files.iter();
    let files = files
        .map(|f| Some((f.path.clone(), resolve(&reading.file, &f.path)?)))
        .collect::<Option<_>>()?;
    let basis = basis(db, root, settings.clone());
    let map = basis.map.clone().map(|mut map| {
        let shared = || shared(db, root, settings.clone()).crs.clone().map(Text);
        map.crs = map.crs.or_else(shared);
        Arc::new(map.seen_by(&node))
    });
    Some(Arc::new(Definition {
        id,
        node,
        inputs,
        files,
        seed: reading.seed,
        units: basis.units,
        own_units: reading.units,
        map,
        file: reading.file.clone(),
    }))
}

/// A reference as it was written.
fn text_of(reference: &Reference) -> Arc<str> {
    match reference.section {
        Some(section) => format!("{}.{}", section.name(), reference.name).into(),
        None => reference.name.clone(),
    }
}

/// Everything that is wrong with the spec and can be known without evaluating it.
#[salsa::tracked(returns(clone))]
pub fn check(db: &dyn Db, root: SourceFile, settings: Settings) -> Arc<Vec<Diagnostic>> {
    let program = program(db, root);
    let mut diagnostics = program.diagnostics.clone();
    diagnostics.extend(
        scope(db, root, settings.clone())
            .diagnostics
            .iter()
            .cloned(),
    );
    for name in program.modules.keys() {
        let scope = scope_of(db, root, settings.clone(), name);
        let told = scope.diagnostics.iter().cloned();
        diagnostics.extend(told.map(|d| program.through(name, d)));
    }
    let basis = basis(db, root, settings.clone());
    diagnostics.extend(basis.diagnostics.iter().cloned());
    for own in &program.seeds {
        let told = seed_of(db, root, settings.clone(), own.clone())
            .1
            .into_iter();
        diagnostics.extend(told.map(|d| program.through(&own.module, d)));
    }
    // Of a map that is wrong, what it does not say is no error of its own.
    if basis.map.is_some() && basis.diagnostics.is_empty() {
        let shared = shared(db, root, settings.clone());
        diagnostics.extend(shared.diagnostics.iter().cloned());
    }
    diagnostics.extend(
        linked(db, root, settings.clone())
            .diagnostics
            .iter()
            .cloned(),
    );
    for id in program.entries.keys() {
        if let Some(reading) = read(db, root, settings.clone(), id.clone()) {
            let module = &program.entries[id].module;
            let told = reading.decoded.diagnostics.iter().cloned();
            diagnostics.extend(told.map(|d| program.through(module, d)));
            diagnostics.extend(missing_files(db, &reading));
        }
    }
    for id in program.entries.keys().filter(|id| has_patterns(id.section)) {
        let job = Job {
            root,
            settings: settings.clone(),
            node: id.clone(),
            region: None,
            window: None,
        };
        let is_whole = job
            .needs(db)
            .iter()
            .all(|need| need.node.section == Section::Symbols || need.definition(db).is_some());
        let action = is_whole.then(|| outline(db, &job)).flatten();
        diagnostics.extend(action.iter().flat_map(description::check));
    }
    Arc::new(diagnostics)
}

/// What is wrong with the files that an entry names.
fn missing_files(db: &dyn Db, reading: &Reading) -> Vec<Diagnostic> {
    let problem = |file: &FileUse| {
        let span = file.span.clone();
        let Some(path) = resolve(&reading.file, &file.path) else {
            return Some(outside(&file.path, span));
        };
        let error = db.file(&path).content(db).as_ref().err()?;
        Some(unreadable(db, &file.path, &path, error, span))
    };
    reading.decoded.files.iter().filter_map(problem).collect()
}

/// Whether entries of a section hold patterns or name some.
fn has_patterns(section: Section) -> bool {
    matches!(section, Section::Patterns | Section::Facades)
}
