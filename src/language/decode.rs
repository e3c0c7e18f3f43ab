//! From a [`Tree`] to a typed value: the trait of all types of the language, and the decoder that
//! collects references, files and errors on the way. Positions are paths. All errors of an entry are
//! found, not only the first one.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

use super::hint::of_decimal_comma;
use super::types::{Ref, TypeSet, Wanted};
use super::{Section, Tree, Unit};
use fretwork_diagnostic::{Diagnostic, Span};

/// A type of the language. It can be read from a tree and, by [`JsonSchema`], described.
pub trait Decode: Sized + JsonSchema {
    /// The value of `tree`; none if it has errors, which are pushed to `cx`.
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Self>;

    /// The value of a missing field; none if the field is required.
    fn absent() -> Option<Self> {
        None
    }

    /// The schema of a field of this type.
    fn field_schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<Self>()
    }
}

/// What decoding needs to know besides the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecodeContext {
    /// The file that the entry is written in.
    pub file: Arc<str>,
    /// The path of the entry in that file: section and name.
    pub path: Vec<Arc<str>>,
    /// The unit of plain lengths in that file.
    pub file_units: Unit,
    /// The unit that lengths are converted to.
    pub spec_units: Unit,
    /// Whether drawings have a scale that the entry need not name, that of a map.
    pub is_scaled: bool,
    /// The names of the modules whose entries may be named.
    pub modules: Arc<[Arc<str>]>,
}

/// A name that an entry uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reference {
    /// The reference as it is written.
    pub written: Arc<str>,
    /// The section, if the reference is written `section.name`.
    pub section: Option<Section>,
    /// The name of the entry.
    pub name: Arc<str>,
    /// The types that are allowed here.
    pub wants: TypeSet,
    /// Those of them that only stand in for the others.
    pub stand_ins: TypeSet,
    /// Whether it is an error if nothing has this name. An argument of a script is plain text then.
    pub required: bool,
    /// The place of the reference.
    pub span: Span,
}

/// A file that an entry uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileUse {
    /// The path as it is written, relative to the file that the entry is written in.
    pub path: Arc<str>,
    /// The place of the path.
    pub span: Span,
}

/// Collects what decoding finds.
pub struct Decoder<'a> {
    context: &'a DecodeContext,
    path: Vec<Arc<str>>,
    /// Whether plain lengths of the output are in millimetres, because the artifact has a scale.
    pub(super) scaled: bool,
    pub(super) references: Vec<Reference>,
    pub(super) files: Vec<FileUse>,
    pub(super) diagnostics: Vec<Diagnostic>,
}

