//! Diagnostics of one drawing as they are met.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use roxmltree::{Attribute, Node};

use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::counted;

/// Errors beyond this many are counted, not kept.
const MOST_ERRORS: usize = 20;

/// What was met so far.
pub struct Report {
    file: Arc<str>,
    errors: Vec<Diagnostic>,
    more_errors: usize,
    warnings: Vec<Diagnostic>,
    /// What was told once for all, with the first place and how often.
    notes: BTreeMap<String, (Span, &'static str, usize)>,
}

impl Report {
    /// Nothing met yet.
    pub fn new(file: &Arc<str>) -> Report {
        let file = file.clone();
        Report {
            file,
            errors: Vec::new(),
            more_errors: 0,
            warnings: Vec::new(),
            notes: BTreeMap::new(),
        }
    }

    /// A report of the same drawing whose content nobody reads.
    pub fn silent(&self) -> Report {
        Report::new(&self.file)
    }

    /// An error at `range`.
    pub fn error(&mut self, range: Range<usize>, message: impl Into<String>) {
        let diagnostic = Diagnostic::error(message).at(self.span(range), "");
        self.push(diagnostic);
    }

    /// An error without a place in the text.
    pub fn push(&mut self, error: Diagnostic) {
        if self.errors.len() < MOST_ERRORS {
            self.errors.push(error);
        } else {
            self.more_errors += 1;
        }
    }

    /// A warning at `range`.
    pub fn warn(&mut self, range: Range<usize>, message: impl Into<String>, help: &str) {
        if self.warnings.len() < MOST_ERRORS {
            self.warnings.push(
                Diagnostic::warning(message)
                    .at(self.span(range), "")
                    .help(help),
            );
        }
    }

    /// Something visible is not read; said once for all of its `kind`.
    pub fn unread(&mut self, node: Node, kind: &str, help: &'static str) {
        self.note(node, format!("{kind} is not read"), help);
    }

    /// A warning that is said once, with how often there is cause for it.
    pub fn note(&mut self, node: Node, message: String, help: &'static str) {
        let span = self.span(tag_range(node));
        if self.notes.len() < MOST_ERRORS || self.notes.contains_key(&message) {
            self.notes.entry(message).or_insert((span, help, 0)).2 += 1;
        }
    }

    /// Whether there is an error.
    pub fn failed(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The span of `range`.
    pub fn span(&self, range: Range<usize>) -> Span {
        Span::Bytes {
            file: self.file.clone(),
            start: range.start,
            end: range.end,
        }
    }

    /// Errors first, then warnings.
    pub fn finish(mut self) -> Vec<Diagnostic> {
        if self.more_errors > 0 {
            let more = counted(self.more_errors, "more error", "more errors");
            let message = format!("{more} in this drawing");
            self.errors
                .push(Diagnostic::error(message).at(Span::File(self.file.clone()), ""));
        }
        self.errors.append(&mut self.warnings);
        for (message, (span, help, count)) in self.notes {
            let message = match count {
                1 => message,
                _ => format!("{message} ({count} times)"),
            };
            self.errors
                .push(Diagnostic::warning(message).at(span, "").help(help));
        }
        self.errors
    }
}

/// The start of the element's tag, `<` and its name.
pub fn tag_range(node: Node) -> Range<usize> {
    let range = node.range();
    let end = range.start + 1 + node.tag_name().name().len();
    range.start..end.min(range.end)
}

/// The bytes of character number `index` (from 1) of an attribute's value. Where the value holds
/// references or line breaks, the place is near it but inside the value all the same.
pub fn value_range(attribute: Attribute, index: usize) -> Range<usize> {
    let range = attribute.range_value();
    let value = attribute.value();
    let at = value.char_indices().nth(index.saturating_sub(1));
    let (from, length) = at.map_or((value.len(), 0), |(i, c)| (i, c.len_utf8()));
    let start = (range.start + from).min(range.end);
    start..(start + length).min(range.end)
}
