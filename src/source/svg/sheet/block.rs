//! The text of a style sheet to its parts (CSS Syntax, level 3): comments off, blocks matched,
//! declarations apart.

use std::borrow::Cow;

/// One `name: value`.
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration<'a> {
    /// In lower case.
    pub name: Cow<'a, str>,
    /// Trimmed, without `!important`.
    pub value: &'a str,
    /// Whether it wins over all that are not.
    pub important: bool,
}

/// `text` with a blank for each comment and for the marks `<!--` and `-->`. In strings they are
/// text.
pub fn without_comments(text: &str) -> String {
    let mut bare = String::with_capacity(text.len());
    let mut rest = text;
    let mut quote = None;
    while let Some(c) = rest.chars().next() {
        let skipped = match quote {
            Some(_) => None,
            None if rest.starts_with("/*") => {
                Some(rest[2..].find("*/").map_or(rest.len(), |end| end + 4))
            }
            None if rest.starts_with("<!--") => Some(4),
            None if rest.starts_with("-->") => Some(3),
            None => None,
        };
        if let Some(length) = skipped {
            bare.push(' ');
            rest = &rest[length..];
            continue;
        }
        quote = match quote {
            Some(q) if q == c || c == '\n' => None,
            None if c == '"' || c == '\'' => Some(c),
            other => other,
        };
        bare.push(c);
        rest = &rest[c.len_utf8()..];
    }
    bare
}

/// A part of a sheet or of a rule's body.
#[derive(Debug, PartialEq)]
pub enum Part<'a> {
    /// What ends in `;`, or with the text.
    Statement(&'a str),
    /// What stands before `{`, and what is in the block.
    Block(&'a str, &'a str),
}

/// The parts of `text`, which holds no comments. A `}` that closes nothing is skipped.
pub fn parts(text: &str) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    let mut scan = Scan::default();
    let (mut start, mut body, mut depth) = (0, 0, 0usize);
    for (i, c) in text.char_indices() {
        if !scan.is_outside(c) {
            continue;
        }
        match c {
            ';' if depth == 0 => {
                parts.push(Part::Statement(text[start..i].trim()));
                start = i + 1;
            }
            '{' => {
                if depth == 0 {
                    body = i + 1;
                }
                depth += 1;
            }
            '}' if depth == 1 => {
                let prelude = text[start..body - 1].trim();
                parts.push(Part::Block(prelude, &text[body..i]));
                (start, depth) = (i + 1, 0);
            }
            '}' if depth == 0 => {
                parts.push(Part::Statement(text[start..i].trim()));
                start = i + 1;
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
    parts.push(match depth {
        0 => Part::Statement(text[start..].trim()),
        // What is open at the end is closed there.
        _ => Part::Block(text[start..body - 1].trim(), &text[body..]),
    });
    parts.retain(|part| *part != Part::Statement(""));
    parts
}

/// What `part` declares; nothing when it is no declaration.
pub fn declaration(part: &str) -> Option<Declaration<'_>> {
    let (name, value) = uncommented(part).split_once(':')?;
    let value = uncommented(value);
    let (bare, important) = match value.rsplit_once('!') {
        Some((bare, word)) if word.trim().eq_ignore_ascii_case("important") => {
            (uncommented(bare), true)
        }
        _ => (value, false),
    };
    let name = uncommented(name);
    let is_lower = !name.bytes().any(|b| b.is_ascii_uppercase()) || name.starts_with("--");
    Some(Declaration {
        name: match is_lower {
            true => Cow::Borrowed(name),
            false => Cow::Owned(name.to_ascii_lowercase()),
        },
        value: bare,
        important,
    })
}

/// The declarations of a `style` attribute.
pub fn declarations(text: &str) -> impl Iterator<Item = Declaration<'_>> {
    split_outside(text, ';').filter_map(declaration)
}

/// `text` without the comments and blanks at its ends.
fn uncommented(text: &str) -> &str {
    let mut text = text.trim();
    while let Some(rest) = text.strip_prefix("/*") {
        text = rest.split_once("*/").map_or("", |(_, tail)| tail).trim();
    }
    while let Some(rest) = text.strip_suffix("*/") {
        let Some((before, _)) = rest.rsplit_once("/*") else {
            break;
        };
        text = before.trim();
    }
    text
}

/// The parts of `text` between separators that stand outside quotes, parentheses and comments.
pub fn split_outside(text: &str, separator: char) -> impl Iterator<Item = &str> {
    let mut scan = Scan::default();
    text.split(move |c: char| scan.is_outside(c) && c == separator)
}

/// Whether the next character stands outside of quotes, parentheses, brackets and comments.
#[derive(Default)]
struct Scan {
    depth: usize,
    quote: Option<char>,
    /// In a comment.
    is_comment: bool,
    last: char,
}

impl Scan {
    fn is_outside(&mut self, c: char) -> bool {
        let last = std::mem::replace(&mut self.last, c);
        if self.is_comment {
            if last == '*' && c == '/' {
                self.is_comment = false;
                self.last = ' ';
            }
            return false;
        }
        match (self.quote, c) {
            (Some(q), _) if c == q || c == '\n' => self.quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => self.quote = Some(c),
            (None, '*') if last == '/' => {
                self.is_comment = true;
                self.last = ' ';
            }
            (None, '(' | '[') => self.depth += 1,
            (None, ')' | ']') => self.depth = self.depth.saturating_sub(1),
            // A brace ends what a parenthesis left open.
            (None, '{' | '}') => {
                self.depth = 0;
                return true;
            }
            _ => return self.depth == 0,
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_split_outside_quotes_parentheses_and_comments() {
        let found: Vec<_> = declarations(
            "fill : url(a;b) ; x:'a;b';/* ; */STROKE:/*c*/red /* d */! IMPORTANT;;bad",
        )
        .collect();
        let plain = |name: &'static str, value| Declaration {
            name: name.into(),
            value,
            important: false,
        };
        let red = Declaration {
            important: true,
            ..plain("stroke", "red")
        };
        assert_eq!(found, [plain("fill", "url(a;b)"), plain("x", "'a;b'"), red]);
    }

    #[test]
    fn comments_are_blanks_but_not_in_strings() {
        assert_eq!(
            without_comments("a/*b*/c<!--d-->'/*e*/'/*f"),
            "a c d '/*e*/' "
        );
    }

    #[test]
    fn blocks_nest_and_are_closed_at_the_end() {
        assert_eq!(
            parts("@import 'a;b'; g { x: 1; .a { y: 2 } } } h{'}'"),
            [
                Part::Statement("@import 'a;b'"),
                Part::Block("g", " x: 1; .a { y: 2 } "),
                Part::Block("h", "'}'"),
            ]
        );
        assert_eq!(parts("x: 1; .a{} y: 2").len(), 3);
        assert_eq!(parts("}{;,.a"), [Part::Block("", ";,.a")]);
    }
}
