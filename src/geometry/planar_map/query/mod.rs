//! What one asks a planar map, and what must hold of it.

mod check;
pub(in crate::planar_map) mod locate;
mod measures;
mod queries;
mod spread;

pub(in crate::planar_map) use queries::NO_HALF_EDGE;
pub use queries::{EdgeId, FaceId, HalfEdge, Source, VertexId};
