//! A beam search forward along a filled table, for what the table cannot weigh: exact offsets, and
//! repetition.

use std::rc::Rc;

use fretwork_geometry::budget;

use super::autocorrelation::Measure;
use super::partial_sequence::{PartialSequence, PartialSequences, Way};
use super::search::{CostTable, Search};
use super::task::{Found, Rank, Sequence};

/// The pieces of a sequence and the sums by which its repetition is measured.
struct Trail {
    pieces: Vec<u8>,
    /// The sum of likenesses for each lag, from 1.
    sums: Vec<f32>,
}

/// A sequence that the search may go on from.
struct Candidate {
    score: f64,
    sequence: PartialSequence,
    /// The trail of the sequence without its last piece, where repetition is weighed.
    trail: Option<Rc<Trail>>,
}

impl Candidate {
    /// Candidates of one kind differ only in exact length and offset, and in what lies behind them.
    fn is_of_kind(&self, other: &Candidate) -> bool {
        let kind = |c: &Candidate| (c.sequence.state, c.sequence.rest);
        kind(self) == kind(other)
    }

    /// Whether two candidates of one kind are the same sequence, as far as can be seen.
    fn is_same(&self, other: &Candidate) -> bool {
        let place = |c: &Candidate| (c.score, c.sequence.to_go, c.sequence.offset);
        place(self) == place(other)
    }
}

/// The best candidates with one remaining length, the best first, and not too many of a kind.
#[derive(Default)]
struct Row(Vec<Candidate>);

impl Row {
    /// Whether a candidate of this score would be kept if it were the only one of its kind.
    fn admits(&self, score: f64, width: usize) -> bool {
        self.0.len() < width || self.0.last().is_some_and(|worst| score < worst.score)
    }

