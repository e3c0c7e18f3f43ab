//! What belongs to one evaluation and not to the script: natives find it through the evaluator.

use std::any::Any;
use std::cell::{Cell as Slot, RefCell};
use std::sync::Arc;

use starlark::eval::Evaluator;
use starlark::values::Value;

use crate::fault::Note;
use crate::library::Library;
use crate::sandbox::budget::{Budget, Limits};
pub use crate::scale::Scale;
use crate::scope::Scope;
use crate::values::cell::{Cell, CellKind};

pub use crate::values::curves::CurvesValue;
use crate::values::session::Import;
pub use crate::values::session::Session;
use fretwork_geometry::{Curves, LabelSet, PlanarMap, Point};

/// How deeply evaluations may be nested in one another.
const DEPTH: usize = 24;

/// A refusal by a native.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(pub String);

/// A refusal as an error of the interpreter.
pub fn refuse(message: impl Into<String>) -> starlark::Error {
    starlark::Error::new_other(Refusal(message.into()))
}

impl Session {
    /// A session that may use `limits` and reads from `library`; constructions take their seeds
    /// from `scope`.
    pub fn new(
        limits: Limits,
        library: Arc<Library>,
        scope: Scope,
        scale: Scale,
        job: Option<Arc<dyn Any + Send + Sync>>,
    ) -> Session {
        Session {
            budget: Budget::new(limits),
            library,
            scale,
            scope: RefCell::new(scope),
            maps: RefCell::default(),
            imports: RefCell::default(),
            notes: RefCell::default(),
            labels: RefCell::default(),
            depth: Slot::new(0),
            watch: None,
            shift: Slot::new(Point::ORIGIN),
            known: None,
            job,
        }
    }

    /// What natives have used and may use.
    pub(crate) fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Steps and points that natives have used.
    pub fn used(&self) -> (u64, usize) {
        (self.budget.steps(), self.budget.points())
    }

    /// Notes work on so many elements.
    pub fn charge(&self, elements: usize) -> starlark::Result<()> {
        Ok(self.budget.charge(elements as u64 / 8)?)
    }

    /// Notes that `curves` were made.
    pub fn draw(&self, curves: &Curves) -> starlark::Result<()> {
        self.draw_points(curves.points().len() + curves.len())
    }

    /// Notes that something as large as curves of so many points was made.
    pub fn draw_points(&self, points: usize) -> starlark::Result<()> {
        Ok(self.budget.draw(points)?)
    }

    /// Whether `label` is in `labels`; found again faster than [`LabelSet::contains`] finds it.
    pub fn has_label(&self, labels: LabelSet, label: &str) -> bool {
        self.labels.borrow_mut().contains(labels, label)
    }

    /// What the evaluation was started with.
    pub fn job<T: Any + Send + Sync>(&self) -> Option<Arc<T>> {
        self.job.clone()?.downcast().ok()
    }

    /// Works on the scope that is open.
    pub fn scope<T>(&self, with: impl FnOnce(&mut Scope) -> T) -> T {
        with(&mut self.scope.borrow_mut())
    }

    /// Opens `scope`, does `work`, and closes it.
    pub fn within<T>(&self, scope: Scope, work: impl FnOnce() -> T) -> T {
        let outer = self.scope.replace(scope);
        let result = work();
        self.scope.replace(outer);
        result
    }

    /// The measures of the top-level region.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Makes `map` known; its number.
    pub fn add_map(&self, map: Arc<PlanarMap>) -> u32 {
        let mut maps = self.maps.borrow_mut();
        maps.push(map);
        (maps.len() - 1) as u32
    }

    /// The planar map that `cell` is a cell of.
    pub fn map(&self, cell: Cell) -> starlark::Result<Arc<PlanarMap>> {
        self.know(cell)?;
        self.maps
            .borrow()
            .get(cell.map as usize)
            .cloned()
            .ok_or_else(|| refuse("this cell is of a finished evaluation"))
    }

