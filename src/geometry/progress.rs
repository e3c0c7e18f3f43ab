//! What long work is doing just now, for somebody who waits. The work says it on its own thread; who watches reads it
//! from any other. Results never depend on it.

use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};

/// The step that a piece of work is at.
#[derive(Debug, Default)]
pub struct Steps(Mutex<String>);

impl Steps {
    /// The step in words, as in `uniting 3 of 64`; empty where nothing was said yet.
    pub fn now(&self) -> String {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    fn set(&self, step: String) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = step;
    }
}

thread_local! {
    static WATCHED: RefCell<Option<Arc<Steps>>> = const { RefCell::new(None) };
}

/// Does `work` on this thread, its steps told to `steps`.
///
/// ```
/// use fretwork_geometry::progress::{Steps, step, watched};
/// let steps = std::sync::Arc::default();
/// watched(&steps, || step(|| "counting".to_owned()));
/// step(|| unreachable!("nobody watches any more"));
/// assert_eq!(steps.now(), "counting");
/// ```
pub fn watched<T>(steps: &Arc<Steps>, work: impl FnOnce() -> T) -> T {
    let before = WATCHED.replace(Some(steps.clone()));
    let result = work();
    WATCHED.set(before);
    result
}

/// Says what the work on this thread is doing from now on. Costs next to nothing where nobody watches.
pub fn step(what: impl FnOnce() -> String) {
    WATCHED.with_borrow(|steps| {
        if let Some(steps) = steps {
            steps.set(what());
        }
    });
}

/// Who watches the work on this thread, for parts of it that are spread on others.
#[derive(Clone, Debug)]
pub struct Watcher(Option<Arc<Steps>>);

impl Watcher {
    /// Who watches the work on this thread.
    pub fn here() -> Watcher {
        Watcher(WATCHED.with_borrow(Clone::clone))
    }

    /// As [`step`], on any thread.
    pub fn step(&self, what: impl FnOnce() -> String) {
        if let Some(steps) = &self.0 {
            steps.set(what());
        }
    }
}
