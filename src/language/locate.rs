//! From a path of keys back to bytes of the text.

use std::ops::Range;
use std::sync::Arc;

use super::Tree;
use super::read::{Key, Spot, Value, read};
use super::scalar_text::source_range;

/// The places of one text, for many look-ups.
pub struct Places {
    text: Arc<str>,
    tree: Option<Spot>,
}

impl Places {
    /// Reads `text` with positions. A text that is not YAML has no places.
    pub fn new(text: Arc<str>) -> Places {
        Places {
            tree: read(&"".into(), &text).ok(),
            text,
        }
    }

    /// The bytes of the value at the end of `path`, or with `key` those of its key. If the text ends
    /// before the path does, because a field is missing or an expression made an item, these are the
    /// bytes of the last value that is there.
    pub fn locate(&self, path: &[Arc<str>], key: bool) -> Option<Range<usize>> {
        let (spot, found, is_whole) = self.walk(path)?;
        Some(shown(spot, found, key && is_whole))
    }

    /// The first byte of what gave the value at the end of `path`, or its key. It is the same for all
    /// uses of an alias.
    pub fn origin(&self, path: &[Arc<str>], key: bool) -> Option<usize> {
        let (spot, found, is_whole) = self.walk(path)?;
        match found {
            Some(found) if key && is_whole => Some(found.origin),
            _ => Some(spot.origin),
        }
    }

    /// The bytes that gave the bytes `range` of the text that is the value at the end of `path`; those
    /// of the whole value if that is not known.
    pub fn locate_text(&self, path: &[Arc<str>], range: Range<usize>) -> Option<Range<usize>> {
        let (spot, key, _) = self.walk(path)?;
        let inside = match &spot.value {
            Value::Scalar(Tree::Text(text)) => {
                let raw = self.text.get(spot.span.clone())?;
                source_range(raw, text, range)
                    .map(|r| spot.span.start + r.start..spot.span.start + r.end)
            }
            _ => None,
        };
        inside.or_else(|| Some(shown(spot, key, false)))
    }

    /// The last value on `path` that is there, its key, and whether the whole path is there.
    fn walk(&self, path: &[Arc<str>]) -> Option<(&Spot, Option<&Key>, bool)> {
        let mut spot = self.tree.as_ref()?;
        let mut key = None;
        for step in path {
            let next = match &spot.value {
                Value::Scalar(_) => None,
                Value::List(items) => step
                    .parse()
                    .ok()
                    .and_then(|n: usize| items.get(n))
                    .map(|item| (item, None)),
                Value::Map(entries) => entries
                    .iter()
                    .find(|(k, _)| k.name == *step)
                    .map(|(k, v)| (v, Some(k))),
            };
            match next {
                Some((value, found)) => (spot, key) = (value, found),
                None => return Some((spot, key, false)),
            }
        }
        Some((spot, key, true))
    }
}

/// The span of a value, or of its key if that is preferred or the value has no bytes.
fn shown(spot: &Spot, key: Option<&Key>, prefer_key: bool) -> Range<usize> {
    match key {
        Some(key) if prefer_key || spot.span.is_empty() => key.span.clone(),
        _ => spot.span.clone(),
    }
}

/// The bytes of `text` at `path`, as [`Places::locate`] finds them, for one look-up.
pub fn locate(text: &str, path: &[Arc<str>], key: bool) -> Option<Range<usize>> {
    Places::new(text.into()).locate(path, key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, path: &str, key: bool, expected: &str) {
        let path: Vec<Arc<str>> = path
            .split('/')
            .filter(|s| !s.is_empty())
            .map(Arc::from)
            .collect();
        let range = locate(text, &path, key).expect("the text is YAML");
        assert_eq!(&text[range], expected);
    }

    #[test]
    fn keys_values_and_items_have_places() {
        let text = "é: 1\nregions:\n  page: { rectangle: { width: 3, points: [[1, 2], [ 3, 4 ]] } } # end\nlast: \"a b\"\n";
        check(text, "regions/page", true, "page");
        check(text, "regions/page/rectangle/width", false, "3");
        check(text, "regions/page/rectangle/points/1/0", false, "3");
        check(text, "regions/page/rectangle/points/1", false, "[ 3, 4 ]");
        check(
            text,
            "regions/page",
            false,
            "{ rectangle: { width: 3, points: [[1, 2], [ 3, 4 ]] } }",
        );
        check(text, "last", false, "\"a b\"");
        check(text, "é", true, "é");
    }

    #[test]
    fn what_is_not_there_is_shown_at_what_is() {
        check("a: { b: 1 }\n", "a/c", false, "{ b: 1 }");
        check("a: { b: 1 }\n", "a/b/0", false, "1");
        check("a:\n  b:\nc: 1", "a/b", false, "b");
    }

    #[test]
    fn aliases_and_merged_keys_stand_where_they_are_used() {
        let text = "base: &b { x: 1 }\nuse: *b\nmore:\n  <<: *b\n  y: 2\n";
        check(text, "use", false, "*b");
        check(text, "use/x", false, "*b");
        check(text, "more/y", false, "2");
        assert!(locate(text, &["more".into(), "x".into()], false).is_some());
    }
}
