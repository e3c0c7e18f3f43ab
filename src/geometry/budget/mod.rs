//! What a build may use, in steps and bytes, and what it has used. Seconds are not counted, so that a
//! build ends the same way on every machine and with any number of threads.
//!
//! A kernel says what it is about to do before it does it: [`spend`] for work, [`make`] and [`hold`] for things
//! that take memory. Both charge the meter of the node that is being evaluated, which the stage has put in
//! its place with [`Budget::run`]. It is no parameter, because a hundred kernels would hand it through
//! to a few that need it, and it is of no concern to their results: it can only end them. It ends
//! them by unwinding to [`Budget::run`], without a message of a panic, as salsa ends queries that are no
//! longer wanted; what holds a lock must not charge. Where no stage has put a meter in its
//! place, as in tests of a kernel, nothing is charged.
//!
//! A limit decides only over sums that do not depend on the order of work: all that one node charges,
//! and all nodes of a build ([`Budget::is_spent`]): their steps, and the bytes of their results, which stay in memory
//! until the build ends. Work on other threads is charged to the same meter where the
//! meter is carried there with [`Meter::during`]. Memory that several nodes need at the same time is no error: a node
//! that makes something large waits until no other one does (`turn`).

mod exceeded;
mod held;
mod meter;
mod stop;
mod turn;

pub use exceeded::{Exceeded, size};
pub use meter::{Meter, apart, factor, hold, make, release, spend};
pub use stop::{GivenUp, Stop};

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use turn::Turns;

/// What one node may use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Steps. One is as much work as to move a few points: about ten nanoseconds of one core.
    pub steps: u64,
    /// Bytes of all that it holds: of each kind of thing the most (`held`).
    pub bytes: u64,
    /// How many times as much as without `--budget` this is.
    pub factor: f64,
}

impl Limits {
    /// What a node may use that nobody has given more: some ten seconds, and a gibibyte.
    pub const DEFAULT: Limits = Limits {
        steps: 1_000_000_000,
        bytes: 1 << 30,
        factor: 1.0,
    };

    /// So many times as much.
    pub fn times(factor: f64) -> Limits {
        let times = |limit: u64| (limit as f64 * factor) as u64;
        Limits {
            steps: times(Limits::DEFAULT.steps),
            bytes: times(Limits::DEFAULT.bytes),
            factor,
        }
    }

    /// What a node may use that is allowed for more than others.
    fn of(&self, allowance: Allowance) -> Limits {
        Limits {
            steps: self.steps.saturating_mul(allowance.steps),
            bytes: self.bytes.saturating_mul(allowance.bytes),
            ..*self
        }
    }

    /// The factor that is to be tried next, where `times` as much as allowed is needed.
    fn next(&self, times: f64) -> u64 {
        (self.factor * times.max(2.0)).ceil() as u64
    }
}

/// How many times as much as other nodes one of some kind may use. What it uses counts as a part of the build's as
/// it does of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowance {
    /// Times the steps.
    pub steps: u64,
    /// Times the bytes.
    pub bytes: u64,
}

impl Allowance {
    /// What most nodes get.
    pub const PLAIN: Allowance = Allowance { steps: 1, bytes: 1 };

    /// What nodes get that work on voxels: millions of them are no mistake, and take a minute or two.
    pub const VOXELS: Allowance = Allowance {
        steps: 12,
        bytes: 2,
    };
}

/// The nodes of one spec may use so many times as much together as one of them.
const NODES: u64 = 2;

/// The results of a build may take this part of the memory that a node may: they are there beside it, and that of files
/// in each of the forms in which it is made.
const KEPT: u64 = 2;

/// The budget of a build. Clones share what was used.
#[derive(Clone, Debug)]
pub struct Budget {
    limits: Limits,
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    /// Of how many specs the build is.
    specs: AtomicU64,
    /// Steps of all nodes that have ended.
    spent: AtomicU64,
    /// Bytes of their results.
    kept: AtomicU64,
    turns: Arc<Turns>,
    stop: Stop,
}

