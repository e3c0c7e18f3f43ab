//! A search forward along a filled table, for what the table cannot weigh: exact offsets, and repetition.

use std::rc::Rc;

use super::solver::{Filled, Found, Rank, Search};
use super::table::Rest;
use super::variety::Measure;

/// An unfinished sequence.
#[derive(Clone, Copy)]
struct Node {
    /// The number of the sequence without its last piece.
    before: u32,
    state: u32,
    rest: Rest,
    cost: u64,
    /// The length to the goal.
    to_go: f64,
    offset: f64,
}

/// What stands before a first piece.
const NOTHING: u32 = u32::MAX;

/// What the repetition of a sequence is measured by, where it is.
struct Trail {
    pieces: Vec<u8>,
    sums: Vec<f32>,
}

/// A sequence that may be searched on from.
struct Candidate {
    score: f64,
    node: Node,
    /// That of the sequence before.
    trail: Option<Rc<Trail>>,
}

/// The best candidates of one remaining length, the best first, not too many of a kind.
#[derive(Default)]
struct Row(Vec<Candidate>);

impl Row {
    /// Whether one of this score would be kept if it were the only one of its kind.
    fn admits(&self, score: f64, width: usize) -> bool {
        self.0.len() < width || self.0.last().is_some_and(|worst| score < worst.score)
    }

    /// Keeps one that is admitted if few of its kind are better, and it is not there yet: a sequence comes by its exact and by its
    /// counted length.
    fn keep(&mut self, new: Candidate, width: usize) {
        let (mut alike, mut last) = (0, 0);
        let kind = |c: &Candidate| (c.node.state, c.node.rest);
        let place = |c: &Candidate| (c.score, c.node.to_go, c.node.offset);
        for (i, k) in self.0.iter().enumerate().filter(|(_, k)| kind(k) == kind(&new)) {
            if place(k) == place(&new) {
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
        self.0.truncate(width - 1);
        let at = self.0.partition_point(|k| k.score <= new.score);
        self.0.insert(at, new);
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
        // Lengths near the curve's, spread over the tolerance.
        let every = starts.len().div_ceil(STARTS).max(1);
        let starts: Vec<u32> = starts.into_iter().step_by(every).collect();
        let rows = (0..=highest).map(|_| Row::default()).collect();
        let mut forward =
            Forward { beam: self, nodes: Vec::new(), rows, best: None, sums: Vec::new(), ways: Vec::new() };
        for row in (0..=highest).rev() {
            if starts.contains(&row) {
                for node in offsets.iter().filter_map(|&offset| self.first(row, offset)) {
                    forward.visit(Candidate { score: 0.0, node, trail: None });
                }
            }
            for candidate in std::mem::take(&mut forward.rows[row as usize].0) {
                forward.visit(candidate);
            }
        }
        forward.best
    }

    /// The least cost of all, as far as the table knows; 0 where it knows none.
    pub fn least(&self) -> f64 {
        let offsets = self.beginnings();
        let cost = |row: u32| {
            let rest = Rest { length: row, ..self.filled.start };
            let costs = offsets.iter().map(|&offset| self.filled.table.cost(0, self.filled.at(rest, offset)));
            costs.fold(f64::INFINITY, f64::min)
        };
        let starts = self.search.starts(self.filled, |_| true);
        let least = starts.into_iter().map(cost).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least * self.filled.units.cost } else { 0.0 }
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
        let to_go = f64::from(row) * self.filled.units.length;
        let node = Node { before: NOTHING, state: 0, rest, cost: 0, to_go, offset };
        self.filled.table.cost(0, rest).is_finite().then_some(node)
    }

    /// What the repetition in a sequence with one more piece costs; the sums are left in `sums`.
    fn repeats(&self, trail: Option<&Trail>, state: u32, sums: &mut Vec<f32>) -> f64 {
        let (Some(measure), Some(trail)) = (self.measure, trail) else { return 0.0 };
        let piece = self.search.states.pieces[state as usize] as u8;
        let repeats = measure.extend(&trail.pieces, &trail.sums, piece, sums);
        measure.penalty(trail.pieces.len() + 1, repeats)
    }
}

/// A search under way.
struct Forward<'a> {
    beam: &'a Beam<'a>,
    /// All sequences that were visited.
    nodes: Vec<Node>,
    rows: Vec<Row>,
    best: Option<Found>,
    /// Room for the sums of one sequence.
    sums: Vec<f32>,
    /// Room for what may follow one sequence, each with the least cost to the end.
    ways: Vec<(Node, f64)>,
}

