//! One axis from its words to its places: the tolerance that grows until something fits (rule R8),
//! and the borders and letters of the layout that was chosen.

use super::budget::Budget;
use super::candidate::{Axis, Wanted, Word};
use super::network::Entry;
use super::search::Width;
use super::selection::{Aligned, Layout, Outcome, select};
use super::word::Environment;

/// A solved axis.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The tolerance that the layout was found at, in the unit of the canvas.
    pub tolerance: f64,
    /// The alignment error in the unit of the canvas.
    pub alignment_error: f64,
    /// The error of the sizes in squared units.
    pub size_error: f64,
    /// The counters.
    pub counters: Environment,
    /// The borders between columns, of all groups, from 0 to the side of the canvas.
    pub borders: Vec<f64>,
    /// The letters of each line that are drawn.
    pub lines: Vec<Vec<Placed>>,
    /// Whether the search ended before all candidates were compared.
    pub is_cut_short: bool,
}

/// A letter in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Number of its symbol.
    pub symbol: usize,
    /// Whether it is mirrored.
    pub mirrored: bool,
    /// Where it begins.
    pub start: f64,
    /// Where it ends.
    pub end: f64,
}

/// The steps of all narrow searches for one axis; each takes at most a quarter of what is left.
const NARROW_STEPS: u64 = 2_400_000;
/// The steps for finding the words of a narrow search.
const WORD_STEPS: u64 = 40_000;
/// The nodes that a narrow search keeps at each depth.
const NARROW_WIDTH: usize = 48;
/// The words of a pattern that a narrow search tries.
const NARROW_WORDS: usize = 12;
/// The first tolerance, as a fraction of the canvas, and what it grows by.
const FIRST: f64 = 0.01;
const GROWTH: f64 = 1.5;

/// The best layout at the least tolerance that has one. Where the best alignments of no tolerance can
/// be sized, others are tried. None when nothing fits even at a tolerance as large as the canvas.
/// Tolerances above `limit` (a fraction of the canvas) are not tried.
pub fn solve(axis: &Axis, limit: f64, budget: &mut Budget) -> Option<Solved> {
    let mut tolerances = vec![axis.canvas * FIRST];
    while let Some(last) = tolerances
        .last()
        .copied()
        .filter(|last| *last < axis.canvas)
    {
        tolerances.push((last * GROWTH).min(axis.canvas));
    }
    tolerances.retain(|tolerance| *tolerance <= limit * axis.canvas * (1.0 + 1e-9));
    // What is missing after a search that was cut short may be found by a narrow one.
    let mut spare = Budget::new(NARROW_STEPS);
    let mut unsizable = Vec::new();
    for tolerance in &tolerances {
        let exact = if budget.exhausted {
            None
        } else {
            Some(attempt(axis, *tolerance, Width::Exact, budget))
        };
        let mut outcomes = vec![];
        outcomes.extend(exact);
        if budget.exhausted && outcomes.iter().all(|o| o.layout.is_none()) {
            outcomes.push(narrow(
                axis,
                *tolerance,
                Width::Narrow(NARROW_WIDTH),
                &mut spare,
            ));
            if outcomes.iter().any(|o| o.is_unsizable)
                && outcomes.iter().all(|o| o.layout.is_none())
            {
                outcomes.push(narrow(
                    axis,
                    *tolerance,
                    Width::Sizable(NARROW_WIDTH),
                    &mut spare,
                ));
            }
        } else if outcomes.iter().any(|o| o.is_unsizable) {
            unsizable.push(*tolerance);
        }
        if let Some(layout) = outcomes.into_iter().find_map(|o| o.layout) {
            let is_cut_short = budget.exhausted || !layout.is_sure;
            return Some(place(axis, *tolerance, layout, is_cut_short));
        }
    }
    let sizable = |tolerance: &f64| {
        let layout = narrow(axis, *tolerance, Width::Sizable(NARROW_WIDTH), &mut spare).layout?;
        Some(place(axis, *tolerance, layout, budget.exhausted))
    };
    unsizable.iter().find_map(sizable)
}

