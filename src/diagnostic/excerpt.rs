//! The lines that a diagnostic shows: cut out of their files, long ones cropped around their places.

use std::ops::Range;
use std::sync::Arc;

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::shown;

/// A longer line is cropped, in characters.
const LONGEST_LINE: usize = 110;
/// What is left of a cropped line, in characters.
const WINDOW: usize = 84;
/// Places with at most this many lines between them are shown in one piece.
const NEAR: usize = 3;

/// A text and where its lines begin.
pub(super) type Text = (Arc<str>, Arc<[usize]>);

/// A place in a text.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// The file.
    pub file: Arc<str>,
    /// Its text; nothing if the file as a whole is meant.
    pub source: Option<Text>,
    /// The bytes of the place.
    pub bytes: Range<usize>,
}

/// Pieces of files, one after the other in one buffer.
#[derive(Debug)]
pub(super) struct Excerpt {
    pieces: Vec<Piece>,
    /// Where each place begins in the buffer, with its line and column in its file, from 0.
    starts: Vec<(usize, (usize, usize))>,
}

#[derive(Debug)]
struct Piece {
    file: Arc<str>,
    /// Where it begins in the buffer.
    start: usize,
    first_line: usize,
    text: String,
}

impl Excerpt {
    /// The excerpt that shows `places`, and their spans in it.
    pub fn of(places: &[Place]) -> (Excerpt, Vec<SourceSpan>) {
        let mut order: Vec<usize> = (0..places.len()).collect();
        // The file of the first place comes first.
        order.sort_by_key(|&n| {
            (
                places[n].file != places[0].file,
                places[n].file.clone(),
                places[n].bytes.start,
            )
        });
        let mut excerpt = Excerpt {
            pieces: Vec::new(),
            starts: Vec::new(),
        };
        let mut spans = vec![SourceSpan::from((0, 0)); places.len()];
        let mut rest = &*order;
        while let Some((&first, _)) = rest.split_first() {
            let together = 1 + rest
                .windows(2)
                .take_while(|pair| near(&places[pair[0]], &places[pair[1]]))
                .count();
            let piece = rest[..together].iter().map(|&n| (n, &places[n]));
            match &places[first].source {
                Some((text, lines)) => excerpt.add(text, lines, piece.collect(), &mut spans),
                None => excerpt.add_file(&places[first].file, &rest[..together], &mut spans),
            }
            rest = &rest[together..];
        }
        (excerpt, spans)
    }

    /// Where the next piece begins: a byte lies between, so that no two share an offset.
    fn end(&self) -> usize {
        self.pieces
            .last()
            .map_or(0, |piece| piece.start + piece.text.len() + 1)
    }

    /// Adds an empty piece for a file as a whole.
    fn add_file(&mut self, file: &Arc<str>, places: &[usize], spans: &mut [SourceSpan]) {
        let start = self.end();
        self.pieces.push(Piece {
            file: file.clone(),
            start,
            first_line: 0,
            text: String::new(),
        });
        self.starts.push((start, (0, 0)));
        places.iter().for_each(|&n| spans[n] = (start, 0).into());
    }

