//! Which lengths and counts sequences of pieces can have at all. It is asked only for the error
//! that says why a pattern cannot be made; costs and offsets play no part.

use std::collections::BTreeSet;

use super::closed::beginnings;
use super::quantize::{Limits, Tracked, quantize};
use super::quantized::{Keep, Quantized};
use super::states::{States, Step};
use super::task::{Demand, Problem, Task};

/// The lengths and counts that can be had.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Feasible {
    /// Lengths up to a third above the curve's, whatever the counts; ascending.
    pub lengths: Vec<f64>,
    /// Numbers of components within the tolerance of the length, whatever the holes.
    pub components: BTreeSet<u32>,
    /// Numbers of holes within the tolerance of the length: in one component where one is asked
    /// for, else whatever the components.
    pub holes: BTreeSet<u32>,
}

/// Counts from this on are not listed. A bit set of this size is 256 bytes a cell; more would only
/// help patterns of thousands of holes, whose list nobody reads.
const MOST_COUNT: usize = 2048;
/// Lengths up to this multiple of the curve's are listed: far enough to name the nearest one above.
const FARTHEST: f64 = 1.34;

/// Searches all sequences. Exact but for the rounding of lengths.
pub fn feasible(problem: &Problem) -> Feasible {
    let mut found = Feasible::default();
    let firsts = if problem.task.closed {
        beginnings(problem.pieces, problem.seams)
    } else {
        vec![(0, vec![true; problem.pieces.len()])]
    };
    for (first, allowed) in firsts {
        add_beginning(problem, first, &allowed, &mut found);
    }
    found.lengths.sort_by(f64::total_cmp);
    found.lengths.dedup();
    found
}

/// Adds what sequences can have that begin with `first` and go on with `allowed` pieces.
fn add_beginning(problem: &Problem, first: usize, allowed: &[bool], found: &mut Feasible) {
    let task = problem.task;
    // A demand for so many that none has them makes the states keep the counts.
    let any_components = Demand {
        components: Some(u32::MAX),
        holes: None,
        around: task.demand.around,
    };
    let any_holes = Demand {
        components: task.demand.components.filter(|&n| n == 1),
        holes: Some(u32::MAX),
        around: task.demand.around,
    };
    let states = |demand: Demand| {
        let task = &Task {
            demand,
            ..task.clone()
        };
        let problem = &Problem { task, ..*problem };
        let states = if task.closed {
            States::closed(problem, first, allowed.to_vec())
        } else {
            States::open(problem)
        };
        states.unwrap_or_default()
    };
    let (with_components, with_holes) = (states(any_components), states(any_holes));
    let width = problem.pieces[first].width;
    let lengths = sums(&with_components, width, FARTHEST * task.length, None);
    found.lengths.extend(lengths.into_iter().map(|s| s.0));
    for (counter, states, set) in [
        (Counter::Components, &with_components, &mut found.components),
        (Counter::Holes, &with_holes, &mut found.holes),
    ] {
        let longest = task.length + task.tolerance;
        for (length, counts) in sums(states, width, longest, Some(counter)) {
            if (length - task.length).abs() <= task.tolerance * (1.0 + 1e-9) {
                set.extend(counts);
            }
        }
    }
}

/// Which of the two counts is asked for.
#[derive(Clone, Copy)]
enum Counter {
    Components,
    Holes,
}

impl Counter {
    fn of(self, step: &Step) -> u32 {
        match self {
            Counter::Components => step.components,
            Counter::Holes => step.holes,
        }
    }
}

/// A set of counts: bit n stands for the count n.
type Bits = Vec<u64>;

/// The lengths up to `longest` that patterns can have, each with the counts at that length.
fn sums(
    states: &States,
    first: f64,
    longest: f64,
    counter: Option<Counter>,
) -> Vec<(f64, Vec<u32>)> {
    let remaining = longest - first;
    if states.is_empty() || remaining < 0.0 {
        return Vec::new();
    }
    let limits = Limits {
        longest: remaining,
        components: None,
        holes: None,
        keep: Keep::Choices,
    };
    let (quantized, units) = quantize(states, &limits, Tracked::Nothing);
    let words = counter.map_or(1, |_| MOST_COUNT / 64);
    let base = match counter {
        Some(Counter::Components) => states.start.0,
        Some(Counter::Holes) => states.start.1,
        None => 0,
    };
    let sets = fill(states, &quantized, words, counter);
    sets.into_iter()
        .enumerate()
        .filter(|(_, bits)| bits.iter().any(|&w| w != 0))
        .map(|(row, bits)| {
            let is_in = |n: &u32| bits[*n as usize / 64] >> (n % 64) & 1 == 1;
            let counts = (0..words as u32 * 64).filter(is_in);
            let length = first + row as f64 * units.length;
            (length, counts.map(|n| n + base).collect())
        })
        .collect()
}

/// For every remaining length, the sets of counts with which the first state can be finished.
fn fill(
    states: &States,
    quantized: &Quantized,
    words: usize,
    counter: Option<Counter>,
) -> Vec<Bits> {
    let depth = quantized.lengths.iter().copied().max().unwrap_or(1) as usize + 1;
    let mut ring: Vec<Vec<Bits>> = vec![vec![vec![0; words]; depth]; states.len()];
    let mut start = Vec::new();
    for row in 0..=quantized.longest as usize {
        for state in 0..states.len() {
            let mut bits: Bits = vec![0; words];
            let ends_here = quantized.ends[state].0 as usize == row;
            if let Some(end) = states.ends[state].filter(|_| ends_here) {
                let count = match counter {
                    Some(Counter::Components) => end.components,
                    Some(Counter::Holes) => end.holes,
                    None => 0,
                };
                if (count as usize) < words * 64 {
                    bits[count as usize / 64] |= 1 << (count % 64);
                }
            }
            for (k, step) in states.steps(state as u32).iter().enumerate() {
                let length = quantized.lengths[states.step_base(state as u32) + k] as usize;
                if length <= row {
                    let from = &ring[step.to as usize][(row - length) % depth];
                    shift_into(&mut bits, from, counter.map_or(0, |c| c.of(step)) as usize);
                }
            }
            ring[state][row % depth] = bits;
        }
        start.push(ring[0][row % depth].clone());
    }
    start
}

/// Adds the counts of the set `from`, each raised by `by`.
fn shift_into(bits: &mut Bits, from: &Bits, by: usize) {
    let (words, rest) = (by / 64, by % 64);
    for i in (words..bits.len()).rev() {
        let high = from[i - words] << rest;
        let low = if rest > 0 && i > words {
            from[i - words - 1] >> (64 - rest)
        } else {
            0
        };
        bits[i] |= high | low;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_shift_across_words() {
        let mut bits = vec![0, 0];
        shift_into(&mut bits, &vec![1 << 63 | 1, 0], 1);
        assert_eq!(bits, [2, 1]);
        shift_into(&mut bits, &vec![1, 0], 64);
        assert_eq!(bits, [2, 1]);
    }
}