impl Default for Budget {
    fn default() -> Budget {
        Budget::new(Limits::DEFAULT)
    }
}

impl Budget {
    /// A budget of which nothing was used.
    pub fn new(limits: Limits) -> Budget {
        Budget {
            limits,
            shared: Arc::new(Shared {
                specs: AtomicU64::new(1),
                spent: AtomicU64::new(0),
                kept: AtomicU64::new(0),
                turns: Arc::default(),
                stop: Stop::default(),
            }),
        }
    }

    /// What a node may use.
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// What gives up the work that is charged to it.
    pub fn stop(&self) -> &Stop {
        &self.shared.stop
    }

    /// What `work` gives, which is charged to a meter of its own.
    ///
    /// # Errors
    /// When it needs more than one node may use. What it has done until then is lost.
    pub fn run<T>(&self, work: impl FnOnce() -> T) -> Result<T, Exceeded> {
        self.run_allowing(Allowance::PLAIN, work)
    }

    /// As [`Budget::run`], for a node that may use more than others.
    ///
    /// # Errors
    /// Those of [`Budget::run`].
    pub fn run_allowing<T>(
        &self,
        allowance: Allowance,
        work: impl FnOnce() -> T,
    ) -> Result<T, Exceeded> {
        let limits = self.limits.of(allowance);
        let meter = Meter::new(limits, self.shared.turns.clone(), self.shared.stop.clone());
        let result = catch_unwind(AssertUnwindSafe(|| meter.of_stage(work)));
        let steps = meter.steps().min(limits.steps) / allowance.steps;
        self.shared.spent.fetch_add(steps, Ordering::Relaxed);
        result.map_err(|payload| match payload.downcast::<Exceeded>() {
            Ok(exceeded) => *exceeded,
            Err(other) => resume_unwind(other),
        })
    }

    /// Notes that a result of so many bytes stays until the build ends.
    pub fn keep(&self, bytes: usize) {
        self.shared.kept.fetch_add(bytes as u64, Ordering::Relaxed);
    }

    /// How many bytes the results have that stay until the build ends.
    pub fn kept(&self) -> u64 {
        self.shared.kept.load(Ordering::Relaxed)
    }

    /// Whether the nodes that have ended used more than all nodes of the build may use together. A node
    /// counts for no more steps than one may use, so that the sum is the same in whatever order they ran.
    pub fn is_spent(&self) -> bool {
        self.shared.spent.load(Ordering::Relaxed) > self.all() || self.is_full()
    }

    /// Whether the results take more memory than they may. There are not more of them allowed for more specs: they
    /// are on one machine.
    fn is_full(&self) -> bool {
        self.kept() > self.room()
    }

    /// How many bytes the results may take together.
    fn room(&self) -> u64 {
        self.limits.bytes / KEPT
    }

    /// How many steps all nodes of the build may take together.
    fn all(&self) -> u64 {
        let specs = self.shared.specs.load(Ordering::Relaxed);
        self.limits.steps.saturating_mul(NODES * specs)
    }

    /// A build of so many specs begins, of which nothing was used.
    pub fn begin(&self, specs: usize) {
        self.shared
            .specs
            .store(specs.max(1) as u64, Ordering::Relaxed);
        self.shared.spent.store(0, Ordering::Relaxed);
        self.shared.kept.store(0, Ordering::Relaxed);
    }

    /// What is told when it is spent. Of which there was too much first depends on the order of the nodes.
    pub fn message(&self) -> String {
        let steps = exceeded::short(&self.all());
        let room = exceeded::size(&self.room());
        format!(
            "the nodes of this build need more than {steps} steps, or {room} for their results, together"
        )
    }

    /// What can be done when it is spent.
    pub fn help(&self) -> String {
        let factor = self.limits.next(2.0);
        format!(
            "`--budget {factor}` allows for more, and so does building fewer artifacts at a time"
        )
    }
}

#[cfg(test)]
mod tests;
