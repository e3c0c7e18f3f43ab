//! The lines that a diagnostic shows: cut out of their files, long ones cropped around their places.

use std::ops::Range;
use std::sync::Arc;

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::shown;

/// The longest line that is shown whole, in characters: with the line number it fits the 100 columns of
/// a report, or nearly so.
const LONGEST_LINE: usize = 110;
/// The part of a longer line that is shown, in characters.
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
                Some((text, lines)) => {
                    let source = Source { text, lines };
                    excerpt.add(source, &piece.collect::<Vec<_>>(), &mut spans);
                }
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
    fn add(&mut self, source: Source, places: &[(usize, &Place)], spans: &mut [SourceSpan]) {
        let of_places = || places.iter().map(|(_, place)| source.line(place));
        let first = of_places().min().unwrap_or(0).saturating_sub(1);
        let last = (of_places().max().unwrap_or(0) + 1).min(source.lines.len() - 1);
        let mut piece = Piece {
            file: places[0].1.file.clone(),
            start: self.end(),
            first_line: first,
            text: String::new(),
        };
        for line in first..=last {
            let bytes = source.bytes(line);
            let here: Vec<&(usize, &Place)> = places
                .iter()
                .filter(|(_, place)| source.line(place) == line)
                .collect();
            if here.is_empty() && bytes.is_empty() && line + 1 == source.lines.len() {
                break;
            }
            // A line beside a place is cropped like the line of the place.
            let focus = source.column(here.first().unwrap_or(&&places[0]).1);
            let window = window(source.text, bytes.clone(), focus);
            let shift = piece.push(source.text, &window, &bytes);
            for (n, place) in here {
                let moved =
                    |byte: usize| byte.clamp(window.start, window.end) - window.start + shift;
                let start = moved(place.bytes.start);
                let end = moved(place.bytes.end.min(bytes.end));
                spans[*n] = (start, end.max(start) - start).into();
                self.starts.push((start, (line, source.column(place))));
            }
        }
        self.pieces.push(piece);
    }
}

impl Piece {
    /// Adds the part `window` of the line `bytes`, and returns where that part begins in the buffer.
    fn push(&mut self, text: &str, window: &Range<usize>, bytes: &Range<usize>) -> usize {
        self.text += if window.start > bytes.start {
            "…"
        } else {
            ""
        };
        let start = self.start + self.text.len();
        self.text.extend(text[window.clone()].chars().map(visible));
        self.text += if window.end < bytes.end { "…" } else { "" };
        self.text.push('\n');
        start
    }
}

/// The character, or in place of one that commands a terminal another with as many bytes, so that spans
/// stay right.
fn visible(c: char) -> char {
    match c {
        c if c == '\t' || !c.is_control() => c,
        c if c.len_utf8() == 1 => '?',
        _ => '\u{a4}',
    }
}

/// A text with the bytes at which its lines begin.
#[derive(Clone, Copy)]
struct Source<'a> {
    text: &'a str,
    lines: &'a [usize],
}

impl Source<'_> {
    /// The line in which a place begins.
    fn line(self, place: &Place) -> usize {
        line_of(self.lines, place.bytes.start)
    }

    /// The column in which a place begins, in characters.
    fn column(self, place: &Place) -> usize {
        let bytes = self.bytes(self.line(place));
        let before = bytes.start..place.bytes.start.min(bytes.end);
        self.text[before].chars().count()
    }

    /// The bytes of a line without its end.
    fn bytes(self, line: usize) -> Range<usize> {
        let start = self.lines[line];
        let next = self.lines.get(line + 1);
        let end = next.map_or(self.text.len(), |next| next - 1);
        let has_return = self.text[start..end].ends_with('\r');
        start..end - usize::from(has_return)
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
