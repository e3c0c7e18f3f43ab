//! Turns of nodes that hold large things, of which only one does at any time.

use std::sync::{Arc, Condvar, Mutex, PoisonError};

/// Whether somebody's turn it is.
#[derive(Debug, Default)]
pub(super) struct Turns {
    is_taken: Mutex<bool>,
    changed: Condvar,
}

/// A turn. It ends when it is dropped.
#[derive(Debug)]
pub(super) struct Turn(Arc<Turns>);

impl Turns {
    /// Waits until it is nobody's turn. Whoever has a turn waits for no other node, so it ends.
    pub fn wait(self: &Arc<Turns>) -> Turn {
        let mut is_taken = self.is_taken.lock().unwrap_or_else(PoisonError::into_inner);
        while *is_taken {
            let waited = self.changed.wait(is_taken);
            is_taken = waited.unwrap_or_else(PoisonError::into_inner);
        }
        *is_taken = true;
        Turn(self.clone())
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        let is_taken = &self.0.is_taken;
        *is_taken.lock().unwrap_or_else(PoisonError::into_inner) = false;
        self.0.changed.notify_one();
    }
}
