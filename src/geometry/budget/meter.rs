//! What one node has used, and the thread-local place where kernels find its meter.

use std::cell::RefCell;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::held::Held;
use super::stop::Stop;
use super::turn::{Turn, Turns};
use super::{Exceeded, Limits};

/// A node that holds more than this part of what it may is large: only one such node works at a time.
const LARGE: u64 = 8;

/// What the counter is set to when it is past the limit: too much for any limit, and far enough from the greatest number for what other
/// threads charge until they hear of it.
const NONE_LEFT: u64 = 1 << 60;

thread_local! {
    static CURRENT: RefCell<Meter> = const { RefCell::new(Meter(None)) };
}

/// What one node has used. Clones share it. The meter of no node charges nothing.
#[derive(Clone, Debug)]
pub struct Meter(Option<Place>);

/// The meter as one thread sees it.
#[derive(Clone, Debug)]
struct Place {
    counter: Arc<Counter>,
    /// Whether this is the thread of the stage, which does its work in a fixed order and may wait. A thread of the
    /// pool must not: the work for which it would wait may need it.
    is_stage: bool,
}

#[derive(Debug)]
struct Counter {
    limits: Limits,
    steps: AtomicU64,
    held: Held,
    turns: Arc<Turns>,
    /// The node's turn, once it has made something large.
    turn: Mutex<Option<Turn>>,
    stop: Stop,
}

impl Counter {
    fn new(limits: Limits, turns: Arc<Turns>, stop: Stop) -> Counter {
        Counter {
            limits,
            steps: AtomicU64::new(0),
            held: Held::default(),
            turns,
            turn: Mutex::new(None),
            stop,
        }
    }
}

impl Meter {
    pub(super) fn new(limits: Limits, turns: Arc<Turns>, stop: Stop) -> Meter {
        Meter(Some(Place {
            counter: Arc::new(Counter::new(limits, turns, stop)),
            is_stage: true,
        }))
    }

    pub(super) fn steps(&self) -> u64 {
        let of = |place: &Place| place.counter.steps.load(Ordering::Relaxed);
        self.0.as_ref().map_or(0, of)
    }

    /// Does the work of a stage on this thread, and gives its turn back.
    pub(super) fn of_stage<T>(&self, work: impl FnOnce() -> T) -> T {
        let _guard = Guard::set(self.clone());
        work()
    }

    /// The meter of what this thread does, to be carried to other threads.
    pub fn current() -> Meter {
        let mut meter = CURRENT.with_borrow(Meter::clone);
        if let Some(place) = &mut meter.0 {
            place.is_stage = false;
        }
        meter
    }

    /// Does `work` on this thread and charges it to the meter.
    pub fn during<T>(&self, work: impl FnOnce() -> T) -> T {
        let _guard = Guard::set(self.clone());
        work()
    }
}

/// Puts the former meter back, also when the work is unwound.
struct Guard {
    former: Meter,
}

impl Guard {
    fn set(meter: Meter) -> Guard {
        Guard {
            former: CURRENT.replace(meter),
        }
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        let meter = CURRENT.replace(Meter(self.former.0.take()));
        if let Some(place) = meter.0
            && place.is_stage
        {
            let turn = &place.counter.turn;
            drop(turn.lock().unwrap_or_else(PoisonError::into_inner).take());
        }
    }
}

/// Charges for `steps` steps of work that is about to be done with `what`. Does not return when the node has
/// used up its budget, or when its work is given up.
pub fn spend(what: &'static str, steps: u64) {
    let exceeded = CURRENT.with_borrow(|meter| {
        let place = meter.0.as_ref()?;
        // The meter is lent no longer once this unwinds.
        place.counter.stop.check();
        place.spend(what, steps)
    });
    if let Some(exceeded) = exceeded {
        resume_unwind(Box::new(exceeded));
    }
}

/// Charges for `count` things of `bytes` bytes each that are about to be made: as [`hold`], and a step for each.
pub fn make(what: &'static str, count: usize, bytes: usize) {
    hold(what, count, bytes);
    spend(what, count as u64);
}

/// Asks for the memory of `count` things of `bytes` bytes each; of what grows bit by bit `count` is the whole. Things
/// of one kind, as `what` names it, follow one another in a node, so that the most of them counts; kinds are
/// added up. Does not return when the budget does not allow for it; waits while another node holds large things, if
/// this one does.
pub fn hold(what: &'static str, count: usize, bytes: usize) {
    let (count, bytes) = (count as u64, (count as u64).saturating_mul(bytes as u64));
    let exceeded = CURRENT.with_borrow(|meter| meter.0.as_ref()?.hold(what, count, bytes));
    if let Some(exceeded) = exceeded {
        resume_unwind(Box::new(exceeded));
    }
}

/// Tells that the things of a kind are gone before the node ends. To be called by the thread of the stage, where it is
/// the same in every run what is held before and after.
pub fn release(what: &'static str) {
    let place = CURRENT.with_borrow(|meter| meter.0.clone());
    if let Some(place) = place.filter(|place| place.is_stage) {
        place.counter.held.release(what);
    }
}

/// Does `work` on a meter of its own, which may use as much. What several nodes keep for one another is charged to
/// none of them, because it is by chance which of them asks for it first.
pub fn apart<T>(work: impl FnOnce() -> T) -> T {
    let mut meter = Meter::current();
    if let Some(place) = &mut meter.0 {
        let Counter {
            limits,
            turns,
            stop,
            ..
        } = &*place.counter;
        place.counter = Arc::new(Counter::new(*limits, turns.clone(), stop.clone()));
    }
    meter.during(work)
}

/// How many times as much as without `--budget` the node may use.
pub fn factor() -> f64 {
    let of = |place: &Place| place.counter.limits.factor;
    CURRENT.with_borrow(|meter| meter.0.as_ref().map_or(1.0, of))
}

impl Place {
    fn spend(&self, what: &'static str, steps: u64) -> Option<Exceeded> {
        let limit = self.counter.limits.steps;
        let steps = steps.min(NONE_LEFT);
        let before = self.counter.steps.fetch_add(steps, Ordering::Relaxed);
        let steps = before.saturating_add(steps);
        if steps <= limit {
            return None;
        }
        self.counter.steps.store(NONE_LEFT, Ordering::Relaxed);
        // Many small charges say nothing of how many more there would be.
        let is_estimate = self.is_stage && before <= limit && steps - before > limit / 2;
        Some(if is_estimate {
            Exceeded::Steps { what, steps, limit }
        } else {
            Exceeded::More { what, limit }
        })
    }

    fn hold(&self, what: &'static str, count: u64, bytes: u64) -> Option<Exceeded> {
        let limit = self.counter.limits.bytes;
        if bytes > limit {
            return Some(Exceeded::Bytes {
                what,
                count,
                bytes,
                limit,
            });
        }
        let all = self.counter.held.raise(what, bytes);
        if all > limit {
            // What other threads hold by now differs from run to run.
            let bytes = self.is_stage.then_some(all);
            return Some(Exceeded::Together { what, bytes, limit });
        }
        if self.is_stage && all > limit / LARGE {
            let turn = self.counter.turn.lock();
            let mut turn = turn.unwrap_or_else(PoisonError::into_inner);
            turn.get_or_insert_with(|| self.counter.turns.wait());
        }
        None
    }
}
