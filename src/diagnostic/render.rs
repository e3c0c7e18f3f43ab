//! Diagnostics as text for people: file, line, column, the source lines with their places underlined.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan};

use super::excerpt::{Excerpt, Place, Text};
use super::{Diagnostic, Severity, Span, shown};

/// Columns of the text.
const WIDTH: usize = 100;

/// The texts that spans point into. Both are asked for every place, so keep what is dear to find.
pub trait Sources {
    /// The text of `file`, if it is known.
    fn text(&self, file: &str) -> Option<Arc<str>>;
    /// The bytes of the file's text that `span` covers.
    fn locate(&self, span: &Span) -> Option<Range<usize>>;
}

/// A line and a column, in characters; both begin at 1.
pub type Position = (usize, usize);

/// The positions between which a place lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// The position of its first character.
    pub start: Position,
    /// The position after its last character.
    pub end: Position,
}

/// The extent of `span`, if its text is known.
pub fn extent(span: &Span, sources: &dyn Sources) -> Option<Extent> {
    let text = sources.text(span.file())?;
    let bytes = sources.locate(span)?;
    let start = position_of(&text, bytes.start)?;
    let end = text.ceil_char_boundary(bytes.end.clamp(bytes.start, text.len()));
    Some(Extent {
        start,
        end: position_of(&text, end)?,
    })
}

/// The position of the start of `span`, if its text is known.
pub fn position(span: &Span, sources: &dyn Sources) -> Option<Position> {
    position_of(&sources.text(span.file())?, sources.locate(span)?.start)
}

fn position_of(text: &str, byte: usize) -> Option<Position> {
    let before = text.get(..byte)?;
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    Some((
        before.matches('\n').count() + 1,
        before[line_start..].chars().count() + 1,
    ))
}

/// All diagnostics as text of 100 columns, ordered by file and position, each only once.
pub fn render(diagnostics: &[Diagnostic], sources: &dyn Sources, color: bool) -> String {
    let mut texts = Texts {
        sources,
        files: BTreeMap::new(),
    };
    let mut shown: Vec<(Vec<Place>, &Diagnostic)> = diagnostics
        .iter()
        .map(|d| {
            (
                d.labels
                    .iter()
                    .map(|label| texts.place(&label.span))
                    .collect(),
                d,
            )
        })
        .collect();
    shown.sort_by(|(a_places, a), (b_places, b)| {
        let key = |places: &[Place]| {
            places
                .first()
                .map(|place| (place.file.clone(), place.bytes.start))
        };
        key(a_places).cmp(&key(b_places)).then_with(|| a.cmp(b))
    });
    shown.dedup_by(|a, b| a.1 == b.1);
    let theme = if color {
        GraphicalTheme::unicode()
    } else {
        GraphicalTheme::unicode_nocolor()
    };
    let handler = GraphicalReportHandler::new_themed(theme).with_width(WIDTH);
    let mut out = String::new();
    for (places, diagnostic) in shown {
        let report = Report::new(diagnostic, &places);
        // Writing to a string cannot fail; a report that could not be drawn is still named.
        if handler.render_report(&mut out, &report).is_err() {
            out += &format!("{report}\n");
        }
        out += "\n";
    }
    out
}

/// The texts of all files, and where their lines begin.
struct Texts<'a> {
    sources: &'a dyn Sources,
    files: BTreeMap<Arc<str>, Option<Text>>,
}

impl Texts<'_> {
    fn place(&mut self, span: &Span) -> Place {
        let file = span.file().clone();
        let known = self.files.entry(file.clone()).or_insert_with(|| {
            let text = self.sources.text(&file)?;
            let lines = std::iter::once(0)
                .chain(text.match_indices('\n').map(|(at, _)| at + 1))
                .collect();
            Some((text, lines))
        });
        let bytes = match (span, &known) {
            (Span::File(_), _) | (_, None) => None,
            (_, Some((text, _))) => self.sources.locate(span).map(|bytes| {
                let start = text.floor_char_boundary(bytes.start);
                start..text.ceil_char_boundary(bytes.end.clamp(start, text.len().max(start)))
            }),
        };
        Place {
            file,
            source: known.clone().filter(|_| bytes.is_some()),
            bytes: bytes.unwrap_or(0..0),
        }
    }
}

/// A diagnostic as miette takes it.
#[derive(Debug)]
struct Report {
    severity: Severity,
    message: String,
    help: Option<String>,
    labels: Vec<LabeledSpan>,
    excerpt: Excerpt,
}

