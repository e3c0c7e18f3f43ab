//! The planar map of curves: vertices, edges and faces of their arrangement, with labels.
//!
//! [`PlanarMap::build`] takes five steps. Each one may rely on what the steps before it established:
//!
//! 1. **Snap** (`noding::snap_grid`, `noding::segments`). Points become whole numbers, which `f64` holds exactly. From here
//!    on `noding::exact` decides without error on which side of a line a point lies, so no later step can contradict another.
//!    *Invariant:* segments have two different ends, and the order of their ends does not depend on how curves run.
//! 2. **Node** (`noding`). Segments are led through the nodes where they end, cross or nearly touch: snap rounding with a
//!    disc around each node. `bins` finds what is near, `crossings` works through one cell at a time, `clusters` merges
//!    nodes of one cell, `routes` holds the result, and `excerpt` takes out what has to be noded again because something moved.
//!    *Invariant:* segments meet at nodes only, and no node is near a segment that does not run through it.
//! 3. **Order** (`build::stars`, `build::chains`). The pieces around each node are sorted counter-clockwise, pieces that
//!    coincide become one, and pieces that follow one another where nothing branches become an edge.
//!    *Invariant:* every piece is part of exactly one edge, and edges are numbered by place and not by curve.
//! 4. **Trace** (`build::half_edges`, `build::nesting`). Every edge has two half-edges; the next one around a face is the
//!    neighbour in the star of its target. The cycles that arise run around faces or, clockwise, around components, and each
//!    component is put into the face that lies to the left of its lowest point (`query::locate`).
//!    *Invariant:* Euler's formula, V - E + F = C for V vertices, E edges, F bounded faces and C components.
//! 5. **Label** (`build::labels`, `build::finish`). Cells take the union of the labels of the curves along them, and whole
//!    numbers become points again.
//!    *Invariant:* everything that `query::check` lists; tests and fuzz targets call it on every map.
//!
//! `query` holds what users ask a map. Regions, clipping and mapping are not here.
//!
//! **Meaning.** Vertices are the ends of curves and the points where other than two pieces of curves
//! meet; edges are the maximal pieces between vertices; a closed curve has one vertex at its
//! start. Points along a curve nearer than the resolution are one, and a vertex nearer than half of it to a curve
//! lies on that curve. Coincident pieces are one edge, oriented like the first curve in the list.

mod build;
mod error;
mod map;
mod noding;
mod parallel;
mod query;

pub use error::PlanarMapError;
pub use map::{MAP_RESOLUTION, PlanarMap, resolution};
pub use query::{EdgeId, FaceId, HalfEdge, Source, VertexId};

#[cfg(test)]
mod tests;
