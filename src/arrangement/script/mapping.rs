//! Mapping operators: a function of the script is called on every cell of a planar map, and the
//! curves that it gives are put one after another (Loi 2015, section 3.4).

use std::sync::Arc;

use starlark::codemap::FileSpan;
use starlark::eval::Evaluator;
use starlark::values::{Value, ValueLike};

use crate::script::operators::arguments::kind;
use crate::script::seeds::plain;
use fretwork_geometry::{Bounds, Curves, PlanarMap, Point, Seed};
use fretwork_script::fault::Note;
use fretwork_script::scope::Scope;
use fretwork_script::session::{CurvesValue, Session, refuse, session};
use fretwork_script::values::{Callable, Cell, CellKind, is_same_weight};
use fretwork_script::watch::{forget_text, wrote_text};

/// Which cells are mapped.
pub(crate) enum Items {
    /// All, in the order of their numbers.
    All,
    /// These.
    Some(Vec<u32>),
    /// These, once for each move, by which the cells lie elsewhere.
    Copies { cells: Vec<u32>, moves: Vec<Point> },
}

/// The numbers of the cells of a kind: all but the unbounded face.
pub(crate) fn cells_of(map: &PlanarMap, kind: CellKind) -> std::ops::Range<u32> {
    match kind {
        CellKind::Vertex => 0..map.vertex_count() as u32,
        CellKind::Edge => 0..map.edge_count() as u32,
        CellKind::Face => 1..map.face_count() as u32 + 1,
    }
}

/// A planar map and which of its cells are mapped.
pub(crate) struct Mapping {
    pub kind: CellKind,
    pub map: Arc<PlanarMap>,
    pub items: Items,
    /// Of the construction.
    pub seed: Seed,
    /// Where it was constructed.
    pub site: Option<FileSpan>,
    /// How far curves may leave the box of their cell.
    pub reach: Reach,
}

/// How far from its box the curves of a cell may reach (Loi 2015, section 4.2.2).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Reach {
    /// Nothing is promised.
    #[default]
    Any,
    /// By a length.
    Length(f64),
    /// By the diagonal of the box.
    Diagonal,
}

impl Reach {
    /// Whether `curves`, which a mapper gives for a cell with the box `cell`, keep to it; points nearer than
    /// `resolution` are one.
    ///
    /// # Errors
    /// How far they reach.
    fn check(self, cell: Bounds, curves: &[Point], resolution: f64) -> starlark::Result<()> {
        let (allowed, promise) = match self {
            Reach::Any => return Ok(()),
            Reach::Length(length) => (length, format!("`reach: {length}` promises no more")),
            Reach::Diagonal => {
                let diagonal = cell.min.distance(cell.max);
                let promise =
                    "without `reach`, `vary` promises no more than the diagonal of the box";
                let advice = "; say how far with `reach: LENGTH`";
                (
                    diagonal,
                    format!("{promise}, which is {}{advice}", shown(diagonal)),
                )
            }
        };
        let drawn = Bounds::of(curves.iter().copied());
        if drawn.is_empty() || cell.is_empty() {
            return Ok(());
        }
        let (low, high) = (cell.min - drawn.min, drawn.max - cell.max);
        let farthest = low.x.max(low.y).max(high.x).max(high.y);
        if farthest <= allowed + resolution {
            return Ok(());
        }
        let by = shown(farthest);
        Err(refuse(format!(
            "a curve reaches {by} out of the box of its cell, and {promise}"
        )))
    }
}

impl Mapping {
    /// The numbers of the cells of the map: all but the unbounded face.
    pub fn cells(&self) -> std::ops::Range<u32> {
        cells_of(&self.map, self.kind)
    }

    /// How many calls there are.
    pub fn len(&self) -> usize {
        match &self.items {
            Items::All => self.cells().len(),
            Items::Some(cells) => cells.len(),
            Items::Copies { cells, moves } => cells.len() * moves.len(),
        }
    }

    /// The cell of a call, and by how much it lies elsewhere.
    pub fn item(&self, n: usize) -> (u32, Point) {
        match &self.items {
            Items::All => (self.cells().start + n as u32, Point::ORIGIN),
            Items::Some(cells) => (cells[n], Point::ORIGIN),
            Items::Copies { cells, moves } => (cells[n % cells.len()], moves[n / cells.len()]),
        }
    }

    /// What is being done when `mapper` is called on some cell.
    pub fn site_note(&self, mapper: Value<'_>) -> Note {
        Note {
            text: format!("`{}`", name(mapper)),
            site: self.site.clone(),
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
    /// By how much what is added is moved.
    pub by: Point,
    limit: usize,
}

impl Collected {
    /// No curves yet; there may be `limit` points in the end.
    pub fn up_to(limit: usize) -> Collected {
        Collected {
            curves: Curves::new(),
            by: Point::ORIGIN,
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
        if self.by == Point::ORIGIN {
            self.curves.append(more);
        } else {
            self.curves.append_moved(more, self.by);
        }
        Ok(())
    }
}

/// Calls `mapper` on `cell` in a scope of its own, and adds what it gives to `out`. `kinds` are the
/// seeds of the mapping operator for each kind of cell.
pub(crate) fn map_cell<'v>(
    mapper: Value<'v>,
    cell: Cell,
    (kinds, reach): ([Seed; 3], Reach),
    out: &mut Collected,
    eval: &mut Evaluator<'v, '_, '_>,
) -> starlark::Result<()> {
    let argument = eval.heap().alloc(cell);
    forget_text();
    let result = session(eval).within(Scope::call(cell, kinds), || {
        eval.eval_function(mapper, &[argument], &[])
    })?;
    match result.downcast_ref::<CurvesValue>() {
        Some(curves) => {
            check_weight(curves, session(eval))?;
            if reach != Reach::Any {
                let session = session(eval);
                let bounds = session.with_map(cell, |map| plain(cell).bounds(map))?;
                reach.check(bounds, curves.curves.points(), session.scale().resolution)?;
            }
            out.append(&curves.curves)
        }
        None => Err(refuse(format!(
            "the mapper gives {}, not curves",
            described(result)
        ))),
    }
}

/// Refuses curves that do not go with the cell that they were made for, where somebody watches.
pub(crate) fn check_weight(curves: &CurvesValue, session: &Session) -> starlark::Result<()> {
    if session.watch().is_none() {
        return Ok(());
    }
    if wrote_text() {
        return Err(refuse("it writes a place or a cell as text"));
    }
    if curves.is_nothing() || is_same_weight(curves.weight, 1.0) {
        return Ok(());
    }
    Err(refuse("it gives curves that do not go with the cell"))
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
