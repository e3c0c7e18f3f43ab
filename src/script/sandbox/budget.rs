//! What an evaluation may use, and what it has used. Budgets count steps and bytes, never seconds,
//! so that a script ends the same way everywhere.

use std::cell::Cell;

use fretwork_geometry::budget;

/// What an evaluation may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Calls and rounds of loops.
    pub steps: u64,
    /// Bytes of the interpreter's heap.
    pub heap: usize,
    /// Calls within calls.
    pub calls: usize,
    /// Points of all curves that are made.
    pub points: usize,
}

impl Limits {
    /// For one `${…}`: some tens of milliseconds at most.
    pub const EXPRESSION: Limits = Limits {
        steps: 200_000,
        heap: 32 << 20,
        calls: 50,
        points: 0,
    };
    /// For reading a script and calling its entry.
    pub const ENTRY: Limits = Limits {
        steps: 10_000_000,
        heap: 64 << 20,
        calls: 100,
        points: 1 << 22,
    };
    /// For one call of a mapper, with all that it evaluates inside its cell.
    pub const MAPPER: Limits = Limits {
        steps: 10_000_000,
        heap: 64 << 20,
        calls: 100,
        points: 1 << 24,
    };
    /// These limits as many times as the budget of the node is that of other builds.
    pub fn scaled(self) -> Limits {
        let times = |limit: usize| (limit as f64 * budget::factor()) as usize;
        Limits {
            steps: times(self.steps as usize) as u64,
            heap: times(self.heap),
            calls: self.calls,
            points: times(self.points),
        }
    }

    /// The steps of all mapper calls of one evaluation together.
    pub const EVALUATION: u64 = 2_000_000_000;
    /// The points that one evaluation may give.
    pub const RESULT: usize = 1 << 25;
}

/// The work that natives did on behalf of a script.
#[derive(Debug)]
pub(crate) struct Budget {
    steps: Cell<u64>,
    points: Cell<usize>,
    limits: Limits,
}

/// What a budget says when it is used up.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Exhausted {
    #[error("this takes more than {0} steps")]
    Steps(u64),
    #[error("this needs more than {} MiB of memory", .0 >> 20)]
    Heap(usize),
    #[error("this makes curves of more than {0} points")]
    Points(usize),
    #[error("lists are nested more than {0} deep")]
    Depth(usize),
}

impl Budget {
    pub fn new(limits: Limits) -> Budget {
        Budget {
            steps: Cell::new(0),
            points: Cell::new(0),
            limits,
        }
    }

    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// Work noted so far, in steps.
    pub fn steps(&self) -> u64 {
        self.steps.get()
    }

    /// Points noted so far.
    pub fn points(&self) -> usize {
        self.points.get()
    }

    /// Notes work worth `steps` more.
    pub fn charge(&self, steps: u64) -> Result<(), Exhausted> {
        self.steps.set(self.steps.get().saturating_add(steps));
        if self.steps.get() > self.limits.steps {
            Err(Exhausted::Steps(self.limits.steps))
        } else {
            Ok(())
        }
    }

    /// Notes that curves of `points` more points are made.
    pub fn draw(&self, points: usize) -> Result<(), Exhausted> {
        self.points.set(self.points.get().saturating_add(points));
        self.charge(points as u64 / 8)?;
        if self.points.get() > self.limits.points {
            Err(Exhausted::Points(self.limits.points))
        } else {
            Ok(())
        }
    }

    /// Notes that `elements` will be walked and as many written on a heap of `heap` bytes.
    pub fn grow(&self, elements: usize, heap: usize) -> Result<(), Exhausted> {
        self.charge(elements as u64 / 8)?;
        let wanted = elements.saturating_mul(16).saturating_add(heap);
        if wanted > self.limits.heap {
            Err(Exhausted::Heap(self.limits.heap))
        } else {
            Ok(())
        }
    }
}
