//! Errors and warnings with their places and with advice.
//!
//! Every room returns [`Diagnostic`]s besides or instead of a value. Nothing here reads a file. A
//! [`Span`] names a place by a path of keys or by a range of bytes; it becomes a line and a column only
//! when [`render`](render::render) looks it up in the text.

mod excerpt;
mod nearest;
mod quoted;
pub mod render;

pub use nearest::{nearest, nearest_file};
pub use quoted::shown;

use std::sync::Arc;

use quoted::shortened;
use serde::{Deserialize, Serialize};

/// Whether a diagnostic is an error or a warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// There is no value.
    Error,
    /// There is a value, but it may not be what the author meant.
    Warning,
}

/// What a diagnostic is about: the same for ever, so that programs may tell diagnostics apart.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Code {
    /// The text of a spec.
    Syntax,
    /// A section, kind or field.
    Field,
    /// A name that stands for something else.
    Reference,
    /// What stands in a field, or what comes of it.
    #[default]
    Value,
    /// A file that is read.
    File,
    /// A script or an expression.
    Script,
    /// The pattern of a facade.
    Pattern,
    /// What is asked for cannot be made, or not well.
    Synthesis,
    /// What an artifact can hold.
    Format,
    /// A file that is written, and the cache.
    Output,
}

impl Code {
    /// All of them.
    pub const ALL: [Code; 10] = [
        Code::Syntax,
        Code::Field,
        Code::Reference,
        Code::Value,
        Code::File,
        Code::Script,
        Code::Pattern,
        Code::Synthesis,
        Code::Format,
        Code::Output,
    ];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Code::Syntax => "syntax",
            Code::Field => "field",
            Code::Reference => "reference",
            Code::Value => "value",
            Code::File => "file",
            Code::Script => "script",
            Code::Pattern => "pattern",
            Code::Synthesis => "synthesis",
            Code::Format => "format",
            Code::Output => "output",
        }
    }

    /// What it is about, in a sentence.
    pub fn about(self) -> &'static str {
        match self {
            Code::Syntax => "The text of a spec cannot be read.",
            Code::Field => "A section, a kind or a field is unknown, missing or there twice.",
            Code::Reference => "A name stands for nothing, or for something of another kind.",
            Code::Value => "What stands in a field, or what comes of it, cannot be or is doubtful.",
            Code::File => "A file that a spec reads is missing, damaged or not what it should be.",
            Code::Script => "A script or an expression fails.",
            Code::Pattern => "The pattern of a facade is wrong.",
            Code::Synthesis => "What is asked for cannot be made, or not well.",
            Code::Format => "An artifact cannot hold what it is to show.",
            Code::Output => "A file cannot be written, or is not what the specs give.",
        }
    }
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Span {
    /// The file as a whole; its path is relative to the project root.
    File(Arc<str>),
    /// The value, or with `key` the key, at the end of a path such as `regions.page.rectangle.width`.
    /// Items of lists are numbers. The span stays right when the text around it moves.
    Name {
        /// The file, relative to the project root.
        file: Arc<str>,
        /// Keys and numbers of items from the top of the file.
        path: Vec<Arc<str>>,
        /// Whether the span is the last key rather than its value.
        key: bool,
    },
    /// Bytes of a text that is a value, such as a script or a pattern inside a spec.
    Text {
        /// The file, relative to the project root.
        file: Arc<str>,
        /// Keys and numbers of items from the top of the file.
        path: Vec<Arc<str>>,
        /// The first byte of the text.
        start: usize,
        /// The byte after the last one.
        end: usize,
    },
    /// Bytes of a script, a drawing, or a text that could not be parsed.
    Bytes {
        /// The file, relative to the project root.
        file: Arc<str>,
        /// The first byte.
        start: usize,
        /// The byte after the last one.
        end: usize,
    },
}

impl Span {
    /// The value under `path` in `file`.
    pub fn value(file: &Arc<str>, path: &[Arc<str>]) -> Span {
        Span::Name {
            file: file.clone(),
            path: path.to_vec(),
            key: false,
        }
    }

    /// The key at the end of `path` in `file`.
    pub fn key(file: &Arc<str>, path: &[Arc<str>]) -> Span {
        Span::Name {
            file: file.clone(),
            path: path.to_vec(),
            key: true,
        }
    }

    /// The file that the place is in.
    pub fn file(&self) -> &Arc<str> {
        match self {
            Span::File(file)
            | Span::Name { file, .. }
            | Span::Text { file, .. }
            | Span::Bytes { file, .. } => file,
        }
    }
}

/// A place with a few words about it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// The words; may be empty.
    pub text: String,
}

/// One error or warning. Its first label is the place that is reported as file, line and column.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Diagnostic {
    /// Whether it is an error or a warning.
    pub severity: Severity,
    /// One sentence without a full stop.
    pub message: String,
    /// Places, the most important one first.
    pub labels: Vec<Label>,
    /// What to do about it.
    pub help: Option<String>,
    /// What it is about, where that was said.
    pub code: Option<Code>,
}

impl Diagnostic {
    /// An error without a place yet.
    pub fn error(message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Error,
            message: shortened(message.into()),
            labels: Vec::new(),
            help: None,
            code: None,
        }
    }

    /// A warning without a place yet.
    pub fn warning(message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Warning,
            ..Diagnostic::error(message)
        }
    }

    /// The same with one more place.
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label {
            span,
            text: shortened(text.into()),
        });
        self
    }

    /// The same with advice.
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(shortened(help.into()));
        self
    }

    /// The same with the advice `did you mean`, if a known name is near to `unknown`.
    pub fn suggest<'a>(
        self,
        unknown: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Diagnostic {
        match nearest(unknown, known) {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// The same, about `code` unless it was said to be about something else before.
    pub fn about(self, code: Code) -> Diagnostic {
        Diagnostic {
            code: self.code.or(Some(code)),
            ..self
        }
    }

    /// Whether it is an error rather than a warning.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}
