//! Seeds of cells and constructions in a running script (rule R14).

use crate::cells;
use fretwork_geometry::{EdgeId, FaceId, Point, Seed, VertexId};
use fretwork_script::scope::Scope;
use fretwork_script::session::{Session, refuse};
use fretwork_script::values::{Cell, CellKind};

/// The cell as the operators know it.
pub(crate) fn plain(cell: Cell) -> cells::Cell {
    match cell.kind {
        CellKind::Vertex => cells::Cell::Vertex(VertexId(cell.id)),
        CellKind::Edge => cells::Cell::Edge(EdgeId(cell.id)),
        CellKind::Face => cells::Cell::Face(FaceId(cell.id)),
    }
}

/// Where `cell` is.
pub(crate) fn position(session: &Session, cell: Cell) -> starlark::Result<Point> {
    session.with_map(cell, |map| plain(cell).position(map))
}

/// Where a field is read for `cell`.
pub(crate) fn inner(session: &Session, cell: Cell) -> starlark::Result<Point> {
    session.with_map(cell, |map| plain(cell).inner(map))
}

/// The seed of `cell` for the mapping operator whose mapper is running.
pub(crate) fn cell_seed(session: &Session, cell: Cell) -> starlark::Result<Seed> {
    let position = || Some(position(session, cell).ok()? + session.shift());
    let seed = session.scope(|scope| scope.cell(cell, position, session.scale().snap));
    seed.ok_or_else(|| refuse("this cell is of a finished evaluation"))
}

/// Works on the scope that is open, after telling it the seed of its own cell if it wants that.
pub(crate) fn settled<T>(
    session: &Session,
    with: impl FnOnce(&mut Scope) -> T,
) -> starlark::Result<T> {
    if let Some(cell) = session.scope(|scope| scope.wanted()) {
        let seed = cell_seed(session, cell)?;
        session.scope(|scope| scope.settle(seed));
    }
    Ok(session.scope(with))
}
