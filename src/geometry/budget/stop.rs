//! Work that is given up because nobody wants its result any more. It ends as work beyond its budget does, by unwinding
//! where it charges for what it is about to do, but it leaves no error: what was not computed is as if it had never begun.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the work of a build is to be given up. Clones share it; any thread may set it.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

/// What unwinds through work that is given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GivenUp;

impl Stop {
    /// Gives up the work that is being done and all that begins before [`Stop::clear`].
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Lets work be done again.
    pub fn clear(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    /// Whether work is to be given up.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Does not return when work is to be given up: unwinds with [`GivenUp`], without a message of a panic.
    pub fn check(&self) {
        if self.is_set() {
            resume_unwind(Box::new(GivenUp));
        }
    }
}
