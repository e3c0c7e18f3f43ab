//! All alignments of one candidate that are as good as the best one: of the least error and, among
//! these, of the most columns (rule R9). They differ in what they demand of the sizes; alignments
//! that demand the same are one. Lengths of wildcards are known here.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::balance::Balance;
use super::budget::Budget;
use super::network::{Network, Passed, Place, State};

/// An alignment and its demands.
#[derive(Clone, Debug)]
pub struct Tie {
    /// What it demands of the sizes.
    pub balance: Balance,
    /// Where the rows are read to: at the start, and after every column.
    pub path: Vec<Vec<Place>>,
}

/// The alignments of least error (at most `bound`) and most columns, `most` different ones at each node at most.
pub fn ties(
    network: &Network,
    bound: i64,
    idle: &[bool],
    most: usize,
    budget: &mut Budget,
) -> (i64, Vec<Tie>) {
    let network = &network.with_outlook(bound, budget);
    let row = &network.rows[0];
    let spans_matter = row.steps(0, row.letters()) + bound > network.longest;
    let mut graph = Graph {
        network,
        spans_matter,
        nodes: Vec::new(),
        index: HashMap::new(),
        open: BTreeMap::new(),
    };
    graph.add(network.start(), 0, None);
    // Columns only lead to nodes with more letters read.
    while let Some((_, ids)) = graph.open.pop_first() {
        for id in ids {
            let state = graph.nodes[id].state.clone();
            let columns = graph.nodes[id].columns + 1;
            let mut found = Vec::new();
            network.expand(&state, bound, budget, &mut |next, _| {
                found.push(next.clone())
            });
            found
                .into_iter()
                .for_each(|next| graph.add(next, columns, Some(id)));
            if budget.exhausted {
                return (0, Vec::new());
            }
        }
    }
    graph.collect(idle, most, budget)
}

/// A node with the ways to it that are best.
struct Node {
    state: State,
    columns: usize,
    parents: Vec<usize>,
}

/// What tells nodes apart.
type Key = (Vec<Place>, Vec<Passed>, i64);

/// The node, and the number among its demands, that demands come from.
type Origin = Option<(usize, usize)>;
/// The different demands of the best ways to each node.
type Demands = BTreeMap<usize, Vec<(Balance, Origin)>>;

struct Graph<'a> {
    network: &'a Network,
    nodes: Vec<Node>,
    index: HashMap<Key, usize>,
    /// Nodes that are not expanded yet, by the letters read.
    open: BTreeMap<usize, Vec<usize>>,
    spans_matter: bool,
}

impl Graph<'_> {
    fn add(&mut self, state: State, columns: usize, parent: Option<usize>) {
        let span = if self.spans_matter { state.span } else { 0 };
        let key = (state.places.clone(), state.passed.clone(), span);
        let Some(id) = self.index.get(&key).copied() else {
            let depth = state.places.iter().map(|p| p.letter()).sum();
            self.index.insert(key, self.nodes.len());
            self.open.entry(depth).or_default().push(self.nodes.len());
            self.nodes.push(Node {
                state,
                columns,
                parents: parent.into_iter().collect(),
            });
            return;
        };
        let node = &mut self.nodes[id];
        let (new, old) = (
            (state.error, usize::MAX - columns),
            (node.state.error, usize::MAX - node.columns),
        );
        if new < old {
            *node = Node {
                state,
                columns,
                parents: parent.into_iter().collect(),
            };
        } else if new == old {
            node.parents.extend(parent);
        }
    }

    /// The nodes that a best way leads over, and the error and the ends.
    fn best(&self) -> Option<(i64, Vec<usize>, BTreeSet<usize>)> {
        let ends =
            (0..self.nodes.len()).filter(|id| self.network.is_end(&self.nodes[*id].state.places));
        let rank = |id: &usize| {
            (
                self.nodes[*id].state.error,
                usize::MAX - self.nodes[*id].columns,
            )
        };
        let ends: Vec<usize> = ends.collect();
        let least = ends.iter().map(rank).min()?;
        let ends: Vec<usize> = ends.into_iter().filter(|id| rank(id) == least).collect();
        let mut marked: BTreeSet<usize> = ends.iter().copied().collect();
        let mut stack = ends.clone();
        while let Some(id) = stack.pop() {
            for parent in &self.nodes[id].parents {
                if marked.insert(*parent) {
                    stack.push(*parent);
                }
            }
        }
        Some((least.0, ends, marked))
    }

    fn collect(&self, idle: &[bool], most: usize, budget: &mut Budget) -> (i64, Vec<Tie>) {
        let Some((error, ends, marked)) = self.best() else {
            return (0, Vec::new());
        };
        let mut order: Vec<usize> = marked.into_iter().collect();
        order.sort_by_key(|id| {
            (
                self.nodes[*id]
                    .state
                    .places
                    .iter()
                    .map(|p| p.letter())
                    .sum::<usize>(),
                *id,
            )
        });
        // Per node: demands so far, and the parent with the number of its demands they came from.
        let mut demands = Demands::new();
        demands.insert(0, vec![(Balance::default(), None)]);
        for id in order.into_iter().filter(|id| *id != 0) {
            let mut list: Vec<(Balance, Origin)> = Vec::new();
            for parent in &self.nodes[id].parents {
                let before = demands.get(parent).map_or(&[][..], |d| d);
                for (n, (balance, _)) in before.iter().enumerate() {
                    if list.len() >= most || !budget.spend(1 + self.network.rows.len() as u64) {
                        break;
                    }
                    let mut balance = balance.clone();
                    let (from, to) = (
                        &self.nodes[*parent].state.places,
                        &self.nodes[id].state.places,
                    );
                    balance.pass(self.network, from, to, idle);
                    if !list.iter().any(|(other, _)| other.covers(&balance)) {
                        list.retain(|(other, _)| !balance.covers(other));
                        list.push((balance, Some((*parent, n))));
                    }
                }
            }
            demands.insert(id, list);
        }
        let mut found = Vec::new();
        for end in ends {
            for (balance, from) in demands.get(&end).into_iter().flatten() {
                found.push(Tie {
                    balance: balance.clone(),
                    path: self.path(end, *from, &demands),
                });
            }
        }
        (error, found)
    }

    fn path(&self, end: usize, from: Origin, demands: &Demands) -> Vec<Vec<Place>> {
        let mut path = vec![self.nodes[end].state.places.clone()];
        let mut next = from;
        while let Some((id, n)) = next {
            path.push(self.nodes[id].state.places.clone());
            next = demands
                .get(&id)
                .and_then(|list| list.get(n))
                .and_then(|(_, from)| *from);
        }
        path.reverse();
        path
    }
}
