//! What is said about specs that are wrong: every file in `tests/bad/` has a snapshot of its own.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use fretwork::diagnostic::render::{Sources, position, render};
use fretwork::diagnostic::{Diagnostic, Span};
use fretwork::language::{MAX_BYTES, locate, parse, parse_bytes};

use super::language::{decode_all, files};

/// One file, known under its name.
struct One(Arc<str>);

impl Sources for One {
    fn text(&self, _: &str) -> Option<Arc<str>> {
        Some(self.0.clone())
    }

    fn locate(&self, span: &Span) -> Option<Range<usize>> {
        match span {
            Span::File(_) => None,
            Span::Name { path, key, .. } => locate(&self.0, path, *key),
            Span::Text { path, .. } => locate(&self.0, path, false),
            Span::Bytes { start, end, .. } => Some(*start..*end),
        }
    }
}

/// All that is wrong with a file.
fn diagnostics(path: &Path) -> (Vec<Diagnostic>, One) {
    let file: Arc<str> = path.file_name().unwrap().to_string_lossy().into();
    let bytes = std::fs::read(path).unwrap();
    let parsed = parse_bytes(&file, &bytes);
    let decoded = decode_all(&file, &parsed.document);
    let all = parsed
        .diagnostics
        .into_iter()
        .chain(decoded.into_iter().flat_map(|d| d.diagnostics))
        .collect();
    (all, One(String::from_utf8_lossy(&bytes).into()))
}

#[test]
fn every_mistake_is_explained_at_its_place() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for path in files("bad") {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let (diagnostics, source) = diagnostics(&path);
            assert!(
                diagnostics.iter().any(Diagnostic::is_error),
                "{name} is not bad"
            );
            for diagnostic in &diagnostics {
                let place = &diagnostic
                    .labels
                    .first()
                    .expect("every diagnostic has a place")
                    .span;
                assert!(
                    matches!(place, Span::File(_)) || position(place, &source).is_some(),
                    "{name}: {diagnostic:?}"
                );
            }
            insta::assert_snapshot!(format!("bad_{name}"), render(&diagnostics, &source, false));
        }
    });
}

#[test]
fn a_file_over_the_limit_is_refused_at_once() {
    let text = format!("fretwork: 1\nlet: {{ a: \"{}\" }}\n", "x".repeat(MAX_BYTES));
    let parsed = parse(&"large.yaml".into(), &text);
    let messages: Vec<&str> = parsed.diagnostics.iter().map(|d| &*d.message).collect();
    assert_eq!(messages, ["the file has 16777243 bytes, more than 16 MiB"]);
}
