//! The planar map of curves: vertices, edges and faces of their arrangement, with labels.
//!
//! [`PlanarMap::build`] goes one way: `lattice` rounds points to integers, `strands` holds the
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

mod bins;
mod chains;
mod check;
mod clusters;
mod crossings;
mod error;
mod exact;
mod excerpt;
mod finish;
mod half_edges;
mod labels;
mod lattice;
mod locate;
mod measures;
mod nesting;
mod noding;
mod order;
mod parallel;
mod queries;
mod routes;
mod stars;
mod strands;

use std::sync::OnceLock;

use super::{Curves, Point};
pub use error::PlanarMapError;
pub use queries::{EdgeId, FaceId, HalfEdge, Source, VertexId};

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
    lattice: lattice::Lattice,
    /// Where the vertices are.
    points: Vec<Point>,
    /// One half-edge that leaves each vertex.
    outgoing: Vec<u32>,
    /// Source and target vertex of every edge.
    ends: Vec<[u32; 2]>,
    /// Where the inner points of every edge begin; empty when no edge has any.
    inner_starts: Vec<u32>,
    /// The inner points of edges.
    inner: Vec<Point>,
    /// The half-edge after each half-edge around the face on its left.
    next: Vec<u32>,
    /// The face on the left of each half-edge.
    faces: nesting::Faces,
    /// The first curve along each edge, and edge and packed source of the others.
    first_source: Vec<u32>,
    more_sources: Vec<(u32, u32)>,
    labels: labels::Labels,
    index: OnceLock<locate::Index>,
}

impl PlanarMap {
    /// The planar map of `curves`, with points nearer than `resolution` (a power of two, see
    /// [`resolution`]) taken for one. No curves give a map without cells; named points are ignored.
    ///
    /// Guarantees: no two edges cross, no vertex is nearer than 0.49 resolutions to an edge that it does not
    /// end, the map of [`PlanarMap::to_curves`] is the same map, and the order and direction of
    /// the curves decide nothing but the orientation of edges and the order of sources.
    ///
    /// # Errors
    /// When a coordinate is not finite or is farther than 2^43 resolutions from the origin or from another one, when
    /// there are more cells than can be numbered, when the curves are a thicket that does not come
    /// apart at this resolution.
    ///
    /// Time grows like (n + crossings) log n for n segments that are spread over the plane.
    pub fn build(curves: &Curves, resolution: f64) -> Result<PlanarMap, PlanarMapError> {
        let lattice = lattice::Lattice::fit(curves, resolution)?;
        let noding::Network { sites, routes } =
            noding::node(snapped(curves, &lattice)?, resolution)?;
        let stars = stars::Stars::around(&sites, &routes);
        let (ends, walks) = (routes.ends(), labels::labelled(curves, &routes));
        drop(routes);
        let mut chains = chains::Chains::join(&stars, &ends);
        let next = half_edges::link(&chains, &stars);
        let ends = labels::leaving(walks, &stars, &chains);
        drop(stars);
        let shape = half_edges::Shape {
            chains: &chains,
            sites: &sites,
        };
        let faces = nesting::nest(&shape, &next, half_edges::trace(&shape, &next));
        chains.half_edges = Vec::new();
        let labels = labels::gather(curves, &chains, &ends, &faces.of);
        Ok(finish::finish(lattice, sites, chains, next, faces, labels))
    }
}

/// The curves with their points rounded to the grid, without pieces of no length.
fn snapped(
    curves: &Curves,
    lattice: &lattice::Lattice,
) -> Result<strands::Strands, PlanarMapError> {
    const LIMIT: usize = (u32::MAX / 8) as usize;
    if curves.points().len() > LIMIT {
        return Err(PlanarMapError::TooLarge {
            what: "points of curves",
            count: curves.points().len(),
        });
    }
    let mut strands = strands::Strands::with_capacity(curves.points().len() - curves.len());
    for (i, curve) in (0u32..).zip(curves.iter()) {
        strands.push(curve.points.iter().map(|p| lattice.snap(*p)), i);
    }
    Ok(strands)
}

#[cfg(test)]
mod tests;
