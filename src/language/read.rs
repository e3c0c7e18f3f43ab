//! From YAML text to a tree with positions, or the error in the text.
//!
//! The limits here keep a hostile file from costing more than its size. What the values mean is not
//! known here.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde_yaml::budget::BudgetBreach;
use serde_yaml::options::{DuplicateKeyPolicy, NonFiniteFloatPolicy};
use serde_yaml::{Location, MessageFormatter, Spanned, UserMessageFormatter};

use super::Tree;
use super::hint;
use fretwork_diagnostic::{Code, Diagnostic, Span};

/// The greatest size of a file, in bytes. Larger data belongs into files of its own.
pub const MAX_BYTES: usize = 16 << 20;
/// The greatest depth of lists and maps inside one another. Trees are walked by recursion.
pub const MAX_DEPTH: usize = 100;
/// The number of values that all aliases (`*name`) together may repeat. Without a limit, ten lines of
/// aliases of aliases would be a billion values.
pub const MAX_REPEATED: usize = 100_000;
const TOO_DEEP: &str = "lists and maps stand more than 100 deep inside one another";
/// The number of values and keys in a file.
pub const MAX_NODES: usize = 2 << 20;

/// A value with its place in the text.
#[derive(Debug)]
pub(super) struct Spot {
    pub value: Value,
    /// The bytes of the text that it is shown at: those of an alias are where it is used.
    pub span: Range<usize>,
    /// The first byte of what gave the value: behind an alias, where its anchor stands.
    pub origin: usize,
}

#[derive(Debug)]
pub(super) enum Value {
    Scalar(Tree),
    List(Vec<Spot>),
    /// The entries as they are written, even if a key stands twice.
    Map(Vec<(Key, Spot)>),
}

#[derive(Debug)]
pub(super) struct Key {
    pub name: Arc<str>,
    pub span: Range<usize>,
    /// As [`Spot::origin`].
    pub origin: usize,
}

/// The tree of `text`, or the error in its syntax.
pub(super) fn read(file: &Arc<str>, text: &str) -> Result<Spot, Diagnostic> {
    if text.len() > MAX_BYTES {
        let message = format!(
            "the file has {} bytes, more than {} MiB",
            text.len(),
            MAX_BYTES >> 20
        );
        return Err(Diagnostic::error(message)
            .about(Code::Syntax)
            .at(Span::File(file.clone()), "")
            .help("move parts of it to `include` files"));
    }
    match serde_yaml::from_str_with_options::<Option<Spanned<Raw>>>(text, options()) {
        Ok(None) => Ok(Spot {
            value: Value::Scalar(Tree::Null),
            span: 0..0,
            origin: 0,
        }),
        Ok(Some(raw)) => Ok(placed(raw, text)),
        Err(error) => Err(syntax_error(file, text, &error)),
    }
}

fn options() -> serde_yaml::Options {
    serde_yaml::options! {
        budget: serde_yaml::budget! {
            max_depth: MAX_DEPTH,
            flow_nesting_limit: MAX_DEPTH,
            max_events: 2 * MAX_NODES,
            max_nodes: MAX_NODES,
            max_merge_keys: MAX_REPEATED,
            max_documents: 1,
            enforce_alias_anchor_ratio: false,
        },
        alias_limits: serde_yaml::alias_limits! { max_total_replayed_events: MAX_REPEATED },
        duplicate_keys: DuplicateKeyPolicy::PassThrough,
        non_finite_float_policy: NonFiniteFloatPolicy::PassThrough,
        underscored_numbers_as_strings: true,
        strict_booleans: true,
        reject_unsupported_tags: true,
        with_snippet: false,
    }
}

/// A value as the deserializer gives it.
enum Raw {
    Scalar(Tree),
    List(Vec<Spanned<Raw>>),
    Map(Vec<(Spanned<Name>, Spanned<Raw>)>),
}

/// A key: any scalar, as its text.
struct Name(Arc<str>);

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Name, D::Error> {
        String::deserialize(deserializer).map(|name| Name(name.into()))
    }
}

impl<'de> Deserialize<'de> for Raw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Raw, D::Error> {
        deserializer.deserialize_any(RawVisitor)
    }
}

