//! Diagnostics for machines: their places as lines and columns.

use std::sync::Arc;

use serde::Serialize;

use super::session::Session;
use fretwork_diagnostic::render::{Sources, extent};
use fretwork_diagnostic::{Diagnostic, Severity, Span};

/// A diagnostic as `--format json` prints it; lines and columns count characters from 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Placed {
    /// What it is about.
    pub code: &'static str,
    /// Whether it is an error.
    pub severity: Severity,
    /// One sentence.
    pub message: String,
    /// The file, from the project root.
    pub file: Option<String>,
    /// Where it begins.
    pub line: Option<usize>,
    /// Where it begins.
    pub column: Option<usize>,
    /// Where it ends.
    pub end_line: Option<usize>,
    /// The column after its last character.
    pub end_column: Option<usize>,
    /// What to do about it.
    pub help: Option<String>,
    /// The path of names to it, which stays the same when lines move.
    #[serde(skip)]
    pub path: Vec<Arc<str>>,
}

/// Diagnostics with their places looked up, in order of file and position.
pub fn placed<'a>(
    session: &Session,
    diagnostics: impl Iterator<Item = &'a Diagnostic>,
) -> Vec<Placed> {
    let sources = session.compiler.sources();
    let mut found: Vec<Placed> = diagnostics.map(|d| place(&sources, d)).collect();
    let key = |p: &Placed| (p.file.clone(), p.line, p.column, p.message.clone());
    found.sort_by_cached_key(key);
    found.dedup();
    found
}

/// A diagnostic with its place looked up in `sources`.
pub fn place(sources: &dyn Sources, diagnostic: &Diagnostic) -> Placed {
    let span = diagnostic.labels.first().map(|l| &l.span);
    let extent = span.and_then(|s| extent(s, sources));
    let path = match span {
        Some(Span::Name { path, .. } | Span::Text { path, .. }) => path.clone(),
        _ => Vec::new(),
    };
    Placed {
        code: diagnostic.code.unwrap_or_default().name(),
        severity: diagnostic.severity,
        message: diagnostic.message.clone(),
        file: span.map(|s| s.file().to_string()),
        line: extent.map(|e| e.start.0),
        column: extent.map(|e| e.start.1),
        end_line: extent.map(|e| e.end.0),
        end_column: extent.map(|e| e.end.1),
        help: diagnostic.help.clone(),
        path,
    }
}
