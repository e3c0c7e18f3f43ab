//! Tokens of a formula with their places. Texts have no escapes here; one that has is left to
//! Starlark.

use crate::formula::tree::FormulaError;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Token<'a> {
    Int(i64),
    Float(f64),
    Text(&'a str),
    Word(&'a str),
    /// One of the operators, brackets and the comma.
    Sign(&'static str),
    End,
}

const SIGNS: [&str; 16] = [
    "==", "!=", "<=", ">=", "//", "+", "-", "*", "/", "%", "<", ">", "(", ")", ",", "=",
];

/// The tokens of `text`, each with the bytes it covers; an [`Token::End`] closes them.
pub(crate) fn tokens(text: &str) -> Result<Vec<(Token<'_>, usize, usize)>, FormulaError> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let Some(first) = rest.chars().next() else {
            break;
        };
        if first == ' ' || first == '\t' {
            at += 1;
            continue;
        }
        let (token, length) = token(rest, first).ok_or_else(|| unexpected(text, at))?;
        out.push((token, at, at + length));
        at += length;
    }
    out.push((Token::End, text.len(), text.len()));
    Ok(out)
}

fn token(rest: &str, first: char) -> Option<(Token<'_>, usize)> {
    let next_is_digit = rest[first.len_utf8()..].starts_with(|c: char| c.is_ascii_digit());
    if first.is_ascii_digit() || (first == '.' && next_is_digit) {
        return number(rest);
    }
    if first == '_' || first.is_ascii_alphabetic() {
        let length = rest
            .find(|c: char| c != '_' && !c.is_ascii_alphanumeric())
            .unwrap_or(rest.len());
        return (!rest[length..].starts_with(['"', '\'']))
            .then_some((Token::Word(&rest[..length]), length));
    }
    if first == '"' || first == '\'' {
        let body = &rest[1..];
        let length = body.find(first)?;
        let plain =
            !body[..length].contains(['\\', '\n']) && !body[length + 1..].starts_with(first);
        return plain.then_some((Token::Text(&body[..length]), length + 2));
    }
    SIGNS
        .iter()
        .find(|sign| rest.starts_with(**sign))
        .map(|sign| (Token::Sign(sign), sign.len()))
}

fn number(rest: &str) -> Option<(Token<'_>, usize)> {
    let bytes = rest.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let mut length = digits(0);
    let mut whole = true;
    if bytes.get(length) == Some(&b'.') {
        whole = false;
        length = digits(length + 1);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let end = digits(length + 1 + sign);
        if end == length + 1 + sign {
            return None;
        }
        whole = false;
        length = end;
    }
    // `0x1f`, `2mm` and `012` are not numbers here.
    if bytes
        .get(length)
        .is_some_and(|b| b.is_ascii_alphanumeric() || *b == b'_')
    {
        return None;
    }
    let text = &rest[..length];
    if whole {
        let leading_zero = length > 1 && bytes[0] == b'0';
        return if leading_zero {
            None
        } else {
            text.parse().ok().map(|i| (Token::Int(i), length))
        };
    }
    text.parse()
        .ok()
        .filter(|f: &f64| f.is_finite())
        .map(|f| (Token::Float(f), length))
}

fn unexpected(text: &str, at: usize) -> FormulaError {
    let length = text[at..]
        .find([' ', ',', ')'])
        .unwrap_or(text.len() - at)
        .max(1);
    let end = (at + length..=text.len())
        .find(|e| text.is_char_boundary(*e))
        .unwrap_or(text.len());
    FormulaError {
        message: format!("`{}` cannot stand here", &text[at..end]),
        start: at,
        end,
        help: None,
    }
}
