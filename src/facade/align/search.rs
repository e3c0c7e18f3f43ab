//! The best alignment of one candidate (rules R6, R7 and R9): the shortest path through the alignment
//! decision network. The lengths of wildcards are found on the way.
//!
//! The exact search is A*: it follows the node with the least lower bound of the error first, and
//! drops labels that another one dominates (`dominance`). When it would take too long, a beam search
//! goes along the canvas, part by part, and follows the most promising nodes of each only.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::dominance::Labels;
use super::network::Network;
use super::place::{Place, State};
use crate::budget::Budget;

/// An alignment, and how good it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alignment {
    /// The error, in steps.
    pub error: i64,
    /// The least and the greatest length that each wildcard can have.
    pub lengths: Vec<(i64, i64)>,
    /// The places in all rows, at the start and after every column.
    pub path: Vec<Vec<Place>>,
}

/// The steps that a beam search may take for the successors of one node. With fewer, nodes in long
/// rows lose successors that are needed; with more, one node with many wildcards may use up the
/// share of its whole part of the canvas.
pub const NODE_STEPS: u64 = 1500;
/// The comparisons of labels that count as one step, so that steps take about the same time. If it is
/// too high, searches with many labels at one place take long; if too low, they end too early.
const COMPARED: u64 = 4;

/// How thoroughly to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Follow all nodes that can lead to the best alignment.
    Exact,
    /// Follow at most so many nodes in each part of the canvas.
    Beam(usize),
    /// The same, but only nodes whose equations of sizes have a solution: see `select::sizable`.
    SizableBeam(usize),
}

/// The alignment of the least error up to `bound`; among these, the one with the shortest wildcards;
/// among these, the one with the most columns. If wildcards are kept, there is one alignment for each
/// set of their lengths that no better alignment can have. None if there is no alignment, or if the
/// budget ran out before one was found.
pub fn align(network: &Network, bound: i64, width: Effort, budget: &mut Budget) -> Vec<Alignment> {
    let network = &network.with_lower_bound(bound, budget);
    let mut search = Search {
        network,
        bound,
        labels: Labels::new(network, bound),
        ends: Vec::new(),
        kept: network.wildcards.iter().any(|w| w.kept),
    };
    let start = network.start();
    let Some((ahead, span)) = network.ahead(&start) else {
        return Vec::new();
    };
    if ahead > bound || span > network.longest {
        return Vec::new();
    }
    search.labels.insert(&start, ahead, None);
    match width {
        Effort::Exact => search.a_star(budget),
        Effort::Beam(width) | Effort::SizableBeam(width) => search.beam(width, budget),
    }
    search
        .ends
        .iter()
        .map(|end| search.alignment(*end))
        .collect()
}

struct Search<'a> {
    network: &'a Network,
    bound: i64,
    labels: Labels<'a>,
    ends: Vec<u32>,
    kept: bool,
}

impl Search<'_> {
    /// Follows the label with the least lower bound first; of equal ones the deepest.
    fn a_star(&mut self, budget: &mut Budget) {
        let mut queue = BinaryHeap::new();
        let entry = |labels: &Labels, id: u32| {
            let label = labels.get(id);
            Reverse((label.rank, Reverse(label.depth()), id))
        };
        queue.push(entry(&self.labels, 0));
        while let Some(Reverse((_, _, id))) = queue.pop() {
            let label = self.labels.get(id);
            if !label.alive {
                continue;
            }
            if self.network.is_end(&label.places) {
                if self.network.settle(&label.lengths).is_some() {
                    self.ends.push(id);
                    if !self.kept {
                        return;
                    }
                }
                continue;
            }
            for new in self.follow(id, budget) {
                queue.push(entry(&self.labels, new));
            }
            if budget.exhausted {
                return;
            }
        }
    }

    /// Follows at most `width` labels in each part of the canvas, from its start on.
    fn beam(&mut self, width: usize, budget: &mut Budget) {
        let part = self.network.part();
        let mut open: BTreeMap<i64, Vec<u32>> = BTreeMap::from([(0, vec![0])]);
        let mut ends = Vec::new();
        while let Some((number, mut ids)) = open.pop_first() {
            // The labels of one part may not use up what later parts need.
            let mut share = self.network.share(number * part, budget);
            ids.retain(|id| self.labels.get(*id).alive);
            ids.sort_by_cached_key(|id| (self.guess(*id), self.labels.get(*id).rank, *id));
            for id in self.varied(ids, width) {
                let label = self.labels.get(id);
                if self.network.is_end(&label.places) {
                    if self.network.settle(&label.lengths).is_some() {
                        ends.push((label.rank, id));
                    }
                    continue;
                }
                if share.exhausted {
                    continue;
                }
                let mut node = share.part(NODE_STEPS);
                let followers = self.follow(id, &mut node);
                share.charge(&node);
                share.spend(1);
                for new in followers {
                    open.entry(self.labels.get(new).span / part)
                        .or_default()
                        .push(new);
                }
            }
            budget.charge(&share);
            if !budget.spend(1) {
                break;
            }
        }
        self.ends = ends
            .into_iter()
            .min()
            .map(|(_, id)| id)
            .into_iter()
            .collect();
    }

    /// An estimate of the whole error. What is still to pay counts like what was paid, or labels that
    /// put off their costs would fill the beam.
    fn guess(&self, id: u32) -> i64 {
        let label = self.labels.get(id);
        let lower_bound = self.network.lower_bound.as_ref();
        lower_bound
            .map_or(0, |lower_bound| {
                label.error + lower_bound.sum(&label.places)
            })
            .max(label.rank.error)
    }

    /// The first `width` labels, but at most a quarter of `width` at the same places. A beam full of
    /// labels at one place would end with it.
    fn varied(&self, ids: Vec<u32>, width: usize) -> Vec<u32> {
        let mut alike: BTreeMap<&[Place], usize> = BTreeMap::new();
        let mut taken = Vec::new();
        for id in ids {
            let count = alike.entry(&self.labels.get(id).places).or_default();
            if *count < (width / 4).max(1) {
                *count += 1;
                taken.push(id);
            }
            if taken.len() >= width {
                break;
            }
        }
        taken
    }

    /// Makes the labels that follow label `id`.
    fn follow(&mut self, id: u32, budget: &mut Budget) -> Vec<u32> {
        let state = self.labels.get(id).state();
        let mut found: Vec<(State, i64)> = Vec::new();
        self.network
            .expand(&state, self.bound, budget, &mut |next, bound| {
                found.push((next.clone(), bound))
            });
        let before = self.labels.compared;
        let new = found
            .iter()
            .filter_map(|(next, bound)| self.labels.insert(next, *bound, Some(id)))
            .collect();
        budget.spend((self.labels.compared - before) / COMPARED);
        new
    }

    fn alignment(&self, end: u32) -> Alignment {
        let last = self.labels.get(end);
        let mut path = vec![last.places.to_vec()];
        let mut label = last;
        while let Some(parent) = label.parent {
            label = self.labels.get(parent);
            path.push(label.places.to_vec());
        }
        path.reverse();
        Alignment {
            error: last.error,
            lengths: last.lengths.to_vec(),
            path,
        }
    }
}
