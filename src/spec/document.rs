//! A file as a whole: its head, and the entries of its sections with their expressions still in them.

use std::sync::Arc;

use super::read::{Spot, Value, read};
use super::scalar::{Integer, Text};
use super::value::{Named, NonEmpty};
use super::{Decode, DecodeContext, Decoder, Param, Piece, Section, Tree, Unit, expression, hint, split};
use crate::diagnostic::{Diagnostic, Span};

/// The version of the language.
pub const VERSION: i64 = 1;

/// More diagnostics than this are not collected from one file.
const MAX_DIAGNOSTICS: usize = 1000;

/// More files than this out of one artifact's `each` are refused.
const MAX_COMBINATIONS: usize = 10_000;

/// What a file says, without positions.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Document {
    /// The unit of plain lengths in this file.
    pub units: Unit,
    /// The root of all randomness: a whole number, or text with an expression.
    pub seed: Tree,
    /// Values that a caller may override.
    pub params: Vec<Param>,
    /// Derived values, with their expressions.
    pub lets: Vec<(Arc<str>, Tree)>,
    /// Other files whose entries belong to this one.
    pub includes: Vec<Include>,
    /// The entries of all sections, in the order of the file.
    pub entries: Vec<Entry>,
}

/// Another file.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Include {
    /// As written: relative to the file that it is written in.
    pub path: Arc<str>,
    /// Where.
    pub span: Span,
}

/// An entry of a section.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Entry {
    /// The section.
    pub section: Section,
    /// Its name as written; that of an artifact may hold expressions.
    pub name: Arc<str>,
    /// Its own seed: a whole number, or text with an expression.
    pub seed: Option<Tree>,
    /// What it is for.
    pub doc: Option<Arc<str>>,
    /// All else, with its expressions.
    pub body: Tree,
}

impl Entry {
    /// The path of the entry in its file.
    pub fn path(&self) -> Vec<Arc<str>> {
        vec![self.section.name().into(), self.name.clone()]
    }
}

/// A file with what is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parsed {
    /// What could be read.
    pub document: Document,
    /// Errors and warnings of the file as a whole; those inside entries come from [`decode`](super::decode()).
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads a file. `file` is its path for diagnostics.
pub fn parse(file: &Arc<str>, text: &str) -> Parsed {
    let mut diagnostics = Vec::new();
    let tree = match read(file, text) {
        Ok(mut spot) => {
            hint::check(&mut spot, file, text, &mut diagnostics);
            report_duplicates(&spot, file, &mut diagnostics);
            spot.into_tree()
        }
        Err(error) => return Parsed { document: empty(), diagnostics: vec![error] },
    };
    let document = document(&tree, file, &mut diagnostics);
    diagnostics.truncate(MAX_DIAGNOSTICS);
    Parsed { document, diagnostics }
}

/// Reads a file whose bytes may not be text.
pub fn parse_bytes(file: &Arc<str>, bytes: &[u8]) -> Parsed {
    match std::str::from_utf8(bytes) {
        Ok(text) => parse(file, text),
        Err(error) => {
            let at = error.valid_up_to();
            let place = Span::Bytes { file: file.clone(), start: at, end: at + 1 };
            let diagnostic =
                Diagnostic::error(format!("the file is not UTF-8 text: byte {at} is not part of a character"));
            Parsed { document: empty(), diagnostics: vec![diagnostic.at(place, "").help("save it as UTF-8")] }
        }
    }
}

fn empty() -> Document {
    Document {
        units: Unit::Millimetre,
        seed: Tree::Int(0),
        params: Vec::new(),
        lets: Vec::new(),
        includes: Vec::new(),
        entries: Vec::new(),
    }
}

impl Spot {
    /// The value without positions. Of a key that stands twice the first one counts.
    pub(super) fn into_tree(self) -> Tree {
        match self.value {
            Value::Scalar(tree) => tree,
            Value::List(items) => Tree::list(items.into_iter().map(Spot::into_tree)),
            Value::Map(entries) => {
                let mut seen = std::collections::HashSet::new();
                let entries = entries.into_iter().filter(|(key, _)| seen.insert(key.name.clone()));
                Tree::map(entries.map(|(key, value)| (key.name, value.into_tree())))
            }
        }
    }
}

