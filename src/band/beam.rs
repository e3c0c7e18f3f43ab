//! A search forward along a filled table, for what the table cannot weigh: exact offsets, and repetition.

use std::rc::Rc;

use super::solver::{Filled, Found, Rank, Search};
use super::table::Rest;
use super::variety::Measure;

/// An unfinished sequence.
struct Node {
    state: u32,
    rest: Rest,
    cost: u64,
    /// The length to the goal.
    to_go: f64,
    offset: f64,
    history: Vec<u8>,
    sums: Vec<f32>,
}

/// One that may be grown from a node by a step.
struct Candidate {
    score: f64,
    state: u32,
    rest: Rest,
    to_go: f64,
    offset: f64,
    parent: Rc<Node>,
    step: usize,
}

/// The best candidates of one remaining length, the best first, not too many of a kind.
#[derive(Default)]
struct Row(Vec<Candidate>);

impl Row {
    /// Whether one of this score would be kept if it were the only one of its kind.
    fn admits(&self, score: f64, width: usize) -> bool {
        self.0.len() < width || self.0.last().is_some_and(|worst| score < worst.score)
    }

    /// Keeps one if few of its kind are better, and it is not there yet: a sequence comes by its exact and by its counted length.
    fn keep(&mut self, new: Candidate, width: usize) {
        let (mut alike, mut last) = (0, 0);
        for (i, k) in self.0.iter().enumerate().filter(|(_, k)| (k.state, k.rest) == (new.state, new.rest)) {
            if (k.score, k.to_go, k.offset) == (new.score, new.to_go, new.offset) {
                return;
            }
            (alike, last) = (alike + 1, i);
        }
        if alike == KEPT_ALIKE {
            if self.0[last].score <= new.score {
                return;
            }
            self.0.remove(last);
        }
        let at = self.0.partition_point(|k| k.score <= new.score);
        self.0.insert(at, new);
        self.0.truncate(width);
    }
}

/// A search forward among the sequences that a table says can be finished: of every remaining length the best few are kept, a
/// few of them for each state, by cost so far, least cost to the end and, where it is weighed, repetition so far. Lengths and
/// offsets are exact: the table knows them in rows and levels, whose rounding adds up along a sequence.
pub struct Beam<'a> {
    /// What is searched for.
    pub search: &'a Search<'a>,
    /// The table with all costs.
    pub filled: &'a Filled,
    /// How repetition is weighed, if it is.
    pub measure: Option<&'a Measure>,
    /// How many sequences are kept of one remaining length.
    pub width: usize,
}

/// No more of them have the same state, counts, row and level.
const KEPT_ALIKE: usize = 3;
/// Lengths that are tried.
const STARTS: usize = 12;

