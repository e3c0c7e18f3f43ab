//! A file as a whole: its head, and the entries of its sections, whose expressions are not evaluated yet.

use std::sync::Arc;

use super::entry::{check_expressions, read_section, read_seed};
use super::head::{check_lets, check_version, read_includes, read_lets, read_params};
use super::map::is_map;
use super::modules::read_uses;
use super::read::{Spot, Value, read};
use super::record::below_empty;
use super::{Decode, DecodeContext, Decoder, Param, Section, Tree, Unit, hint};
use fretwork_diagnostic::{Code, Diagnostic, Span, nearest};

/// The version of the language.
pub const VERSION: i64 = 1;

/// The most diagnostics that are collected from one file. Nobody reads more, and a large file of another
/// kind could give millions.
const MAX_DIAGNOSTICS: usize = 1000;

/// The contents of a file, without positions.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Document {
    /// The unit of plain lengths in this file.
    pub units: Unit,
    /// The head `map`, with its expressions, if the file has it.
    pub map: Option<Tree>,
    /// The root of all randomness, if the file says one: a whole number, or text with an expression.
    pub seed: Option<Tree>,
    /// Values that a caller may override.
    pub params: Vec<Param>,
    /// Derived values, with their expressions.
    pub lets: Vec<(Arc<str>, Tree)>,
    /// Other files whose entries belong to this one.
    pub includes: Vec<Include>,
    /// Other files that are modules of this one.
    pub uses: Vec<Use>,
    /// The entries of all sections, in the order of the file.
    pub entries: Vec<Entry>,
    /// Names whose params or entries could not be read. That has been reported; what uses them is not
    /// wrong for that.
    pub broken: Vec<Arc<str>>,
    /// Whether a whole section could not be read, so that any name may be missing.
    pub has_broken_section: bool,
}

impl Document {
    /// The param of this name.
    fn param(&self, name: &str) -> Option<&Param> {
        self.params.iter().find(|param| *param.name == *name)
    }
}

/// Another file.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Include {
    /// As written: relative to the file that it is written in.
    pub path: Arc<str>,
    /// Where.
    pub span: Span,
}

/// Another file as a module, whose entries are named `NAME.ENTRY`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Use {
    /// The name of the module.
    pub name: Arc<str>,
    /// The file as written: relative to the one that it is written in.
    pub path: Arc<str>,
    /// Values for its params, with their expressions.
    pub with: Vec<(Arc<str>, Tree)>,
    /// The path of the map that holds it, in the file.
    pub at: Vec<Arc<str>>,
    /// Where the file is named.
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
    /// The description of the entry.
    pub doc: Option<Arc<str>>,
    /// All other fields, with their expressions.
    pub body: Tree,
}

impl Entry {
    /// The path of the entry in its file.
    pub fn path(&self) -> Vec<Arc<str>> {
        vec![self.section.name().into(), self.name.clone()]
    }
}

/// A file with its errors and warnings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parsed {
    /// What could be read.
    pub document: Document,
    /// Errors and warnings of the file as a whole; those inside entries come from [`decode`](super::decode()).
    pub diagnostics: Vec<Diagnostic>,
}

/// Parses a file. `file` is its path for diagnostics.
pub fn parse(file: &Arc<str>, text: &str) -> Parsed {
    let mut diagnostics = Vec::new();
    let tree = match read(file, text) {
        Ok(mut spot) => {
            hint::check(&mut spot, file, text, &mut diagnostics);
            report_duplicates(&spot, file, &mut diagnostics);
            spot.into_tree()
        }
        Err(error) => {
            return Parsed {
                document: Document {
                    has_broken_section: true,
                    ..empty()
                },
                diagnostics: vec![error],
            };
        }
    };
    let document = document(&tree, file, &mut diagnostics);
    diagnostics.truncate(MAX_DIAGNOSTICS);
    Parsed {
        document,
        diagnostics,
    }
}

/// Parses a file whose bytes may not be text.
pub fn parse_bytes(file: &Arc<str>, bytes: &[u8]) -> Parsed {
    match std::str::from_utf8(bytes) {
        Ok(text) => parse(file, text),
        Err(error) => {
            let at = error.valid_up_to();
            let place = Span::Bytes {
                file: file.clone(),
                start: at,
                end: at + 1,
            };
            let diagnostic = Diagnostic::error(format!(
                "the file is not UTF-8 text: byte {at} is not part of a character"
            ));
            Parsed {
                document: empty(),
                diagnostics: vec![diagnostic.at(place, "").help("save it as UTF-8")],
            }
        }
    }
}

fn empty() -> Document {
    Document {
        units: Unit::Millimetre,
        map: None,
        seed: None,
        params: Vec::new(),
        lets: Vec::new(),
        includes: Vec::new(),
        uses: Vec::new(),
        entries: Vec::new(),
        broken: Vec::new(),
        has_broken_section: false,
    }
}

