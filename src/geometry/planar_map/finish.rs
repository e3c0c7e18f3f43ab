//! The finished map: vertices numbered in the order in which the edges meet them, sites turned into points.

use std::sync::OnceLock;

use super::super::LabelSet;
use super::PlanarMap;
use super::chains::Chains;
use super::labels::Labels;
use super::lattice::{Lattice, Site};
use super::nesting::Faces;

/// Puts the parts together.
pub(super) fn finish(
    lattice: Lattice,
    sites: Vec<Site>,
    mut chains: Chains,
    next: Vec<u32>,
    faces: Faces,
    mut labels: Labels,
) -> PlanarMap {
    let mut number = vec![u32::MAX; sites.len()];
    let (mut points, mut outgoing) = (Vec::with_capacity(sites.len()), Vec::with_capacity(sites.len()));
    for (edge, ends) in chains.ends.iter_mut().enumerate() {
        for (end, v) in ends.iter_mut().enumerate() {
            let node = *v as usize;
            if number[node] == u32::MAX {
                number[node] = points.len() as u32;
                points.push(lattice.point(sites[node]));
                outgoing.push((2 * edge + end) as u32);
            }
            *v = number[node];
        }
    }
    let mut vertices = Vec::new();
    for (node, label) in labels.vertices.iter().enumerate().filter(|l| !l.1.is_empty()) {
        vertices.resize(points.len(), LabelSet::EMPTY);
        vertices[number[node] as usize] = *label;
    }
    labels.vertices = vertices;
    PlanarMap {
        lattice,
        points,
        outgoing,
        ends: chains.ends,
        inner: chains.inner.iter().map(|v| lattice.point(sites[*v as usize])).collect(),
        inner_starts: chains.inner_starts,
        next,
        faces,
        first_source: chains.first,
        more_sources: chains.more,
        labels,
        index: OnceLock::new(),
    }
}