impl<'a> Decoder<'a> {
    /// A decoder at the path of `context`.
    pub fn new(context: &'a DecodeContext) -> Decoder<'a> {
        Decoder {
            context,
            path: context.path.clone(),
            scaled: false,
            references: Vec::new(),
            files: Vec::new(),
            diagnostics: Vec::new(),
        }
    }

    /// Does `work` one step further down the path.
    pub fn at<T>(&mut self, step: &str, work: impl FnOnce(&mut Self) -> T) -> T {
        self.path.push(step.into());
        let result = work(self);
        self.path.pop();
        result
    }

    /// Decodes the items of a list; none if one of them has errors.
    pub fn items<T: Decode>(&mut self, items: &[Tree]) -> Option<Vec<T>> {
        let decoded: Vec<Option<T>> = items
            .iter()
            .enumerate()
            .map(|(n, item)| self.at(&n.to_string(), |cx| T::decode(item, cx)))
            .collect();
        decoded.into_iter().collect()
    }

    /// The value at the current path.
    pub fn span(&self) -> Span {
        Span::value(&self.context.file, &self.path)
    }

    /// The key at the end of the current path.
    pub fn key_span(&self) -> Span {
        Span::key(&self.context.file, &self.path)
    }

    /// The key `name` in the map at the current path.
    pub fn key_span_of(&self, name: &str) -> Span {
        let path: Vec<Arc<str>> = self.path.iter().cloned().chain([name.into()]).collect();
        Span::key(&self.context.file, &path)
    }

    /// The last step of the current path: the name of a field or the number of an item.
    pub fn step(&self) -> &str {
        self.path.last().map_or("", |step| step)
    }

    /// How a message calls the value at the current path: by its key, or as an item of a list.
    pub fn subject(&self) -> String {
        match &*self.path {
            [.., list, item] if item.bytes().all(|b| b.is_ascii_digit()) => {
                format!("an item of `{list}`")
            }
            _ => format!("`{}`", self.step()),
        }
    }

    /// The unit of plain lengths in the file.
    pub fn file_units(&self) -> Unit {
        self.context.file_units
    }

    /// The unit that lengths are converted to.
    pub fn spec_units(&self) -> Unit {
        self.context.spec_units
    }

    /// Adds an error or a warning.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Adds an error at the current path, and returns none.
    pub fn error<T>(&mut self, message: impl Into<String>) -> Option<T> {
        let span = self.span();
        self.push(Diagnostic::error(message).at(span, ""));
        None
    }

    /// Adds an error with advice at the current path, and returns none.
    pub fn error_with<T>(
        &mut self,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        let span = self.span();
        self.push(Diagnostic::error(message).at(span, "").help(help));
        None
    }

    /// Adds the error that `found` is not what was expected, such as "a length", and returns none.
    pub fn mismatch<T>(&mut self, expected: &str, found: &Tree) -> Option<T> {
        let span = if *found == Tree::Null {
            self.key_span()
        } else {
            self.span()
        };
        let message = format!("expected {expected}, found {}", found.describe());
        let diagnostic = Diagnostic::error(message).at(span, "");
        let advice = found.as_text().and_then(|text| of_decimal_comma(text));
        self.push(advice.into_iter().fold(diagnostic, Diagnostic::help));
        None
    }

    /// Adds a reference to `text`, which may be `section.name`; none if it cannot be a name.
    pub fn reference<T: Wanted>(&mut self, text: &Arc<str>, required: bool) -> Option<()> {
        let span = self.span();
        self.reference_in::<T>(text, required, span)
    }

    /// Adds the reference that the key `key` of the map at the current path is.
    pub fn reference_at_key<T: Wanted>(&mut self, key: &str, to: &Ref<T>) -> Option<()> {
        let span = self.key_span_of(key);
        self.reference_in::<T>(&to.name, true, span)
    }

    fn reference_in<T: Wanted>(
        &mut self,
        text: &Arc<str>,
        required: bool,
        span: Span,
    ) -> Option<()> {
        let (section, name) = match text.split_once('.') {
            None => (None, text.clone()),
            Some((section, name)) => match Section::named(section) {
                Some(section) => (Some(section), name.into()),
                None if self
                    .context
                    .modules
                    .iter()
                    .any(|module| **module == *section) =>
                {
                    (None, text.clone())
                }
                None if !required => return Some(()),
                None => {
                    let message = format!("there is no section and no module `{section}`");
                    let unknown = Diagnostic::error(message).at(span, "");
                    let modules = self.context.modules.clone();
                    let known = Section::ALL.iter().map(|s| s.name());
                    let known = known.chain(modules.iter().map(|module| &**module));
                    self.push(unknown.suggest(section, known));
                    return None;
                }
            },
        };
        self.references.push(Reference {
            written: text.clone(),
            section,
            name,
            wants: T::TYPES,
            stand_ins: T::STAND_INS,
            required,
            span,
        });
        Some(())
    }
}

impl JsonSchema for Tree {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Value".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({})
    }
}

impl Decode for Tree {
    fn decode(tree: &Tree, _: &mut Decoder) -> Option<Tree> {
        Some(tree.clone())
    }
}

impl<T: Decode> Decode for Option<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Option<T>> {
        if *tree == Tree::Null {
            Some(None)
        } else {
            T::decode(tree, cx).map(Some)
        }
    }

    fn absent() -> Option<Option<T>> {
        Some(None)
    }

    fn field_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [T::field_schema(generator), { "type": "null" }] })
    }
}
