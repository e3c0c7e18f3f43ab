//! The planar map as a value.

use std::sync::OnceLock;

use crate::Point;
use crate::planar_map::build::labels::Labels;
use crate::planar_map::build::nesting::Faces;
use crate::planar_map::noding::snap_grid::SnapGrid;
use crate::planar_map::query::locate::Index;

/// The resolution for a region with this longer side: the largest power of two that is not above
/// 5e-10 of it. A side that is not positive and finite gets that of 1.
pub fn resolution(longer_side: f64) -> f64 {
    let side = if longer_side.is_finite() && longer_side > 1e-250 {
        longer_side
    } else {
        1.0
    };
    // Clearing the mantissa of a normal number leaves its power of two.
    f64::from_bits((side * 5e-10).to_bits() & 0x7ff0_0000_0000_0000)
}

/// The resolution of maps, whose unit is the metre: the largest power of two that is not above a micrometre, whatever
/// their extent.
pub const MAP_RESOLUTION: f64 = 1.0 / (1 << 20) as f64;

/// The arrangement of labelled curves in the plane. Immutable; vertices, edges and faces are numbered by place, so
/// that the numbers depend on the geometry alone.
///
/// ```
/// use fretwork_geometry::planar_map::{PlanarMap, resolution};
/// use fretwork_geometry::{CurveLabels, Curves, Point};
/// let mut curves = Curves::new();
/// curves.push([Point::new(0.0, 0.5), Point::new(1.0, 0.5)], CurveLabels::default());
/// curves.push([Point::new(0.5, 0.0), Point::new(0.5, 1.0)], CurveLabels::default());
/// let map = PlanarMap::build(&curves, resolution(1.0)).unwrap();
/// assert_eq!((map.vertex_count(), map.edge_count(), map.face_count(), map.component_count()), (5, 4, 0, 1));
/// ```
pub struct PlanarMap {
    pub(in crate::planar_map) grid: SnapGrid,
    /// Where the vertices are.
    pub(in crate::planar_map) points: Vec<Point>,
    /// One half-edge that leaves each vertex.
    pub(in crate::planar_map) outgoing: Vec<u32>,
    /// Source and target vertex of every edge.
    pub(in crate::planar_map) ends: Vec<[u32; 2]>,
    /// Where the inner points of every edge begin; empty when no edge has any.
    pub(in crate::planar_map) inner_starts: Vec<u32>,
    /// The inner points of edges.
    pub(in crate::planar_map) inner: Vec<Point>,
    /// The half-edge after each half-edge around the face on its left.
    pub(in crate::planar_map) next: Vec<u32>,
    /// The face on the left of each half-edge.
    pub(in crate::planar_map) faces: Faces,
    /// The first curve along each edge, and edge and packed source of the others.
    pub(in crate::planar_map) first_source: Vec<u32>,
    pub(in crate::planar_map) more_sources: Vec<(u32, u32)>,
    /// Edges along which a curve runs more often than its sources tell; see [`PlanarMap::passes`].
    pub(in crate::planar_map) passes: Vec<(u32, u32, i32)>,
    pub(in crate::planar_map) labels: Labels,
    pub(in crate::planar_map) index: OnceLock<Index>,
}