impl Beam<'_> {
    /// The best sequence that was seen, of those whose final offsets stay in the band if there is one; none where none was finished.
    pub fn run(&self) -> Option<Found> {
        let offsets = self.beginnings();
        let known = |row: u32| offsets.iter().any(|&offset| self.first(row, offset).is_some());
        let starts = self.search.starts(self.filled, known);
        let highest = starts.iter().copied().max()?;
        let mut rows: Vec<Row> = (0..=highest).map(|_| Row::default()).collect();
        let mut best: Option<Found> = None;
        let mut sums = Vec::new();
        // Lengths near the curve's, spread over the tolerance.
        let every = starts.len().div_ceil(STARTS).max(1);
        let starts: Vec<u32> = starts.into_iter().step_by(every).collect();
        for row in (0..=highest).rev() {
            let mut nodes: Vec<Rc<Node>> = Vec::new();
            if starts.contains(&row) {
                nodes.extend(offsets.iter().filter_map(|&offset| self.first(row, offset)).map(Rc::new));
            }
            let candidates = std::mem::take(&mut rows[row as usize]);
            nodes.extend(candidates.0.into_iter().map(|c| Rc::new(self.grown(&c, &mut sums))));
            for node in nodes {
                self.finish(&node, &mut best);
                self.expand(&node, &mut rows, &mut sums);
            }
        }
        best
    }

    /// The least cost of all, as far as the table knows; 0 where it knows none.
    pub fn least(&self) -> f64 {
        let offsets = self.beginnings();
        let cost = |row: u32| {
            let costs = offsets.iter().filter_map(|&offset| {
                let rest = self.filled.at(Rest { length: row, ..self.filled.start }, offset);
                self.filled.table.cost(0, rest)
            });
            costs.min_by(f64::total_cmp)
        };
        let starts = self.search.starts(self.filled, |_| true);
        starts.into_iter().filter_map(cost).min_by(f64::total_cmp).unwrap_or(0.0) * self.filled.units.cost
    }

    /// The offsets that the first piece may have: that of the curve; on a loop, which has no first piece, those at which it may end.
    fn beginnings(&self) -> Vec<f64> {
        if !self.search.task.closed {
            return vec![0.0];
        }
        let (low, high) = self.search.task.drift.ranges[self.search.first];
        let scaled = &self.filled.scaled;
        let offset = |level: u32| low + (high - low) * (f64::from(level) + 0.5) / f64::from(scaled.level_count);
        (scaled.end_levels.0..=scaled.end_levels.1).map(offset).collect()
    }

    /// The first piece at this offset; none when the table knows no way from there.
    fn first(&self, row: u32, offset: f64) -> Option<Node> {
        let rest = self.filled.at(Rest { length: row, ..self.filled.start }, offset);
        self.filled.table.cost(0, rest)?;
        let to_go = f64::from(row) * self.filled.units.length;
        let history = vec![self.search.first as u8];
        Some(Node { state: 0, rest, cost: 0, to_go, offset, history, sums: Vec::new() })
    }

    /// The node that a candidate stands for.
    fn grown(&self, c: &Candidate, sums: &mut Vec<f32>) -> Node {
        let states = self.search.states;
        let number = states.step_base(c.parent.state) + c.step;
        let step = states.steps(c.parent.state)[c.step];
        let piece = states.pieces[step.to as usize] as u8;
        self.repeats(&c.parent, piece, sums);
        let mut history = Vec::with_capacity(c.parent.history.len() + 1);
        history.extend_from_slice(&c.parent.history);
        history.push(piece);
        Node {
            state: step.to,
            rest: c.rest,
            cost: c.parent.cost + self.filled.scaled.costs[number],
            to_go: c.to_go,
            offset: c.offset,
            history,
            sums: sums.clone(),
        }
    }

    /// What the repetition in a node and one more piece costs; its sums are left in `sums`.
    fn repeats(&self, node: &Node, piece: u8, sums: &mut Vec<f32>) -> f64 {
        self.measure.map_or(0.0, |measure| {
            let repeats = measure.extend(&node.history, &node.sums, piece, sums);
            measure.penalty(node.history.len() + 1, repeats)
        })
    }

    /// Notes a node that may end.
    fn finish(&self, node: &Node, best: &mut Option<Found>) {
        let Filled { scaled, units, .. } = self.filled;
        let least = (node.cost + scaled.ends[node.state as usize].1) as f64 * units.cost;
        let may_be_better = best.as_ref().is_none_or(|b| Rank { leaves: false, value: least } < b.rank);
        if !may_be_better || !self.filled.ends(self.search.states, node.state, node.rest) {
            return;
        }
        let Some(sequence) = self.search.sequence(node.history.iter().map(|&p| p.into()).collect()) else { return };
        let value = self.measure.map_or(sequence.cost, |m| m.value(&sequence, self.search.task.closed));
        if self.search.meets(&sequence) {
            let rank = self.search.rank(&sequence, value);
            *best = Found::better(best.take(), Some(Found { rank, sequence }));
        }
    }

    fn expand(&self, node: &Rc<Node>, rows: &mut [Row], sums: &mut Vec<f32>) {
        let (states, filled) = (self.search.states, self.filled);
        for (k, step) in states.steps(node.state).iter().enumerate() {
            let number = states.step_base(node.state) + k;
            let piece = states.pieces[step.to as usize];
            let (low, high) = self.search.task.drift.ranges[piece as usize];
            let offset = node.offset + step.seam.rise;
            if !(low..=high).contains(&offset) {
                continue;
            }
            let to_go = node.to_go - step.length;
            let mut repeats = None;
            // The row of the exact length, and the one that the table comes to, which is sure to have a way to the end.
            let exact = libm::round(to_go / filled.units.length) as i64;
            let counted = i64::from(node.rest.length) - i64::from(filled.scaled.lengths[number]);
            for row in std::iter::once(exact).chain((counted != exact).then_some(counted)) {
                if !(0..i64::from(node.rest.length)).contains(&row) {
                    continue;
                }
                let Some(rest) = filled.after(node.rest, step, row as u32, offset) else { continue };
                let Some(least) = filled.table.cost(step.to, rest) else { continue };
                let cost = ((node.cost + filled.scaled.costs[number]) as f64 + least) * filled.units.cost;
                let kept = &mut rows[row as usize];
                if !kept.admits(cost, self.width) {
                    continue;
                }
                let score = cost + *repeats.get_or_insert_with(|| self.repeats(node, piece as u8, sums));
                if kept.admits(score, self.width) {
                    let parent = node.clone();
                    kept.keep(Candidate { score, state: step.to, rest, to_go, offset, parent, step: k }, self.width);
                }
            }
        }
    }
}