struct RawVisitor;

impl<'de> Visitor<'de> for RawVisitor {
    type Value = Raw;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E>(self) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::Null))
    }

    fn visit_none<E>(self) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::Null))
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Raw, D::Error> {
        Raw::deserialize(deserializer)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::Bool(value)))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::Int(value)))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Raw, E> {
        Ok(Raw::Scalar(
            i64::try_from(value).map_or_else(|_| Tree::from(value as f64), Tree::Int),
        ))
    }

    fn visit_i128<E>(self, value: i128) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::from(value as f64)))
    }

    fn visit_u128<E>(self, value: u128) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::from(value as f64)))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::from(value)))
    }

    fn visit_str<E>(self, value: &str) -> Result<Raw, E> {
        Ok(Raw::Scalar(Tree::from(value)))
    }

    fn visit_bytes<E: serde::de::Error>(self, _: &[u8]) -> Result<Raw, E> {
        Err(E::custom("binary data has no place in a spec"))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Raw, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(Raw::List(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Raw, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Raw::Map(entries))
    }
}

fn placed(raw: Spanned<Raw>, text: &str) -> Spot {
    let span = bytes(&raw.referenced, text);
    let source = bytes(&raw.defined, text);
    let origin = source.start;
    match raw.value {
        Raw::Scalar(tree) => Spot {
            value: Value::Scalar(written(tree, &text[source])),
            span,
            origin,
        },
        Raw::List(items) => {
            let items: Vec<Spot> = items.into_iter().map(|item| placed(item, text)).collect();
            let end = items.last().map_or(span.end, |item| item.span.end);
            Spot {
                span: closed(span, end, text),
                value: Value::List(items),
                origin,
            }
        }
        Raw::Map(entries) => {
            let entries: Vec<(Key, Spot)> = entries
                .into_iter()
                .map(|(k, v)| (key(k, text), placed(v, text)))
                .collect();
            let end = entries
                .last()
                .map_or(span.end, |(k, v)| v.span.end.max(k.span.end));
            Spot {
                span: closed(span, end, text),
                value: Value::Map(entries),
                origin,
            }
        }
    }
}

/// A scalar with the way in which it is written in `source`, if it is a number or a truth value.
fn written(tree: Tree, source: &str) -> Tree {
    // An anchor may stand before it.
    let word = source.split_whitespace().last().unwrap_or_default();
    let is_plain = |b: u8| b.is_ascii_alphanumeric() || b"+-._:".contains(&b);
    match tree {
        Tree::Int(_) | Tree::Float(_) | Tree::Bool(_)
            if !word.is_empty() && word.bytes().all(is_plain) =>
        {
            Tree::written(tree, word)
        }
        tree => tree,
    }
}

fn key(raw: Spanned<Name>, text: &str) -> Key {
    Key {
        span: bytes(&raw.referenced, text),
        origin: bytes(&raw.defined, text).start,
        name: raw.value.0,
    }
}

fn bytes(location: &Location, text: &str) -> Range<usize> {
    let span = location.span();
    let start = span.byte_offset().map_or(0, |n| n as usize).min(text.len());
    let end = (start + span.byte_len().map_or(0, |n| n as usize)).min(text.len());
    if text.is_char_boundary(start) && text.is_char_boundary(end) {
        start..end
    } else {
        0..0
    }
}

/// The span of a list or map from where it starts to the end of its last item, or to the bracket
/// after it. An item that is an alias ends where it is used, so `last` is never far away.
fn closed(span: Range<usize>, last: usize, text: &str) -> Range<usize> {
    let end = last.max(span.end);
    let bracket = match text.as_bytes().get(span.start) {
        Some(b'{') => '}',
        Some(b'[') => ']',
        _ => return span.start..end,
    };
    let rest = text[end..].trim_start_matches([' ', '\t', '\r', '\n', ',']);
    if rest.starts_with(bracket) {
        span.start..text.len() - rest.len() + 1
    } else {
        span.start..end
    }
}