fn report_duplicates(spot: &Spot, file: &Arc<str>, diagnostics: &mut Vec<Diagnostic>) {
    match &spot.value {
        Value::Scalar(_) => {}
        Value::List(items) => items.iter().for_each(|item| report_duplicates(item, file, diagnostics)),
        Value::Map(entries) => {
            let mut first = std::collections::HashMap::new();
            for (key, value) in entries {
                let here = Span::Bytes { file: file.clone(), start: key.span.start, end: key.span.end };
                match first.get(&key.name) {
                    None => {
                        first.insert(&key.name, here);
                    }
                    Some(_) if diagnostics.len() > MAX_DIAGNOSTICS => {}
                    Some(there) => diagnostics.push(
                        Diagnostic::error(format!("the key `{}` stands here twice", key.name))
                            .at(here, "the second one")
                            .at(there.clone(), "the first one"),
                    ),
                }
                report_duplicates(value, file, diagnostics);
            }
        }
    }
}

const HEAD: [&str; 6] = ["fretwork", "units", "seed", "params", "let", "include"];

fn document(tree: &Tree, file: &Arc<str>, diagnostics: &mut Vec<Diagnostic>) -> Document {
    let mut document = empty();
    let context = |units| DecodeContext { file: file.clone(), path: Vec::new(), file_units: units, spec_units: units };
    let top = match tree {
        Tree::Map(entries) => &**entries,
        Tree::Null => {
            let empty = Diagnostic::error("the file is empty").at(Span::File(file.clone()), "");
            diagnostics.push(empty.help(format!("begin it with `fretwork: {VERSION}`")));
            return document;
        }
        _ => {
            let message = format!("a spec is a map of sections, not {}", tree.describe());
            diagnostics.push(Diagnostic::error(message).at(Span::value(file, &[]), ""));
            return document;
        }
    };
    check_version(tree, file, diagnostics);
    let units_context = context(Unit::Millimetre);
    let mut cx = Decoder::new(&units_context);
    if let Some(units) = tree.get("units") {
        document.units = cx.at("units", |cx| Unit::decode(units, cx)).unwrap_or(Unit::Millimetre);
    }
    diagnostics.append(&mut cx.diagnostics);
    let context = context(document.units);
    let mut cx = Decoder::new(&context);
    for (key, value) in top {
        cx.at(key, |cx| match (&**key, Section::named(key)) {
            (_, Some(section)) => read_section(section, value, &mut document.entries, cx),
            ("seed", _) => document.seed = read_seed(value, cx).unwrap_or(Tree::Int(0)),
            ("params", _) => document.params = read_params(value, cx),
            ("let", _) => document.lets = read_lets(value, &document.params, cx),
            ("include", _) => document.includes = read_includes(value, file, cx),
            ("fretwork" | "units", _) => {}
            _ => {
                let unknown = Diagnostic::error(format!("there is no section `{key}`")).at(cx.key_span(), "");
                let known = HEAD.into_iter().chain(Section::ALL.iter().map(|section| section.name()));
                cx.push(unknown.suggest(key, known));
            }
        });
    }
    check_lets(&document, &mut cx);
    diagnostics.append(&mut cx.diagnostics);
    document
}

fn check_version(tree: &Tree, file: &Arc<str>, diagnostics: &mut Vec<Diagnostic>) {
    let path = ["fretwork".into()];
    let error = match tree.get("fretwork") {
        Some(Tree::Int(VERSION)) => return,
        None => Diagnostic::error("the file does not say which version of the language it is in")
            .at(Span::File(file.clone()), "")
            .help(format!("begin it with `fretwork: {VERSION}`")),
        Some(Tree::Int(other)) => {
            Diagnostic::error(format!("this fretwork reads version {VERSION} of the language, not {other}"))
                .at(Span::value(file, &path), "")
        }
        Some(other) => Diagnostic::error(format!("the version must be {VERSION}, not {}", other.describe()))
            .at(Span::value(file, &path), ""),
    };
    diagnostics.push(error);
}