    /// Works on the planar map that `cell` is a cell of.
    pub fn with_map<T>(
        &self,
        cell: Cell,
        with: impl FnOnce(&PlanarMap) -> T,
    ) -> starlark::Result<T> {
        self.know(cell)?;
        match self.maps.borrow().get(cell.map as usize) {
            Some(map) => Ok(with(map)),
            None => Err(refuse("this cell is of a finished evaluation")),
        }
    }

    /// Forgets all but the first `count` maps, whose cells no value holds any more.
    pub fn forget_maps(&self, count: usize) {
        self.maps.borrow_mut().truncate(count);
    }

    /// Goes one evaluation deeper for `work`.
    pub fn deeper<T>(&self, work: impl FnOnce() -> starlark::Result<T>) -> starlark::Result<T> {
        if self.depth.get() >= DEPTH {
            return Err(refuse(
                "arrangements are nested too deeply; one must not be made of itself",
            ));
        }
        self.depth.set(self.depth.get() + 1);
        let result = work();
        self.depth.set(self.depth.get() - 1);
        result
    }

    /// Remembers what was being done when an error passed by.
    pub fn note(&self, note: Note) {
        self.notes.borrow_mut().push(note);
    }

    /// What was being done, the innermost first.
    pub fn take_notes(&self) -> Vec<Note> {
        self.notes.take()
    }
}

/// `curves` of a weight as a value, noted in the budget.
pub fn curves_value<'v>(
    curves: Curves,
    weight: f64,
    eval: &Evaluator<'v, '_, '_>,
) -> starlark::Result<Value<'v>> {
    session(eval).draw(&curves)?;
    let curves = Arc::new(curves);
    Ok(eval.heap().alloc(CurvesValue { curves, weight }))
}

/// The curves of the drawing at `path`, relative to the script whose code is running, as polylines that are no farther
/// from them than `tolerance`, if there is one.
pub fn import(
    path: &str,
    tolerance: Option<f64>,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<Arc<Curves>> {
    let session = session(eval);
    let from = eval.call_stack_top_location();
    let from = from.as_ref().map_or("", |span| span.filename());
    let known = session
        .imports
        .borrow()
        .iter()
        .find(|i| i.path == path && i.from == from && i.tolerance == tolerance)
        .map(|i| i.curves.clone());
    if let Some(curves) = known {
        return Ok(curves);
    }
    let curves = session
        .library
        .curves(path, from, tolerance)
        .map_err(refuse)?;
    session.imports.borrow_mut().push(Import {
        from: from.to_owned(),
        path: path.to_owned(),
        tolerance,
        curves: curves.clone(),
    });
    Ok(curves)
}

/// A cell as a value.
pub fn cell_value<'v>(
    kind: CellKind,
    map: u32,
    id: u32,
    eval: &Evaluator<'v, '_, '_>,
) -> Value<'v> {
    eval.heap().alloc(Cell { kind, map, id })
}

/// Gives a new evaluator its session and the limits of it.
pub fn prepare<'a>(eval: &mut Evaluator<'_, 'a, '_>, session: &'a Session) {
    let limits = session.budget.limits();
    let unset = "a limit of a new evaluator is not set and not zero";
    // Half as much again, because an evaluator serves until half the steps of a call are used up.
    eval.set_max_tick_count(limits.steps + limits.steps / 2)
        .expect(unset);
    eval.set_max_heap_size(limits.heap).expect(unset);
    eval.set_max_callstack_size(limits.calls).expect(unset);
    // Collecting garbage recurses into values as deep as a script makes them.
    eval.disable_gc();
    eval.extra = Some(session);
}

/// The session of the evaluation that `eval` does.
pub fn session<'a>(eval: &Evaluator<'_, 'a, '_>) -> &'a Session {
    eval.extra
        .and_then(|extra| extra.downcast_ref())
        .expect("every evaluation is given a session")
}