    /// Keeps an admitted candidate if few of its kind are better and it is not there yet. The same
    /// sequence can come twice: by its exact length and by its counted length.
    fn keep(&mut self, new: Candidate, width: usize) {
        let (mut alike, mut last) = (0, 0);
        for (i, kept) in self.0.iter().enumerate() {
            if !kept.is_of_kind(&new) {
                continue;
            }
            if kept.is_same(&new) {
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

/// A search forward among the sequences that a table says can be finished. Of those with the same
/// remaining length the best few are kept, and few of them for each state. The score is the cost so
/// far, the least cost to the end and, where it is weighed, the repetition so far.
pub struct Beam<'a> {
    /// What is searched for.
    pub search: &'a Search<'a>,
    /// The table with all costs.
    pub table: &'a CostTable,
    /// How repetition is weighed, if it is.
    pub measure: Option<&'a Measure>,
    /// How many sequences are kept for one remaining length.
    pub width: usize,
}

/// How many kept sequences may have the same state, counts, row and level. With one, the cheapest
/// hides those that drift or repeat themselves less; with many, a row holds nothing else.
const KEPT_ALIKE: usize = 3;
/// How many lengths are tried. Fewer may miss the length that fits best; more share the width of
/// the beam among sequences that differ only in length.
const STARTS: usize = 12;

/// Steps for a way to go on, and for a piece of a trail, which is copied; they also bound how long trails are.
const WAY_STEPS: usize = 10;
const PIECE_STEPS: usize = 5;

impl Beam<'_> {
    /// The best sequence that was seen. One whose final offsets stay in the band is better than any
    /// that leaves it. None where none was finished.
    pub fn run(&self) -> Option<Found> {
        let sequences = PartialSequences::new(self.search, self.table);
        let can_begin = |row| !sequences.beginnings(&[row]).is_empty();
        let mut starts = self.search.starts(self.table, can_begin);
        let highest = starts.iter().copied().max()?;
        // Lengths near the curve's, spread over the tolerance.
        let every = starts.len().div_ceil(STARTS).max(1);
        starts = starts.into_iter().step_by(every).collect();
        let mut forward = Forward {
            beam: self,
            sequences,
            rows: (0..=highest).map(|_| Row::default()).collect(),
            best: None,
            sums: Vec::new(),
            ways: Vec::new(),
        };
        for row in (0..=highest).rev() {
            if starts.contains(&row) {
                for (sequence, _) in forward.sequences.beginnings(&[row]) {
                    forward.visit(Candidate {
                        score: 0.0,
                        sequence,
                        trail: None,
                    });
                }
            }
            for candidate in std::mem::take(&mut forward.rows[row as usize].0) {
                forward.visit(candidate);
            }
        }
        forward.best
    }

    /// What the repetition costs in a sequence with one more piece. Its sums are left in `sums`.
    fn repeats(&self, trail: Option<&Trail>, state: u32, sums: &mut Vec<f32>) -> f64 {
        let (Some(measure), Some(trail)) = (self.measure, trail) else {
            return 0.0;
        };
        let piece = self.search.states.pieces[state as usize] as u8;
        let repeats = measure.extend(&trail.pieces, &trail.sums, piece, sums);
        measure.penalty(trail.pieces.len() + 1, repeats)
    }
}

/// A search under way.
struct Forward<'a> {
    beam: &'a Beam<'a>,
    sequences: PartialSequences<'a>,
    /// The candidates by remaining rows.
    rows: Vec<Row>,
    best: Option<Found>,
    /// A buffer for the sums of one sequence.
    sums: Vec<f32>,
    /// A buffer for what may follow one sequence.
    ways: Vec<Way>,
}

impl Forward<'_> {
    /// Takes a sequence as the end, and offers what may follow it to the rows.
    fn visit(&mut self, candidate: Candidate) {
        let Candidate {
            sequence, trail, ..
        } = candidate;
        self.finish(&sequence);
        let measure = self.beam.measure;
        let trail = measure.map(|_| Rc::new(self.longer(&sequence, trail.as_deref())));
        let number = self.sequences.add(sequence);
        self.sequences.follow(number, &mut self.ways);
        let pieces = trail.as_ref().map_or(0, |trail| trail.pieces.len());
        let steps = WAY_STEPS * (1 + self.ways.len()) + PIECE_STEPS * pieces;
        budget::spend("partial sequences", steps as u64);
        let width = self.beam.width;
        // Ways to one state come one after the other, and repeat themselves alike.
        let mut repeats: Option<(u32, f64)> = None;
        for (sequence, least) in self.ways.drain(..).filter(|way| way.1.is_finite()) {
            let cost = (sequence.cost as f64 + least) * self.beam.table.units.cost;
            let kept = &mut self.rows[sequence.rest.length as usize];
            if !kept.admits(cost, width) {
                continue;
            }
            let state = sequence.state;
            let known = repeats.filter(|r| r.0 == state).map(|r| r.1);
            let repeated =
                known.unwrap_or_else(|| self.beam.repeats(trail.as_deref(), state, &mut self.sums));
            repeats = Some((state, repeated));
            let score = cost + repeated;
            if kept.admits(score, width) {
                let trail = trail.clone();
                let candidate = Candidate {
                    score,
                    sequence,
                    trail,
                };
                kept.keep(candidate, width);
            }
        }
    }

    /// The trail of a sequence; `before` is the trail without its last piece.
    fn longer(&mut self, sequence: &PartialSequence, before: Option<&Trail>) -> Trail {
        self.sums.clear();
        self.beam.repeats(before, sequence.state, &mut self.sums);
        let mut pieces = Vec::with_capacity(before.map_or(0, |t| t.pieces.len()) + 1);
        pieces.extend(before.iter().flat_map(|t| &t.pieces));
        pieces.push(self.beam.search.states.pieces[sequence.state as usize] as u8);
        Trail {
            pieces,
            sums: self.sums.clone(),
        }
    }

    /// Notes a sequence that may end, if it can be better than the best so far.
    fn finish(&mut self, sequence: &PartialSequence) {
        let Some(cost) = self.sequences.whole_cost(sequence) else {
            return;
        };
        let best_possible = Rank {
            leaves: false,
            value: cost as f64 * self.beam.table.units.cost,
        };
        if self.best.as_ref().is_none_or(|b| best_possible < b.rank) {
            let closed = self.beam.search.problem.task.closed;
            let value = |s: &Sequence| self.beam.measure.map_or(s.cost, |m| m.value(s, closed));
            let found = self.sequences.finished(sequence, value);
            self.best = Found::better(self.best.take(), found);
        }
    }
}
