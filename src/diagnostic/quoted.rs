//! Foreign text in messages: short, and without power over a terminal or the lines of a log.

use std::borrow::Cow;

/// As many characters of a quoted text are shown.
const LONGEST_QUOTE: usize = 120;

/// As many characters of a message are shown, however many quotes are in it.
const LONGEST_MESSAGE: usize = 4000;

/// `text` with its control characters written as escapes, line breaks too, and so those that turn the
/// direction of writing.
pub fn shown(text: &str) -> Cow<'_, str> {
    if !text.chars().any(has_power) {
        return Cow::Borrowed(text);
    }
    let escaped = |c: char| match c {
        '\n' => "\\n".to_string(),
        '\r' => "\\r".to_string(),
        '\t' => "\\t".to_string(),
        c if has_power(c) => format!("\\u{{{:x}}}", u32::from(c)),
        c => c.to_string(),
    };
    Cow::Owned(text.chars().map(escaped).collect())
}

fn has_power(c: char) -> bool {
    let turns =
        matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

/// `message` with each long text between backticks cut in its middle, and its end cut where it is too long itself.
pub(super) fn shortened(message: String) -> String {
    if message.len() <= LONGEST_QUOTE {
        return message;
    }
    let parts: Vec<Cow<'_, str>> = (message.split('`').enumerate())
        .map(|(n, part)| {
            if n % 2 == 1 {
                cut(part, LONGEST_QUOTE)
            } else {
                Cow::Borrowed(part)
            }
        })
        .collect();
    let whole = parts.join("`");
    match whole.char_indices().nth(LONGEST_MESSAGE) {
        None => whole,
        Some((at, _)) => format!("{}…", &whole[..at]),
    }
}

/// `text`, or its first and last characters where it has more than `longest`.
fn cut(text: &str, longest: usize) -> Cow<'_, str> {
    if text.len() <= longest || text.chars().nth(longest).is_none() {
        return Cow::Borrowed(text);
    }
    let half = longest / 2;
    let first = text
        .char_indices()
        .nth(half)
        .map_or(text.len(), |(at, _)| at);
    let last = text
        .char_indices()
        .nth_back(half - 1)
        .map_or(0, |(at, _)| at);
    Cow::Owned(format!("{}…{}", &text[..first], &text[last..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_seen() {
        assert_eq!(shown("plain é"), "plain é");
        assert_eq!(shown("a\n::error::b\u{1b}[2J"), "a\\n::error::b\\u{1b}[2J");
        assert_eq!(shown("a\u{202e}b\u{85}"), "a\\u{202e}b\\u{85}");
    }

    #[test]
    fn long_quotes_are_cut() {
        let long = "é".repeat(1_000_000);
        let message = shortened(format!("nothing is named `{long}` in `regions`"));
        assert!(
            message.chars().count() < 200 && message.ends_with("` in `regions`"),
            "{message}"
        );
        let text = "a word of a text ".repeat(1000);
        assert!(shortened(text).chars().count() <= LONGEST_MESSAGE + 1);
        assert_eq!(shortened("`short`".to_string()), "`short`");
    }
}
