//! Advice for traps that YAML sets for specs: an expression or a colour without quotes, a comma in a
//! number, lines that are indented by too little or too much.

use std::sync::Arc;

use super::Tree;
use super::read::{Spot, Value};
use fretwork_diagnostic::{Code, Diagnostic, Span};

const QUOTE_EXPRESSION: &str =
    "put quotes around it: \"${…}\"; without them YAML reads its braces, colons and `#`";

/// Reports plain `${…}` and colours that YAML took for comments. The latter get their colour back,
/// so that nothing else complains about them.
pub(super) fn check(
    spot: &mut Spot,
    file: &Arc<str>,
    text: &str,
    diagnostics: &mut Vec<Diagnostic>,
) {
    match &mut spot.value {
        Value::Scalar(_) => check_quotes(&spot.span, file, text, diagnostics),
        Value::List(items) => items
            .iter_mut()
            .for_each(|item| check(item, file, text, diagnostics)),
        Value::Map(entries) => {
            for (key, value) in entries {
                check_quotes(&key.span, file, text, diagnostics);
                let lost = lost_colour(&text[key.span.end..])
                    .filter(|_| matches!(value.value, Value::Scalar(Tree::Null)));
                let Some((skipped, colour)) = lost else {
                    check(value, file, text, diagnostics);
                    continue;
                };
                let start = key.span.end + skipped;
                let place = Span::Bytes {
                    file: file.clone(),
                    start,
                    end: start + colour.len(),
                };
                diagnostics.push(
                    Diagnostic::error(format!("`{}` lost its colour to a comment", key.name))
                        .at(place, "YAML reads a comment here")
                        .help(format!("put quotes around it: \"{colour}\"")),
                );
                value.value = Value::Scalar(Tree::from(colour));
            }
        }
    }
}

fn check_quotes(
    span: &std::ops::Range<usize>,
    file: &Arc<str>,
    text: &str,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let source = &text[span.clone()];
    if source.contains("${") && !source.starts_with(['"', '\'']) && !is_block(&text[..span.start]) {
        diagnostics.push(
            Diagnostic::error("an expression stands without quotes")
                .about(Code::Syntax)
                .at(
                    Span::Bytes {
                        file: file.clone(),
                        start: span.start,
                        end: span.end,
                    },
                    "",
                )
                .help(QUOTE_EXPRESSION),
        );
    }
}

/// Whether `before` ends with the sign of a block scalar (`|` or `>`) on a line of its own.
fn is_block(before: &str) -> bool {
    let sign = before.trim_end_matches([' ', '\t', '\r', '\n']);
    let line = sign.rsplit('\n').next().unwrap_or_default();
    let line = line.split(" #").next().unwrap_or_default().trim_end();
    let ends_line = before[sign.len()..].contains('\n');
    ends_line
        && line
            .trim_end_matches(|c: char| c.is_ascii_digit() || c == '+' || c == '-')
            .ends_with(['|', '>'])
}

/// The colour in a comment right after the colon that `text` starts with, and where it starts.
fn lost_colour(text: &str) -> Option<(usize, &str)> {
    let rest = text.trim_start_matches(['"', '\'']).strip_prefix(':')?;
    let comment = rest.trim_start_matches(' ');
    let digits = comment
        .strip_prefix('#')?
        .bytes()
        .take_while(u8::is_ascii_hexdigit)
        .count();
    let next = comment.as_bytes().get(1 + digits);
    let ends = next.is_none_or(|b| !b.is_ascii_alphanumeric());
    (matches!(digits, 3 | 4 | 6 | 8) && ends)
        .then(|| (text.len() - comment.len(), &comment[..1 + digits]))
}

/// Advice about a syntax error at byte `at` of `text`: an unquoted expression on its line, or a
/// colour lost to a comment before it (which takes the closing brace with it).
pub(super) fn of_syntax_error(text: &str, at: usize) -> Option<String> {
    let at = text.floor_char_boundary(at);
    let line_start = text[..at].rfind('\n').map_or(0, |i| i + 1);
    let line_end = text[at..].find('\n').map_or(text.len(), |i| at + i);
    if unquoted(&text[line_start..line_end], "${").is_some() {
        return Some(QUOTE_EXPRESSION.to_owned());
    }
    for line in text[..line_end].lines() {
        let colon = unquoted(line, ": #").and_then(|i| lost_colour(&line[i..]));
        if let Some((_, colour)) = colon {
            return Some(format!(
                "`#` starts a comment: put quotes around the colour, \"{colour}\""
            ));
        }
    }
    if text[line_start..line_end]
        .trim_start_matches(' ')
        .starts_with('\t')
    {
        return Some("indent with spaces: YAML does not allow tabs there".to_owned());
    }
    if let Some(advice) = of_indentation(&text[..line_end]) {
        return Some(advice);
    }
    if is_escaped(&text[line_start..line_end]) {
        return Some(ESCAPE.to_owned());
    }
    text[..line_end]
        .lines()
        .find(|line| unquoted(line, "${").is_some())
        .map(|_| QUOTE_EXPRESSION.to_owned())
}

/// Advice for a `\` in a path.
const ESCAPE: &str =
    "in double quotes `\\` begins an escape: write `/` between folders, on Windows too";

/// Whether a line has a `\` within double quotes.
fn is_escaped(line: &str) -> bool {
    let mut parts = line.split('"');
    parts.next();
    parts.step_by(2).any(|quoted| quoted.contains('\\'))
}

