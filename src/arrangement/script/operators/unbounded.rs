//! Where a mapper is watched, it must not learn of the face around all cells from a cell that stands for others: on a
//! region that face may be closed by what lies at the region's border.

use crate::script::seeds::plain;
use fretwork_geometry::FaceId;
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

/// Refuses what is asked of the unbounded face itself.
pub(crate) fn asked(session: &Session, of: Cell) -> starlark::Result<()> {
    let is_unbounded = of.kind == CellKind::Face && of.id == FaceId::UNBOUNDED.0;
    if is_unbounded && of.map == 0 {
        session.unwatched("it asks what lies around the face around all cells")?;
    }
    Ok(())
}
