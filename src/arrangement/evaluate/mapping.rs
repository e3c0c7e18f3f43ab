//! Mapping operators: a function of the script is called on every cell of a planar map, and the
//! curves that it gives are put one after another (Loi 2015, section 3.4).

use std::sync::Arc;

use starlark::codemap::FileSpan;
use starlark::eval::Evaluator;
use starlark::values::{Value, ValueLike};

use super::parallel::{self, Job};
use super::seeds::plain;
use crate::operators::kind;
use fretwork_geometry::{Curves, PlanarMap, Seed};
use fretwork_script::Limits;
use fretwork_script::fault::Note;
use fretwork_script::scope::{Scope, cell_seeds};
use fretwork_script::session::{CurvesValue, refuse, session};
use fretwork_script::values::{Callable, Cell, CellKind};

/// A planar map and which of its cells are mapped, in the order of their numbers.
pub(super) struct Mapping {
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

/// The curves that `mapper` gives for the cells. A mapper that is frozen, as all are that exist
/// before the evaluation, is called on all cores where the evaluation is not itself part of such a
/// call; the result is the same.
pub(super) fn map_cells<'v>(
    mapping: &Mapping,
    mapper: Value<'v>,
    eval: &mut Evaluator<'v, '_, '_>,
) -> starlark::Result<Curves> {
    let session = session(eval);
    if let (Some(job), Some(frozen)) = (session.job::<Job>(), mapper.unpack_frozen()) {
        return parallel::map_cells(mapping, frozen, &job).map_err(|fault| job.stash(fault));
    }
    // A planar map lives until the mapper's call around it ends, and takes about as much memory.
    session.draw_points(4 * mapping.map.edge_count())?;
    let number = session.add_map(mapping.map.clone());
    let kinds = cell_seeds(mapping.seed);
    let mut out = Curves::new();
    for id in mapping.cells() {
        let cell = Cell {
            kind: mapping.kind,
            map: number,
            id,
        };
        let mapped = map_cell(mapper, cell, kinds, &mut out, Limits::MAPPER.points, eval);
        mapped.inspect_err(|_| session.note(mapping.note(mapper, cell)))?;
    }
    Ok(out)
}

/// Calls `mapper` on `cell` and appends what it gives to `out`, which is to have at most `limit` points.
pub(super) fn map_cell<'v>(
    mapper: Value<'v>,
    cell: Cell,
    kinds: [Seed; 3],
    out: &mut Curves,
    limit: usize,
    eval: &mut Evaluator<'v, '_, '_>,
) -> starlark::Result<()> {
    let argument = eval.heap().alloc(cell);
    let result = session(eval).within(Scope::call(cell, kinds), || {
        eval.eval_function(mapper, &[argument], &[])
    })?;
    match result.downcast_ref::<CurvesValue>() {
        Some(curves) => append(out, &curves.0, limit),
        None => Err(refuse(format!(
            "the mapper gives {}, not curves",
            described(result)
        ))),
    }
}

/// Appends `more` unless that makes more than `limit` points.
pub(super) fn append(out: &mut Curves, more: &Curves, limit: usize) -> starlark::Result<()> {
    if out.points().len() + more.points().len() > limit {
        return Err(refuse(format!(
            "this makes curves of more than {limit} points"
        )));
    }
    out.append(more);
    Ok(())
}

/// What `value` is, for a mapper or arrangement that gives something else than curves.
pub(super) fn described(value: Value<'_>) -> String {
    if value.is_none() {
        return "None (a path without `return`? `nothing()` stands for no curves)".into();
    }
    if Callable::from_value(value).is_some() {
        return "an arrangement (apply it to the cell: `texture(face)`)".into();
    }
    kind(value)
}
