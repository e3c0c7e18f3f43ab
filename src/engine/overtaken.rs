//! Builds that nobody waits for any more: they are given up where they stand. What they have finished stays known.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use super::compile::Compiler;
use super::database::{Database, Db as _};
use fretwork_geometry::budget::{GivenUp, Stop};

impl Compiler {
    /// What gives up the work of this compiler. Any thread may use it.
    pub fn stop(&self) -> Stop {
        self.database.budget().stop().clone()
    }

    /// About how many bytes the last build has added to what this compiler holds.
    pub fn kept(&self) -> u64 {
        self.database.budget().kept()
    }

    /// What `work` gives; none when it was given up, and with it the evaluations that it had begun.
    pub fn unless_stopped<T>(&self, work: impl FnOnce(&Compiler) -> T) -> Option<T> {
        match catch_unwind(AssertUnwindSafe(|| work(self))) {
            Ok(result) => Some(result),
            Err(payload) if is_given_up(&self.database, &*payload) => {
                // They belong to no build that is told of.
                drop(self.database.take_events());
                None
            }
            Err(payload) => resume_unwind(payload),
        }
    }
}

/// Does `work`, which may be given up, on a thread that others wait for: they learn of it at their own next step.
pub fn until_stopped(database: &Database, work: impl FnOnce()) {
    if let Err(payload) = catch_unwind(AssertUnwindSafe(work))
        && !is_given_up(database, &*payload)
    {
        resume_unwind(payload);
    }
}

/// Whether a thread unwinds because its work, or work of another thread that it waited for, was given up.
fn is_given_up(database: &Database, payload: &(dyn Any + Send)) -> bool {
    let is_ours = payload.is::<GivenUp>() || payload.is::<salsa::Cancelled>();
    is_ours && database.budget().stop().is_set()
}
