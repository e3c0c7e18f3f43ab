//! What keeps a script within its budget. The interpreter counts calls and rounds of loops, and
//! looks at its heap every thousand of them; between two looks a single operation could still
//! double a list thirty times or compare giants. So before a text is run
//! - [`layout`] refuses one that is nested too deeply for any stack,
//! - [`rewrite`] lets every operation that can grow or walk a large value (`+ * % << |`, `in`,
//!   comparisons, slices, copying methods) pass through a native of [`natives`], which charges the
//!   [`Budget`] first and is one call when the values are small.
//!
//! Budgets count steps and bytes, never seconds, so that a script ends the same way everywhere.

mod layout;
mod natives;
mod rewrite;

pub(super) use layout::Layout;
pub(super) use natives::{call_method, call_standard, i64_of, register};
pub(super) use rewrite::{OPERATORS, Rewritten, rewrite};

use std::cell::Cell;

/// What an evaluation may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Calls and rounds of loops.
    pub steps: u64,
    /// Bytes of the interpreter's heap.
    pub heap: usize,
    /// Calls within calls.
    pub calls: usize,
}

impl Limits {
    /// For one `${…}`: some tens of milliseconds at most.
    pub const EXPRESSION: Limits = Limits { steps: 200_000, heap: 32 << 20, calls: 50 };
    /// For reading a script and calling its entry.
    pub const ENTRY: Limits = Limits { steps: 20_000_000, heap: 256 << 20, calls: 100 };
    /// For one call of a mapper, with all that it evaluates inside its cell.
    pub const MAPPER: Limits = Limits { steps: 20_000_000, heap: 256 << 20, calls: 100 };
}

/// The work that natives did on behalf of a script, in steps.
#[derive(Debug)]
pub(super) struct Budget {
    used: Cell<u64>,
    limits: Limits,
}

/// What a budget says when it is used up.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum Exhausted {
    #[error("this takes more than {0} steps")]
    Steps(u64),
    #[error("this needs more than {} MiB of memory", .0 >> 20)]
    Heap(usize),
}

impl Budget {
    pub fn new(limits: Limits) -> Budget {
        Budget { used: Cell::new(0), limits }
    }

    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// Notes work worth `steps` more.
    pub fn charge(&self, steps: u64) -> Result<(), Exhausted> {
        self.used.set(self.used.get().saturating_add(steps));
        if self.used.get() > self.limits.steps { Err(Exhausted::Steps(self.limits.steps)) } else { Ok(()) }
    }

    /// Notes that `elements` will be walked and as many written on a heap of `heap` bytes.
    pub fn grow(&self, elements: usize, heap: usize) -> Result<(), Exhausted> {
        self.charge(elements as u64 / 8)?;
        let wanted = elements.saturating_mul(16).saturating_add(heap);
        if wanted > self.limits.heap { Err(Exhausted::Heap(self.limits.heap)) } else { Ok(()) }
    }
}
