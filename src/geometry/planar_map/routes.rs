//! The nodes along every segment, and the pieces between them.

use std::sync::Mutex;

use super::crossings::{Found, REACH};
use super::exact::{Segment, distance};
use super::lattice::{RESOLUTION, Site};
use super::parallel::for_each_row;

/// Pieces no longer than this, in grid units, vanish: their ends are merged. In a triangle with longer
/// sides at most one corner is within [`REACH`] of the opposite side (a height of more than √3/2
/// sides is left to the others), so that a segment that was led through a node is not led back.
const SHORT: f64 = RESOLUTION;

/// The nodes along every segment, from a to b.
pub(super) struct Routes {
    starts: Vec<u32>,
    nodes: Vec<u32>,
    /// For every segment the one whose route it takes, itself as a rule; empty when no segment equals another.
    leader: Vec<u32>,
}

impl Routes {
    /// Sorts what was found by segments and along them; `sites` are those of all parts, one after the
    /// other. Nodes along a segment that are too near to one another, they come from different
    /// cells, are merged: whether any were.
    pub fn gather(segments: &[Segment], sites: &[Site], found: Vec<Found>) -> (Routes, bool) {
        let mut routes = Routes::fill(segments.len(), found);
        let near = Mutex::new(Vec::new());
        let Routes { starts, nodes, leader } = &mut routes;
        for_each_row(starts, nodes, &|inner: &mut Vec<(f64, u32)>, i, row| {
            if leader.is_empty() || leader[i] as usize == i {
                sort(&segments[i], row, inner, sites, &near);
            }
        });
        let near = near.into_inner().expect("no thread panics while it holds the list");
        let merged = !near.is_empty();
        if merged {
            routes.merge(sites, near);
        }
        (routes, merged)
    }

    /// Routes with their ends in place and the inner nodes in any order.
    fn fill(count: usize, found: Vec<Found>) -> Routes {
        // Row i begins at starts[i]; next[i] is where its next inner node goes.
        let mut starts = vec![0u32; count + 1];
        found.iter().flat_map(|f| &f.incidences).for_each(|(segment, _)| starts[*segment as usize + 1] += 1);
        for i in 0..count {
            starts[i + 1] += starts[i] + 2;
        }
        let mut nodes = vec![0u32; starts[count] as usize];
        let mut next: Vec<u32> = starts[..count].iter().map(|s| s + 1).collect();
        let mut leader: Vec<u32> = Vec::new();
        let mut base = 0;
        for part in found {
            for (end, node) in part.ends {
                let segment = end as usize / 2;
                let slot = if end % 2 == 0 { starts[segment] } else { starts[segment + 1] - 1 };
                nodes[slot as usize] = base + node;
            }
            for (segment, node) in part.incidences {
                let slot = &mut next[segment as usize];
                nodes[*slot as usize] = base + node;
                *slot += 1;
            }
            if !part.same.is_empty() && leader.is_empty() {
                leader.extend(0..count as u32);
            }
            part.same.iter().for_each(|&(copy, first)| leader[copy as usize] = first);
            base += part.sites.len() as u32;
        }
        Routes { starts, nodes, leader }
    }

    fn of(&self, segment: usize) -> &[u32] {
        let leader = self.leader.get(segment).map_or(segment, |l| *l as usize);
        &self.nodes[self.starts[leader] as usize..self.starts[leader + 1] as usize]
    }

    /// Merges the nodes of pairs, in the order of their sites.
    fn merge(&mut self, sites: &[Site], mut near: Vec<[u32; 2]>) {
        let mirrored: Vec<[u32; 2]> = near.iter().map(|[v, w]| [*w, *v]).collect();
        near.extend(mirrored);
        let key = |v: u32| sites[v as usize].map(f64::to_bits);
        near.sort_unstable_by_key(|p| (key(p[0]), key(p[1])));
        let mut alias: Vec<u32> = (0..sites.len() as u32).collect();
        let mut fixed = vec![false; sites.len()];
        for &[v, w] in &near {
            if alias[v as usize] == v && !fixed[w as usize] && alias[w as usize] == w {
                fixed[v as usize] = true;
                alias[w as usize] = v;
            }
        }
        self.nodes.iter_mut().for_each(|v| *v = alias[*v as usize]);
    }

    /// The pieces of all routes in the direction of the curves, and the curve of each; `curves` says of each
    /// segment 2 × curve, + 1 where the curve runs from b to a.
    pub fn pieces(&self, curves: &[u32]) -> (Vec<[u32; 2]>, Vec<u32>) {
        let count = (0..curves.len()).map(|i| self.of(i).len() - 1).sum();
        let (mut pieces, mut of) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut push = |from: u32, to: u32, curve: u32| {
            if from != to {
                pieces.push([from, to]);
                of.push(curve);
            }
        };
        for (i, &curve) in curves.iter().enumerate() {
            let pairs = self.of(i).windows(2);
            if curve % 2 == 0 {
                pairs.for_each(|w| push(w[0], w[1], curve / 2));
            } else {
                pairs.rev().for_each(|w| push(w[1], w[0], curve / 2));
            }
        }
        (pieces, of)
    }
}

/// Sorts the inner nodes of a route from a to b and notes nodes that are to be merged.
fn sort(segment: &Segment, row: &mut [u32], inner: &mut Vec<(f64, u32)>, sites: &[Site], near: &Mutex<Vec<[u32; 2]>>) {
    let position = |v: u32| segment.position(sites[v as usize]);
    let [a, rest @ .., b] = row else { unreachable!("a route has two ends") };
    let gap = distance(segment.a, segment.b) * SHORT;
    let (low, high) = (position(*a), position(*b));
    let note = |v: u32, w: u32, reach: f64| {
        if v != w && distance(sites[v as usize], sites[w as usize]) <= reach {
            near.lock().expect("no thread panics while it holds the list").push([v, w]);
        }
    };
    inner.clear();
    inner.extend(rest.iter().map(|&v| (position(v), v)));
    inner.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    let (mut last, mut before) = (low, *a);
    for (slot, &(at, node)) in rest.iter_mut().zip(inner.iter()) {
        // Beyond an end there is nothing of the segment, but there may be a node to merge with the end.
        let beyond = if at <= low { Some(*a) } else { Some(*b).filter(|_| at >= high) };
        if let Some(end) = beyond {
            note(end, node, REACH);
            *slot = end;
            continue;
        }
        *slot = node;
        if at - last <= gap {
            note(before, node, SHORT);
        }
        (last, before) = (at, node);
    }
    if high - last <= gap {
        note(before, *b, SHORT);
    }
}
