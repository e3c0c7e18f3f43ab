//! The bytes that one node holds: of each kind of thing the most that it has asked for, added up.
//!
//! The most of several numbers and their sum do not depend on the order in which threads ask, so that a
//! node is refused by every run or by none.

use std::sync::{Mutex, PoisonError};

/// The most bytes of each kind of thing. There are a handful of kinds in a node.
#[derive(Debug, Default)]
pub(super) struct Held(Mutex<Vec<(&'static str, u64)>>);

impl Held {
    /// Notes that `bytes` bytes of a kind are held, and gives the sum over all kinds. O(kinds).
    pub fn raise(&self, what: &'static str, bytes: u64) -> u64 {
        let mut kinds = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match kinds.iter_mut().find(|(kind, _)| *kind == what) {
            Some((_, most)) => *most = bytes.max(*most),
            None => kinds.push((what, bytes)),
        }
        let sum = |all: u64, (_, most): &(_, u64)| all.saturating_add(*most);
        kinds.iter().fold(0, sum)
    }

    /// Notes that nothing of a kind is held any more.
    pub fn release(&self, what: &'static str) {
        let mut kinds = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kinds.retain(|(kind, _)| *kind != what);
    }
}
