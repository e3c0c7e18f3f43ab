//! The nodes along every segment, and the curves as curve_ends through them.

use std::sync::Mutex;

use crate::planar_map::noding::candidate::REACH;
use crate::planar_map::noding::crossings::Found;
use crate::planar_map::noding::exact::{Segment, distance};
use crate::planar_map::noding::segments::Segments;
use crate::planar_map::noding::snap_grid::{RESOLUTION, Site};
use crate::planar_map::parallel::for_each_row;

/// Pieces no longer than this, in grid units, vanish: their ends are merged. It is twice [`REACH`] and
/// more, so that the nodes that a segment is led through on either side of it are still apart
/// along it, and that a segment that was led through a node is not led back: in a triangle with longer sides
/// at most one corner is within reach of the opposite side.
const SHORT: f64 = RESOLUTION;

/// The nodes along every segment, from a to b; the same node may follow itself.
#[derive(Default)]
pub(in crate::planar_map) struct Routes {
    starts: Vec<u32>,
    nodes: Vec<u32>,
    /// For every segment the one whose route it takes, itself as a rule; empty when no segment equals another.
    leader: Vec<u32>,
    /// As in [`Segments`].
    pub curves: Vec<u32>,
    /// As in [`Segments`].
    pub ends: Vec<u8>,
    sequence: Vec<u32>,
}

/// A curve as it goes through the nodes.
pub(in crate::planar_map) struct CurveEnds {
    pub curve: u32,
    /// Its first node and the one after it.
    pub first: [u32; 2],
    /// Its last node and the one before it.
    pub last: [u32; 2],
}

impl Routes {
    /// Sorts what was found by segments and along them. Nodes along a segment that are too near to one
    /// another are merged; also returned are the nodes that others were merged with.
    pub fn gather(segments: Segments, sites: &[Site], found: Vec<Found>) -> (Routes, Vec<u32>) {
        let Segments {
            by_place,
            curves,
            ends,
            sequence,
        } = segments;
        let mut routes = Routes {
            curves,
            ends,
            sequence,
            ..Routes::fill(by_place.len(), found)
        };
        let near = Mutex::new(Vec::new());
        let Routes {
            starts,
            nodes,
            leader,
            ..
        } = &mut routes;
        for_each_row(starts, nodes, &|inner: &mut Vec<(f64, u32)>, i, row| {
            if leader.is_empty() || leader[i] as usize == i {
                sort(&by_place[i], row, inner, sites, &near);
            }
        });
        let near = near
            .into_inner()
            .expect("no thread panics while it holds the list");
        let merged = if near.is_empty() {
            Vec::new()
        } else {
            routes.merge(sites.len(), near)
        };
        (routes, merged)
    }

    /// Routes with their ends in place and the inner nodes in any order.
    fn fill(count: usize, found: Vec<Found>) -> Routes {
        // Row i begins at starts[i]; next[i] is where its next inner node goes.
        let mut starts = vec![0u32; count + 1];
        found
            .iter()
            .flat_map(|f| &f.incidences)
            .for_each(|(segment, _)| starts[*segment as usize + 1] += 1);
        for i in 0..count {
            starts[i + 1] += starts[i] + 2;
        }
        let mut nodes = vec![0u32; starts[count] as usize];
        let mut next: Vec<u32> = starts[..count].iter().map(|s| s + 1).collect();
        let mut leader: Vec<u32> = Vec::new();
        for part in found {
            for (end, node) in part.ends {
                let segment = end as usize / 2;
                let slot = if end % 2 == 0 {
                    starts[segment]
                } else {
                    starts[segment + 1] - 1
                };
                nodes[slot as usize] = part.base + node;
            }
            for (segment, node) in part.incidences {
                let slot = &mut next[segment as usize];
                nodes[*slot as usize] = part.base + node;
                *slot += 1;
            }
            if !part.same.is_empty() && leader.is_empty() {
                leader.extend(0..count as u32);
            }
            part.same
                .iter()
                .for_each(|&(copy, first)| leader[copy as usize] = first);
        }
        Routes {
            starts,
            nodes,
            leader,
            ..Routes::default()
        }
    }

    /// Merges the nodes of pairs, in reading order. Returns the nodes that others were merged with.
    fn merge(&mut self, count: usize, mut near: Vec<[u32; 2]>) -> Vec<u32> {
        let mirrored: Vec<[u32; 2]> = near.iter().map(|[v, w]| [*w, *v]).collect();
        near.extend(mirrored);
        near.sort_unstable();
        let mut alias: Vec<u32> = (0..count as u32).collect();
        let mut fixed = vec![false; count];
        for &[v, w] in &near {
            if alias[v as usize] == v && !fixed[w as usize] && alias[w as usize] == w {
                fixed[v as usize] = true;
                alias[w as usize] = v;
            }
        }
        self.nodes.iter_mut().for_each(|v| *v = alias[*v as usize]);
        near.iter()
            .map(|n| n[0])
            .filter(|v| fixed[*v as usize])
            .collect()
    }

