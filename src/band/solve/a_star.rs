//! A* (Hart, Nilsson, Raphael 1968): goes on from the partial sequence whose whole costs least.
//! What the rest costs at least is known from the table of the dynamic program, so that the
//! estimate is exact but for the rounding of lengths and offsets.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use fretwork_geometry::budget;

use super::partial_sequence::{PartialSequences, Way};
use super::search::{CostTable, Search};
use super::task::Found;

/// A search for the cheapest sequence, which ends when patience does.
pub struct AStar<'a> {
    /// What is searched for.
    pub search: &'a Search<'a>,
    /// The table with all costs.
    pub table: &'a CostTable,
    /// How many sequences are gone on from, for every row of the table.
    pub patience: usize,
}

/// How many sequences with the same state, counts, row and level are gone on from; these are the
/// cheapest. With one, a sequence that fits a level by its rounding alone hides the one that fits
/// exactly; each more multiplies the work.
const KEPT_ALIKE: u8 = 2;

/// Steps for a partial sequence that is looked at; they also bound how many are held.
const STEPS: u64 = 30;

/// A partial sequence that waits: the cost of its whole in units of the table, the rows that
/// remain, and its number. The cheapest comes first, of equals the one nearest to its end, then the
/// oldest. The cost is given by its bits, which are in order for numbers that are not negative.
type Waiting = Reverse<(u64, u32, u32)>;

/// The remaining rows of a sequence that ends here. One that may go on has one more than its rows,
/// so that the finished one comes first.
const ENDED: u32 = 0;

/// The partial sequences that wait, with all that were taken in.
struct Queue<'a> {
    sequences: PartialSequences<'a>,
    waiting: BinaryHeap<Waiting>,
}

impl Queue<'_> {
    fn push(&mut self, (sequence, least): Way) {
        let cost = sequence.cost as f64 + least;
        let remains = sequence.rest.length + 1;
        let number = self.sequences.add(sequence);
        self.waiting
            .push(Reverse((cost.to_bits(), remains, number)));
    }

    fn push_ended(&mut self, cost: u64, number: u32) {
        let cost = cost as f64;
        self.waiting.push(Reverse((cost.to_bits(), ENDED, number)));
    }
}

impl AStar<'_> {
    /// The cheapest sequence that stays in the band with its final offsets. Where patience ends
    /// before one is found it is the best of those that were finished; none where none was.
    pub fn run(&self) -> Option<Found> {
        let to_go = &self.table.to_go;
        let mut queue = Queue {
            sequences: PartialSequences::new(self.search, self.table),
            waiting: BinaryHeap::new(),
        };
        let starts = self.search.starts(self.table, |_| true);
        for way in queue.sequences.beginnings(&starts) {
            queue.push(way);
        }
        let mut alike = vec![0u8; to_go.size()];
        let mut ways: Vec<Way> = Vec::new();
        let mut best: Option<Found> = None;
        let mut left = self.patience * to_go.start.len();
        while let Some(Reverse((_, remains, number))) = queue.waiting.pop() {
            let last = queue.sequences.get(number);
            if remains == ENDED {
                best = Found::better(best, queue.sequences.finished(&last, |s| s.cost));
                if best.as_ref().is_some_and(|found| !found.rank.leaves) {
                    break;
                }
                continue;
            }
            let visited = &mut alike[to_go.index(last.state, last.rest)];
            if *visited == KEPT_ALIKE {
                continue;
            }
            *visited += 1;
            if left == 0 {
                break;
            }
            left -= 1;
            if let Some(cost) = queue.sequences.whole_cost(&last) {
                queue.push_ended(cost, number);
            }
            queue.sequences.follow(number, &mut ways);
            budget::spend("partial sequences", STEPS * (1 + ways.len() as u64));
            for way in ways.drain(..) {
                let open = alike[to_go.index(way.0.state, way.0.rest)] < KEPT_ALIKE;
                if way.1.is_finite() && open {
                    queue.push(way);
                }
            }
        }
        best
    }
}
