//! From files to one program: parsing, and merging what is included.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::modules::{Module, inside};
use fretwork_action::{ReadError, resolve};
use fretwork_diagnostic::{Code, Diagnostic, Span, nearest_file};
use fretwork_graph::{NodeId, Unread};
use fretwork_language::{Document, Entry, Param, Parsed, Section, Tree, Unit};

impl Program {
    /// The unit in which all values are measured: that of the root file, and the metre in maps.
    pub fn measure(&self) -> Unit {
        match self.map {
            Some(_) => Unit::Metre,
            None => self.units,
        }
    }
}

/// An entry and the file that it stands in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Located<T> {
    /// The file.
    pub file: Arc<str>,
    /// The unit of its plain lengths.
    pub units: Unit,
    /// The module that it belongs to; none has no name.
    pub module: Arc<str>,
    /// The modules that it may name.
    pub modules: Arc<[Arc<str>]>,
    /// The seed of its file or else of the one that names the file, unless that is the root's.
    pub seed: Option<Arc<OwnSeed>>,
    /// What stands there.
    pub item: T,
}

impl Located<Entry> {
    /// The place of the entry's name.
    pub fn span(&self) -> Span {
        Span::key(&self.file, &self.item.path())
    }
}

/// The seed that a file beside the root says.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct OwnSeed {
    /// The module that the file belongs to.
    pub module: Arc<str>,
    /// The file.
    pub file: Arc<str>,
    /// What it says; may be an expression.
    pub seed: Tree,
}

/// A spec with everything that it includes. Holds no positions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// The root file.
    pub root: Arc<str>,
    /// The unit of the root file.
    pub units: Unit,
    /// The root file's head `map` or, where a region from `geodata` alone makes a map, an empty one.
    pub map: Option<Tree>,
    /// The root file's seed, if it says one; may be an expression.
    pub seed: Option<Tree>,
    /// The seeds of other files that say one.
    pub seeds: Vec<Arc<OwnSeed>>,
    /// The modules by name, those of modules as `lid.hinge`.
    pub modules: BTreeMap<Arc<str>, Module>,
    /// The parameters of all files in order.
    pub params: Vec<Located<Param>>,
    /// The derived values of all files in order.
    pub lets: Vec<Located<(Arc<str>, Tree)>>,
    /// The entries by name.
    pub entries: BTreeMap<NodeId, Located<Entry>>,
    /// The names that could not be read, which has been reported.
    pub unread: Unread,
    /// Of parsing and of merging.
    pub diagnostics: Vec<Diagnostic>,
}

/// The tree of a file and what is wrong with its text. The one query that sees every edit.
#[salsa::tracked(returns(clone))]
pub fn parse(db: &dyn Db, file: SourceFile) -> Arc<Parsed> {
    let path = file.path(db);
    let bytes = file.content(db).clone().and_then(|content| content.whole());
    Arc::new(match bytes {
        Ok(bytes) => fretwork_language::parse_bytes(path, &bytes),
        Err(error) => Parsed {
            document: fretwork_language::parse_bytes(path, b"fretwork: 1").document,
            diagnostics: vec![
                Diagnostic::error(format!("cannot read `{path}`: {error}"))
                    .about(Code::File)
                    .at(Span::File(path.clone()), ""),
            ],
        },
    })
}

/// The spec whose root is `file`, with its includes merged in the order in which they are named,
/// each file once.
#[salsa::tracked(returns(clone))]
pub fn program(db: &dyn Db, file: SourceFile) -> Arc<Program> {
    let parsed = parse(db, file);
    let mut merge = Merge {
        db,
        program: Program {
            root: file.path(db).clone(),
            units: parsed.document.units,
            map: parsed.document.map.clone(),
            seed: parsed.document.seed.clone(),
            seeds: Vec::new(),
            modules: BTreeMap::new(),
            params: Vec::new(),
            lets: Vec::new(),
            entries: BTreeMap::new(),
            unread: Unread::default(),
            diagnostics: Vec::new(),
        },
        names: BTreeMap::new(),
        module: "".into(),
        seed: None,
        has_modules: false,
        lost: Vec::new(),
        stack: Vec::new(),
        seen: Vec::new(),
    };
    merge.add(file);
    merge.finish_map();
    merge.finish_modules();
    Arc::new(merge.program)
}