fn read_section(section: Section, tree: &Tree, entries: &mut Vec<Entry>, cx: &mut Decoder) {
    let named = match tree {
        Tree::Map(named) => &**named,
        Tree::Null => &[],
        other => {
            cx.mismatch::<()>("a map of names", other);
            return;
        }
    };
    for (name, tree) in named {
        check_name(section, name, cx);
        entries.push(cx.at(name, |cx| {
            check_expressions(tree, cx);
            read_entry(section, name, tree, cx)
        }));
    }
}

fn read_entry(section: Section, name: &Arc<str>, tree: &Tree, cx: &mut Decoder) -> Entry {
    let mut entry = Entry { section, name: name.clone(), seed: None, doc: None, body: tree.clone() };
    let Tree::Map(fields) = tree else {
        return entry;
    };
    if let Some(seed) = tree.get("seed") {
        entry.seed = cx.at("seed", |cx| read_seed(seed, cx));
    }
    if let Some(doc) = tree.get("doc") {
        entry.doc = cx.at("doc", |cx| Text::decode(doc, cx)).map(|doc| doc.0);
    }
    if entry.seed.is_some() || tree.get("seed").or(tree.get("doc")).is_some() {
        let rest = fields.iter().filter(|(key, _)| !matches!(&**key, "seed" | "doc"));
        entry.body = Tree::map(rest.cloned());
    }
    entry
}

/// Names of entries are words; those of symbols letters, those of artifacts paths.
fn check_name(section: Section, name: &str, cx: &mut Decoder) {
    let word = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    let problem = match section {
        Section::Artifacts => split(name).err().map(|_| "an expression in its name is not closed"),
        Section::Symbols => {
            super::scalar::Letter::of(name).is_none().then_some("the name of a symbol is a single letter")
        }
        _ if word(name) => None,
        _ => Some("a name is made of letters, digits, `_` and `-`"),
    };
    if let Some(problem) = problem {
        let place = cx.key_span_of(name);
        cx.push(Diagnostic::error(format!("`{name}` cannot be a name here: {problem}")).at(place, ""));
    }
}

/// A seed is a whole number, or an expression that gives one.
fn read_seed(tree: &Tree, cx: &mut Decoder) -> Option<Tree> {
    match tree {
        Tree::Text(text) if super::has_expression(text) => {
            check_expressions(tree, cx);
            Some(tree.clone())
        }
        _ => seed_value(tree, cx).map(|_| tree.clone()),
    }
}

fn seed_value(tree: &Tree, cx: &mut Decoder) -> Option<u64> {
    let value = Integer::decode(tree, cx)?;
    match u64::try_from(value.0) {
        Ok(seed) => Some(seed),
        Err(_) => cx.error("a seed must not be below 0"),
    }
}

/// The seed of a file or an entry whose expression has been replaced by its value. The path of
/// `context` is that of the file (empty) or the entry.
///
/// # Errors
/// What is not a whole number, 0 or above.
pub fn decode_seed(tree: &Tree, context: &DecodeContext) -> Result<u64, Vec<Diagnostic>> {
    let mut cx = Decoder::new(context);
    let seed = cx.at("seed", |cx| seed_value(tree, cx));
    seed.ok_or(cx.diagnostics)
}

/// The combinations of values of an artifact's `each`: for every file its names and values.
pub type Combinations = Vec<Vec<(Arc<str>, Tree)>>;

/// All combinations of an artifact's `each` (whose own expressions have been replaced), the last
/// name changing fastest. One empty combination where nothing varies.
///
/// # Errors
/// What is not a map of names to lists, and more than 10,000 combinations.
pub fn decode_each(tree: &Tree, context: &DecodeContext) -> Result<Combinations, Vec<Diagnostic>> {
    let mut cx = Decoder::new(context);
    let each = cx.at("each", |cx| {
        let each: Named<NonEmpty<Tree>> = Named::decode(tree, cx)?;
        let total = each.iter().map(|(_, values)| values.len()).fold(1, usize::saturating_mul);
        if total > MAX_COMBINATIONS {
            return cx.error(format!("`each` asks for {total} files, more than {MAX_COMBINATIONS}"));
        }
        Some(each)
    });
    let mut combinations: Combinations = vec![Vec::new()];
    for (name, values) in each.ok_or(cx.diagnostics)?.0 {
        let longer = |known: &Vec<(Arc<str>, Tree)>, value: &Tree| {
            known.iter().cloned().chain([(name.clone(), value.clone())]).collect()
        };
        combinations =
            combinations.iter().flat_map(|known| values.iter().map(move |value| longer(known, value))).collect();
    }
    Ok(combinations)
}