impl Spot {
    /// The value without positions. If a key stands twice, the first one counts.
    pub(super) fn into_tree(self) -> Tree {
        match self.value {
            Value::Scalar(tree) => tree,
            Value::List(items) => Tree::list(items.into_iter().map(Spot::into_tree)),
            Value::Map(entries) => {
                let mut seen = std::collections::HashSet::new();
                let entries = entries
                    .into_iter()
                    .filter(|(key, _)| seen.insert(key.name.clone()));
                Tree::map(entries.map(|(key, value)| (key.name, value.into_tree())))
            }
        }
    }
}

fn report_duplicates(spot: &Spot, file: &Arc<str>, diagnostics: &mut Vec<Diagnostic>) {
    match &spot.value {
        Value::Scalar(_) => {}
        Value::List(items) => items
            .iter()
            .for_each(|item| report_duplicates(item, file, diagnostics)),
        Value::Map(entries) => {
            let mut first = std::collections::HashMap::new();
            for (key, value) in entries {
                let here = Span::Bytes {
                    file: file.clone(),
                    start: key.span.start,
                    end: key.span.end,
                };
                match first.get(&key.name) {
                    None => {
                        first.insert(&key.name, here);
                    }
                    Some(_) if diagnostics.len() > MAX_DIAGNOSTICS => {}
                    Some(there) => diagnostics.push(
                        Diagnostic::error(format!("the key `{}` stands here twice", key.name))
                            .about(Code::Field)
                            .at(here, "the second one")
                            .at(there.clone(), "the first one"),
                    ),
                }
                report_duplicates(value, file, diagnostics);
            }
        }
    }
}

/// The error for a key that is no section; `before` are the fields before it.
fn unknown_section(key: &str, before: &[(Arc<str>, Tree)], place: Span) -> Diagnostic {
    let unknown = Diagnostic::error(format!("there is no section `{key}`"))
        .about(Code::Field)
        .at(place, "");
    let sections = Section::ALL.iter().map(|section| section.name());
    let known: Vec<&str> = HEAD.into_iter().chain(sections).collect();
    if nearest(key, known.iter().copied()).is_none()
        && let Some(advice) = below_empty(before)
    {
        return unknown.help(advice);
    }
    unknown.suggest(key, known)
}

/// The key of a map that could not be read, and the keys in it: one of them may be the name of an
/// entry.
fn names_below<'t>(key: &'t Arc<str>, value: &'t Tree) -> impl Iterator<Item = Arc<str>> + 't {
    let inside = value.as_map().into_iter().flatten();
    std::iter::once(key)
        .chain(inside.map(|(key, _)| key))
        .cloned()
}

pub(super) const HEAD: [&str; 8] = [
    "fretwork", "units", "map", "seed", "params", "let", "include", "use",
];

fn document(tree: &Tree, file: &Arc<str>, diagnostics: &mut Vec<Diagnostic>) -> Document {
    let mut document = empty();
    let context = |units| DecodeContext {
        file: file.clone(),
        path: Vec::new(),
        file_units: units,
        spec_units: units,
        is_scaled: false,
        modules: Arc::default(),
    };
    let top = match tree {
        Tree::Map(entries) => &**entries,
        Tree::Null => {
            let empty = Diagnostic::error("the file is empty")
                .about(Code::Syntax)
                .at(Span::File(file.clone()), "");
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
    let usual = if is_map(tree) {
        Unit::Metre
    } else {
        Unit::Millimetre
    };
    let units = tree.get("units");
    let units = units.and_then(|units| cx.at("units", |cx| Unit::decode(units, cx)));
    document.units = units.unwrap_or(usual);
    diagnostics.append(&mut cx.diagnostics);
    let context = context(document.units);
    let mut cx = Decoder::new(&context);
    for (n, (key, value)) in top.iter().enumerate() {
        cx.at(key, |cx| {
            if let Some(section) = Section::named(key) {
                document.has_broken_section |= !matches!(value, Tree::Map(_) | Tree::Null);
                read_section(section, value, &mut document.entries, cx);
            } else if !document.read_head((key, value), file, cx) {
                document.broken.extend(names_below(key, value));
                cx.push(unknown_section(key, &top[..n], cx.key_span()));
            }
        });
    }
    check_lets(&document, &mut cx);
    diagnostics.append(&mut cx.diagnostics);
    document
}

impl Document {
    /// Reads the key of a file's head, and tells whether it is one.
    fn read_head(
        &mut self,
        (key, value): (&Arc<str>, &Tree),
        file: &Arc<str>,
        cx: &mut Decoder,
    ) -> bool {
        match &**key {
            "map" => {
                check_expressions(value, cx);
                self.map = Some(value.clone());
            }
            "seed" => self.seed = read_seed(value, cx),
            "params" => {
                self.params = read_params(value, cx);
                let is_missing = |name: &Arc<str>| self.param(name).is_none();
                let missing: Vec<_> = names_below(key, value).filter(is_missing).collect();
                self.broken.extend(missing);
            }
            "let" => self.lets = read_lets(value, cx),
            "include" => self.includes = read_includes(value, file, cx),
            "use" => self.uses = read_uses(value, file, cx),
            "fretwork" | "units" => {}
            _ => return false,
        }
        true
    }
}
