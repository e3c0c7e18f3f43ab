//! What a YAML text says, without where it says it.
//!
//! A [`Tree`] holds no positions, so that two texts that differ in layout alone give equal trees;
//! [`locate`](super::locate()) finds the place of a path again.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// A value of a spec. Cheap to clone.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Tree {
    /// Nothing, or `null`.
    #[default]
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// Another number; may be NaN or infinite, which decoding refuses.
    Float(Float),
    /// A number or a truth value that is written in a way of its own, such as `007`.
    Written(Arc<Written>),
    /// Text, quoted or not; may hold `${…}`.
    Text(Arc<str>),
    /// A list.
    List(Arc<[Tree]>),
    /// Keys and values in the order of the file, each key once.
    Map(Arc<[(Arc<str>, Tree)]>),
}

/// A number or a truth value with the text that it was written as. As a number, `007` is 7; as text it
/// is `007`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Written {
    value: Tree,
    text: Arc<str>,
}

/// A number that compares and hashes by its bits. Zero has no sign, and all NaNs are one.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Float(f64);

impl Float {
    /// The number with its sign of zero and its kind of NaN taken away.
    pub fn new(value: f64) -> Float {
        Float(if value.is_nan() {
            f64::NAN
        } else {
            value + 0.0
        })
    }

    /// The number.
    pub fn get(self) -> f64 {
        self.0
    }
}

impl PartialEq for Float {
    fn eq(&self, other: &Float) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

impl Eq for Float {}

impl Hash for Float {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

impl Tree {
    /// A number or a truth value that was written as `text`.
    pub fn written(value: Tree, text: &str) -> Tree {
        if value.to_text().as_deref() == Some(text) {
            return value;
        }
        let text = text.into();
        Tree::Written(Arc::new(Written { value, text }))
    }

    /// The value without the way in which it was written.
    pub fn plain(&self) -> &Tree {
        match self {
            Tree::Written(written) => &written.value,
            tree => tree,
        }
    }
    /// The same as JSON, which has no NaN and no infinity: they become null.
    pub fn to_json(&self) -> serde_json::Value {
        match self {
            Tree::Null => serde_json::Value::Null,
            Tree::Bool(b) => (*b).into(),
            Tree::Int(n) => (*n).into(),
            Tree::Float(x) => x.get().into(),
            Tree::Written(written) => written.value.to_json(),
            Tree::Text(text) => (**text).into(),
            Tree::List(items) => items.iter().map(Tree::to_json).collect(),
            Tree::Map(entries) => entries
                .iter()
                .map(|(key, value)| (key.to_string(), value.to_json()))
                .collect(),
        }
    }

    /// A list.
    pub fn list(items: impl IntoIterator<Item = Tree>) -> Tree {
        Tree::List(items.into_iter().collect())
    }

    /// A map. The keys must differ.
    pub fn map<K: Into<Arc<str>>>(entries: impl IntoIterator<Item = (K, Tree)>) -> Tree {
        Tree::Map(entries.into_iter().map(|(k, v)| (k.into(), v)).collect())
    }

    /// The value under `key`, if this is a map that has it.
    pub fn get(&self, key: &str) -> Option<&Tree> {
        self.as_map()?
            .iter()
            .find(|(k, _)| &**k == key)
            .map(|(_, v)| v)
    }

    /// The value at the end of a path of keys and numbers of items.
    pub fn at(&self, path: &[Arc<str>]) -> Option<&Tree> {
        path.iter().try_fold(self, |tree, step| match tree {
            Tree::List(items) => items.get(step.parse::<usize>().ok()?),
            tree => tree.get(step),
        })
    }

    /// The text, if it is one.
    pub fn as_text(&self) -> Option<&Arc<str>> {
        if let Tree::Text(text) = self {
            Some(text)
        } else {
            None
        }
    }

    /// The items, if it is a list.
    pub fn as_list(&self) -> Option<&[Tree]> {
        if let Tree::List(items) = self {
            Some(items)
        } else {
            None
        }
    }

    /// The entries, if it is a map.
    pub fn as_map(&self) -> Option<&[(Arc<str>, Tree)]> {
        if let Tree::Map(entries) = self {
            Some(entries)
        } else {
            None
        }
    }