    /// Adds the lines around places that are near to one another.
    fn add(
        &mut self,
        text: &str,
        lines: &[usize],
        places: Vec<(usize, &Place)>,
        spans: &mut [SourceSpan],
    ) {
        let at = |place: &Place| line_of(lines, place.bytes.start);
        let first = places
            .iter()
            .map(|(_, place)| at(place))
            .min()
            .unwrap_or(0)
            .saturating_sub(1);
        let last = places.iter().map(|(_, place)| at(place)).max().unwrap_or(0) + 1;
        let file = places[0].1.file.clone();
        let mut piece = Piece {
            file,
            start: self.end(),
            first_line: first,
            text: String::new(),
        };
        let column = |place: &Place| {
            let bytes = line_bytes(text, lines, at(place));
            text[bytes.start..place.bytes.start.min(bytes.end)]
                .chars()
                .count()
        };
        for line in first..=last.min(lines.len() - 1) {
            let bytes = line_bytes(text, lines, line);
            let here: Vec<&(usize, &Place)> = places
                .iter()
                .filter(|(_, place)| at(place) == line)
                .collect();
            if here.is_empty() && bytes.is_empty() && line + 1 == lines.len() {
                break;
            }
            // Lines around a place are cropped where its own is.
            let window = window(
                text,
                bytes.clone(),
                column(here.first().unwrap_or(&&places[0]).1),
            );
            let prefix = if window.start > bytes.start {
                "…"
            } else {
                ""
            };
            let shift = piece.start + piece.text.len() + prefix.len();
            for (n, place) in here {
                let clamp =
                    |byte: usize| byte.clamp(window.start, window.end) - window.start + shift;
                let (start, end) = (
                    clamp(place.bytes.start),
                    clamp(place.bytes.end.min(bytes.end)),
                );
                spans[*n] = (start, end.max(start) - start).into();
                self.starts.push((start, (line, column(place))));
            }
            let suffix = if window.end < bytes.end { "…" } else { "" };
            piece.text += prefix;
            // As many bytes as before, so that the spans stay right.
            piece.text.extend(text[window].chars().map(|c| match c {
                '\t' => c,
                c if c.is_control() => {
                    if c.len_utf8() == 1 {
                        '?'
                    } else {
                        '\u{a4}'
                    }
                }
                c => c,
            }));
            piece.text += suffix;
            piece.text.push('\n');
        }
        self.pieces.push(piece);
    }
}

fn near(a: &Place, b: &Place) -> bool {
    a.file == b.file
        && match (&a.source, &b.source) {
            (Some((_, lines)), Some(_)) => {
                line_of(lines, b.bytes.start) - line_of(lines, a.bytes.start) <= NEAR
            }
            (None, None) => true,
            _ => false,
        }
}

fn line_of(lines: &[usize], byte: usize) -> usize {
    lines.partition_point(|&start| start <= byte) - 1
}

/// The bytes of a line without its end.
fn line_bytes(text: &str, lines: &[usize], line: usize) -> Range<usize> {
    let end = lines.get(line + 1).map_or(text.len(), |next| next - 1);
    let end = if text[lines[line]..end].ends_with('\r') {
        end - 1
    } else {
        end
    };
    lines[line]..end
}

/// The part of a line that is shown: all of it, or what is around the character `focus`.
fn window(text: &str, line: Range<usize>, focus: usize) -> Range<usize> {
    let characters = text[line.clone()].chars().count();
    if characters <= LONGEST_LINE {
        return line;
    }
    let first = focus.saturating_sub(WINDOW / 3).min(characters);
    let byte = |n: usize| {
        text[line.clone()]
            .char_indices()
            .nth(n)
            .map_or(line.end, |(at, _)| line.start + at)
    };
    byte(first)..byte(first + WINDOW)
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let inside = |piece: &&Piece| {
            piece.start <= span.offset()
                && span.offset() + span.len() <= piece.start + piece.text.len()
        };
        let piece = self
            .pieces
            .iter()
            .rev()
            .find(inside)
            .ok_or(MietteError::OutOfBounds)?;
        let local = SourceSpan::from((span.offset() - piece.start, span.len()));
        let contents = piece.text.as_bytes().read_span(&local, before, after)?;
        let known = self
            .starts
            .iter()
            .find(|(start, _)| *start == span.offset() && before == 0);
        let (line, column) = known.map_or(
            (piece.first_line + contents.line(), contents.column()),
            |(_, place)| *place,
        );
        let whole = SourceSpan::from((
            contents.span().offset() + piece.start,
            contents.span().len(),
        ));
        let file = shown(&piece.file).into_owned();
        Ok(Box::new(MietteSpanContents::new_named(
            file,
            contents.data(),
            whole,
            line,
            column,
            contents.line_count(),
        )))
    }
}
