//! Errors and warnings about a facade, and the part of it that each is about. The room knows no files:
//! its caller turns a [`Part`] into a span.

use std::ops::Range;
use std::sync::Arc;

use fretwork_diagnostic::{Code, Diagnostic, Severity, Span};

/// An error or a warning about a part of a facade.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Whether it is an error or a warning.
    pub severity: Severity,
    /// One sentence without a full stop.
    pub message: String,
    /// The part that it is about.
    pub part: Part,
    /// What to do about it.
    pub help: Option<String>,
}

/// A part of a facade's description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// The facade as a whole.
    Facade,
    /// The canvas: `width` or `height`.
    Canvas(&'static str),
    /// The range of a counter.
    Counter(char),
    /// An attribute of a symbol, or the symbol.
    Symbol(char, Option<&'static str>),
    /// A field of a layer, or the layer.
    Layer(Arc<str>, Option<&'static str>),
    /// Characters of a pattern's text.
    Pattern {
        /// The pattern.
        name: Arc<str>,
        /// Which of its texts.
        text: PatternPart,
        /// The bytes of the text that it is about.
        bytes: Range<usize>,
    },
}

/// One of the texts of a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PatternPart {
    /// The text of a plain pattern.
    Whole,
    /// The control pattern.
    Control,
    /// The content for this letter.
    Content(char),
}

impl Problem {
    /// An error.
    pub fn error(part: Part, message: impl Into<String>) -> Problem {
        Problem {
            severity: Severity::Error,
            message: message.into(),
            part,
            help: None,
        }
    }

    /// A warning.
    pub fn warning(part: Part, message: impl Into<String>) -> Problem {
        Problem {
            severity: Severity::Warning,
            ..Problem::error(part, message)
        }
    }

    /// The same with advice.
    pub fn help(mut self, help: impl Into<String>) -> Problem {
        self.help = Some(help.into());
        self
    }

    /// The diagnostic, at the place that `span` finds for the part.
    pub fn diagnostic(&self, span: impl Fn(&Part) -> Span) -> Diagnostic {
        let diagnostic = Diagnostic {
            severity: self.severity,
            message: self.message.clone(),
            labels: Vec::new(),
            help: self.help.clone(),
            code: Some(match self.part {
                Part::Pattern { .. } => Code::Pattern,
                _ => Code::Synthesis,
            }),
        };
        diagnostic.at(span(&self.part), "")
    }
}
