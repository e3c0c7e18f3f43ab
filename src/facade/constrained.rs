//! An alignment that can be sized, for candidates of which the best alignments cannot: fixed symbols
//! in one column, or a symbol that would have to vanish. The search is narrow: it looks for a good
//! layout where the exact search found none at any tolerance.

use std::collections::BTreeMap;

use super::balance::Balance;
use super::budget::Budget;
use super::network::{Network, State};
use super::search::Alignment;

/// The steps that may be taken for one node.
const NODE_STEPS: u64 = 1500;

/// An alignment of an error of at most `bound` whose demands `can_size` accepts. Of the nodes at the
/// same part of the canvas, at most `width` are followed, those first that promise the least error.
pub fn align_sizable(
    network: &Network,
    bound: i64,
    width: usize,
    symbols: usize,
    budget: &mut Budget,
    can_size: &mut dyn FnMut(&Balance, &mut Budget) -> bool,
) -> Option<Alignment> {
    let network = &network.with_outlook(bound, budget);
    let (idle, part) = (vec![false; symbols], network.part());
    let start = Node { state: network.start(), balance: Balance::default(), rank: (0, 0, 0), parent: None };
    let mut nodes = vec![start];
    let mut open: BTreeMap<i64, Vec<usize>> = BTreeMap::from([(0, vec![0])]);
    let mut ends = Vec::new();
    while let Some((number, mut ids)) = open.pop_first() {
        let mut share = network.share(number * part, budget);
        ids.sort_by_key(|id| (nodes[*id].rank, *id));
        let mut followed: Vec<usize> = Vec::new();
        for id in ids {
            let node = &nodes[id];
            let like = |other: &&usize| nodes[**other].state.places == node.state.places;
            let is_beaten = |other: &usize| nodes[*other].is_as_good(node);
            if followed.len() >= width
                || followed.iter().filter(like).count() >= (width / 4).max(1)
                || followed.iter().any(is_beaten)
                || share.exhausted
                || !can_size(&node.balance, &mut share)
            {
                continue;
            }
            if network.is_end(&node.state.places) {
                if network.settle(&node.state.lengths).is_some() {
                    ends.push((node.state.error, node.rank.2, id));
                }
                continue;
            }
            followed.push(id);
            let mut steps = share.part(NODE_STEPS);
            let found = follow(network, bound, &nodes[id], id, &idle, &mut steps);
            share.charge(&steps);
            share.spend(1);
            for next in found {
                open.entry(next.state.span / part).or_default().push(nodes.len());
                nodes.push(next);
            }
        }
        budget.charge(&share);
        if !budget.spend(1) {
            break;
        }
    }
    ends.into_iter().min().map(|(.., end)| alignment(&nodes, end))
}

/// The nodes after one.
fn follow(network: &Network, bound: i64, node: &Node, id: usize, idle: &[bool], budget: &mut Budget) -> Vec<Node> {
    let mut found = Vec::new();
    network.expand(&node.state, bound, budget, &mut |next, error| {
        let mut balance = node.balance.clone();
        balance.pass(network, &node.state.places, &next.places, idle);
        let guess = next.error + network.outlook.as_ref().map_or(0, |outlook| outlook.sum(&next.places));
        let rank = (guess.max(error), error, node.rank.2 - 1);
        found.push(Node { state: next.clone(), balance, rank, parent: Some(id) });
    });
    found
}

struct Node {
    state: State,
    balance: Balance,
    /// What the error may come to, its bound, minus the columns.
    rank: (i64, i64, i64),
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
