//! Snap rounding: segments in, pieces out that meet at nodes only. A node is an end of a segment
//! or a crossing, rounded to the grid; a segment is led through every node within a resolution of
//! it, and nodes within a resolution of one another are merged (Hobby 1999; Guibas and Marimont
//! 1998, with a disc of one resolution in the place of the hot pixel). Where that moves anything
//! farther than a harmless bend the pieces are noded again until they come to rest, as in iterated
//! snap rounding (Halperin and Packer 2002): in the end every node is farther than a resolution
//! from every piece that it does not end, so the result is its own snap rounding.
//! Curves and labels are not known here beyond the number of the curve a piece is of.

use super::PlanarMapError;
use super::bins::{Bins, Cells};
use super::crossings::{CellWork, Found, Incidence, MERGE};
use super::exact::{Segment, distance};
use super::lattice::Site;

/// The polylines of the curves as pieces between nodes, in the order and direction of the curves.
#[derive(Default)]
pub(super) struct Network {
    /// The nodes.
    pub sites: Vec<Site>,
    /// From and to, never the same node.
    pub pieces: Vec<[u32; 2]>,
    /// The curve of every piece, ascending.
    pub curves: Vec<u32>,
}

/// Passes after which noding gives up; real inputs take one to three.
const PASSES: usize = 64;

/// The noded network of `raw`, whose pieces may cross, touch, overlap and have nodes of their own at
/// equal sites.
pub(super) fn node(raw: Network, resolution: f64) -> Result<Network, PlanarMapError> {
    let mut network = raw;
    for _ in 0..PASSES {
        let (next, settled) = pass(&network)?;
        network = next;
        if settled {
            return Ok(network);
        }
    }
    Err(PlanarMapError::Unresolved { resolution })
}

/// One round of finding nodes and leading the segments through them; whether it is the last.
fn pass(network: &Network) -> Result<(Network, bool), PlanarMapError> {
    let (segments, reversed): (Vec<Segment>, Vec<bool>) = network
        .pieces
        .iter()
        .map(|p| Segment::between(network.sites[p[0] as usize], network.sites[p[1] as usize]))
        .unzip();
    if segments.is_empty() {
        return Ok((Network::default(), true));
    }
    let found = find(&segments);
    let mut ends = vec![0u32; 2 * segments.len()];
    for &(end, node) in &found.ends {
        ends[end as usize] = node;
    }
    let routes = Routes::gather(&segments, &ends, &found);
    let (alias, merged) = routes.merge(&found.sites);
    let mut next = Network { sites: Vec::new(), pieces: Vec::new(), curves: Vec::new() };
    for (i, &curve) in network.curves.iter().enumerate() {
        let mut push = |from: u32, to: u32| {
            if from != to {
                next.pieces.push([from, to]);
                next.curves.push(curve);
            }
        };
        let route = routes.of(i);
        if reversed[i] {
            route.windows(2).rev().for_each(|w| push(alias[w[1] as usize], alias[w[0] as usize]));
        } else {
            route.windows(2).for_each(|w| push(alias[w[0] as usize], alias[w[1] as usize]));
        }
    }
    let settled = !merged && !found.unsettled();
    next.sites = found.sites;
    if next.pieces.len() > (u32::MAX / 4) as usize {
        return Err(PlanarMapError::TooLarge { what: "pieces of curves", count: next.pieces.len() });
    }
    Ok((next, settled))
}

/// Nodes and incidences of all cells.
fn find(segments: &[Segment]) -> Found {
    let cells = Cells::suited(segments);
    let bins = Bins::fill(cells, (0u32..).zip(segments));
    let mut work = CellWork::default();
    let mut found = Found::default();
    for cell in 0..cells.len() {
        let bucket = bins.members(cell);
        if !bucket.is_empty() {
            work.run(segments, bucket, |s| cells.owner(s) == cell, &mut found);
        }
    }
    found
}

/// The nodes along every segment, from a to b.
struct Routes {
    starts: Vec<u32>,
    nodes: Vec<u32>,
}

impl Routes {
    fn gather(segments: &[Segment], ends: &[u32], found: &Found) -> Routes {
        let mut on: Vec<Incidence> = found.incidences.clone();
        on.sort_unstable_by(|p, q| {
            p.segment.cmp(&q.segment).then(p.position.total_cmp(&q.position)).then(p.node.cmp(&q.node))
        });
        let mut routes = Routes { starts: Vec::with_capacity(segments.len() + 1), nodes: Vec::new() };
        let mut k = 0;
        for (i, s) in segments.iter().enumerate() {
            routes.starts.push(routes.nodes.len() as u32);
            let (a, b) = (ends[2 * i], ends[2 * i + 1]);
            let (low, high) = (s.position(found.sites[a as usize]), s.position(found.sites[b as usize]));
            routes.nodes.push(a);
            while k < on.len() && on[k].segment as usize == i {
                if low < on[k].position && on[k].position < high {
                    routes.nodes.push(on[k].node);
                }
                k += 1;
            }
            routes.nodes.push(b);
        }
        routes.starts.push(routes.nodes.len() as u32);
        routes
    }

    fn of(&self, segment: usize) -> &[u32] {
        &self.nodes[self.starts[segment] as usize..self.starts[segment + 1] as usize]
    }

    /// For every node the one it is merged with, itself as a rule; and whether any is merged.
    /// Neighbours along a route that are too near come from different cells.
    fn merge(&self, sites: &[Site]) -> (Vec<u32>, bool) {
        let mut alias: Vec<u32> = (0..sites.len() as u32).collect();
        let mut near: Vec<[u32; 2]> = Vec::new();
        for i in 0..self.starts.len() - 1 {
            for w in self.of(i).windows(2) {
                if w[0] != w[1] && distance(sites[w[0] as usize], sites[w[1] as usize]) <= MERGE {
                    near.push([w[0], w[1]]);
                    near.push([w[1], w[0]]);
                }
            }
        }
        let key = |v: u32| (sites[v as usize][0] as i64, sites[v as usize][1] as i64);
        near.sort_unstable_by_key(|p| (key(p[0]), key(p[1])));
        let mut fixed = vec![false; if near.is_empty() { 0 } else { sites.len() }];
        for &[v, w] in &near {
            if alias[v as usize] == v && !fixed[w as usize] && alias[w as usize] == w {
                fixed[v as usize] = true;
                alias[w as usize] = v;
            }
        }
        (alias, !near.is_empty())
    }
}
