//! The finished map: vertices numbered without the nodes that are none, sites turned into points.

use std::sync::OnceLock;

use crate::planar_map::PlanarMap;
use crate::planar_map::build::chains::{Chains, NONE};
use crate::planar_map::build::labels::Labels;
use crate::planar_map::build::nesting::Faces;
use crate::planar_map::noding::snap_grid::{Site, SnapGrid};
use crate::planar_map::parallel;

/// Puts the parts together.
pub(in crate::planar_map) fn finish(
    grid: SnapGrid,
    sites: Vec<Site>,
    mut chains: Chains,
    next: Vec<u32>,
    faces: Faces,
    mut labels: Labels,
) -> PlanarMap {
    let mut number = vec![NONE; sites.len()];
    for (i, v) in (0u32..).zip(&chains.vertices) {
        number[*v as usize] = i;
    }
    let vertices = if labels.vertices.is_empty() {
        Vec::new()
    } else {
        let label = |v: &u32| {
            labels
                .vertices
                .get(*v as usize)
                .copied()
                .unwrap_or_default()
        };
        chains.vertices.iter().map(label).collect()
    };
    labels.vertices = vertices;
    chains
        .ends
        .iter_mut()
        .flatten()
        .for_each(|v| *v = number[*v as usize]);
    let mut outgoing = vec![0u32; chains.vertices.len()];
    for (edge, ends) in (0u32..).zip(&chains.ends) {
        outgoing[ends[0] as usize] = 2 * edge;
        outgoing[ends[1] as usize] = 2 * edge + 1;
    }
    let points = parallel::map(chains.vertices.len(), |i| {
        grid.point(sites[chains.vertices[i] as usize])
    });
    PlanarMap {
        grid,
        points,
        outgoing,
        ends: chains.ends,
        inner: chains
            .inner
            .iter()
            .map(|v| grid.point(sites[*v as usize]))
            .collect(),
        inner_starts: chains.inner_starts,
        next,
        faces,
        first_source: chains.first,
        more_sources: chains.more,
        passes: chains.passes,
        labels,
        index: OnceLock::new(),
    }
}