impl Report {
    fn new(diagnostic: &Diagnostic, places: &[Place]) -> Report {
        let (excerpt, spans) = Excerpt::of(places);
        let labels =
            spans
                .into_iter()
                .zip(&diagnostic.labels)
                .enumerate()
                .map(|(n, (span, label))| {
                    let text =
                        Some(shown(&label.text).into_owned()).filter(|text| !text.is_empty());
                    if n == 0 {
                        LabeledSpan::new_primary_with_span(text, span)
                    } else {
                        LabeledSpan::new_with_span(text, span)
                    }
                });
        Report {
            severity: diagnostic.severity,
            message: shown(&diagnostic.message).into_owned(),
            help: diagnostic
                .help
                .as_deref()
                .map(|help| shown(help).into_owned()),
            labels: labels.collect(),
            excerpt,
        }
    }
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Report {}

impl miette::Diagnostic for Report {
    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        self.help
            .as_ref()
            .map(|help| Box::new(help) as Box<dyn std::fmt::Display>)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        Some(&self.excerpt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Files;

    const FIRST: &str = "fretwork: 1\r\nré: { width: x }\r\nlast: 1\r\n";

    impl Sources for Files {
        fn text(&self, file: &str) -> Option<Arc<str>> {
            match file {
                "a.yaml" => Some(FIRST.into()),
                "b.star" => Some("def f():\n\treturn 1\n".into()),
                _ => None,
            }
        }

        fn locate(&self, span: &Span) -> Option<Range<usize>> {
            match span {
                Span::Bytes { start, end, .. } => Some(*start..*end),
                _ => None,
            }
        }
    }

    fn bytes(file: &str, start: usize, end: usize) -> Span {
        Span::Bytes {
            file: file.into(),
            start,
            end,
        }
    }

    fn text_of(diagnostics: &[Diagnostic]) -> String {
        render(diagnostics, &Files, false)
    }

    #[test]
    fn positions_count_characters_and_lines() {
        let at = FIRST.find("x }").expect("it is there");
        assert_eq!(
            position(&bytes("a.yaml", at, at + 1), &Files),
            Some((2, 14))
        );
        assert_eq!(position(&bytes("none", 0, 0), &Files), None);
        let extent = extent(&bytes("a.yaml", at, at + 1), &Files).expect("it has a text");
        assert_eq!((extent.start, extent.end), ((2, 14), (2, 15)));
    }

    #[test]
    fn files_and_places_are_in_order_and_nothing_is_said_twice() {
        let late = Diagnostic::error("late").at(bytes("a.yaml", 33, 37), "");
        let early = Diagnostic::warning("early").at(bytes("a.yaml", 14, 17), "");
        let other = Diagnostic::error("other").at(bytes("b.star", 0, 3), "");
        let text = text_of(&[other, late.clone(), early, late]);
        let places: Vec<usize> = ["early", "late", "other"]
            .map(|word| text.find(word).expect("it is shown"))
            .into();
        assert!(places.is_sorted());
        assert_eq!(text.matches("late").count(), 1);
        assert!(!text.contains('\u{1b}') && !text.contains('\r'));
    }

    #[test]
    fn places_in_several_files_are_shown() {
        let diagnostic = Diagnostic::error("two files")
            .at(bytes("b.star", 10, 16), "here")
            .at(bytes("a.yaml", 13, 16), "called here")
            .at(Span::File("gone.yaml".into()), "from here")
            .help("help");
        let text = text_of(&[diagnostic]);
        for part in [
            "[b.star:2:2]",
            "[a.yaml:2:1]",
            "[gone.yaml:1:1]",
            "called here",
            "help: help",
        ] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }

    #[test]
    fn spans_outside_of_the_text_do_not_harm() {
        for (start, end) in [
            (0, 1000),
            (1000, 2000),
            (14, 16),
            (5, 2),
            (FIRST.len(), FIRST.len()),
        ] {
            assert!(
                text_of(&[Diagnostic::error("odd").at(bytes("a.yaml", start, end), "x")])
                    .contains("odd")
            );
        }
        assert!(text_of(&[Diagnostic::error("nowhere")]).contains("nowhere"));
    }

    #[test]
    fn color_is_there_when_asked_for() {
        let diagnostic = Diagnostic::error("e").at(bytes("a.yaml", 0, 3), "");
        assert!(render(&[diagnostic], &Files, true).contains('\u{1b}'));
    }
}
