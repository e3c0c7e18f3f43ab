//! Expressions `${…}` inside text: finding them, and replacing them by values.
//!
//! What an expression means is not known here: its text is given to a function that evaluates it.

use std::sync::Arc;

use super::Tree;
use fretwork_diagnostic::{Diagnostic, Span};

/// A part of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Piece {
    /// Text as it is; `$${` has become `${`.
    Literal(String),
    /// The inside of one `${…}`, trimmed.
    Expression(String),
}

/// The parts of `text` in order. An expression ends at the first `}` that belongs to no bracket and no
/// quoted text within it.
///
/// # Errors
/// The byte at which a `${` begins that is never closed.
pub fn split(text: &str) -> Result<Vec<Piece>, usize> {
    let mut pieces = Vec::new();
    let mut literal = String::new();
    let mut at = 0;
    while let Some(found) = text[at..].find("${") {
        let start = at + found;
        if text[at..start].ends_with('$') {
            literal.push_str(&text[at..start]);
            literal.push('{');
            at = start + 2;
            continue;
        }
        literal.push_str(&text[at..start]);
        let inside = &text[start + 2..];
        let length = expression_length(inside).ok_or(start)?;
        if !literal.is_empty() {
            pieces.push(Piece::Literal(std::mem::take(&mut literal)));
        }
        pieces.push(Piece::Expression(inside[..length].trim().to_owned()));
        at = start + 2 + length + 1;
    }
    literal.push_str(&text[at..]);
    if !literal.is_empty() {
        pieces.push(Piece::Literal(literal));
    }
    Ok(pieces)
}

/// The number of bytes before the `}` that closes the expression at the start of `text`.
fn expression_length(text: &str) -> Option<usize> {
    let mut open = 0_usize;
    let mut quote = None;
    let mut chars = text.char_indices();
    while let Some((at, c)) = chars.next() {
        match (quote, c) {
            (Some(_), '\\') => {
                chars.next();
            }
            (Some(q), c) if c == q => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '{' | '[' | '(') => open += 1,
            (None, '}') if open == 0 => return Some(at),
            (None, '}' | ']' | ')') => open = open.saturating_sub(1),
            _ => {}
        }
    }
    None
}

/// Whether `text` holds an expression (or one that is not closed).
pub fn has_expression(text: &str) -> bool {
    split(text).map_or(true, |pieces| {
        pieces.iter().any(|p| matches!(p, Piece::Expression(_)))
    })
}

/// The error for an expression in the text at `span` that is not closed.
pub(super) fn unclosed(text: &str, start: usize, span: Span) -> Diagnostic {
    let from = super::tree::shortened(&text[start..]);
    Diagnostic::error(format!("the expression `{from}` is not closed"))
        .at(span, "a `}` is missing")
        .help("write `${…}`, or `$${` where a plain `${` is meant")
}

/// The error for an empty expression in the text at `span`.
pub(super) fn empty(span: Span) -> Diagnostic {
    Diagnostic::error("the expression is empty").at(span, "")
}

/// A function that returns the value of the expression at a path, or why it has none.
pub type Evaluate<'a> = dyn FnMut(&str, &[Arc<str>]) -> Result<Tree, Diagnostic> + 'a;

/// `tree` with every `${…}` in its texts replaced by its value; keys stay. A text that is one
/// expression and nothing else becomes the value as it is; inside other text the value is written
/// out. `path` is that of `tree` in `file`, and is the same again afterwards.
///
/// # Errors
/// All errors of `evaluate`, of unclosed expressions, and of lists, maps and nulls inside text.
pub fn substitute(
    tree: &Tree,
    file: &Arc<str>,
    path: &mut Vec<Arc<str>>,
    evaluate: &mut Evaluate,
) -> Result<Tree, Vec<Diagnostic>> {
    match tree {
        Tree::Text(text) => substitute_text(text, file, path, evaluate),
        Tree::List(items) => {
            let mut numbered = items
                .iter()
                .enumerate()
                .map(|(n, item)| (n.to_string().into(), item));
            substitute_all(&mut numbered, file, path, evaluate)
                .map(|items| Tree::list(items.into_iter().map(|i| i.1)))
        }
        Tree::Map(entries) => {
            let mut named = entries.iter().map(|(key, value)| (key.clone(), value));
            substitute_all(&mut named, file, path, evaluate).map(Tree::map)
        }
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => {
            Ok(tree.clone())
        }
    }
}

type Children = Vec<(Arc<str>, Tree)>;

fn substitute_all(
    children: &mut dyn Iterator<Item = (Arc<str>, &Tree)>,
    file: &Arc<str>,
    path: &mut Vec<Arc<str>>,
    evaluate: &mut Evaluate,
) -> Result<Children, Vec<Diagnostic>> {
    let mut done = Vec::new();
    let mut errors = Vec::new();
    for (step, child) in children {
        path.push(step.clone());
        match substitute(child, file, path, evaluate) {
            Ok(child) => done.push((step, child)),
            Err(more) => errors.extend(more),
        }
        path.pop();
    }
    if errors.is_empty() {
        Ok(done)
    } else {
        Err(errors)
    }
}

