//! The slow and obvious solver for tests: all sequences of pieces, one by one.

use std::collections::BTreeMap;

use super::alignment::joints;
use super::search::counts;
use super::task::{Demand, Problem, Task};
use crate::exemplar::seam::Seam;

/// The least cost of every triple of components, holes, and whether a component runs round.
pub type Counts = BTreeMap<(u32, u32, bool), f64>;

/// No exemplar of a test may have more sequences.
const MOST_SEQUENCES: usize = 300_000;

/// The counts of all sequences that stay in the band and whose length is off by no more than
/// `tolerance`; none when there are too many.
pub fn all_counts(problem: &Problem, tolerance: f64) -> Option<Counts> {
    some_counts(problem, tolerance, &|_| true)
}

/// As [`all_counts`], of those sequences that are `wanted`.
pub fn some_counts(
    problem: &Problem,
    tolerance: f64,
    wanted: &dyn Fn(&[usize]) -> bool,
) -> Option<Counts> {
    let mut all = All {
        problem: *problem,
        tolerance,
        wanted,
        found: BTreeMap::new(),
        left: MOST_SEQUENCES,
    };
    let pieces = problem.pieces.len();
    let firsts = if problem.task.closed { 0..pieces } else { 0..1 };
    firsts.for_each(|first| all.grow(&mut vec![first]));
    (all.left > 0).then_some(all.found)
}

/// The least cost that meets a demand.
pub fn least(found: &Counts, demand: Demand) -> Option<f64> {
    let meets = |&(&(c, h, around), _): &(&(u32, u32, bool), &f64)| {
        demand.components.is_none_or(|n| n == c)
            && demand.holes.is_none_or(|n| n == h)
            && (around || !demand.around)
    };
    found
        .iter()
        .filter(meets)
        .map(|(_, &cost)| cost)
        .min_by(f64::total_cmp)
}

struct All<'a> {
    problem: Problem<'a>,
    tolerance: f64,
    wanted: &'a dyn Fn(&[usize]) -> bool,
    found: Counts,
    left: usize,
}

impl All<'_> {
    fn grow(&mut self, sequence: &mut Vec<usize>) {
        let All {
            tolerance, wanted, ..
        } = *self;
        let Problem {
            pieces,
            seams,
            task,
        } = self.problem;
        let last = sequence[sequence.len() - 1];
        let inner = joints(seams, sequence, false).unwrap();
        let widths: f64 = sequence.iter().map(|&p| pieces[p].width).sum();
        let length = widths + inner.iter().map(|s| s.gap).sum::<f64>();
        if length > task.length + tolerance + 1e-9
            || self.left == 0
            || drifts(&inner, sequence, task)
        {
            return;
        }
        self.left -= 1;
        let ends = task.closed || last == pieces.len() - 1;
        if ends && let Some(all) = joints(seams, sequence, task.closed) {
            let length = widths + all.iter().map(|s| s.gap).sum::<f64>();
            if (length - task.length).abs() <= tolerance + 1e-9
                && wanted(sequence)
                && let Some(n) = counts(pieces, sequence, task.closed)
            {
                let cost: f64 = all.iter().map(|s| s.cost).sum();
                let least = self
                    .found
                    .entry((n.components, n.holes, n.around > 0))
                    .or_insert(f64::INFINITY);
                *least = least.min(cost);
            }
        }
        for next in (0..pieces.len()).filter(|&next| seams.get(last, next).is_some()) {
            sequence.push(next);
            self.grow(sequence);
            sequence.pop();
        }
    }
}

/// Whether the pieces leave the band when the first of them stands on the curve.
fn drifts(inner: &[Seam], sequence: &[usize], task: &Task) -> bool {
    let mut offset = 0.0;
    sequence.iter().enumerate().any(|(i, &piece)| {
        offset += if i > 0 { inner[i - 1].rise } else { 0.0 };
        let (low, high) = task.drift.ranges[piece];
        !(low..=high).contains(&offset)
    })
}
