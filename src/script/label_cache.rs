//! Which labels are in which sets, remembered: mappers ask the same few questions for every cell, and
//! the table of all sets is shared by all threads.

use std::hash::{DefaultHasher, Hash, Hasher};

use fretwork_geometry::LabelSet;

const SLOTS: usize = 128;

/// Answers to the last questions, at most one per slot.
#[derive(Debug, Default)]
pub(crate) struct LabelCache {
    slots: Vec<Option<(LabelSet, Box<str>, bool)>>,
}

impl LabelCache {
    /// Whether `label` is in `labels`.
    pub fn contains(&mut self, labels: LabelSet, label: &str) -> bool {
        if self.slots.is_empty() {
            self.slots = vec![None; SLOTS];
        }
        let mut hasher = DefaultHasher::new();
        (labels, label).hash(&mut hasher);
        let slot = &mut self.slots[hasher.finish() as usize % SLOTS];
        if let Some((known, name, answer)) = slot
            && *known == labels
            && **name == *label
        {
            return *answer;
        }
        let answer = labels.contains(label);
        *slot = Some((labels, label.into(), answer));
        answer
    }
}