/// One entry of a program: the firewall behind which an edit of anything else is not seen.
#[salsa::tracked(returns(clone))]
pub fn entry(db: &dyn Db, root: SourceFile, id: NodeId) -> Option<Arc<Located<Entry>>> {
    program(db, root).entries.get(&id).cloned().map(Arc::new)
}

/// How deep includes may be nested.
const MAX_DEPTH: usize = 64;

struct Merge<'db> {
    db: &'db dyn Db,
    program: Program,
    /// Names of params and lets by their module, in which they share one scope, and where they were first defined.
    names: BTreeMap<(Arc<str>, Arc<str>), Span>,
    /// The module that is being merged.
    module: Arc<str>,
    /// The seed of the file that is being merged, unless that is the root's.
    seed: Option<Arc<OwnSeed>>,
    /// Whether a file was used as a module.
    has_modules: bool,
    /// Modules whose files cannot be read, which has been told: the modules that use them, and their names.
    lost: Vec<(Arc<str>, Arc<str>)>,
    /// The files being merged, the root first, with the place that included or used each.
    stack: Vec<(Arc<str>, Option<Span>)>,
    /// The files that were merged, each with its module.
    seen: Vec<(Arc<str>, Arc<str>)>,
}

impl Merge<'_> {
    fn add(&mut self, file: SourceFile) {
        let path = file.path(self.db).clone();
        let is_known = self.seen.iter().any(|(_, known)| *known == path);
        self.seen.push((self.module.clone(), path.clone()));
        let parsed = parse(self.db, file);
        if !is_known {
            let parsed = parsed.diagnostics.iter().cloned();
            self.program.diagnostics.extend(parsed);
        }
        let document = &parsed.document;
        self.check_map(&path, document);
        let outer = self.seed.clone();
        self.take_seed(&path, document);
        let unread = &mut self.program.unread;
        let module = self.module.clone();
        let broken = document.broken.iter().map(|name| inside(&module, name));
        unread.names.extend(broken);
        unread.any |= document.has_broken_section;
        let seed = self.seed.clone();
        let located = |item| Located {
            file: path.clone(),
            units: document.units,
            module: module.clone(),
            modules: Arc::default(),
            seed: seed.clone(),
            item,
        };
        self.add_values(&path, document);
        // What a file makes is made by its own build, not by those that use it.
        let is_part = |entry: &&Entry| module.is_empty() || entry.section != Section::Artifacts;
        for entry in document.entries.iter().filter(is_part) {
            let id = NodeId {
                section: entry.section,
                name: inside(&module, &entry.name),
            };
            if let Some(first) = self.program.entries.get(&id) {
                let diagnostic = Diagnostic::error(format!("`{id}` is defined twice"))
                    .at(Span::key(&path, &entry.path()), "again here")
                    .at(first.span(), "first here");
                self.program.diagnostics.push(diagnostic);
            } else {
                self.program.entries.insert(id, located(entry.clone()));
            }
        }
        self.include(&path, document);
        self.use_modules(&path, document);
        self.seed = outer;
    }

    /// Makes the seed of a file beside the root that of what is merged from here on.
    fn take_seed(&mut self, path: &Arc<str>, document: &Document) {
        if self.stack.is_empty() {
            return;
        }
        let Some(seed) = &document.seed else { return };
        let own = Arc::new(OwnSeed {
            module: self.module.clone(),
            file: path.clone(),
            seed: seed.clone(),
        });
        self.program.seeds.push(own.clone());
        self.seed = Some(own);
    }

    /// Whether an included file makes a map of those that do not say so themselves, which is an error.
    fn check_map(&mut self, path: &Arc<str>, document: &Document) {
        if document.map.is_none() || self.program.map.is_some() {
            return;
        }
        let place = Span::key(path, &["map".into()]);
        let error = Diagnostic::error("a file that is included by others cannot make them maps");
        let root = &self.program.root;
        let error = error
            .at(place, "")
            .help(format!("put `map: {{}}` into `{root}`"));
        self.program.diagnostics.push(error);
    }

    /// The params and derived values of a file.
    fn add_values(&mut self, path: &Arc<str>, document: &Document) {
        let (file, units) = (path.clone(), document.units);
        for param in &document.params {
            let name = &param.name;
            if self.is_new_name(name, Span::key(path, &["params".into(), name.clone()])) {
                self.program.params.push(Located {
                    file: file.clone(),
                    units,
                    module: self.module.clone(),
                    modules: Arc::default(),
                    seed: None,
                    item: param.clone(),
                });
            }
        }
        for (name, value) in &document.lets {
            if self.is_new_name(name, Span::key(path, &["let".into(), name.clone()])) {
                self.program.lets.push(Located {
                    file: file.clone(),
                    units,
                    module: self.module.clone(),
                    modules: Arc::default(),
                    seed: None,
                    item: (name.clone(), value.clone()),
                });
            }
        }
    }

    /// A region from `geodata` makes a map, in whatever file.
    fn finish_map(&mut self) {
        let mut entries = self.program.entries.iter();
        let is_map = entries.any(|(id, located)| {
            id.section == Section::Regions && located.item.body.get("geodata").is_some()
        });
        if is_map {
            self.program.map.get_or_insert(Tree::Null);
        }
    }

    fn is_new_name(&mut self, name: &Arc<str>, span: Span) -> bool {
        // A name that one file gives to a param and a let has been told by its parse.
        let name_in = (self.module.clone(), name.clone());
        if self
            .names
            .get(&name_in)
            .is_some_and(|first| first.file() == span.file())
        {
            return false;
        }
        if let Some(first) = self.names.get(&name_in) {
            let diagnostic = Diagnostic::error(format!("`{name}` is defined twice"))
                .at(span, "again here")
                .at(first.clone(), "first here");
            self.program.diagnostics.push(diagnostic);
            return false;
        }
        self.names.insert(name_in, span);
        true
    }

    fn include(&mut self, path: &Arc<str>, document: &Document) {
        for include in &document.includes {
            let known = |merge: &Merge, target: &Arc<str>| {
                let in_module = |(module, file): &(Arc<str>, Arc<str>)| {
                    *module == merge.module && file == target
                };
                merge.seen.iter().any(in_module)
            };
            if let Some(file) = self.found(path, &include.path, &include.span)
                && !known(self, file.path(self.db))
            {
                self.stack.push((path.clone(), Some(include.span.clone())));
                self.add(file);
                self.stack.pop();
            }
        }
    }

    /// Merges the modules of a file, each under its name.
    fn use_modules(&mut self, path: &Arc<str>, document: &Document) {
        for uses in &document.uses {
            self.has_modules = true;
            let name = inside(&self.module, &uses.name);
            if let Some(first) = self.program.modules.get(&name) {
                let twice = Diagnostic::error(format!("the module `{name}` is named twice"));
                let twice = twice.at(uses.span.clone(), "again here");
                let twice = twice.at(first.uses.span.clone(), "first here");
                self.program.diagnostics.push(twice);
                continue;
            }
            let Some(file) = self.found(path, &uses.path, &uses.span) else {
                self.lost.push((self.module.clone(), uses.name.clone()));
                continue;
            };
            let module = Module {
                parent: self.module.clone(),
                user: (path.clone(), document.units),
                uses: uses.clone(),
            };
            self.program.modules.insert(name.clone(), module);
            let outer = std::mem::replace(&mut self.module, name);
            self.stack.push((path.clone(), Some(uses.span.clone())));
            self.add(file);
            self.stack.pop();
            self.module = outer;
        }
    }

    /// The file that another one names, if it can be merged; what is wrong with it is told.
    fn found(&mut self, path: &Arc<str>, named: &str, span: &Span) -> Option<SourceFile> {
        let span = span.clone();
        let Some(target) = resolve(path, named) else {
            self.program.diagnostics.push(outside(named, span));
            self.program.unread.any = true;
            return None;
        };
        if let Some(start) = self.position_in_stack(path, &target) {
            let cycle = self.cycle(start, path, &target, span);
            self.program.diagnostics.push(cycle);
            // What the file defines is not known here, and that is told.
            self.program.unread.any = true;
            return None;
        }
        if self.stack.len() >= MAX_DEPTH {
            let message = format!("includes are nested more than {MAX_DEPTH} deep");
            let error = Diagnostic::error(message).at(span, "not followed");
            self.program.diagnostics.push(error);
            return None;
        }
        let file = self.db.file(&target);
        if let Err(error) = file.content(self.db) {
            let error = unreadable(self.db, named, &target, error, span);
            self.program.diagnostics.push(error);
            self.program.unread.any = true;
            return None;
        }
        Some(file)
    }

    /// Tells entries which modules they may name: those of their own module, whichever of its files names them.
    fn finish_modules(&mut self) {
        let mut of: BTreeMap<Arc<str>, Vec<Arc<str>>> = BTreeMap::new();
        for module in self.program.modules.values() {
            let names = of.entry(module.parent.clone()).or_default();
            names.push(module.uses.name.clone());
        }
        for (parent, name) in &self.lost {
            of.entry(parent.clone()).or_default().push(name.clone());
        }
        let of: BTreeMap<Arc<str>, Arc<[Arc<str>]>> = of
            .into_iter()
            .map(|(module, names)| (module, names.into()))
            .collect();
        for located in self.program.entries.values_mut() {
            located.modules = of.get(&located.module).cloned().unwrap_or_default();
        }
    }

    /// What a cycle is made of, and what a file in it does with the next: includes alone, or modules too.
    fn cyclic(&self) -> (&'static str, &'static str) {
        if self.has_modules {
            ("modules", "uses")
        } else {
            ("includes", "includes")
        }
    }

    fn position_in_stack(&self, path: &Arc<str>, target: &Arc<str>) -> Option<usize> {
        if path == target {
            return Some(self.stack.len());
        }
        self.stack.iter().position(|(file, _)| file == target)
    }

    fn cycle(&self, start: usize, path: &Arc<str>, target: &Arc<str>, span: Span) -> Diagnostic {
        let files: Vec<&str> = self.stack[start..]
            .iter()
            .map(|(f, _)| &**f)
            .chain([&**path, &**target])
            .collect();
        let mut diagnostic = Diagnostic::error(format!(
            "a cycle of {}: {}",
            self.cyclic().0,
            files.join(" → ")
        ))
        .about(Code::Reference)
        .at(span, format!("`{path}` {} `{target}`", self.cyclic().1));
        for (i, (file, span)) in self.stack.iter().enumerate().skip(start) {
            let next = self.stack.get(i + 1).map_or(path, |(f, _)| f);
            if let Some(span) = span {
                let here = format!("`{file}` {} `{next}`", self.cyclic().1);
                diagnostic = diagnostic.at(span.clone(), here);
            }
        }
        diagnostic
    }
}