fn syntax_error(file: &Arc<str>, text: &str, error: &serde_yaml::Error) -> Diagnostic {
    use serde_yaml::Error as E;
    let span = error
        .location()
        .map_or(0..0, |location| place_of_error(&location, text));
    let mut error = error.without_snippet();
    while let E::AliasError { error: inside, .. } = error {
        error = inside;
    }
    let what = UserMessageFormatter.format_message(error);
    let (message, help) = match error {
        E::AliasReplayLimitExceeded { .. }
        | E::AliasExpansionLimitExceeded { .. }
        | E::AliasReplayStackDepthExceeded { .. } => (
            format!("aliases repeat more than {MAX_REPEATED} values"),
            Some("use fewer `*aliases` of large values".to_owned()),
        ),
        E::UnsupportedTag { .. } => (
            format!("a spec has no tags: {what}"),
            Some("write a kind as a key, `kind: { … }`".to_owned()),
        ),
        E::MultipleDocuments { .. }
        | E::Budget {
            breach: BudgetBreach::Documents { .. },
            ..
        } => (
            "a spec is one YAML document".to_owned(),
            Some("take out the line, `---` or `...`, that ends the first one".to_owned()),
        ),
        E::Budget {
            breach: BudgetBreach::Depth { .. },
            ..
        } => (TOO_DEEP.to_owned(), None),
        // The scanner has no other way to say so.
        _ if what.ends_with("recursion limit exceeded") => (TOO_DEEP.to_owned(), None),
        E::Budget {
            breach: BudgetBreach::Nodes { .. } | BudgetBreach::Events { .. },
            ..
        } => (
            format!("the file has more than {MAX_NODES} values"),
            Some("move parts of it to `include` files".to_owned()),
        ),
        E::Budget { .. } => (format!("the file asks for too much: {what}"), None),
        _ => (
            format!("this is not YAML: {what}"),
            hint::of_syntax_error(text, span.start),
        ),
    };
    let place = Span::Bytes {
        file: file.clone(),
        start: span.start,
        end: span.end,
    };
    let diagnostic = Diagnostic::error(message).about(Code::Syntax).at(place, "");
    match help {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }
}

/// The bytes of an error's place. Errors of the scanner have a line and a column only.
fn place_of_error(location: &Location, text: &str) -> Range<usize> {
    if location.span().byte_offset().is_some() {
        return bytes(location, text);
    }
    let line_start = match usize::try_from(location.line()).unwrap_or(usize::MAX) {
        0 | 1 => 0,
        line => text
            .match_indices('\n')
            .nth(line - 2)
            .map_or(text.len(), |(at, _)| at + 1),
    };
    let line = text[line_start..].lines().next().unwrap_or_default();
    let column = usize::try_from(location.column())
        .unwrap_or(usize::MAX)
        .saturating_sub(1);
    let column = line
        .char_indices()
        .nth(column)
        .map_or(line.len(), |(at, _)| at);
    line_start + column..line_start + column
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_truth_values_keep_how_they_are_written() {
        let text = "a: [0510210600, 007, 1.50, 1e3, 0x1F, +49, -0, .5, 1.0, True, 12, 1.5]\n\
                    b: &b 08.10\nc: *b\nd: { e: 1.0, f: 3.0 }\n";
        let tree = read(&"f.yaml".into(), text).expect("YAML").into_tree();
        let items = tree.get("a").and_then(Tree::as_list).expect("a list");
        let written: Vec<String> = items
            .iter()
            .map(|item| item.to_text().expect("text").to_string())
            .collect();
        let expected = "0510210600 007 1.50 1e3 0x1F +49 -0 .5 1.0 True 12 1.5";
        assert_eq!(written.join(" "), expected);
        assert_eq!(items[1].as_number(), Some(7.0));
        assert_eq!(items[4].as_number(), Some(31.0));
        assert_eq!(items[10], Tree::Int(12));
        for key in ["b", "c"] {
            let item = tree.get(key).expect("an item");
            assert_eq!(item.to_text().as_deref(), Some("08.10"));
        }
        let inside = tree.get("d").and_then(|d| d.get("f")).expect("an item");
        assert_eq!(inside.to_text().as_deref(), Some("3.0"));
    }
}
