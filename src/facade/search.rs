//! The best alignment of one candidate (rules R6, R7, R9): the shortest path through the alignment
//! decision network. Lengths of wildcards are found on the way. The search goes on from the node
//! with the least bound of the error first; nodes that are no better than another one at the same
//! place are given up (`label`). When the exact search is too long, a narrow one goes along the
//! canvas with the most promising nodes only.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::budget::Budget;
use super::label::Labels;
use super::network::{Network, Place, State};

/// An alignment, and how good it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alignment {
    /// The error, in steps.
    pub error: i64,
    /// The lengths that each wildcard can have.
    pub lengths: Vec<(i64, i64)>,
    /// Where the rows are read to: at the start, and after every column.
    pub path: Vec<Vec<Place>>,
}

/// The steps that a narrow search may take for one node.
const NODE_STEPS: u64 = 1500;
/// Comparing this many labels with others is a step.
const COMPARED: u64 = 4;

/// How widely to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// All that can lead to the best.
    Exact,
    /// At most this many nodes at each part of the canvas.
    Narrow(usize),
    /// At most this many nodes at each depth, and only those that sizes can be found for: see `constrained`.
    Sizable(usize),
}

/// The alignment of least error up to `bound`; among these, of the least total length of wildcards;
/// among these, of most columns. Where wildcards are kept, one alignment per set of their lengths
/// that no better one has too.
pub fn align(network: &Network, bound: i64, width: Width, budget: &mut Budget) -> Vec<Alignment> {
    let network = &network.with_outlook(bound, budget);
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
        Width::Exact => search.best_first(budget),
        Width::Narrow(width) | Width::Sizable(width) => search.along(width, budget),
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
    fn best_first(&mut self, budget: &mut Budget) {
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

    /// Follows the nodes of each part of the canvas, from its start on.
    fn along(&mut self, width: usize, budget: &mut Budget) {
        let part = self.network.part();
        let mut open: BTreeMap<i64, Vec<u32>> = BTreeMap::from([(0, vec![0])]);
        let mut ends = Vec::new();
        while let Some((number, mut ids)) = open.pop_first() {
            // The nodes of one part may not take what those that follow need.
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

    /// What the error may come to: what was put off counts as well as what was paid.
    fn guess(&self, id: u32) -> i64 {
        let label = self.labels.get(id);
        let outlook = self.network.outlook.as_ref();
        outlook
            .map_or(0, |outlook| label.error + outlook.sum(&label.places))
            .max(label.rank.error)
    }

    /// At most `width` nodes, the first ones; no more than a quarter of them alike in what was read.
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

    /// Makes the labels that follow `id`.
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
