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
    let start = Node {
        state: network.start(),
        balance: Balance::default(),
        rank: (0, 0, 0),
        parent: None,
    };
    let open = BTreeMap::from([(0, vec![0])]);
    let idle = vec![false; symbols];
    let mut walk = Walk {
        network,
        bound,
        width,
        idle,
        nodes: vec![start],
        open,
        ends: Vec::new(),
    };
    while let Some((part, ids)) = walk.open.pop_first() {
        let mut share = network.share(part * network.part(), budget);
        walk.pass(ids, &mut share, can_size);
        budget.charge(&share);
        if !budget.spend(1) {
            break;
        }
    }
    walk.ends
        .iter()
        .min()
        .map(|(.., end)| alignment(&walk.nodes, *end))
}

/// A way along the canvas, part by part.
struct Walk<'a> {
    network: &'a Network,
    bound: i64,
    width: usize,
    idle: Vec<bool>,
    nodes: Vec<Node>,
    /// Nodes by their part of the canvas.
    open: BTreeMap<i64, Vec<usize>>,
    /// Error, minus the columns, and number of the nodes that end.
    ends: Vec<(i64, i64, usize)>,
}

impl Walk<'_> {
    /// Follows the best of some nodes.
    fn pass(
        &mut self,
        mut ids: Vec<usize>,
        budget: &mut Budget,
        can_size: &mut dyn FnMut(&Balance, &mut Budget) -> bool,
    ) {
        ids.sort_by_key(|id| (self.nodes[*id].rank, *id));
        let mut followed: Vec<usize> = Vec::new();
        for id in ids {
            if followed.len() >= self.width || budget.exhausted {
                return;
            }
            let node = &self.nodes[id];
            let others = || followed.iter().map(|other| &self.nodes[*other]);
            let alike = others()
                .filter(|other| other.state.places == node.state.places)
                .count();
            let is_beaten =
                alike >= (self.width / 4).max(1) || others().any(|other| other.is_as_good(node));
            if is_beaten || !can_size(&node.balance, budget) {
                continue;
            }
            if self.network.is_end(&node.state.places) {
                if self.network.settle(&node.state.lengths).is_some() {
                    self.ends.push((node.state.error, node.rank.2, id));
                }
                continue;
            }
            followed.push(id);
            for next in self.follow(id, budget) {
                self.open
                    .entry(next.state.span / self.network.part())
                    .or_default()
                    .push(self.nodes.len());
                self.nodes.push(next);
            }
        }
    }

    /// The nodes after one.
    fn follow(&self, id: usize, budget: &mut Budget) -> Vec<Node> {
        let (network, node) = (self.network, &self.nodes[id]);
        let mut found = Vec::new();
        let mut steps = budget.part(NODE_STEPS);
        network.expand(&node.state, self.bound, &mut steps, &mut |next, error| {
            let mut balance = node.balance.clone();
            balance.pass(network, &node.state.places, &next.places, &self.idle);
            let guess = next.error
                + network
                    .outlook
                    .as_ref()
                    .map_or(0, |outlook| outlook.sum(&next.places));
            let rank = (guess.max(error), error, node.rank.2 - 1);
            found.push(Node {
                state: next.clone(),
                balance,
                rank,
                parent: Some(id),
            });
        });
        budget.charge(&steps);
        budget.spend(1);
        found
    }
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
    Alignment {
        error: last.error,
        lengths: last.lengths.clone(),
        path,
    }
}