    /// How many segments there are.
    pub fn len(&self) -> usize {
        self.curves.len()
    }

    /// The nodes along a segment.
    pub fn of(&self, segment: usize) -> &[u32] {
        let leader = self.leader.get(segment).map_or(segment, |l| *l as usize);
        &self.nodes[self.starts[leader] as usize..self.starts[leader + 1] as usize]
    }

    /// The pieces of a segment from a to b, between nodes that differ.
    pub fn pieces(&self, segment: usize) -> impl DoubleEndedIterator<Item = [u32; 2]> + '_ {
        self.of(segment)
            .windows(2)
            .filter(|w| w[0] != w[1])
            .map(|w| [w[0], w[1]])
    }

    /// The same segments with `renew` telling the nodes of each segment from a to b.
    pub fn renewed(self, mut renew: impl FnMut(&Routes, usize, &mut Vec<u32>)) -> Routes {
        let mut starts = Vec::with_capacity(self.len() + 1);
        let mut nodes = Vec::with_capacity(self.nodes.len());
        for i in 0..self.len() {
            starts.push(nodes.len() as u32);
            let mut row = Vec::new();
            renew(&self, i, &mut row);
            row.dedup();
            nodes.extend(row);
        }
        starts.push(nodes.len() as u32);
        Routes {
            starts,
            nodes,
            leader: Vec::new(),
            ..self
        }
    }

    fn in_order(&self) -> impl Iterator<Item = usize> + '_ {
        let stored = if self.sequence.is_empty() {
            self.curves.len()
        } else {
            0
        };
        (0..stored).chain(self.sequence.iter().map(|i| *i as usize))
    }

    /// The nodes where curves end that have not vanished.
    pub fn ends(&self) -> Vec<u32> {
        let vanished = |i: usize| self.pieces(i).next().is_none();
        if (0..self.len()).any(|i| self.ends[i] != 0 && vanished(i)) {
            return self
                .curve_ends(|_| true)
                .iter()
                .flat_map(|w| [w.first[0], w.last[0]])
                .collect();
        }
        let mut ends = Vec::new();
        for (i, bits) in self.ends.iter().enumerate().filter(|e| *e.1 != 0) {
            let route = self.of(i);
            let (mut first, mut last) = (route[0], route[route.len() - 1]);
            if self.curves[i] % 2 == 1 {
                (first, last) = (last, first);
            }
            ends.extend((bits & Segments::FIRST != 0).then_some(first));
            ends.extend((bits & Segments::LAST != 0).then_some(last));
        }
        ends
    }

    /// The curve_ends of the chosen curves that have not vanished.
    pub fn curve_ends(&self, choose: impl Fn(u32) -> bool) -> Vec<CurveEnds> {
        let mut curve_ends: Vec<CurveEnds> = Vec::new();
        for i in self.in_order().filter(|i| choose(self.curves[*i] / 2)) {
            let (curve, against) = (self.curves[i] / 2, self.curves[i] % 2 == 1);
            let ends = (self.pieces(i).next(), self.pieces(i).next_back());
            let (Some([a, after]), Some([before, b])) = ends else {
                continue;
            };
            let (first, last) = if against {
                ([b, before], [a, after])
            } else {
                ([a, after], [b, before])
            };
            match curve_ends.last_mut() {
                Some(walk) if walk.curve == curve => walk.last = last,
                _ => curve_ends.push(CurveEnds { curve, first, last }),
            }
        }
        curve_ends
    }
}

/// Sorts the inner nodes of a route from a to b and notes nodes that are to be merged.
fn sort(
    segment: &Segment,
    row: &mut [u32],
    inner: &mut Vec<(f64, u32)>,
    sites: &[Site],
    near: &Mutex<Vec<[u32; 2]>>,
) {
    let position = |v: u32| segment.position(sites[v as usize]);
    let [a, rest @ .., b] = row else {
        unreachable!("a route has two ends")
    };
    let gap = distance(segment.a, segment.b) * SHORT;
    let (low, high) = (position(*a), position(*b));
    let note = |v: u32, w: u32, reach: f64| {
        if v != w && distance(sites[v as usize], sites[w as usize]) <= reach {
            near.lock()
                .expect("no thread panics while it holds the list")
                .push([v, w]);
        }
    };
    inner.clear();
    inner.extend(rest.iter().map(|&v| (position(v), v)));
    inner.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    let (mut last, mut before) = (low, *a);
    for (slot, &(at, node)) in rest.iter_mut().zip(inner.iter()) {
        // Beyond an end there is nothing of the segment, but there may be a node to merge with the end.
        let beyond = if at <= low {
            Some(*a)
        } else {
            Some(*b).filter(|_| at >= high)
        };
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
