//! The planar map of curves: vertices, edges and faces of their arrangement, with labels.
//!
//! [`PlanarMap::build`] goes one way: `grid` rounds points to integers, `segments` holds the
//! segments, `noding` leads them through the nodes where they meet (`bins` finds what is near, `crossings`
//! what happens in one bin, `clusters` merges sites, `exact` decides on which side a point is, `excerpt` takes out
//! what has to be noded again), `routes` holds the result; `stars` orders the pieces around nodes, `chains` makes
//! edges of them, `half_edges` the cycles around faces, `nesting` puts components into faces (`locate` finds what is
//! beside a point), `labels` unites labels, `finish` puts the map together. `queries` and `measures` are what users
//! ask a map, `check` what must hold of it. Regions, clipping and mapping are not here.
//!
//! **Meaning.** Vertices are the ends of curves and the points where other than two pieces of curves
//! meet; edges are the maximal pieces between vertices; a closed curve has one vertex at its
//! start. Points along a curve nearer than the resolution are one, and a vertex nearer than half of it to a curve
//! lies on that curve. Coincident pieces are one edge, oriented like the first curve in the list. With V vertices,
//! E edges, F bounded faces and C components, V - E + F = C.

mod build;
mod error;
mod map;
mod noding;
mod parallel;
mod query;

pub use error::PlanarMapError;
pub use map::{PlanarMap, resolution};
pub use query::{EdgeId, FaceId, HalfEdge, Source, VertexId};

#[cfg(test)]
mod tests;
