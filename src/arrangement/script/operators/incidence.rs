//! Which cells meet (table 3.4, incidence).

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::Value;
use starlark::values::list::AllocList;

use crate::cells;
use crate::script::operators::arguments::{cell, edge};
use crate::script::operators::unbounded::{asked, seen};
use crate::script::seeds::plain;
use fretwork_geometry::FaceId;
use fretwork_script::session::{cell_value, session};
use fretwork_script::values::{Cell, CellKind};

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
}

/// Cells of one kind of the map that `of` is in, as a list.
fn list<'v>(
    kind: CellKind,
    of: Cell,
    ids: impl ExactSizeIterator<Item = u32>,
    eval: &Evaluator<'v, '_, '_>,
) -> starlark::Result<Value<'v>> {
    session(eval).charge(ids.len())?;
    Ok(eval
        .heap()
        .alloc(AllocList(ids.map(|id| cell_value(kind, of.map, id, eval)))))
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    /// The faces around a vertex or beside an edge, the unbounded one included; each once, in a list.
    ///
    /// Fails on what is no cell.
    ///
    /// Example: `faces = incident_faces(edge)`
    fn incident_faces<'v>(
        #[starlark(require = pos)] cell: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let kinds = [CellKind::Vertex, CellKind::Edge];
        let of = self::cell(cell, "incident_faces", &kinds, "a vertex or an edge")?;
        let faces = session(eval).with_map(of, |map| cells::incident_faces(map, plain(of)))?;
        seen(session(eval), of, faces.contains(&FaceId::UNBOUNDED))?;
        session(eval).know_all(of, CellKind::Face, faces.iter().map(|f| f.0))?;
        list(CellKind::Face, of, faces.into_iter().map(|f| f.0), eval)
    }

    /// The edges around a face, those of holes and dangling ones included, or those that end at a vertex; each once, in a list.
    ///
    /// Fails on what is no cell.
    ///
    /// Example: `sides = incident_edges(face)`
    fn incident_edges<'v>(
        #[starlark(require = pos)] cell: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let kinds = [CellKind::Vertex, CellKind::Face];
        let of = self::cell(cell, "incident_edges", &kinds, "a vertex or a face")?;
        asked(session(eval), of)?;
        let edges = session(eval).with_map(of, |map| cells::incident_edges(map, plain(of)))?;
        session(eval).know_all(of, CellKind::Edge, edges.iter().map(|e| e.0))?;
        list(CellKind::Edge, of, edges.into_iter().map(|e| e.0), eval)
    }

    /// The vertices around a face, or the ends of an edge; each once, in a list.
    ///
    /// Fails on what is no cell.
    ///
    /// Example: `corners = incident_vertices(face)`
    fn incident_vertices<'v>(
        #[starlark(require = pos)] cell: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let kinds = [CellKind::Edge, CellKind::Face];
        let of = self::cell(cell, "incident_vertices", &kinds, "a face or an edge")?;
        asked(session(eval), of)?;
        let vertices =
            session(eval).with_map(of, |map| cells::incident_vertices(map, plain(of)))?;
        list(
            CellKind::Vertex,
            of,
            vertices.into_iter().map(|v| v.0),
            eval,
        )
    }

    /// The vertex that an edge begins at.
    ///
    /// Fails on what is no edge.
    ///
    /// Example: `begin = source_vertex(edge)`
    fn source_vertex<'v>(
        #[starlark(require = pos)] edge: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (cell, id) = self::edge(edge, "source_vertex")?;
        let vertex = session(eval).with_map(cell, |map| map.source(id))?;
        Ok(cell_value(CellKind::Vertex, cell.map, vertex.0, eval))
    }

    /// The vertex that an edge ends at.
    ///
    /// Fails on what is no edge.
    ///
    /// Example: `end = target_vertex(edge)`
    fn target_vertex<'v>(
        #[starlark(require = pos)] edge: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (cell, id) = self::edge(edge, "target_vertex")?;
        let vertex = session(eval).with_map(cell, |map| map.target(id))?;
        Ok(cell_value(CellKind::Vertex, cell.map, vertex.0, eval))
    }

    /// The face to the left of an edge, where (-y, x) is left of the direction (x, y).
    ///
    /// Fails on what is no edge.
    ///
    /// Example: `face = left_face(edge)`
    fn left_face<'v>(
        #[starlark(require = pos)] edge: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (cell, id) = self::edge(edge, "left_face")?;
        let face = session(eval).with_map(cell, |map| map.left(id))?;
        seen(session(eval), cell, face == FaceId::UNBOUNDED)?;
        session(eval).know_all(cell, CellKind::Face, std::iter::once(face.0))?;
        Ok(cell_value(CellKind::Face, cell.map, face.0, eval))
    }

    /// The face to the right of an edge.
    ///
    /// Fails on what is no edge.
    ///
    /// Example: `face = right_face(edge)`
    fn right_face<'v>(
        #[starlark(require = pos)] edge: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (cell, id) = self::edge(edge, "right_face")?;
        let face = session(eval).with_map(cell, |map| map.right(id))?;
        seen(session(eval), cell, face == FaceId::UNBOUNDED)?;
        session(eval).know_all(cell, CellKind::Face, std::iter::once(face.0))?;
        Ok(cell_value(CellKind::Face, cell.map, face.0, eval))
    }
}
