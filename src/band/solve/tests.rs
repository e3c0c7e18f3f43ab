//! The solver beside all sequences of small random exemplars, one by one.

use fretwork_language::kinds::bands::Slicing;

use super::alignment::{Alignment, accumulated_offsets};
use super::autocorrelation::{Measure, autocorrelation};
use super::feasible::feasible;
use super::oracle::{Counts, all_counts, least, some_counts};
use super::solver::solve;
use super::task::{Demand, Drift, Failure, Problem, Sequence, Task};
use crate::exemplar::normalize::Exemplar;
use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;
use crate::exemplar::slicing::{Cutting, slice};
use crate::random_exemplar::{Sample, contours};

/// A random exemplar cut into pieces.
struct Cut {
    width: f64,
    pieces: Vec<Piece>,
    seams: Seams,
}

impl Cut {
    fn new(sample: Sample, seed: u64, event_tolerance: f64) -> Cut {
        let exemplar = Exemplar::from_contours(contours(sample, seed));
        let cutting = Cutting {
            slicing: Slicing::Topology,
            event_tolerance,
            min_portal: 0.0,
        };
        let (pieces, _) = slice(&exemplar, &cutting).unwrap();
        Cut {
            width: exemplar.width,
            seams: Seams::new(&pieces, 0.2),
            pieces,
        }
    }

    /// A task without a demand, in a band that is as high as one likes.
    fn task(&self, length: f64, tolerance: f64, closed: bool) -> Task {
        Task {
            length,
            tolerance: tolerance * length,
            closed,
            demand: Demand::default(),
            drift: Drift {
                ranges: vec![(-1e9, 1e9); self.pieces.len()],
            },
            variety: 0.0,
        }
    }

    fn problem<'a>(&'a self, task: &'a Task) -> Problem<'a> {
        Problem {
            pieces: &self.pieces,
            seams: &self.seams,
            task,
        }
    }
}

/// One component, any holes.
fn one_component() -> Demand {
    Demand {
        components: Some(1),
        ..Demand::default()
    }
}

/// Demands that some of the sequences meet, and some that none does.
fn demands(found: &Counts, closed: bool) -> Vec<Demand> {
    let demand = |components, holes, around| Demand {
        components,
        holes,
        around,
    };
    let mut demands = vec![Demand::default(), one_component()];
    for &(c, h, around) in found.keys() {
        demands.extend([
            demand(Some(c), Some(h), around),
            demand(Some(c), None, false),
            demand(None, Some(h), closed),
            demand(Some(c + 1), Some(h), false),
        ]);
    }
    demands.dedup();
    demands
}

/// A comparison of the solver with all sequences.
struct Comparison {
    closed: bool,
    jitter: [f64; 2],
    /// How many demands were met.
    met: usize,
    /// How many were refused, rightly.
    refused: usize,
}

impl Comparison {
    /// Compares for the exemplars of these seeds; how many demands were met and refused.
    fn run(closed: bool, jitter: [f64; 2], seeds: std::ops::Range<u64>) -> (usize, usize) {
        let mut comparison = Comparison {
            closed,
            jitter,
            met: 0,
            refused: 0,
        };
        seeds.for_each(|seed| comparison.compare(seed));
        (comparison.met, comparison.refused)
    }

    /// Whether lengths are whole numbers of cells.
    fn is_even(&self) -> bool {
        self.jitter[1] == 0.0
    }

    fn compare(&mut self, seed: u64) {
        let closed = self.closed;
        // Corners moved along u give many short pieces, and too many sequences.
        let (columns, event_tolerance) = if self.is_even() { (7, 0.02) } else { (5, 0.1) };
        let sample = Sample {
            columns,
            rows: 3 + 2 * (seed as usize % 2),
            filled: 0.35,
            jitter: self.jitter,
        };
        let cut = Cut::new(sample, seed, event_tolerance);
        let shorter = if closed { 3.0 } else { 0.0 };
        let length = cut.width * (1.1 + 0.25 * (seed % 3) as f64) - shorter;
        let mut task = cut.task(length, 0.05, closed);
        let Some(found) = all_counts(&cut.problem(&task), task.tolerance) else {
            return;
        };
        let strict = all_counts(&cut.problem(&task), 0.2 * task.tolerance).unwrap();
        for demand in demands(&found, closed) {
            task.demand = demand;
            let solved = solve(&cut.problem(&task));
            let least_cost = least(&found, demand);
            let case = format!("seed {seed} {demand:?}");
            match (&solved, least_cost) {
                (Ok(s), Some(cost)) => {
                    check(s, &task, &case);
                    assert!(s.cost >= cost - 1e-9, "{case}: {s:?} below {cost}");
                    let most = if self.is_even() {
                        Some(cost)
                    } else {
                        least(&strict, demand)
                    };
                    let is_least = most.is_none_or(|m| s.cost <= m + 1e-4);
                    assert!(is_least, "{case}: {s:?}, not {most:?}");
                    self.met += 1;
                }
                (Err(Failure::Impossible), None) => self.refused += 1,
                (Err(_), Some(_)) if !self.is_even() => assert_eq!(least(&strict, demand), None),
                _ => panic!("{case}: {solved:?}, all sequences say {least_cost:?}"),
            }
        }
    }
}

/// Checks that a sequence has the length and the counts of its task.
fn check(s: &Sequence, task: &Task, case: &str) {
    let demand = task.demand;
    assert!(
        (s.length - task.length).abs() <= task.tolerance + 1e-9,
        "{case}"
    );
    assert!(
        demand.components.is_none_or(|n| n == s.components),
        "{case}"
    );
    assert!(demand.holes.is_none_or(|n| n == s.holes), "{case}");
    assert!(s.around > 0 || !demand.around, "{case}");
}