/// Advice if the last line of `text` begins in a column where no line before it lets it begin.
fn of_indentation(text: &str) -> Option<String> {
    let indent = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let mut open: Vec<usize> = Vec::new();
    let mut lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let last = lines.next_back()?;
    let before = lines.clone().next_back()?;
    for own in lines.map(indent) {
        while open.last().is_some_and(|outer| *outer > own) {
            open.pop();
        }
        if open.last() != Some(&own) {
            open.push(own);
        }
    }
    let own = indent(last);
    let deepest = *open.last()?;
    let plural = if own == 1 { "" } else { "s" };
    if own > deepest && !goes_on(before) {
        return Some(format!(
            "the line is indented by {own} space{plural}, and the line before it has its value: fields of one map begin in \
             one column, here {deepest}"
        ));
    }
    if own >= deepest || open.contains(&own) {
        return None;
    }
    let inner = open.iter().copied().find(|column| *column > own)?;
    let outer = open.iter().copied().rfind(|column| *column < own);
    let outer = outer.map_or(String::new(), |outer| format!(" or {outer}"));
    Some(format!(
        "the line is indented by {own} space{plural}: fields of one map begin in one column, here {inner}{outer}"
    ))
}

/// Whether what a line begins goes on in deeper lines: a map, a list, a text over several lines, something in brackets.
fn goes_on(line: &str) -> bool {
    let line = line.split(" #").next().unwrap_or(line).trim_end();
    let opened = |open, close| line.matches(open).count() > line.matches(close).count();
    line.ends_with([':', '|', '>', '-', ',', '+'])
        || opened('{', '}')
        || opened('[', ']')
        || line.matches('"').count() % 2 == 1
        || line.trim_start().starts_with("- ")
        || !line.contains(':')
}

/// Advice for text that is a number with a decimal comma, such as `20,5`.
pub(super) fn of_decimal_comma(text: &str) -> Option<String> {
    let (whole, rest) = text.trim().split_once(',')?;
    let digits = whole.trim_start_matches(['-', '+']);
    let is_number = !digits.is_empty()
        && digits.bytes().all(|b| b.is_ascii_digit())
        && rest.starts_with(|c: char| c.is_ascii_digit())
        && !rest.contains(',');
    is_number.then(|| format!("write a point before the decimals: `{whole}.{rest}`"))
}

/// Where `pattern` stands in `line` outside of quotes.
fn unquoted(line: &str, pattern: &str) -> Option<usize> {
    let mut quote = None;
    for (at, c) in line.char_indices() {
        match quote {
            Some(q) if c == q => quote = None,
            Some(_) => {}
            None if line[at..].starts_with(pattern) => return Some(at),
            None if c == '"' || c == '\'' => quote = Some(c),
            None if c == '#' && (at == 0 || line[..at].ends_with(' ')) => return None,
            None => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_told_from_comments() {
        assert_eq!(lost_colour(": #c9a27a }"), Some((2, "#c9a27a")));
        assert_eq!(lost_colour(": #fff"), Some((2, "#fff")));
        assert_eq!(lost_colour(": # fff"), None);
        assert_eq!(lost_colour(": #added"), None);
        assert_eq!(lost_colour(": #facade of wood"), Some((2, "#facade")));
        assert_eq!(lost_colour(": red"), None);
    }

    #[test]
    fn decimal_commas_are_recognized() {
        let advice = |text| of_decimal_comma(text).map(|a| a.rsplit(' ').next().map(str::to_owned));
        assert_eq!(advice("20,5"), Some(Some("`20.5`".to_owned())));
        assert_eq!(advice("-1,25mm"), Some(Some("`-1.25mm`".to_owned())));
        for other in ["1,2,3", "a,b", "1,", ",5", "1, x", "12"] {
            assert_eq!(advice(other), None, "{other}");
        }
    }

    #[test]
    fn lines_between_two_columns_are_told() {
        let text = "a:\n  b:\n    c: 1\n   d: 2";
        let advice = of_indentation(text).expect("advice");
        assert!(advice.ends_with("here 4 or 2"), "{advice}");
        assert_eq!(of_indentation("a:\n  b: 1\n  c: 2"), None);
        assert_eq!(of_indentation("a:\n  b: 1\nc: 2"), None);
        let advice = of_indentation("a:\n  b: { c: 1 }\n   d: 2").expect("advice");
        assert!(advice.ends_with("here 2"), "{advice}");
        for deeper in [
            "a:\n  b: 1",
            "a: {\n  b: 1",
            "a: >\n  b: 1",
            "- a: 1\n  b: 2",
        ] {
            assert_eq!(of_indentation(deeper), None, "{deeper}");
        }
    }

    #[test]
    fn backslashes_in_double_quotes_get_advice() {
        let error = super::super::parse(
            &"f.yaml".into(),
            "fretwork: 1\nlet: { a: \"b\\dot.svg\" }\n",
        );
        let help = error.diagnostics[0].help.clone().unwrap_or_default();
        assert!(help.contains("write `/`"), "{help}");
        assert!(!is_escaped("a: 'b\\c' # \"d\""));
    }

    #[test]
    fn blocks_count_as_quoted() {
        let errors = |text: &str| {
            super::super::parse(&"f.yaml".into(), &format!("fretwork: 1\nlet:\n{text}"))
                .diagnostics
                .len()
        };
        assert_eq!(errors("  a: |\n    ${x}\n    ${y}\n"), 0);
        assert_eq!(errors("  a: >2- # folded\n\n    ${x}\n"), 0);
        assert_eq!(errors("  a:\n    ${x}\n"), 1);
        assert_eq!(errors("  a: !!str ${x}\n  b: &b \"${x}\"\n  c: *b\n"), 1);
    }

    #[test]
    fn quotes_hide_what_they_hold() {
        assert_eq!(unquoted("a: \"${x}\"", "${"), None);
        assert_eq!(unquoted("a: '${x}' ${y}", "${"), Some(10));
        assert_eq!(unquoted("a: 1 # ${x}", "${"), None);
    }
}
