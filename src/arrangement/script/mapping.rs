//! Mapping operators: a function of the script is called on every cell of a planar map, and the
//! curves that it gives are put one after another (Loi 2015, section 3.4).

use std::sync::Arc;

use starlark::codemap::FileSpan;
use starlark::eval::Evaluator;
use starlark::values::{Value, ValueLike};

use crate::script::operators::arguments::kind;
use crate::script::seeds::plain;
use fretwork_geometry::{Curves, PlanarMap, Seed};
use fretwork_script::fault::Note;
use fretwork_script::scope::Scope;
use fretwork_script::session::{CurvesValue, refuse, session};
use fretwork_script::values::{Callable, Cell, CellKind};

/// A planar map and which of its cells are mapped, in the order of their numbers.
pub(crate) struct Mapping {
    pub kind: CellKind,
    pub map: Arc<PlanarMap>,
    /// Of the construction.
    pub seed: Seed,
    /// Where it was constructed.
    pub site: Option<FileSpan>,
}

impl Mapping {
    /// The numbers of the cells: all but the unbounded face.
    pub fn cells(&self) -> std::ops::Range<u32> {
        match self.kind {
            CellKind::Vertex => 0..self.map.vertex_count() as u32,
            CellKind::Edge => 0..self.map.edge_count() as u32,
            CellKind::Face => 1..self.map.face_count() as u32 + 1,
        }
    }

    /// What is being done when `mapper` is called on `cell`.
    pub fn note(&self, mapper: Value<'_>, cell: Cell) -> Note {
        let at = plain(cell).position(&self.map);
        let text = format!(
            "`{}` on the {} at ({}, {})",
            name(mapper),
            self.kind.name(),
            shown(at.x),
            shown(at.y)
        );
        Note {
            text,
            site: self.site.clone(),
        }
    }
}

/// A coordinate for people: to a thousandth.
fn shown(x: f64) -> f64 {
    let rounded = libm::round(x * 1e3) / 1e3;
    // Adding 0 turns a negative zero into the other.
    if rounded.is_finite() {
        rounded + 0.0
    } else {
        x
    }
}

fn name(mapper: Value<'_>) -> &str {
    let callable = || Callable::from_value(mapper).map(|_| "the arrangement");
    mapper
        .function_name()
        .or_else(callable)
        .unwrap_or("the mapper")
}

/// Curves that are put one after another, up to a number of points.
pub(crate) struct Collected {
    pub curves: Curves,
    limit: usize,
}

impl Collected {
    /// No curves yet; there may be `limit` points in the end.
    pub fn up_to(limit: usize) -> Collected {
        Collected {
            curves: Curves::new(),
            limit,
        }
    }

    /// Adds `more`, unless that makes too many points.
    pub fn append(&mut self, more: &Curves) -> starlark::Result<()> {
        if self.curves.points().len() + more.points().len() > self.limit {
            return Err(refuse(format!(
                "this makes curves of more than {} points",
                self.limit
            )));
        }
        self.curves.append(more);
        Ok(())
    }
}

/// Calls `mapper` on `cell` in a scope of its own, and adds what it gives to `out`. `kinds` are the
/// seeds of the mapping operator for each kind of cell.
pub(crate) fn map_cell<'v>(
    mapper: Value<'v>,
    cell: Cell,
    kinds: [Seed; 3],
    out: &mut Collected,
    eval: &mut Evaluator<'v, '_, '_>,
) -> starlark::Result<()> {
    let argument = eval.heap().alloc(cell);
    let result = session(eval).within(Scope::call(cell, kinds), || {
        eval.eval_function(mapper, &[argument], &[])
    })?;
    match result.downcast_ref::<CurvesValue>() {
        Some(curves) => out.append(&curves.0),
        None => Err(refuse(format!(
            "the mapper gives {}, not curves",
            described(result)
        ))),
    }
}

/// What `value` is, for a mapper or arrangement that gives something else than curves.
pub(crate) fn described(value: Value<'_>) -> String {
    if value.is_none() {
        return "None (a path without `return`? `nothing()` stands for no curves)".into();
    }
    if Callable::from_value(value).is_some() {
        return "an arrangement (apply it to the cell: `texture(face)`)".into();
    }
    kind(value)
}
