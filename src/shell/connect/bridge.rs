//! Bridges: paths of voxels made as wide as a feature of the pattern (Dumas 2015, 5.2).

use super::forest::Forest;
use super::surface_graph::{SurfaceGraph, Touch, UNIT};

/// Which voxels a bridge along `path` takes: what lies within `radius` pitches, along the surface, of
/// the empty voxels of the path and of the solid ones at their ends. The rest of the path is solid
/// already, and widening it would only change the pattern.
///
/// A bridge is at least a voxel wider on each side than its path: the smooth border of the finished body takes away
/// what is a single voxel wide, and voxels of a path that touch by a corner are no piece.
pub fn widen(
    graph: &SurfaceGraph,
    solid: &[bool],
    paths: &[impl AsRef<[u32]>],
    radius: f64,
) -> Vec<bool> {
    let mut reach = Forest::new(graph.len());
    for path in paths {
        let path = path.as_ref();
        let is_empty = |i: usize| path.get(i).is_some_and(|v| !solid[*v as usize]);
        let at_gap = |i: usize| is_empty(i) || is_empty(i + 1) || (i > 0 && is_empty(i - 1));
        (0..path.len())
            .filter(|i| at_gap(*i))
            .for_each(|i| reach.plant(path[i], 0));
    }
    let limit = (radius.max(1.0) * f64::from(UNIT)).min(f64::from(u32::MAX / 2)) as u32;
    reach.grow(graph, Touch::Corner, limit, |_| true);
    reach.distances.iter().map(|d| *d != u32::MAX).collect()
}
