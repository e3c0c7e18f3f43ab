//! From curves to a planar map, step by step.

pub(in crate::planar_map) mod chains;
mod finish;
pub(in crate::planar_map) mod half_edges;
pub(in crate::planar_map) mod labels;
mod lone;
pub(in crate::planar_map) mod nesting;
mod parted;
pub(in crate::planar_map) mod stars;

use crate::Curves;
use crate::budget;
use crate::planar_map::error::PlanarMapError;
use crate::planar_map::map::PlanarMap;
use crate::planar_map::noding;
use crate::planar_map::noding::network::Network;
use crate::planar_map::noding::segments::Segments;
use crate::planar_map::noding::snap_grid::SnapGrid;

impl PlanarMap {
    /// The planar map of `curves`, with points nearer than `resolution` (a power of two, see
    /// [`resolution`](crate::planar_map::resolution)) taken for one. No curves give a map without edges; named points are ignored.
    /// A point that stands alone is a vertex after all others, or that other one which is nearer than a resolution; an edge that
    /// runs through it is parted there.
    ///
    /// Guarantees: no two edges cross, no vertex is nearer than 0.49 resolutions to an edge that it does not
    /// end, the map of [`PlanarMap::to_curves`] is the same map, and the order and direction of
    /// the curves decide nothing but the orientation of edges and the order of sources. Where coordinates are so large
    /// that their own rounding is more than an eighth of the resolution, eight times this rounding takes its place;
    /// where they are farther than 2^43 resolutions from one another, it is doubled up to three times.
    ///
    /// # Errors
    /// When a coordinate is not finite, is farther than 2^46 resolutions from another one, or is so far from the origin
    /// that a million resolutions are less than its own rounding; when
    /// there are more cells than can be numbered, when the curves are a thicket that does not come
    /// apart at this resolution.
    ///
    /// Time grows like (n + crossings) log n for n segments that are spread over the plane.
    pub fn build(curves: &Curves, resolution: f64) -> Result<PlanarMap, PlanarMapError> {
        let parted = parted::parted(curves, resolution);
        let curves = parted.as_ref().map_or(curves, |parted| &parted.curves);
        let grid = SnapGrid::fit(curves, resolution)?;
        let Network { sites, routes } = noding::node(snapped(curves, &grid)?, resolution)?;
        let stars = stars::Stars::around(&sites, &routes);
        let (ends, curve_ends) = (routes.ends(), labels::labelled(curves, &routes));
        drop(routes);
        let mut chains = chains::Chains::join(&stars, &ends);
        let next = half_edges::link(&chains, &stars);
        let ends = labels::leaving(curve_ends, &stars, &chains);
        drop(stars);
        let embedding = half_edges::Embedding {
            chains: &chains,
            sites: &sites,
        };
        let faces = nesting::nest(&embedding, &next, half_edges::trace(&embedding, &next));
        chains.half_edges = Vec::new();
        let labels = labels::gather(curves, &chains, &ends, &faces.of);
        let mut map = finish::finish(grid, sites, chains, next, faces, labels);
        if let Some(parted) = &parted {
            parted::renumber(&mut map, &parted.of);
        }
        lone::add(&mut map, curves.lone());
        Ok(map)
    }
}

/// Bytes that a map takes while it is built for each point of its curves, and steps.
const POINT: usize = 320;
const POINT_STEPS: u64 = 60;

/// The curves with their points rounded to the grid, without pieces of no length.
fn snapped(curves: &Curves, grid: &SnapGrid) -> Result<Segments, PlanarMapError> {
    const LIMIT: usize = (u32::MAX / 8) as usize;
    if curves.points().len() > LIMIT {
        return Err(PlanarMapError::TooLarge {
            what: "points of curves",
            count: curves.points().len(),
        });
    }
    budget::make("points of curves", curves.points().len(), POINT);
    budget::spend(
        "points of curves",
        POINT_STEPS * curves.points().len() as u64,
    );
    let mut segments = Segments::with_capacity(curves.points().len() - curves.len());
    for (i, curve) in (0u32..).zip(curves.iter()) {
        segments.push(curve.points.iter().map(|p| grid.snap(*p)), i);
    }
    Ok(segments)
}
