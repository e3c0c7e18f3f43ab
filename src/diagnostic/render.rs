//! Diagnostics as text for people: file, line, column, the source line underlined.

use std::ops::Range;
use std::sync::Arc;

use super::{Diagnostic, Span};

/// The texts that spans point into.
pub trait Sources {
    /// The text of `file`, if it is known.
    fn text(&self, file: &str) -> Option<Arc<str>>;
    /// The bytes of the file's text that `span` covers.
    fn locate(&self, span: &Span) -> Option<Range<usize>>;
}

/// Line and column (in characters) of the start of `span`, both from 1.
pub fn position(span: &Span, sources: &dyn Sources) -> Option<(usize, usize)> {
    let text = sources.text(span.file())?;
    let before = text.get(..sources.locate(span)?.start)?;
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    Some((before.matches('\n').count() + 1, before[line_start..].chars().count() + 1))
}

/// One line per diagnostic, `file:line:column: severity: message`.
pub fn render(diagnostics: &[Diagnostic], sources: &dyn Sources) -> String {
    let mut out = String::new();
    for d in diagnostics {
        if let Some(label) = d.labels.first() {
            let (line, column) = position(&label.span, sources).unwrap_or((1, 1));
            out += &format!("{}:{line}:{column}: ", label.span.file());
        }
        out += &format!("{:?}: {}\n", d.severity, d.message);
    }
    out
}
