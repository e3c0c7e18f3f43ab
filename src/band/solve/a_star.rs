//! A search that goes on from the sequence whose whole costs least (Hart, Nilsson, Raphael 1968): what the rest costs is known from
//! the solver's table.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::solve::partial_sequence::{Node, Walk};
use crate::solve::search::{Filled, Found, Search};

/// A search for the cheapest sequence, as long as there is patience.
pub struct BestFirst<'a> {
    /// What is searched for.
    pub search: &'a Search<'a>,
    /// The table with all costs.
    pub filled: &'a Filled,
    /// How many sequences are searched on from, for every row of the table.
    pub patience: usize,
}

/// So many sequences of the same state, counts, row and level are searched on from, the cheapest.
const KEPT_ALIKE: u8 = 2;

/// A sequence that waits: the cost of its whole, in units of the table, the rows that remain, its number. The cheapest comes first, of
/// equals the one nearest to its end, then the oldest.
type Waiting = Reverse<(u64, u32, u32)>;

/// Remains of a sequence that ends here, less than of one that may go on.
const ENDED: u32 = 0;

fn waiting(cost: f64, remains: u32, number: u32) -> Waiting {
    // The bits of what is not negative are in order.
    Reverse((cost.to_bits(), remains, number))
}

impl BestFirst<'_> {
    /// The cheapest sequence that stays in the band with its final offsets, or the cheapest of all where patience ends before one is
    /// found; none where none was finished.
    pub fn run(&self) -> Option<Found> {
        let table = &self.filled.table;
        let mut walk = Walk::new(self.search, self.filled);
        let mut queue: BinaryHeap<Waiting> = BinaryHeap::new();
        let add = |queue: &mut BinaryHeap<Waiting>, walk: &mut Walk, (node, least): (Node, f64)| {
            queue.push(waiting(
                node.cost as f64 + least,
                node.rest.length + 1,
                walk.add(node),
            ));
        };
        let starts = self.search.starts(self.filled, |_| true);
        walk.beginnings(&starts)
            .into_iter()
            .for_each(|way| add(&mut queue, &mut walk, way));
        let mut alike = vec![0u8; table.size()];
        let mut ways: Vec<(Node, f64)> = Vec::new();
        let mut best: Option<Found> = None;
        let mut left = self.patience * table.start.len();
        while let Some(Reverse((_, remains, number))) = queue.pop() {
            let node = walk.node(number);
            if remains == ENDED {
                best = Found::better(best, walk.finished(&node, |sequence| sequence.cost));
                if best.as_ref().is_some_and(|found| !found.rank.leaves) {
                    break;
                }
                continue;
            }
            let visited = &mut alike[table.index(node.state, node.rest)];
            if *visited == KEPT_ALIKE {
                continue;
            }
            *visited += 1;
            if left == 0 {
                break;
            }
            left -= 1;
            if let Some(cost) = walk.whole_cost(&node) {
                queue.push(waiting(cost as f64, ENDED, number));
            }
            walk.follow(number, &mut ways);
            let is_open = |node: &Node| alike[table.index(node.state, node.rest)] < KEPT_ALIKE;
            let open = ways
                .drain(..)
                .filter(|(node, least)| least.is_finite() && is_open(node));
            open.for_each(|way| add(&mut queue, &mut walk, way));
        }
        best
    }
}