/// A text that several expressions stand in may become so many bytes long, which is as many as an expression may give
/// elements. Texts that name one another twice would double from one to the next.
const LONGEST: usize = 1 << 20;

/// The value of one text, as [`substitute`] gives it; also for names, such as that of an artifact.
///
/// # Errors
/// As [`substitute`].
pub fn substitute_text(
    text: &Arc<str>,
    file: &Arc<str>,
    path: &[Arc<str>],
    evaluate: &mut Evaluate,
) -> Result<Tree, Vec<Diagnostic>> {
    let pieces =
        split(text).map_err(|start| vec![unclosed(text, start, Span::value(file, path))])?;
    if pieces.contains(&Piece::Expression(String::new())) {
        return Err(vec![empty(Span::value(file, path))]);
    }
    if let [Piece::Expression(expression)] = &*pieces {
        return evaluate(expression, path).map_err(|error| vec![error]);
    }
    let mut out = String::new();
    let mut errors = Vec::new();
    for piece in pieces {
        match piece {
            Piece::Literal(literal) => out.push_str(&literal),
            Piece::Expression(expression) => match evaluate(&expression, path) {
                Ok(value) => match value.to_text() {
                    Some(value) if out.len() + value.len() > LONGEST => {
                        let error = format!("the text is longer than {LONGEST} bytes");
                        errors.push(Diagnostic::error(error).at(Span::value(file, path), ""));
                        break;
                    }
                    Some(value) => out.push_str(&value),
                    None => errors.push(
                        Diagnostic::error(format!(
                            "`{expression}` is {} and cannot stand inside text",
                            value.describe()
                        ))
                        .at(Span::value(file, path), ""),
                    ),
                },
                Err(error) => errors.push(error),
            },
        }
    }
    if errors.is_empty() {
        Ok(Tree::Text(out.into()))
    } else {
        Err(errors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn literal(text: &str) -> Piece {
        Piece::Literal(text.into())
    }

    fn expression(text: &str) -> Piece {
        Piece::Expression(text.into())
    }

    #[test]
    fn expressions_end_at_their_own_brace() {
        assert_eq!(split("plain"), Ok(vec![literal("plain")]));
        assert_eq!(split(""), Ok(vec![]));
        assert_eq!(split("${ a }b"), Ok(vec![expression("a"), literal("b")]));
        assert_eq!(
            split("x${ {1: 2}[1] }"),
            Ok(vec![literal("x"), expression("{1: 2}[1]")])
        );
        assert_eq!(
            split(r#"${"}" + 'a\'}'}"#),
            Ok(vec![expression(r#""}" + 'a\'}'"#)])
        );
        assert_eq!(
            split("${a}${b}"),
            Ok(vec![expression("a"), expression("b")])
        );
        assert_eq!(split("${é}ü"), Ok(vec![expression("é"), literal("ü")]));
    }

    #[test]
    fn two_dollars_are_one_and_no_expression() {
        assert_eq!(split("$${a}"), Ok(vec![literal("${a}")]));
        assert_eq!(split("cost $5 $"), Ok(vec![literal("cost $5 $")]));
        assert_eq!(
            split("$${a} ${b}"),
            Ok(vec![literal("${a} "), expression("b")])
        );
        assert!(!has_expression("$${a}"));
    }

    #[test]
    fn an_open_expression_is_told_with_its_place() {
        assert_eq!(split("ab ${c"), Err(3));
        assert_eq!(split("${'}"), Err(0));
        assert_eq!(split("${a} ${{}"), Err(5));
        assert!(has_expression("${"));
    }

    fn substituted(tree: &Tree) -> Result<Tree, Vec<Diagnostic>> {
        let mut evaluate = |text: &str, path: &[Arc<str>]| match text {
            "n" => Ok(Tree::Int(3)),
            "x" => Ok(Tree::from(2.0)),
            "list" => Ok(Tree::from([1, 2])),
            _ => Err(Diagnostic::error(format!("{text} at {}", path.join(".")))),
        };
        substitute(
            tree,
            &"f.yaml".into(),
            &mut vec!["root".into()],
            &mut evaluate,
        )
    }

    #[test]
    fn a_lone_expression_keeps_its_type() {
        assert_eq!(substituted(&Tree::from("${n}")), Ok(Tree::Int(3)));
        assert_eq!(substituted(&Tree::from("${list}")), Ok(Tree::from([1, 2])));
        assert_eq!(
            substituted(&Tree::from("${x}mm ${n}")),
            Ok(Tree::from("2mm 3"))
        );
        assert_eq!(substituted(&Tree::from("$${n}")), Ok(Tree::from("${n}")));
    }

    #[test]
    fn all_errors_are_reported_with_their_paths() {
        let tree = Tree::map([
            (
                "a",
                Tree::list([Tree::from("${p}"), Tree::from("x${list}")]),
            ),
            ("b", Tree::from("-${q}")),
        ]);
        let messages: Vec<String> = substituted(&tree)
            .unwrap_err()
            .into_iter()
            .map(|d| d.message)
            .collect();
        assert_eq!(
            messages,
            [
                "p at root.a.0",
                "`list` is a list and cannot stand inside text",
                "q at root.b"
            ]
        );
    }
}