/// The error for a path that leaves the project root.
pub fn outside(path: &str, span: Span) -> Diagnostic {
    if path.contains('\\') && !path.contains(':') {
        return Diagnostic::error(format!("`{path}` is not the path of a file"))
            .about(Code::File)
            .at(span, "")
            .help("write `/` between folders, on Windows too");
    }
    Diagnostic::error(format!("`{path}` leaves the project root")).about(Code::File)
        .at(span, "outside")
        .help("the root is the nearest folder with `.git` or `fretwork.toml`; move the file into it and name it with a relative path")
}

/// The error for the file at `path` that is named `named` and cannot be read.
pub fn unreadable(
    db: &dyn Db,
    named: &str,
    path: &str,
    error: &ReadError,
    span: Span,
) -> Diagnostic {
    if *error == ReadError::Outside {
        return outside(named, span);
    }
    let unreadable = Diagnostic::error(format!("cannot read `{named}`: {error}"))
        .about(Code::File)
        .at(span, "this file");
    if *error != ReadError::Missing {
        return unreadable;
    }
    // In double quotes the folder `\b` of Windows is a control character.
    if named.chars().any(char::is_control) {
        return unreadable.help("write `/` between folders, on Windows too");
    }
    let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
    let beside = db.world().names(folder);
    match nearest_file(name, beside.iter().map(String::as_str)) {
        Some(near) => {
            let folder = named
                .rsplit_once('/')
                .map_or(String::new(), |(folder, _)| format!("{folder}/"));
            unreadable.help(format!("did you mean `{folder}{near}`?"))
        }
        None => unreadable,
    }
}
