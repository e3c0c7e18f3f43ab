//! From a byte of a scalar's text to the byte of the YAML that gave it, through quotes, escapes,
//! indentation and folded lines.

use std::ops::Range;

/// The bytes of `raw`, a scalar as it stands in a file, that the bytes `range` of `text`, its value,
/// came from. None where they came from elsewhere: from an expression, or through an alias.
///
/// White space is not followed, since YAML adds and removes it; a place in it is the place after the
/// letter before it.
pub(super) fn source_range(raw: &str, text: &str, range: Range<usize>) -> Option<Range<usize>> {
    let mut letters = letters(raw).into_iter();
    let mut after_last = 0;
    let mut start = None;
    for (at, letter) in text.char_indices().filter(|(_, c)| !c.is_whitespace()) {
        if at >= range.end && at > range.start {
            break;
        }
        let (bytes, source) = letters.next()?;
        if source != letter {
            return None;
        }
        if at >= range.start && start.is_none() {
            start = Some(bytes.start);
        }
        after_last = bytes.end;
    }
    let start = start.unwrap_or(after_last);
    Some(start..after_last.max(start))
}

/// The letters of the scalar's value that are no white space, with the bytes that stand for each.
fn letters(raw: &str) -> Vec<(Range<usize>, char)> {
    let start = raw.len() - raw.trim_start().len();
    let body = &raw[start..];
    let plain = |from: usize| {
        let text = &raw[from..];
        text.char_indices()
            .map(|(at, c)| (from + at..from + at + c.len_utf8(), c))
            .collect::<Vec<_>>()
    };
    let mut letters = match body.chars().next() {
        Some('"') => escaped(raw, start + 1),
        Some('\'') => single_quoted(&plain(start + 1)),
        Some('|' | '>') => plain(body.find('\n').map_or(raw.len(), |line| start + line + 1)),
        _ => plain(start),
    };
    letters.retain(|(_, c)| !c.is_whitespace());
    letters
}

/// The letters of a single-quoted scalar whose text begins with `all`: two quotes stand for one, and
/// one alone is the end.
fn single_quoted(all: &[(Range<usize>, char)]) -> Vec<(Range<usize>, char)> {
    let mut letters = Vec::with_capacity(all.len());
    let mut rest = all.iter().peekable();
    while let Some((bytes, c)) = rest.next() {
        match (c, rest.peek()) {
            ('\'', Some((next, '\''))) => {
                letters.push((bytes.start..next.end, '\''));
                rest.next();
            }
            ('\'', _) => break,
            _ => letters.push((bytes.clone(), *c)),
        }
    }
    letters
}

/// The letters of a double-quoted scalar whose text begins at `from`.
fn escaped(raw: &str, from: usize) -> Vec<(Range<usize>, char)> {
    let mut letters = Vec::new();
    let mut rest = raw[from..].char_indices().map(|(at, c)| (from + at, c));
    while let Some((at, c)) = rest.next() {
        match c {
            '"' => break,
            '\\' => {
                let Some((next, escape)) = rest.next() else {
                    break;
                };
                let digits = match escape {
                    'x' => 2,
                    'u' => 4,
                    'U' => 8,
                    _ => 0,
                };
                let end = (next + escape.len_utf8() + digits).min(raw.len());
                let code = raw
                    .get(next + 1..end)
                    .and_then(|hex| u32::from_str_radix(hex, 16).ok());
                rest.by_ref().take(digits).for_each(drop);
                let letter = match escape {
                    'x' | 'u' | 'U' => code.and_then(char::from_u32).unwrap_or('\u{fffd}'),
                    'n' | 't' | 'r' | 'v' | 'f' | 'N' | 'L' | 'P' | '_' | '\t' | '\n' => ' ',
                    '0' => '\0',
                    'a' => '\u{7}',
                    'b' => '\u{8}',
                    'e' => '\u{1b}',
                    other => other,
                };
                letters.push((at..end, letter));
            }
            c => letters.push((at..at + c.len_utf8(), c)),
        }
    }
    letters
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(raw: &str, text: &str, part: &str, expected: &str) {
        let at = text.find(part).expect("the part is in the text");
        let range = source_range(raw, text, at..at + part.len()).expect("the text came from there");
        assert_eq!(&raw[range], expected);
    }

    #[test]
    fn every_style_of_a_scalar_is_followed() {
        check("A(BA)^k", "A(BA)^k", "^k", "^k");
        check("'it''s é b'", "it's é b", "s é", "s é");
        check(
            "\"def f(e):\\n  return \\u0062\\\"\\x41\"",
            "def f(e):\n  return b\"A",
            "b\"A",
            "\\u0062\\\"\\x41",
        );
        check(
            "|\n    def f(e):\n\n      return 1\n",
            "def f(e):\n\n  return 1\n",
            "return",
            "return",
        );
        check("|-  # a comment\n  a\n  b", "a\nb", "b", "b");
        check(
            ">\n  one\n  two\n\n  three",
            "one two\nthree\n",
            "three",
            "three",
        );
        check("plain\n  goes on", "plain goes on", "goes", "goes");
    }

    #[test]
    fn places_in_white_space_and_at_the_end_stand_after_the_letter_before() {
        assert_eq!(source_range("\"ab cd\"", "ab cd", 2..3), Some(3..3));
        assert_eq!(source_range("\"ab\"", "ab", 2..2), Some(3..3));
        assert_eq!(source_range("\"ab\"", "ab", 0..0), Some(1..2));
        assert_eq!(source_range("''", "", 0..0), Some(0..0));
    }

    #[test]
    fn what_an_expression_made_has_no_place() {
        assert_eq!(source_range("\"a ${n} b\"", "a 12 b", 5..6), None);
        check("\"a ${n} b\"", "a 12 b", "a", "a");
        assert_eq!(source_range("*alias", "text", 1..2), None);
    }
}
