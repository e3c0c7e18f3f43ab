//! The worst case by lengths (Dumas 2015, 5.2.2): neighbours across a gap between which the pattern goes a
//! long way round are made neighbours indeed, whatever the forces are.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::select::Selection;
use crate::connect::AbstractGraph;

/// Ways from a sample along solid edges.
struct Ways {
    /// For each sample its neighbours by solid edges with the lengths of the edges.
    neighbours: Vec<Vec<(u32, f64)>>,
}

impl Ways {
    fn new(abstracted: &AbstractGraph, solid: &[bool]) -> Ways {
        let mut neighbours = vec![Vec::new(); abstracted.samples.len()];
        for (edge, _) in abstracted
            .edges
            .iter()
            .zip(solid)
            .filter(|(_, solid)| **solid)
        {
            let [a, b] = edge.ends;
            neighbours[a as usize].push((b, edge.length));
            neighbours[b as usize].push((a, edge.length));
        }
        Ways { neighbours }
    }

    /// The distances of all samples from `start` (Dijkstra 1959).
    fn from(&self, start: u32) -> Vec<f64> {
        let mut distances = vec![f64::INFINITY; self.neighbours.len()];
        distances[start as usize] = 0.0;
        // Positive numbers are in the order of their bits.
        let mut queue = BinaryHeap::from([Reverse((0u64, start))]);
        while let Some(Reverse((bits, u))) = queue.pop() {
            let distance = f64::from_bits(bits);
            if distance > distances[u as usize] {
                continue;
            }
            for (v, length) in &self.neighbours[u as usize] {
                let there = distance + length;
                if there < distances[*v as usize] {
                    distances[*v as usize] = there;
                    queue.push(Reverse((there.to_bits(), *v)));
                }
            }
        }
        distances
    }
}

/// Makes solid every empty edge whose ends are farther apart through the pattern than `limit` pitches, the
/// longest way first. All ways are measured again after each: a way is the old one or leads over the new
/// edge, so that the distances from its two ends are enough to know. Ends that do not hang together at
/// all count as infinitely far apart.
pub(super) fn shorten(abstracted: &AbstractGraph, selection: &mut Selection, limit: f64) {
    let mut round = ways_round(abstracted, &selection.solid);
    loop {
        let empty = (0..round.len()).filter(|e| !selection.solid[*e] && round[*e] > limit);
        let worst = empty.max_by(|&a, &b| round[a].total_cmp(&round[b]).then(b.cmp(&a)));
        let Some(worst) = worst else {
            return;
        };
        selection.add(worst);
        let ways = Ways::new(abstracted, &selection.solid);
        let [from, to] = abstracted.edges[worst].ends.map(|end| ways.from(end));
        let length = abstracted.edges[worst].length;
        for (edge, round) in abstracted.edges.iter().zip(&mut round) {
            let [a, b] = edge.ends.map(|end| end as usize);
            let there = from[a] + length + to[b];
            let back = to[a] + length + from[b];
            *round = round.min(there).min(back);
        }
    }
}

/// The way between the ends of each empty edge along solid ones, in pitches; nothing for solid edges.
fn ways_round(abstracted: &AbstractGraph, solid: &[bool]) -> Vec<f64> {
    let ways = Ways::new(abstracted, solid);
    // Edges are in order of their first ends among the empty ones, which are the last.
    let empty: Vec<usize> = (0..solid.len()).filter(|e| !solid[*e]).collect();
    let first = |e: &usize| abstracted.edges[*e].ends[0];
    let groups: Vec<&[usize]> = empty.chunk_by(|a, b| first(a) == first(b)).collect();
    let measure = |group: &&[usize]| {
        let distances = ways.from(first(&group[0]));
        let end = |e: &usize| distances[abstracted.edges[*e].ends[1] as usize];
        group.iter().map(|e| (*e, end(e))).collect::<Vec<_>>()
    };
    let measured: Vec<Vec<(usize, f64)>> = groups.par_iter().map(measure).collect();
    let mut round = vec![0.0; solid.len()];
    for (edge, way) in measured.into_iter().flatten() {
        round[edge] = way;
    }
    round
}