fn narrow(axis: &Axis, tolerance: f64, width: Width, spare: &mut Budget) -> Outcome {
    let mut part = spare.fraction(4);
    let outcome = attempt(axis, tolerance, width, &mut part);
    spare.charge(&part);
    outcome
}

fn attempt(axis: &Axis, tolerance: f64, width: Width, budget: &mut Budget) -> Outcome {
    let window = axis.window(tolerance);
    // Half of the budget is left for the search itself; a narrow one takes few words, and need not pay for them.
    let is_exact = width == Width::Exact;
    let mut part = if is_exact {
        budget.fraction(2)
    } else {
        Budget::new(WORD_STEPS)
    };
    let few = if is_exact { None } else { Some(NARROW_WORDS) };
    let of = |pattern: usize| {
        let wanted = Wanted {
            least: window.shortest,
            longest: window.longest,
            few,
        };
        let near = if few.is_some() || axis.is_rigid(pattern) {
            axis.words(pattern, wanted, &mut part)
        } else {
            Vec::new()
        };
        if near.is_empty() {
            axis.words(pattern, Wanted { least: 0, ..wanted }, &mut part)
        } else {
            near
        }
    };
    let words: Vec<Vec<Word>> = (0..axis.patterns.len()).map(of).collect();
    if is_exact {
        budget.charge(&part);
        budget.exhausted |= part.exhausted;
    }
    select(axis, &words, window, width, budget)
}

fn place(axis: &Axis, tolerance: f64, layout: Layout, is_cut_short: bool) -> Solved {
    let mut lines = vec![Vec::new(); axis.lines.len()];
    let mut borders = Vec::new();
    for (group, aligned) in layout.groups.iter().enumerate() {
        let own = columns(axis, aligned, &layout.sizes.of);
        let members = axis
            .lines
            .iter()
            .enumerate()
            .filter(|(_, line)| line.group == group);
        for ((number, _), (row, word)) in members.zip(&aligned.lines) {
            lines[number] = letters(word, aligned, *row, &own, &layout.sizes.of);
        }
        borders.extend(own);
    }
    borders.sort_by(f64::total_cmp);
    borders.dedup_by(|b, a| *b - *a < axis.canvas * 1e-7);
    Solved {
        tolerance,
        alignment_error: layout.error as f64 * axis.grid.step,
        size_error: layout.sizes.error,
        counters: layout.counters,
        borders,
        lines,
        is_cut_short,
    }
}

/// The borders of a group's columns.
fn columns(axis: &Axis, aligned: &Aligned, sizes: &[f64]) -> Vec<f64> {
    let mut borders = vec![0.0];
    let mut end = 0.0;
    for pair in aligned.path.windows(2) {
        let rows = aligned.network.rows.iter().enumerate();
        let solid = rows.into_iter().find_map(|(i, row)| {
            match aligned.network.entry(i, pair[0][i], pair[1][i]) {
                Entry::Solid(a, b) => Some(
                    row.cells[a..b]
                        .iter()
                        .map(|cell| sizes[cell.symbol])
                        .sum::<f64>(),
                ),
                _ => None,
            }
        });
        end += solid.unwrap_or(0.0);
        borders.push(end);
    }
    if let Some(last) = borders.last_mut() {
        *last = axis.canvas;
    }
    borders
}

/// The solid letters of a line.
fn letters(
    word: &Word,
    aligned: &Aligned,
    row: usize,
    borders: &[f64],
    sizes: &[f64],
) -> Vec<Placed> {
    let mut placed = Vec::new();
    for (pair, border) in aligned.path.windows(2).zip(borders.windows(2)) {
        let Entry::Solid(from, to) = aligned.network.entry(row, pair[0][row], pair[1][row]) else {
            continue;
        };
        let mut start = border[0];
        for i in from..to {
            let end = if i + 1 == to {
                border[1]
            } else {
                start + sizes[word.cells[i].symbol]
            };
            placed.push(Placed {
                symbol: word.cells[i].symbol,
                mirrored: word.letters[i].mirrored,
                start,
                end,
            });
            start = end;
        }
    }
    placed
}
