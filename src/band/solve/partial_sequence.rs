//! Unfinished sequences of pieces, with exact lengths and offsets, among those that a filled table says can be finished: the table
//! knows them in rows and levels, whose rounding adds up along a sequence. What is searched on first is known to the searches.

use crate::solve::cost_to_go::Rest;
use crate::solve::search::{Filled, Found, Search, Sequence};

/// An unfinished sequence.
#[derive(Clone, Copy)]
pub struct Node {
    /// The number of the sequence without its last piece.
    before: u32,
    /// Its state in the solver's graph.
    pub state: u32,
    /// What remains, as the table counts it.
    pub rest: Rest,
    /// The cost so far, in units of the table.
    pub cost: u64,
    /// The length to the goal.
    pub to_go: f64,
    /// The offset of the last piece.
    pub offset: f64,
}

/// What stands before a first piece.
const NOTHING: u32 = u32::MAX;

/// A search under way.
pub struct Walk<'a> {
    /// What is searched for.
    search: &'a Search<'a>,
    /// The table with all costs.
    filled: &'a Filled,
    /// All sequences that were taken in.
    nodes: Vec<Node>,
}

impl<'a> Walk<'a> {
    /// A search that has not begun.
    pub fn new(search: &'a Search<'a>, filled: &'a Filled) -> Walk<'a> {
        Walk {
            search,
            filled,
            nodes: Vec::new(),
        }
    }

    /// Takes in a sequence; its number.
    pub fn add(&mut self, node: Node) -> u32 {
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// The sequence with this number.
    pub fn node(&self, number: u32) -> Node {
        self.nodes[number as usize]
    }

    /// The first piece for each of `rows`, the remaining lengths after it, at each offset that it may have, with the least cost to the
    /// end.
    pub fn beginnings(&self, rows: &[u32]) -> Vec<(Node, f64)> {
        let offsets = self.first_offsets();
        let node = |row: u32, offset: f64| {
            let rest = self.filled.at(
                Rest {
                    length: row,
                    ..self.filled.start
                },
                offset,
            );
            let to_go = f64::from(row) * self.filled.units.length;
            (
                Node {
                    before: NOTHING,
                    state: 0,
                    rest,
                    cost: 0,
                    to_go,
                    offset,
                },
                self.filled.table.cost(0, rest),
            )
        };
        let all = rows
            .iter()
            .flat_map(|&row| offsets.iter().map(move |&offset| node(row, offset)));
        all.filter(|(_, least)| least.is_finite()).collect()
    }

    /// The offsets that the first piece may have: that of the curve; on a loop, which has no first piece, those at which it may end.
    fn first_offsets(&self) -> Vec<f64> {
        if !self.search.task.closed {
            return vec![0.0];
        }
        let (low, high) = self.search.task.drift.ranges[self.search.first];
        let scaled = &self.filled.scaled;
        let offset = |level: u32| {
            low + (high - low) * (f64::from(level) + 0.5) / f64::from(scaled.level_count)
        };
        (scaled.end_levels.0..=scaled.end_levels.1)
            .map(offset)
            .collect()
    }

    /// Lists what may follow a sequence, each with the least cost to the end, which may be infinite: every step to the row of its
    /// exact length, and to the one that the table comes to, which is sure to have a way to the end.
    pub fn follow(&self, number: u32, ways: &mut Vec<(Node, f64)>) {
        let Walk {
            search: &Search { states, task, .. },
            filled,
            ..
        } = *self;
        ways.clear();
        let node = self.node(number);
        let base = states.step_base(node.state);
        for (k, step) in states.steps(node.state).iter().enumerate() {
            let (low, high) = task.drift.ranges[states.pieces[step.to as usize] as usize];
            let offset = node.offset + step.seam.rise;
            if !(low..=high).contains(&offset) {
                continue;
            }
            let Some(rest) = filled.after(node.rest, step, 0, offset) else {
                continue;
            };
            let (to_go, cost) = (
                node.to_go - step.length,
                node.cost + filled.scaled.costs[base + k],
            );
            let exact = libm::round(to_go / filled.units.length) as i64;
            let counted = i64::from(node.rest.length) - i64::from(filled.scaled.lengths[base + k]);
            for row in std::iter::once(exact).chain((counted != exact).then_some(counted)) {
                if (0..i64::from(node.rest.length)).contains(&row) {
                    let rest = Rest {
                        length: row as u32,
                        ..rest
                    };
                    let least = filled.table.cost(step.to, rest);
                    ways.push((
                        Node {
                            before: number,
                            state: step.to,
                            rest,
                            cost,
                            to_go,
                            offset,
                        },
                        least,
                    ));
                }
            }
        }
    }

    /// Whether a sequence may end here; the cost of the whole then, in units of the table.
    pub fn whole_cost(&self, node: &Node) -> Option<u64> {
        let ends = self.filled.ends(self.search.states, node.state, node.rest);
        ends.then(|| node.cost + self.filled.scaled.ends[node.state as usize].1)
    }

    /// The whole sequence that ends with a node, unless its length misses the curve's; `value` is what makes it good.
    pub fn finished(&self, node: &Node, value: impl Fn(&Sequence) -> f64) -> Option<Found> {
        let nodes = std::iter::successors(Some(node), |n| self.nodes.get(n.before as usize));
        let mut pieces: Vec<usize> = nodes
            .map(|n| self.search.states.pieces[n.state as usize].into())
            .collect();
        pieces.reverse();
        let sequence = self
            .search
            .sequence(pieces)
            .filter(|s| self.search.meets(s))?;
        let value = value(&sequence);
        Some(Found {
            rank: self.search.rank(&sequence, value),
            sequence,
        })
    }
}
