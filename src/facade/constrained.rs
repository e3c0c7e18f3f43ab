//! An alignment that can be sized, for candidates of which the best alignments cannot: fixed symbols
//! in one column, or a symbol that would have to vanish. The search is narrow: it looks for a good
//! layout where the exact search found none at any tolerance.

use std::collections::BTreeMap;

use super::balance::Balance;
use super::budget::Budget;
use super::network::{Network, State};
use super::search::Alignment;

/// What asking for sizes costs, in steps.
const SIZE_STEPS: u64 = 500;

/// An alignment of an error of at most `bound` whose demands `can_size` accepts. Of the nodes with the
/// same number of letters read, at most `width` are followed, those of the least error first.
pub fn align_sizable(
    network: &Network,
    bound: i64,
    width: usize,
    symbols: usize,
    budget: &mut Budget,
    can_size: &mut dyn FnMut(&Balance) -> bool,
) -> Option<Alignment> {
    let idle = vec![false; symbols];
    let start = Node { state: network.start(), balance: Balance::default(), rank: (0, 0), parent: None };
    let mut nodes = vec![start];
    let mut open: BTreeMap<usize, Vec<usize>> = BTreeMap::from([(0, vec![0])]);
    while let Some((_, mut ids)) = open.pop_first() {
        ids.sort_by_key(|id| (nodes[*id].rank, *id));
        let mut followed: Vec<usize> = Vec::new();
        for id in ids {
            let node = &nodes[id];
            let like = |other: &usize| nodes[*other].is_as_good(node);
            if followed.len() >= width || followed.iter().any(like) {
                continue;
            }
            if !budget.spend(SIZE_STEPS) {
                return None;
            }
            if !can_size(&node.balance) {
                continue;
            }
            if network.is_end(&node.state.places) && network.settle(&node.state.lengths).is_some() {
                return Some(alignment(&nodes, id));
            }
            followed.push(id);
            let (state, columns) = (node.state.clone(), node.rank.1);
            let mut found: Vec<(State, i64)> = Vec::new();
            network.expand(&state, bound, budget, &mut |next, error| found.push((next.clone(), error)));
            for (next, error) in found {
                let mut balance = nodes[id].balance.clone();
                balance.pass(network, &state.places, &next.places, &idle);
                let depth = next.places.iter().map(|p| p.letter()).sum();
                open.entry(depth).or_default().push(nodes.len());
                nodes.push(Node { state: next, balance, rank: (error, columns - 1), parent: Some(id) });
            }
        }
    }
    None
}

struct Node {
    state: State,
    balance: Balance,
    /// Bound of the error, minus the columns.
    rank: (i64, i64),
    parent: Option<usize>,
}

impl Node {
    /// Whether it comes before `other` in all that matters here.
    fn is_as_good(&self, other: &Node) -> bool {
        let (a, b) = (&self.state, &other.state);
        a.places == b.places
            && a.passed == b.passed
            && a.lengths == b.lengths
            && a.span <= b.span
            && self.balance.covers(&other.balance)
    }
}

fn alignment(nodes: &[Node], end: usize) -> Alignment {
    let last = &nodes[end].state;
    let mut path = vec![last.places.clone()];
    let mut id = end;
    while let Some(parent) = nodes[id].parent {
        path.push(nodes[parent].state.places.clone());
        id = parent;
    }
    path.reverse();
    Alignment { error: last.error, lengths: last.lengths.clone(), path }
}