impl Forward<'_> {
    /// Takes a sequence as the end, and searches on from it.
    fn visit(&mut self, candidate: Candidate) {
        let Candidate { node, trail, .. } = candidate;
        self.nodes.push(node);
        self.finish(&node);
        let trail = self.beam.measure.map(|_| Rc::new(self.longer(&node, trail.as_deref())));
        self.expand(&node, trail);
    }

    /// The trail of a sequence, of which `before` is all but the last piece.
    fn longer(&mut self, node: &Node, before: Option<&Trail>) -> Trail {
        self.sums.clear();
        self.beam.repeats(before, node.state, &mut self.sums);
        let mut pieces = Vec::with_capacity(before.map_or(0, |t| t.pieces.len()) + 1);
        pieces.extend(before.iter().flat_map(|t| &t.pieces));
        pieces.push(self.beam.search.states.pieces[node.state as usize] as u8);
        Trail { pieces, sums: self.sums.clone() }
    }

    /// The pieces of a sequence.
    fn pieces(&self, node: &Node) -> Vec<usize> {
        let before = |n: &&Node| self.nodes.get(n.before as usize);
        let nodes = std::iter::successors(Some(node), before);
        let mut pieces: Vec<usize> = nodes.map(|n| self.beam.search.states.pieces[n.state as usize].into()).collect();
        pieces.reverse();
        pieces
    }

    /// Notes a sequence that may end.
    fn finish(&mut self, node: &Node) {
        let Beam { search, filled, measure, .. } = *self.beam;
        let least = (node.cost + filled.scaled.ends[node.state as usize].1) as f64 * filled.units.cost;
        let may_be_better = self.best.as_ref().is_none_or(|b| Rank { leaves: false, value: least } < b.rank);
        if !may_be_better || !filled.ends(search.states, node.state, node.rest) {
            return;
        }
        let Some(sequence) = search.sequence(self.pieces(node)) else { return };
        let value = measure.map_or(sequence.cost, |m| m.value(&sequence, search.task.closed));
        if search.meets(&sequence) {
            let rank = search.rank(&sequence, value);
            self.best = Found::better(self.best.take(), Some(Found { rank, sequence }));
        }
    }

    /// Offers every step from the last node visited to the row of its exact length, and to the one that the table comes to, which
    /// is sure to have a way to the end.
    fn expand(&mut self, node: &Node, trail: Option<Rc<Trail>>) {
        let Beam { search, filled, width, .. } = *self.beam;
        let (states, base) = (search.states, search.states.step_base(node.state));
        let before = self.nodes.len() as u32 - 1;
        for (k, step) in states.steps(node.state).iter().enumerate() {
            let (low, high) = search.task.drift.ranges[states.pieces[step.to as usize] as usize];
            let offset = node.offset + step.seam.rise;
            if !(low..=high).contains(&offset) {
                continue;
            }
            let Some(rest) = filled.after(node.rest, step, 0, offset) else { continue };
            let (to_go, cost) = (node.to_go - step.length, node.cost + filled.scaled.costs[base + k]);
            let exact = libm::round(to_go / filled.units.length) as i64;
            let counted = i64::from(node.rest.length) - i64::from(filled.scaled.lengths[base + k]);
            for row in std::iter::once(exact).chain((counted != exact).then_some(counted)) {
                if (0..i64::from(node.rest.length)).contains(&row) {
                    let rest = Rest { length: row as u32, ..rest };
                    let least = filled.table.cost(step.to, rest);
                    self.ways.push((Node { before, state: step.to, rest, cost, to_go, offset }, least));
                }
            }
        }
        // The costs are read before any is compared: memory is waited for once.
        let mut repeats: Option<(u32, f64)> = None;
        for (node, least) in self.ways.drain(..).filter(|way| way.1.is_finite()) {
            let cost = (node.cost as f64 + least) * filled.units.cost;
            let kept = &mut self.rows[node.rest.length as usize];
            if !kept.admits(cost, width) {
                continue;
            }
            let known = repeats.filter(|r| r.0 == node.state).map(|r| r.1);
            let repeated = known.unwrap_or_else(|| self.beam.repeats(trail.as_deref(), node.state, &mut self.sums));
            repeats = Some((node.state, repeated));
            let score = cost + repeated;
            if kept.admits(score, width) {
                kept.keep(Candidate { score, node, trail: trail.clone() }, width);
            }
        }
    }
}
