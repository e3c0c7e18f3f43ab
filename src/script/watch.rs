//! Watching a mapper: what it must not ask for when what it gives for one cell is to stand for what it would give for the
//! translates of that cell. What becomes of a mapper that asks all the same is up to the caller; see also
//! [`PointValue`](crate::values::PointValue).

use std::cell::Cell;

use starlark::eval::Evaluator;

use crate::session::{Session, refuse};
use fretwork_geometry::{Bounds, Point};

/// What is watched in an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watch {
    /// Whether random values may be asked for: those of a cell, which hash its place.
    pub allows_random: bool,
    /// Where the cells of the mapped planar map stand for others. Around them there is no outermost face that it would be
    /// safe to ask for.
    pub deep: Bounds,
}

thread_local! {
    /// Whether a place or the number of a cell was written as text since the last call of [`forget_text`].
    static TEXT: Cell<bool> = const { Cell::new(false) };
}

/// Notes that something was written as text which is another text elsewhere.
pub(crate) fn note_text() {
    TEXT.with(|text| text.set(true));
}

/// Forgets what was noted of texts.
pub fn forget_text() {
    TEXT.with(|text| text.set(false));
}

/// Whether a place or the number of a cell was written as text.
pub fn wrote_text() -> bool {
    TEXT.with(Cell::get)
}

impl Session {
    /// The same, watched.
    pub fn watched(mut self, watch: Option<Watch>) -> Session {
        self.watch = watch;
        self
    }

    /// What is watched.
    pub fn watch(&self) -> Option<Watch> {
        self.watch
    }

    /// By how much cells lie elsewhere than their planar map says.
    pub fn shift(&self) -> Point {
        self.shift.get()
    }

    /// Says by how much cells lie elsewhere than their planar map says.
    pub fn set_shift(&self, shift: Point) {
        self.shift.set(shift);
    }

    /// The weight of what lies where a cell is: 1, but 0 where nobody watches.
    pub fn weight(&self) -> f64 {
        if self.watch.is_some() { 1.0 } else { 0.0 }
    }

    /// Refuses where somebody watches.
    ///
    /// # Errors
    /// With `what` is asked for.
    pub fn unwatched(&self, what: &str) -> starlark::Result<()> {
        match self.watch {
            Some(_) => Err(refuse(what)),
            None => Ok(()),
        }
    }

    /// Refuses random values where they are watched for.
    ///
    /// # Errors
    /// When they must not be asked for.
    pub fn allow_random(&self) -> starlark::Result<()> {
        match self.watch {
            Some(watch) if !watch.allows_random => Err(refuse("it asks for a random value")),
            _ => Ok(()),
        }
    }
}

/// The weight of what lies where a cell is, in the evaluation that `eval` does.
pub fn weight(eval: &Evaluator<'_, '_, '_>) -> f64 {
    crate::session::session(eval).weight()
}