    /// The number, if it is one, finite or not.
    pub fn as_number(&self) -> Option<f64> {
        match self.plain() {
            Tree::Int(n) => Some(*n as f64),
            Tree::Float(x) => Some(x.get()),
            _ => None,
        }
    }

    /// The text that a number, a truth value or a text stands for: the text that it was written as. A
    /// computed number, as in `"cuff-${wrist}.3mf"`, has no decimal point if it is whole. None for lists,
    /// maps and null.
    pub fn to_text(&self) -> Option<Arc<str>> {
        match self {
            Tree::Bool(b) => Some(b.to_string().into()),
            Tree::Int(n) => Some(n.to_string().into()),
            Tree::Float(x) => Some(x.get().to_string().into()),
            Tree::Written(written) => Some(written.text.clone()),
            Tree::Text(text) => Some(text.clone()),
            Tree::Null | Tree::List(_) | Tree::Map(_) => None,
        }
    }

    /// What it is, in words for a message: `a list`, `text "wide"`.
    pub fn describe(&self) -> String {
        match self {
            Tree::Null => "nothing".into(),
            Tree::Bool(b) => format!("`{b}`"),
            Tree::Int(n) => format!("the number {n}"),
            Tree::Float(x) => format!("the number {}", x.get()),
            Tree::Written(written) => match written.value {
                Tree::Bool(_) => format!("`{}`", written.text),
                _ => format!("the number {}", written.text),
            },
            Tree::Text(text) if text.is_empty() => "empty text".into(),
            Tree::Text(text) => format!("text \"{}\"", shortened(text)),
            Tree::List(_) => "a list".into(),
            Tree::Map(_) => "a map".into(),
        }
    }
}

/// The beginning of the first line of `text`.
pub(super) fn shortened(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    let head: String = line.chars().take(40).collect();
    if head.len() < text.trim_end().len() {
        head + "…"
    } else {
        head
    }
}

impl From<bool> for Tree {
    fn from(value: bool) -> Tree {
        Tree::Bool(value)
    }
}

impl From<i64> for Tree {
    fn from(value: i64) -> Tree {
        Tree::Int(value)
    }
}

impl From<f64> for Tree {
    fn from(value: f64) -> Tree {
        Tree::Float(Float::new(value))
    }
}

impl From<&str> for Tree {
    fn from(value: &str) -> Tree {
        Tree::Text(value.into())
    }
}

impl<const N: usize> From<[i64; N]> for Tree {
    fn from(items: [i64; N]) -> Tree {
        Tree::list(items.map(Tree::Int))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign_and_nan_equals_itself() {
        assert_eq!(Tree::from(-0.0), Tree::from(0.0));
        assert_eq!(Tree::from(f64::NAN), Tree::from(-f64::NAN));
        assert_ne!(Tree::from(1.0), Tree::Int(1));
    }

    #[test]
    fn whole_numbers_have_no_point_inside_text() {
        assert_eq!(Tree::from(165.0).to_text().as_deref(), Some("165"));
        assert_eq!(Tree::from(165.5).to_text().as_deref(), Some("165.5"));
        assert_eq!(Tree::Null.to_text(), None);
    }

    #[test]
    fn a_number_is_the_text_that_it_is_written_as() {
        let written = Tree::written(Tree::Int(7), "007");
        assert_eq!(written.to_text().as_deref(), Some("007"));
        assert_eq!(written.as_number(), Some(7.0));
        assert_eq!(written.describe(), "the number 007");
        assert_eq!(Tree::written(Tree::Int(7), "7"), Tree::Int(7));
        assert_eq!(Tree::written(Tree::from(1.5), "1.5"), Tree::from(1.5));
    }

    #[test]
    fn long_text_is_shortened_in_messages() {
        assert_eq!(Tree::from("short").describe(), "text \"short\"");
        assert_eq!(Tree::from("two\nlines").describe(), "text \"two…\"");
        assert_eq!(
            Tree::from(&*"x".repeat(50)).describe(),
            format!("text \"{}…\"", "x".repeat(40))
        );
    }
}
