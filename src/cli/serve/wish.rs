//! Values that a reader of the page tries out: what is wanted now, as `--set` would have it, and the command line that would
//! do the same.

use std::collections::BTreeMap;

use serde::Deserialize;

use fretwork_engine::{Settable, Settings};

/// The values of specs, by spec and name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wishes(BTreeMap<String, BTreeMap<String, String>>);

/// The body of a request to `/set`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wish {
    /// The spec.
    pub spec: String,
    /// The values as typed; null takes one back.
    pub values: BTreeMap<String, Option<String>>,
}

impl Wishes {
    /// Whether nothing is tried out.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// These values and those of a wish.
    pub fn with(&self, wish: &Wish) -> Wishes {
        let mut all = self.0.clone();
        let values = all.entry(wish.spec.clone()).or_default();
        for (name, value) in &wish.values {
            match value {
                Some(value) => values.insert(name.clone(), value.clone()),
                None => values.remove(name),
            };
        }
        all.retain(|_, values| !values.is_empty());
        Wishes(all)
    }

    /// The values of names that the specs still have.
    pub fn known(&self, settable: impl Fn(&str) -> Settable) -> Wishes {
        let mut all = self.0.clone();
        for (spec, values) in &mut all {
            let settable = settable(spec);
            values.retain(|name, _| settable.has(name));
        }
        all.retain(|_, values| !values.is_empty());
        Wishes(all)
    }

    /// The values of one spec.
    pub fn of(&self, spec: &str) -> Vec<(&str, &str)> {
        let values = self.0.get(spec).into_iter().flatten();
        values.map(|(name, value)| (&**name, &**value)).collect()
    }

    /// The values of one spec as settings.
    pub fn settings(&self, spec: &str) -> Settings {
        Settings::new(self.of(spec))
    }

    /// The settings of all specs that have any.
    pub fn all(&self) -> BTreeMap<String, Settings> {
        let specs = self.0.keys();
        specs
            .map(|spec| (spec.clone(), self.settings(spec)))
            .collect()
    }
}

/// The command line that builds `spec` with `values`, as a shell takes it.
pub fn command_line(spec: &str, values: &[(&str, &str)]) -> String {
    let mut line = format!("fretwork build {}", quoted(spec));
    for (name, value) in values {
        line += &format!(" --set {}", quoted(&format!("{name}={value}")));
    }
    line
}

/// A word of a command line.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-=+:,%@".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_string();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(json: &str) -> Wish {
        serde_json::from_str(json).expect("a wish")
    }

    #[test]
    fn null_takes_a_value_back() {
        let none = Wishes::default();
        let two = none.with(&wish(r#"{"spec":"a","values":{"x":"1","y":"2"}}"#));
        assert_eq!(two.of("a"), [("x", "1"), ("y", "2")]);
        let one = two.with(&wish(r#"{"spec":"a","values":{"y":null,"x":"3"}}"#));
        assert_eq!(one.of("a"), [("x", "3")]);
        assert_eq!(one.with(&wish(r#"{"spec":"a","values":{"x":null}}"#)), none);
    }

    #[test]
    fn a_command_line_can_be_pasted() {
        let line = command_line("specs/it's.yaml", &[("size", "6cm"), ("text", "a b")]);
        assert_eq!(
            line,
            r"fretwork build 'specs/it'\''s.yaml' --set size=6cm --set 'text=a b'"
        );
    }
}