#[test]
fn open_patterns_are_the_cheapest_of_all_sequences() {
    let (met, refused) = Comparison::run(false, [0.3, 0.0], 0..60);
    assert!(met > 300 && refused > 20, "{met} {refused}");
}

#[test]
fn loops_are_the_cheapest_of_all_cycles() {
    let (met, refused) = Comparison::run(true, [0.3, 0.0], 0..40);
    assert!(met > 150 && refused > 20, "{met} {refused}");
}

#[test]
fn odd_lengths_cost_no_more_than_the_best_well_inside_the_tolerance() {
    let (met, _) = Comparison::run(false, [0.3, 0.3], 0..80);
    assert!(met > 100, "{met}");
    let (met, _) = Comparison::run(true, [0.3, 0.3], 0..40);
    assert!(met > 50, "{met}");
}

/// Compares the solver with all sequences in a band too low for the cheapest one. Returns whether
/// there was a sequence that stays.
fn fills_a_low_band(seed: u64) -> bool {
    let sample = Sample {
        columns: 5,
        rows: 3 + 2 * (seed as usize % 2),
        filled: 0.35,
        jitter: [0.5, 0.3],
    };
    let cut = Cut::new(sample, seed, 0.1);
    let mut task = cut.task(cut.width * (1.5 + 0.25 * (seed % 3) as f64), 0.1, false);
    task.demand = one_component();
    let demand = task.demand;
    let Ok(free) = solve(&cut.problem(&task)) else {
        return false;
    };
    let drifts = accumulated_offsets(&cut.seams, &free.pieces);
    let farthest = drifts.into_iter().map(f64::abs).fold(0.0, f64::max);
    let stays = |offsets: &[f64]| offsets.iter().all(|o| o.abs() <= 0.6 * farthest);
    task.drift.ranges.fill((-0.6 * farthest, 0.6 * farthest));
    let Some(found) = all_counts(&cut.problem(&task), task.tolerance) else {
        return false;
    };
    let settles = |sequence: &[usize]| {
        stays(
            &Alignment::new(&cut.pieces, &cut.seams, sequence, false)
                .unwrap()
                .offsets,
        )
    };
    let best = some_counts(&cut.problem(&task), task.tolerance, &settles).unwrap();
    let can_settle = least(&best, demand).is_some();
    let solved = solve(&cut.problem(&task));
    match (solved, least(&best, demand).or(least(&found, demand))) {
        (Ok(s), Some(cost)) => {
            let accumulated = accumulated_offsets(&cut.seams, &s.pieces);
            assert!(stays(&accumulated), "seed {seed}");
            assert_eq!(settles(&s.pieces), can_settle, "seed {seed}");
            let is_cheap = s.cost >= cost - 1e-9 && s.cost <= 1.05 * cost;
            assert!(is_cheap, "seed {seed}: {} {cost}", s.cost);
            check(&s, &task, &format!("seed {seed}"));
            true
        }
        (Err(Failure::Drift(_)), None) => false,
        (solved, least) => panic!("seed {seed}: {solved:?}, all sequences say {least:?}"),
    }
}

#[test]
fn low_bands_are_filled_wherever_that_is_possible() {
    let met = (0..150).filter(|&seed| fills_a_low_band(seed)).count();
    assert!(met >= 8, "{met}");
}

#[test]
fn what_is_feasible_is_that_of_all_sequences() {
    let mut compared = 0;
    for seed in 0..30 {
        let closed = seed % 3 == 2;
        let sample = Sample {
            columns: 7,
            rows: 5,
            filled: 0.35,
            jitter: [0.3, 0.0],
        };
        let cut = Cut::new(sample, seed, 0.02);
        let length = cut.width * 1.2 - if closed { 3.0 } else { 0.0 };
        let task = cut.task(length, 0.05, closed);
        let Some(all) = all_counts(&cut.problem(&task), task.tolerance) else {
            continue;
        };
        let found = feasible(&cut.problem(&task));
        let components = all.keys().map(|k| k.0).collect();
        assert_eq!(found.components, components, "seed {seed}");
        let holes = all.keys().map(|k| k.1).collect();
        assert_eq!(found.holes, holes, "seed {seed}");
        compared += 1;
    }
    assert!(compared > 15, "{compared}");
}

/// Solves with and without variety. Returns whether the autocorrelation became less.
fn repeats_less_with_variety(seed: u64) -> bool {
    let sample = Sample {
        columns: 12,
        rows: 3 + 2 * (seed as usize % 3),
        filled: 0.3,
        jitter: [0.3, 0.1],
    };
    let cut = Cut::new(sample, seed, 0.02);
    let mut task = cut.task(4.0 * cut.width, 0.05, seed % 2 == 1);
    task.demand = one_component();
    let Ok(plain) = solve(&cut.problem(&task)) else {
        return false;
    };
    task.variety = 0.5;
    task.demand.holes = (seed % 4 < 2).then_some(plain.holes);
    let varied = solve(&cut.problem(&task)).unwrap();
    assert_eq!(varied.components, 1);
    assert!(task.demand.holes.is_none_or(|h| h == varied.holes));
    assert!((varied.length - task.length).abs() <= task.tolerance);
    let measure = Measure::new(&cut.seams, 0.5);
    let is_better =
        measure.value(&varied, task.closed) <= measure.value(&plain, task.closed) + 1e-9;
    assert!(is_better || task.demand.holes.is_some());
    autocorrelation(&varied.pieces, task.closed)
        < autocorrelation(&plain.pieces, task.closed) - 0.05
}

#[test]
fn variety_keeps_the_counts_and_repeats_less() {
    let gained = (0..24)
        .filter(|&seed| repeats_less_with_variety(seed))
        .count();
    assert!(gained >= 6, "{gained}");
}