fn read_params(tree: &Tree, cx: &mut Decoder) -> Vec<Param> {
    let named: Option<Named<Tree>> = Named::decode(tree, cx);
    let mut params = Vec::new();
    for (name, tree) in named.map_or(Vec::new(), |named| named.0) {
        check_variable(&name, cx);
        params.extend(cx.at(&name, |cx| Param::read(&name, &tree, cx)));
    }
    params
}

fn read_lets(tree: &Tree, _: &[Param], cx: &mut Decoder) -> Vec<(Arc<str>, Tree)> {
    let named: Option<Named<Tree>> = Named::decode(tree, cx);
    let lets = named.map_or(Vec::new(), |named| named.0);
    for (name, tree) in &lets {
        check_variable(name, cx);
        cx.at(name, |cx| check_expressions(tree, cx));
    }
    lets
}

/// No name is a param and a let.
fn check_lets(document: &Document, cx: &mut Decoder) {
    for (name, _) in document.lets.iter().filter(|(name, _)| document.params.iter().any(|param| param.name == *name)) {
        let here = cx.at("let", |cx| cx.key_span_of(name));
        let there = cx.at("params", |cx| cx.key_span_of(name));
        cx.push(Diagnostic::error(format!("`{name}` is both a param and a let")).at(here, "").at(there, "the param"));
    }
}

/// Params and lets are variables of expressions.
fn check_variable(name: &str, cx: &mut Decoder) {
    const TAKEN: [&str; 27] = [
        "and", "break", "continue", "def", "elif", "else", "for", "if", "in", "lambda", "load", "not", "or", "pass",
        "return", "while", "as", "assert", "class", "del", "except", "import", "is", "None", "True", "False", "pi",
    ];
    let mut chars = name.chars();
    let starts = chars.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    let problem = if !starts || !chars.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        "it must be letters, digits and `_`, without a digit at its start"
    } else if TAKEN.contains(&name) || name == "deg" {
        "the word has a meaning of its own in expressions"
    } else {
        return;
    };
    let place = cx.key_span_of(name);
    cx.push(Diagnostic::error(format!("`{name}` cannot be a variable: {problem}")).at(place, ""));
}

fn read_includes(tree: &Tree, file: &Arc<str>, cx: &mut Decoder) -> Vec<Include> {
    let paths: Option<super::value::OneOrMany<super::scalar::FilePath>> = match tree {
        Tree::Null => None,
        Tree::List(items) if items.is_empty() => None,
        _ => super::value::OneOrMany::decode(tree, cx),
    };
    let single = !matches!(tree, Tree::List(_));
    let mut includes = Vec::new();
    for (n, path) in paths.iter().flat_map(|paths| paths.iter()).enumerate() {
        let steps: Vec<Arc<str>> =
            ["include".into()].into_iter().chain((!single).then(|| n.to_string().into())).collect();
        let span = Span::value(file, &steps);
        if super::has_expression(&path.0) {
            cx.push(Diagnostic::error("the path of an include cannot hold expressions").at(span, ""));
        } else {
            includes.push(Include { path: path.0.clone(), span });
        }
    }
    includes
}

/// Reports expressions that are not closed, or empty.
fn check_expressions(tree: &Tree, cx: &mut Decoder) {
    match tree {
        Tree::Text(text) => match split(text) {
            Ok(pieces) if pieces.contains(&Piece::Expression(String::new())) => cx.push(expression::empty(cx.span())),
            Ok(_) => {}
            Err(start) => {
                let span = cx.span();
                cx.push(expression::unclosed(text, start, span));
            }
        },
        Tree::List(items) => {
            for (n, item) in items.iter().enumerate() {
                cx.at(&n.to_string(), |cx| check_expressions(item, cx));
            }
        }
        Tree::Map(entries) => entries.iter().for_each(|(key, value)| cx.at(key, |cx| check_expressions(value, cx))),
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) => {}
    }
}
