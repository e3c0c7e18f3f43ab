//! Which lengths and counts can be had at all, for the error that says why a pattern cannot be made.

use std::collections::BTreeSet;

use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;
use crate::solve::closed::beginnings;
use crate::solve::cost_to_go::{Keep, Scaled};
use crate::solve::quantize::{Limits, Tracked, scale};
use crate::solve::search::Task;
use crate::solve::states::{Demand, States, Step};

/// What sequences of pieces can be had.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reach {
    /// Lengths up to a third above the curve's, whatever the counts.
    pub lengths: Vec<f64>,
    /// Numbers of components within the tolerance of the length, whatever the holes.
    pub components: BTreeSet<u32>,
    /// Numbers of holes, with the asked number of components where that is none or one, else whatever the components.
    pub holes: BTreeSet<u32>,
}

/// Counts above this are not told apart from none.
const MOST_COUNT: usize = 2048;

/// Searches all sequences for `task`. Exact but for the rounding of lengths.
pub fn reach(pieces: &[Piece], seams: &Seams, task: &Task) -> Reach {
    let mut found = Reach::default();
    let around = task.demand.around;
    let any = Demand {
        components: Some(u32::MAX),
        holes: None,
        around,
    };
    let asked = Demand {
        components: task.demand.components.filter(|&n| n == 1),
        holes: Some(u32::MAX),
        around,
    };
    let firsts = if task.closed {
        beginnings(pieces, seams)
    } else {
        vec![(0, vec![true; pieces.len()])]
    };
    for (first, allowed) in firsts {
        let states = |demand: Demand| {
            let states = if task.closed {
                States::closed(pieces, seams, demand, first, allowed.clone())
            } else {
                States::open(pieces, seams, demand)
            };
            states.unwrap_or_default()
        };
        let width = pieces[first].width;
        let (with_any, with_asked) = (states(any), states(asked));
        found.lengths.extend(
            sums(&with_any, width, 1.34 * task.length, None)
                .into_iter()
                .map(|s| s.0),
        );
        for (counter, states, set) in [
            (Counter::Components, &with_any, &mut found.components),
            (Counter::Holes, &with_asked, &mut found.holes),
        ] {
            for (length, counts) in sums(states, width, task.length + task.tolerance, Some(counter))
            {
                if (length - task.length).abs() <= task.tolerance * (1.0 + 1e-9) {
                    set.extend(counts);
                }
            }
        }
    }
    found.lengths.sort_by(f64::total_cmp);
    found.lengths.dedup();
    found
}

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

type Bits = Vec<u64>;

/// The lengths up to `longest` that patterns can have, each with the counts at that length.
fn sums(
    states: &States,
    first: f64,
    longest: f64,
    counter: Option<Counter>,
) -> Vec<(f64, Vec<u32>)> {
    let rest = longest - first;
    if states.is_empty() || rest < 0.0 {
        return Vec::new();
    }
    let limits = Limits {
        longest: rest,
        components: None,
        holes: None,
        keep: Keep::Choices,
    };
    let (scaled, units) = scale(states, &limits, Tracked::Nothing);
    let words = if counter.is_some() {
        MOST_COUNT / 64
    } else {
        1
    };
    let base = match counter {
        Some(Counter::Components) => states.start.0,
        Some(Counter::Holes) => states.start.1,
        None => 0,
    };
    let sets = fill(states, &scaled, words, counter);
    sets.into_iter()
        .enumerate()
        .filter(|(_, bits)| bits.iter().any(|&w| w != 0))
        .map(|(row, bits)| {
            let counts =
                (0..words as u32 * 64).filter(|&n| bits[n as usize / 64] >> (n % 64) & 1 == 1);
            (
                first + row as f64 * units.length,
                counts.map(|n| n + base).collect(),
            )
        })
        .collect()
}

/// For every remaining length, the sets of counts with which the first state can be finished.
fn fill(states: &States, scaled: &Scaled, words: usize, counter: Option<Counter>) -> Vec<Bits> {
    let depth = scaled.lengths.iter().copied().max().unwrap_or(1) as usize + 1;
    let mut ring: Vec<Vec<Bits>> = vec![vec![vec![0; words]; depth]; states.len()];
    let mut start = Vec::new();
    for row in 0..=scaled.longest as usize {
        for state in 0..states.len() {
            let mut bits: Bits = vec![0; words];
            if let Some(end) = states.ends[state].filter(|_| scaled.ends[state].0 as usize == row) {
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
                let length = scaled.lengths[states.step_base(state as u32) + k] as usize;
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

/// Adds the set `from`, each count raised by `by`.
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
    use crate::exemplar::slicing::{Slicing, slice};
    use crate::sample::{Sample, exemplar};
    use crate::solve::oracle::all_counts;
    use crate::solve::quantize::Drift;

    #[test]
    fn reach_is_that_of_all_sequences() {
        let mut compared = 0;
        for seed in 0..30 {
            let closed = seed % 3 == 2;
            let sample = Sample {
                columns: 7,
                rows: 5,
                filled: 0.35,
                jitter: [0.3, 0.0],
            };
            let exemplar = exemplar(sample, seed);
            let (pieces, _) = slice(
                &exemplar,
                Slicing::Topology {
                    event_tolerance: 0.02,
                },
                0.0,
            )
            .unwrap();
            let seams = Seams::new(&pieces, 0.2);
            let length = exemplar.width * 1.2 - if closed { 3.0 } else { 0.0 };
            let drift = Drift {
                ranges: vec![(-1e9, 1e9); pieces.len()],
            };
            let task = Task {
                length,
                tolerance: 0.05 * length,
                closed,
                demand: Demand::default(),
                drift,
                variety: 0.0,
            };
            let Some(all) = all_counts(&pieces, &seams, &task, task.tolerance) else {
                continue;
            };
            let found = reach(&pieces, &seams, &task);
            assert_eq!(
                found.components,
                all.keys().map(|k| k.0).collect(),
                "seed {seed}"
            );
            assert_eq!(
                found.holes,
                all.keys().map(|k| k.1).collect(),
                "seed {seed}"
            );
            compared += 1;
        }
        assert!(compared > 15, "{compared}");
    }

    #[test]
    fn sets_shift_across_words() {
        let mut bits = vec![0, 0];
        shift_into(&mut bits, &vec![1 << 63 | 1, 0], 1);
        assert_eq!(bits, [2, 1]);
        shift_into(&mut bits, &vec![1, 0], 64);
        assert_eq!(bits, [2, 1]);
    }
}
