//! Unfinished sequences of pieces, among those that a filled table says can be finished. They carry
//! exact lengths and offsets, because the table knows these only in rows and levels, whose rounding
//! adds up along a sequence. Which of them is searched next is decided by A* and the beam.

use super::quantized::Remaining;
use super::search::{CostTable, Search};
use super::task::{Found, Sequence};

/// An unfinished sequence.
#[derive(Clone, Copy)]
pub struct PartialSequence {
    /// The number of the sequence without its last piece.
    before: u32,
    /// Its state in the solver's graph.
    pub state: u32,
    /// What remains, as the table counts it.
    pub rest: Remaining,
    /// The cost so far, in units of the table.
    pub cost: u64,
    /// The exact length to the goal.
    pub to_go: f64,
    /// The exact offset of the last piece.
    pub offset: f64,
}

/// A partial sequence, and what the rest of it costs at least in units of the table: infinite where
/// the table knows no way to the end.
pub type Way = (PartialSequence, f64);

/// The number that stands before a first piece.
const NOTHING: u32 = u32::MAX;

/// All partial sequences that a search has taken in.
pub struct PartialSequences<'a> {
    search: &'a Search<'a>,
    /// The table with all costs.
    table: &'a CostTable,
    list: Vec<PartialSequence>,
}

impl<'a> PartialSequences<'a> {
    /// None yet.
    pub fn new(search: &'a Search<'a>, table: &'a CostTable) -> PartialSequences<'a> {
        PartialSequences {
            search,
            table,
            list: Vec::new(),
        }
    }

    /// Takes in a sequence and returns its number.
    pub fn add(&mut self, sequence: PartialSequence) -> u32 {
        self.list.push(sequence);
        self.list.len() as u32 - 1
    }

    /// The sequence with this number.
    pub fn get(&self, number: u32) -> PartialSequence {
        self.list[number as usize]
    }

    /// The first piece, for each of `rows` that may remain after it and at each offset that it may
    /// have. Only ways to an end are listed.
    pub fn beginnings(&self, rows: &[u32]) -> Vec<Way> {
        let offsets = self.first_offsets();
        let beginning = |row: u32, offset: f64| {
            let rest = Remaining {
                length: row,
                ..self.table.start
            };
            let rest = self.table.at(rest, offset);
            let first = PartialSequence {
                before: NOTHING,
                state: 0,
                rest,
                cost: 0,
                to_go: f64::from(row) * self.table.units.length,
                offset,
            };
            (first, self.table.to_go.cost(0, rest))
        };
        let all = rows
            .iter()
            .flat_map(|&row| offsets.iter().map(move |&offset| beginning(row, offset)));
        all.filter(|(_, least)| least.is_finite()).collect()
    }

    /// The offsets that the first piece may have. On an open curve it stands on the curve. A loop
    /// has no first piece: there they are those at which the loop may end.
    fn first_offsets(&self) -> Vec<f64> {
        let task = self.search.problem.task;
        if !task.closed {
            return vec![0.0];
        }
        let (low, high) = task.drift.ranges[self.search.first];
        let quantized = &self.table.quantized;
        let offset = |level: u32| {
            low + (high - low) * (f64::from(level) + 0.5) / f64::from(quantized.level_count)
        };
        (quantized.end_levels.0..=quantized.end_levels.1)
            .map(offset)
            .collect()
    }

    /// Lists what may follow a sequence. Every step leads to the row of its exact length, and also
    /// to the row that the table comes to, from which there is sure to be a way to the end.
    pub fn follow(&self, number: u32, ways: &mut Vec<Way>) {
        let (search, table) = (self.search, self.table);
        ways.clear();
        let last = self.get(number);
        let base = search.states.step_base(last.state);
        for (k, step) in search.states.steps(last.state).iter().enumerate() {
            let piece = search.states.pieces[step.to as usize];
            let (low, high) = search.problem.task.drift.ranges[piece as usize];
            let offset = last.offset + step.seam.rise;
            if !(low..=high).contains(&offset) {
                continue;
            }
            let Some(rest) = table.after(last.rest, step, 0, offset) else {
                continue;
            };
            let longer = PartialSequence {
                before: number,
                state: step.to,
                rest,
                cost: last.cost + table.quantized.costs[base + k],
                to_go: last.to_go - step.length,
                offset,
            };
            let exact = libm::round(longer.to_go / table.units.length) as i64;
            let taken = i64::from(table.quantized.lengths[base + k]);
            let counted = i64::from(last.rest.length) - taken;
            for row in std::iter::once(exact).chain((counted != exact).then_some(counted)) {
                if (0..i64::from(last.rest.length)).contains(&row) {
                    let length = row as u32;
                    let rest = Remaining { length, ..rest };
                    let least = table.to_go.cost(step.to, rest);
                    ways.push((PartialSequence { rest, ..longer }, least));
                }
            }
        }
    }

    /// The cost of the whole, in units of the table, if the sequence may end here.
    pub fn whole_cost(&self, last: &PartialSequence) -> Option<u64> {
        let ends = self.table.ends(self.search.states, last.state, last.rest);
        ends.then(|| last.cost + self.table.quantized.ends[last.state as usize].1)
    }

    /// The whole sequence that ends with `last`, unless its length misses the curve's. `value` says
    /// how good it is.
    pub fn finished(
        &self,
        last: &PartialSequence,
        value: impl Fn(&Sequence) -> f64,
    ) -> Option<Found> {
        let before = |s: &&PartialSequence| self.list.get(s.before as usize);
        let backward = std::iter::successors(Some(last), before);
        let mut pieces: Vec<usize> = backward
            .map(|s| self.search.states.pieces[s.state as usize].into())
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
