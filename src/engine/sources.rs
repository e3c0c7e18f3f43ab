//! Texts and places for rendering diagnostics.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::{Arc, Mutex};

use super::database::{Database, Db as _};
use fretwork_diagnostic::render::Sources;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_language::Places;

/// The texts that a database has read. A spec is parsed once more, with positions, when a place in
/// it is first asked for.
pub struct DatabaseSources<'a> {
    database: &'a Database,
    places: Mutex<BTreeMap<Arc<str>, Arc<Places>>>,
}

impl<'a> DatabaseSources<'a> {
    /// The texts of `database`.
    pub fn new(database: &'a Database) -> DatabaseSources<'a> {
        DatabaseSources {
            database,
            places: Mutex::default(),
        }
    }

    fn places(&self, file: &Arc<str>) -> Option<Arc<Places>> {
        let mut places = self.places.lock().ok()?;
        if let Some(found) = places.get(file) {
            return Some(found.clone());
        }
        let parsed = Arc::new(Places::new(self.text(file)?));
        places.insert(file.clone(), parsed.clone());
        Some(parsed)
    }
}

impl DatabaseSources<'_> {
    /// `diagnostics` without those that repeat another one about the same text, which several aliases
    /// bring to several places. The first place is kept.
    pub fn without_repeats(&self, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let mut first: BTreeMap<_, (usize, usize)> = BTreeMap::new();
        let mut repeats = BTreeSet::new();
        for (number, diagnostic) in diagnostics.iter().enumerate() {
            let Some((origin, start)) = self.origin(diagnostic) else {
                continue;
            };
            let key = (
                diagnostic.severity,
                &diagnostic.message,
                &diagnostic.help,
                origin,
            );
            match first.get_mut(&key) {
                None => {
                    first.insert(key, (start, number));
                }
                Some(known) => {
                    let new = (start, number);
                    repeats.insert(new.max(*known).1);
                    *known = new.min(*known);
                }
            }
        }
        let numbered = diagnostics.into_iter().enumerate();
        numbered
            .filter(|(number, _)| !repeats.contains(number))
            .map(|(_, diagnostic)| diagnostic)
            .collect()
    }

    /// What a diagnostic is about: a file and the byte where the value is defined; and where it is
    /// used.
    fn origin(&self, diagnostic: &Diagnostic) -> Option<((Arc<str>, usize), usize)> {
        let span = &diagnostic.labels.first()?.span;
        let Span::Name { file, path, key } = span else {
            return None;
        };
        let origin = self.places(file)?.origin(path, *key)?;
        Some(((file.clone(), origin), self.locate(span)?.start))
    }
}

impl Sources for DatabaseSources<'_> {
    fn text(&self, file: &str) -> Option<Arc<str>> {
        let content = self
            .database
            .file(&Arc::from(file))
            .content(self.database)
            .as_ref()
            .ok()?;
        Some(String::from_utf8_lossy(&content.whole().ok()?).into())
    }

    fn locate(&self, span: &Span) -> Option<Range<usize>> {
        match span {
            Span::File(_) => Some(0..0),
            Span::Bytes { start, end, .. } => Some(*start..*end),
            Span::Name { file, path, key } => self.places(file)?.locate(path, *key),
            Span::Text {
                file,
                path,
                start,
                end,
            } => self.places(file)?.locate_text(path, *start..*end),
        }
    }
}
