//! Where a mapper is watched, it must not learn of the face around all cells from a cell that stands for others: on a
//! region that face may be closed by what lies at the region's border.

use crate::cells;
use crate::script::seeds::plain;
use fretwork_geometry::{FaceId, PlanarMap};
use fretwork_script::session::{Session, refuse};
use fretwork_script::values::{Cell, CellKind};

/// Refuses when `of`, of the map that is mapped, stands for others and what was found beside it `is_unbounded`.
pub(crate) fn seen(session: &Session, of: Cell, is_unbounded: bool) -> starlark::Result<()> {
    let Some(watch) = session.watch().filter(|_| is_unbounded && of.map == 0) else {
        return Ok(());
    };
    let at = session.with_map(of, |map| plain(of).position(map))?;
    if watch.deep.contains(at) {
        return Err(refuse("it asks for the face around all cells"));
    }
    Ok(())
}

/// Refuses to tell whether the unbounded face lies beside `of` where a face beside it is not known.
pub(crate) fn beside(session: &Session, of: Cell) -> starlark::Result<()> {
    let beside = |map: &PlanarMap| {
        let edges = match plain(of) {
            cells::Cell::Face(face) if face == FaceId::UNBOUNDED => Vec::new(),
            cell => cells::incident_edges(map, cell),
        };
        let sides = edges.iter().flat_map(|e| [map.left(*e), map.right(*e)]);
        sides.map(|face| face.0).collect::<Vec<u32>>()
    };
    let faces = session.with_map(of, beside)?;
    session.know_all(of, CellKind::Face, faces.into_iter())
}

/// Refuses what is asked of the unbounded face itself.
pub(crate) fn asked(session: &Session, of: Cell) -> starlark::Result<()> {
    let is_unbounded = of.kind == CellKind::Face && of.id == FaceId::UNBOUNDED.0;
    session.know_around(of)?;
    if is_unbounded && of.map == 0 {
        session.unwatched("it asks what lies around the face around all cells")?;
    }
    Ok(())
}
