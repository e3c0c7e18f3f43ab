//! One axis from its words to its positions: the tolerance grows until something fits (rule R8).

use super::contest::Layout;
use super::positions::{Placed, positions};
use super::selection::{Outcome, select};
use crate::align::search::Effort;
use crate::budget::Budget;
use crate::candidate::axis_task::AxisTask;
use crate::candidate::words::{Wanted, Word};
use crate::pattern::word::Environment;

/// A solved axis.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The tolerance at which the layout was found, in the unit of the canvas.
    pub tolerance: f64,
    /// The alignment error in the unit of the canvas.
    pub alignment_error: f64,
    /// The size error in squared units.
    pub size_error: f64,
    /// The counters.
    pub counters: Environment,
    /// The borders between columns of all groups, from 0 to the side of the canvas.
    pub borders: Vec<f64>,
    /// The letters of each line that are drawn.
    pub lines: Vec<Vec<Placed>>,
    /// Whether the search ended before all candidates were compared.
    pub is_cut_short: bool,
}

/// The first tolerance, as a fraction of the canvas. The paper gives no number. A smaller one only
/// costs more attempts that fail; with a larger one, candidates of a large error compete where a
/// better one exists, and the search takes longer.
const FIRST: f64 = 0.01;
/// The factor between tolerances. Nearer to 1, there are more attempts; further from it, the window of
/// the attempt that succeeds is wider than it must be, with the same effect as a large first one.
const GROWTH: f64 = 1.5;
/// The steps of all beam searches of one axis; each takes a fraction of what is left. With fewer,
/// facades whose exact search is cut short may get no layout; with more, they take seconds.
const BEAM_STEPS: u64 = 2_400_000;
/// A beam search takes at most one of so many parts of the steps that are left, so that later
/// tolerances have their share.
const BEAM_SHARE: u64 = 4;
/// The steps for finding the words of a beam search.
const WORD_STEPS: u64 = 40_000;
/// The labels that a beam search follows in each part of the canvas. A narrower beam loses the layouts
/// of facades with five layers and more; the time grows in proportion to the width.
const BEAM_WIDTH: usize = 48;
/// The words of a pattern that a beam search tries: those nearest to the canvas. Their combinations
/// over all layers are candidates, each of which takes a search.
const BEAM_WORDS: usize = 12;

/// The best layout at the least tolerance that has one; `None` if nothing fits even at a tolerance as
/// large as the canvas. Tolerances above `limit`, a fraction of the canvas, are not tried.
///
/// If the exact search is cut short, the tolerance is tried again with a beam search, and then with
/// one that only follows what can be sized. If the best alignments of every tolerance cannot be
/// sized, the second kind of beam is tried once more at those tolerances.
pub fn solve(task: &AxisTask, limit: f64, budget: &mut Budget) -> Option<Solved> {
    // What an exact search that was cut short left undone may be found by a beam.
    let mut spare = Budget::new(BEAM_STEPS);
    let mut unsizable = Vec::new();
    for tolerance in tolerances(task.canvas, limit) {
        let mut outcomes = vec![];
        if !budget.exhausted {
            outcomes.push(attempt(task, tolerance, Effort::Exact, budget));
        }
        let is_missing = |all: &[Outcome]| all.iter().all(|o| o.layout.is_none());
        let is_unsizable = |all: &[Outcome]| all.iter().any(|o| o.is_unsizable);
        if budget.exhausted && is_missing(&outcomes) {
            let effort = Effort::Beam(BEAM_WIDTH);
            outcomes.push(attempt_with_beam(task, tolerance, effort, &mut spare));
            if is_unsizable(&outcomes) && is_missing(&outcomes) {
                let effort = Effort::SizableBeam(BEAM_WIDTH);
                outcomes.push(attempt_with_beam(task, tolerance, effort, &mut spare));
            }
        } else if is_unsizable(&outcomes) {
            unsizable.push(tolerance);
        }
        if let Some(layout) = outcomes.into_iter().find_map(|o| o.layout) {
            let is_cut_short = budget.exhausted || !layout.is_sure;
            return Some(solved(task, tolerance, layout, is_cut_short));
        }
    }
    unsizable.into_iter().find_map(|tolerance| {
        let effort = Effort::SizableBeam(BEAM_WIDTH);
        let layout = attempt_with_beam(task, tolerance, effort, &mut spare).layout?;
        Some(solved(task, tolerance, layout, budget.exhausted))
    })
}

/// The tolerances to try, ascending, from a fraction of the canvas to the whole of it.
fn tolerances(canvas: f64, limit: f64) -> Vec<f64> {
    let mut all = Vec::new();
    let mut next = canvas * FIRST;
    while next < canvas {
        all.push(next);
        next = (next * GROWTH).min(canvas);
    }
    all.push(next);
    all.retain(|tolerance| *tolerance <= limit * canvas * (1.0 + 1e-9));
    all
}

/// A beam search with a share of the spare steps.
fn attempt_with_beam(
    task: &AxisTask,
    tolerance: f64,
    effort: Effort,
    spare: &mut Budget,
) -> Outcome {
    let mut share = spare.fraction(BEAM_SHARE);
    let outcome = attempt(task, tolerance, effort, &mut share);
    spare.charge(&share);
    outcome
}

/// The best layout at one tolerance.
fn attempt(task: &AxisTask, tolerance: f64, effort: Effort, budget: &mut Budget) -> Outcome {
    let window = task.window(tolerance);
    // Half of the budget is left for the exact search itself. A beam takes few words and does not pay
    // for them.
    let is_exact = effort == Effort::Exact;
    let mut part = if is_exact {
        budget.fraction(2)
    } else {
        Budget::new(WORD_STEPS)
    };
    let few = if is_exact { None } else { Some(BEAM_WORDS) };
    let mut words_of = |pattern: usize| {
        let wanted = Wanted {
            least: window.shortest,
            longest: window.longest,
            few,
        };
        let near = if few.is_some() || task.is_rigid(pattern) {
            task.words(pattern, wanted, &mut part)
        } else {
            Vec::new()
        };
        if near.is_empty() {
            task.words(pattern, Wanted { least: 0, ..wanted }, &mut part)
        } else {
            near
        }
    };
    let words: Vec<Vec<Word>> = (0..task.patterns.len()).map(&mut words_of).collect();
    if is_exact {
        budget.charge(&part);
        budget.exhausted |= part.exhausted;
    }
    select(task, &words, window, effort, budget)
}

fn solved(task: &AxisTask, tolerance: f64, layout: Layout, is_cut_short: bool) -> Solved {
    let positions = positions(task, &layout);
    Solved {
        tolerance,
        alignment_error: layout.error as f64 * task.grid.step,
        size_error: layout.sizes.error,
        counters: layout.counters,
        borders: positions.borders,
        lines: positions.lines,
        is_cut_short,
    }
}
