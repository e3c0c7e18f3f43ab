//! Sets of labels, interned: a set is four bytes to copy and compare.
//!
//! The numbers behind the sets depend on the order in which they were first met, so nothing may
//! order or hash by them into a result; [`LabelSet::names`] is what is written and sorted.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, RwLock};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A set of labels. The default is the empty set.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct LabelSet(u32);

type Names = Arc<[Arc<str>]>;

struct Table {
    sets: Vec<Names>,
    numbers: HashMap<Names, u32>,
    unions: HashMap<(u32, u32), u32>,
}

impl Table {
    fn number(&mut self, names: Names) -> u32 {
        if let Some(&n) = self.numbers.get(&names) {
            return n;
        }
        let n =
            u32::try_from(self.sets.len()).expect("there are fewer than 2^32 distinct label sets");
        self.sets.push(names.clone());
        self.numbers.insert(names, n);
        n
    }
}

static TABLE: LazyLock<RwLock<Table>> = LazyLock::new(|| {
    let empty: Names = Arc::from([]);
    RwLock::new(Table {
        sets: vec![empty.clone()],
        numbers: HashMap::from([(empty, 0)]),
        unions: HashMap::new(),
    })
});

const UNPOISONED: &str = "no code panics while it holds the label table";

impl LabelSet {
    /// The set without a label.
    pub const EMPTY: LabelSet = LabelSet(0);

    /// The set of `names`, in any order, repeated or not.
    pub fn of<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> LabelSet {
        let mut names: Vec<Arc<str>> = names.into_iter().map(|n| Arc::from(n.as_ref())).collect();
        names.sort();
        names.dedup();
        LabelSet(TABLE.write().expect(UNPOISONED).number(names.into()))
    }

    /// The set of one label.
    pub fn one(name: &str) -> LabelSet {
        LabelSet::of([name])
    }

    /// The labels in order.
    pub fn names(self) -> Arc<[Arc<str>]> {
        TABLE.read().expect(UNPOISONED).sets[self.0 as usize].clone()
    }

    /// Whether no label is in the set.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether `name` is in the set.
    pub fn contains(self, name: &str) -> bool {
        !self.is_empty() && self.names().iter().any(|n| &**n == name)
    }

    /// The labels of both.
    pub fn union(self, other: LabelSet) -> LabelSet {
        if self == other || other.is_empty() {
            return self;
        }
        if self.is_empty() {
            return other;
        }
        let key = (self.0.min(other.0), self.0.max(other.0));
        if let Some(&n) = TABLE.read().expect(UNPOISONED).unions.get(&key) {
            return LabelSet(n);
        }
        let union = LabelSet::of(self.names().iter().chain(other.names().iter()));
        TABLE.write().expect(UNPOISONED).unions.insert(key, union.0);
        union
    }
}

impl std::fmt::Debug for LabelSet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_set().entries(self.names().iter()).finish()
    }
}

impl Serialize for LabelSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.names().iter())
    }
}

impl<'de> Deserialize<'de> for LabelSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<LabelSet, D::Error> {
        Ok(LabelSet::of(Vec::<String>::deserialize(deserializer)?))
    }
}

#[cfg(test)]
mod tests {
    use super::LabelSet;

    #[test]
    fn sets_are_equal_however_they_were_made() {
        let ab = LabelSet::of(["b", "a", "b"]);
        assert_eq!(ab, LabelSet::one("a").union(LabelSet::one("b")));
        assert_eq!(ab.union(LabelSet::EMPTY), ab);
        assert!(ab.contains("a") && !ab.contains("c") && !LabelSet::EMPTY.contains("a"));
        assert_eq!(format!("{ab:?}"), r#"{"a", "b"}"#);
    }
}
