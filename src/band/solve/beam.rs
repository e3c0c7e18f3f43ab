//! A search forward along a filled table, for what the table cannot weigh: exact offsets, and repetition.

use std::rc::Rc;

use crate::solve::autocorrelation::Measure;
use crate::solve::partial_sequence::{Node, Walk};
use crate::solve::search::{Filled, Found, Rank, Search, Sequence};

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
        for (i, k) in self
            .0
            .iter()
            .enumerate()
            .filter(|(_, k)| kind(k) == kind(&new))
        {
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
/// few of them for each state, by cost so far, least cost to the end and, where it is weighed, repetition so far.
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
        let walk = Walk::new(self.search, self.filled);
        let mut starts = self
            .search
            .starts(self.filled, |row| !walk.beginnings(&[row]).is_empty());
        let highest = starts.iter().copied().max()?;
        // Lengths near the curve's, spread over the tolerance.
        let every = starts.len().div_ceil(STARTS).max(1);
        starts = starts.into_iter().step_by(every).collect();
        let rows = (0..=highest).map(|_| Row::default()).collect();
        let mut forward = Forward {
            beam: self,
            walk,
            rows,
            best: None,
            sums: Vec::new(),
            ways: Vec::new(),
        };
        for row in (0..=highest).rev() {
            if starts.contains(&row) {
                for (node, _) in forward.walk.beginnings(&[row]) {
                    forward.visit(Candidate {
                        score: 0.0,
                        node,
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

    /// What the repetition in a sequence with one more piece costs; the sums are left in `sums`.
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
    walk: Walk<'a>,
    rows: Vec<Row>,
    best: Option<Found>,
    /// Room for the sums of one sequence.
    sums: Vec<f32>,
    /// Room for what may follow one sequence.
    ways: Vec<(Node, f64)>,
}

impl Forward<'_> {
    /// Takes a sequence as the end, and offers what may follow it to the rows.
    fn visit(&mut self, candidate: Candidate) {
        let Candidate { node, trail, .. } = candidate;
        self.finish(&node);
        let trail = self
            .beam
            .measure
            .map(|_| Rc::new(self.longer(&node, trail.as_deref())));
        let number = self.walk.add(node);
        self.walk.follow(number, &mut self.ways);
        let width = self.beam.width;
        let mut repeats: Option<(u32, f64)> = None;
        for (node, least) in self.ways.drain(..).filter(|way| way.1.is_finite()) {
            let cost = (node.cost as f64 + least) * self.beam.filled.units.cost;
            let kept = &mut self.rows[node.rest.length as usize];
            if !kept.admits(cost, width) {
                continue;
            }
            let known = repeats.filter(|r| r.0 == node.state).map(|r| r.1);
            let repeated = known.unwrap_or_else(|| {
                self.beam
                    .repeats(trail.as_deref(), node.state, &mut self.sums)
            });
            repeats = Some((node.state, repeated));
            let score = cost + repeated;
            if kept.admits(score, width) {
                kept.keep(
                    Candidate {
                        score,
                        node,
                        trail: trail.clone(),
                    },
                    width,
                );
            }
        }
    }

    /// The trail of a sequence, of which `before` is all but the last piece.
    fn longer(&mut self, node: &Node, before: Option<&Trail>) -> Trail {
        self.sums.clear();
        self.beam.repeats(before, node.state, &mut self.sums);
        let mut pieces = Vec::with_capacity(before.map_or(0, |t| t.pieces.len()) + 1);
        pieces.extend(before.iter().flat_map(|t| &t.pieces));
        pieces.push(self.beam.search.states.pieces[node.state as usize] as u8);
        Trail {
            pieces,
            sums: self.sums.clone(),
        }
    }

    /// Notes a sequence that may end.
    fn finish(&mut self, node: &Node) {
        let Some(cost) = self.walk.whole_cost(node) else {
            return;
        };
        let least = cost as f64 * self.beam.filled.units.cost;
        if self.best.as_ref().is_none_or(|b| {
            Rank {
                leaves: false,
                value: least,
            } < b.rank
        }) {
            let closed = self.beam.search.task.closed;
            let value = |s: &Sequence| self.beam.measure.map_or(s.cost, |m| m.value(s, closed));
            self.best = Found::better(self.best.take(), self.walk.finished(node, value));
        }
    }
}
