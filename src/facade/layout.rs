//! Two solved axes → a grid of shapes (rules R2, R12, R13), and what to say when there is none.

use std::collections::{BTreeMap, BTreeSet};

use super::axis::{Placed, Solved, solve};
use super::budget::Budget;
use super::candidate::{Axis, Range, Wanted, counters_of};
use super::input::{Facade, Layer};
use super::prepare::Prepared;
use super::problem::{Part, Problem};
use fretwork_geometry::{FacadeCell, FacadeLayout};

/// Finds the mistakes of a facade that do not need a layout: in its patterns, symbols and ranges.
pub fn check(facade: &Facade) -> Vec<Problem> {
    Prepared::new(facade).map_or_else(|problems| problems, |(_, warnings)| warnings)
}

/// Lays out a facade: the layout and warnings.
///
/// Takes at most a fixed number of search steps. When they do not suffice, the best layout found so
/// far is returned, with a warning that names the counters to be limited.
///
/// # Errors
/// All mistakes of the description, or that nothing fits the canvas.
pub fn lay_out(facade: &Facade) -> Result<(FacadeLayout, Vec<Problem>), Vec<Problem>> {
    let (prepared, mut warnings) = Prepared::new(facade)?;
    let shared = prepared.shared_counters();
    let axes = if shared.is_empty() {
        let mut budgets = [budget(facade), budget(facade)];
        let solved = [0, 1].map(|axis| {
            solve_axis(
                facade,
                &prepared,
                axis,
                &BTreeMap::new(),
                1.0,
                &mut budgets[axis],
            )
        });
        match solved {
            [Some(x), Some(y)] => Some([x, y]),
            [x, y] => {
                let failed = [x.is_none(), y.is_none()];
                let blamed = (0..2).filter(|axis| failed[*axis]);
                return Err(blamed
                    .flat_map(|axis| explain(facade, &prepared, axis, &budgets[axis]))
                    .collect());
            }
        }
    } else {
        solve_shared(facade, &prepared, &shared)
    };
    let Some([x, y]) = axes else {
        let message = format!("no value of {} fits both axes", list(&shared));
        return Err(vec![Problem::error(Part::Facade, message)]);
    };
    for (axis, solved) in [&x, &y]
        .into_iter()
        .enumerate()
        .filter(|(_, solved)| solved.is_cut_short)
    {
        warnings.push(cut_short(facade, &prepared, axis, solved));
    }
    match shape_count(&x, &y) {
        count if count > MOST_SHAPES => {
            let message = format!("the facade has {count} shapes, more than {MOST_SHAPES}");
            Err(vec![
                Problem::error(Part::Facade, message).help("use larger symbols, or fewer layers"),
            ])
        }
        _ => Ok((multiply(facade, &prepared, &x, &y), warnings)),
    }
}

/// The steps of an exact search for one axis, times the square of the lines; a step takes about a tenth of a microsecond.
const EXACT_STEPS: u64 = 16_000_000;
/// Bounds of the steps.
const LEAST_STEPS: u64 = 200_000;
const MOST_STEPS: u64 = 3_000_000;

/// A facade may not have more shapes than this, nor more rectangles between the sides of shapes.
const MOST_SHAPES: usize = 4_000_000;

/// The shapes of all layers, or the rectangles between their sides where those are more.
fn shape_count(x: &Solved, y: &Solved) -> usize {
    let sides = |axis: &Solved| {
        let mut all: Vec<f64> = axis
            .lines
            .iter()
            .flatten()
            .map(|placed| placed.start)
            .collect();
        all.sort_by(f64::total_cmp);
        let slack = 1e-9 * axis.borders.last().copied().unwrap_or(0.0);
        all.dedup_by(|b, a| *b - *a <= slack);
        all.len() + 1
    };
    let shapes = x
        .lines
        .iter()
        .zip(&y.lines)
        .map(|(x, y)| x.len() * y.len())
        .sum::<usize>();
    shapes.max(sides(x) * sides(y))
}

/// What an axis may take: the more lines there are, the less is a search likely to be completed.
fn budget(facade: &Facade) -> Budget {
    let lines = facade.layers.len() as u64;
    Budget::new((EXACT_STEPS / (lines * lines).max(1)).clamp(LEAST_STEPS, MOST_STEPS))
}

fn solve_axis(
    facade: &Facade,
    prepared: &Prepared,
    axis: usize,
    fixed: &BTreeMap<char, i64>,
    limit: f64,
    budget: &mut Budget,
) -> Option<Solved> {
    solve(&prepared.axis(facade, axis, fixed)?, limit, budget)
}

/// The greatest value of a counter that both axes use and no range limits (rule R2).
const MOST_SHARED: i64 = 12;

/// Tries all values of the counters that both axes use (rule R2): the least tolerance decides, then
/// the least alignment error, then the least size error.
fn solve_shared(facade: &Facade, prepared: &Prepared, shared: &[char]) -> Option<[Solved; 2]> {
    let mut budgets = [budget(facade), budget(facade)];
    let mut best: Option<((f64, f64, f64), [Solved; 2])> = None;
    let mut fixed: BTreeMap<char, i64> = shared
        .iter()
        .map(|c| (*c, shared_range(facade, *c).0))
        .collect();
    loop {
        let limit = best.as_ref().map_or(1.0, |(rank, _)| rank.0);
        let x = solve_axis(facade, prepared, 0, &fixed, limit, &mut budgets[0]);
        let y = x
            .as_ref()
            .and_then(|_| solve_axis(facade, prepared, 1, &fixed, limit, &mut budgets[1]));
        if let (Some(x), Some(y)) = (x, y) {
            let tolerance = (x.tolerance / facade.canvas[0]).max(y.tolerance / facade.canvas[1]);
            let rank = (
                tolerance,
                x.alignment_error + y.alignment_error,
                x.size_error + y.size_error,
            );
            if best
                .as_ref()
                .is_none_or(|(other, _)| is_before(rank, *other))
            {
                best = Some((rank, [x, y]));
            }
        }
        let next = shared
            .iter()
            .rev()
            .find(|c| fixed[c] < shared_range(facade, **c).1)
            .copied();
        let Some(next) = next.filter(|_| budgets.iter().all(|b| !b.exhausted) || best.is_none())
        else {
            break;
        };
        if budgets.iter().all(|b| b.exhausted) {
            break;
        }
        for c in shared.iter().rev().take_while(|c| **c != next) {
            fixed.insert(*c, shared_range(facade, *c).0);
        }
        fixed.entry(next).and_modify(|k| *k += 1);
    }
    best.map(|(_, axes)| axes)
}

fn shared_range(facade: &Facade, counter: char) -> (i64, i64) {
    let range = facade
        .counters
        .get(&counter)
        .copied()
        .unwrap_or(Range { min: 1, max: None });
    (range.min, range.max.unwrap_or(MOST_SHARED.max(range.min)))
}

/// Whether a rank comes before another; what differs by rounding is equal.
fn is_before(a: (f64, f64, f64), b: (f64, f64, f64)) -> bool {
    for (a, b) in [(a.0, b.0), (a.1, b.1), (a.2, b.2)] {
        let slack = 1e-9 * b.abs().max(1e-3);
        if (a - b).abs() > slack {
            return a < b;
        }
    }
    false
}

/// The outer products (rule R13).
fn multiply(facade: &Facade, prepared: &Prepared, x: &Solved, y: &Solved) -> FacadeLayout {
    let none = BTreeMap::new();
    let axes = [0, 1].map(|axis| prepared.axis(facade, axis, &none));
    let [Some(axis_x), Some(axis_y)] = axes else {
        unreachable!("both axes were solved")
    };
    let mut cells = Vec::new();
    for (number, layer) in facade.layers.iter().enumerate() {
        let line = facade.layers.len() - 1 - number;
        for b in drawn(layer, 1, &axis_y, &y.lines[line]) {
            for a in drawn(layer, 0, &axis_x, &x.lines[line]) {
                let (along_x, along_y) = (&axis_x.symbols[a.symbol], &axis_y.symbols[b.symbol]);
                cells.push(FacadeCell {
                    layer: number as u32,
                    symbol_x: along_x.name,
                    symbol_y: along_y.name,
                    x: a.start,
                    y: b.start,
                    width: a.end - a.start,
                    height: b.end - b.start,
                    mirrored_x: a.mirrored,
                    mirrored_y: b.mirrored,
                    opaque: along_x.opaque && along_y.opaque,
                });
            }
        }
    }
    FacadeLayout {
        width: facade.canvas[0],
        height: facade.canvas[1],
        x: x.borders.clone(),
        y: y.borders.clone(),
        layers: facade
            .layers
            .iter()
            .map(|layer| layer.name.clone())
            .collect(),
        cells,
        alignment_error: x.alignment_error + y.alignment_error,
        size_error: x.size_error + y.size_error,
    }
}

fn drawn<'a>(
    layer: &'a Layer,
    axis: usize,
    symbols: &'a Axis,
    line: &'a [Placed],
) -> impl Iterator<Item = &'a Placed> {
    let mask = layer.visible[axis].as_ref();
    line.iter()
        .filter(move |p| mask.is_none_or(|mask| mask.contains(&symbols.symbols[p.symbol].name)))
}

fn cut_short(facade: &Facade, prepared: &Prepared, axis: usize, solved: &Solved) -> Problem {
    let help = prepared
        .axis(facade, axis, &BTreeMap::new())
        .map_or_else(String::new, |axis| advice(facade, &axis));
    let name = AXES[axis];
    let message = format!(
        "the layout along {name} may not be the best one: the search for it was cut short (tolerance {:.4}{})",
        solved.tolerance,
        solved
            .counters
            .iter()
            .map(|(counter, k)| format!(", {counter} = {k}"))
            .collect::<String>()
    );
    Problem::warning(Part::Facade, message).help(help)
}

/// What makes a search shorter.
fn advice(facade: &Facade, axis: &Axis) -> String {
    match &free_counters(facade, axis)[..] {
        [] => "use fewer alternations and symbols without a size".to_owned(),
        free => format!("limit the free {} under `counters`", list(free)),
    }
}

const AXES: [&str; 2] = ["x", "y"];

/// The counters of an axis that may take several values.
fn free_counters(facade: &Facade, axis: &Axis) -> Vec<char> {
    let used: BTreeSet<char> = axis.patterns.iter().flat_map(|p| counters_of(p)).collect();
    used.into_iter()
        .filter(|c| {
            facade
                .counters
                .get(c)
                .is_none_or(|range| range.max != Some(range.min))
        })
        .collect()
}

fn list(counters: &[char]) -> String {
    let names: Vec<String> = counters.iter().map(|c| format!("`{c}`")).collect();
    format!(
        "counter{} {}",
        if counters.len() == 1 { "" } else { "s" },
        names.join(", ")
    )
}

/// Why nothing fits along an axis: layers whose words are all too long, or that the layers do not
/// go together.
fn explain(facade: &Facade, prepared: &Prepared, number: usize, budget: &Budget) -> Vec<Problem> {
    let name = AXES[number];
    let Some(axis) = prepared.axis(facade, number, &BTreeMap::new()) else {
        return vec![Problem::error(
            Part::Facade,
            format!("no symbol along {name} has a size"),
        )];
    };
    let mut problems = Vec::new();
    for (layer, line) in facade.layers.iter().rev().zip(&axis.lines) {
        let part = Part::Layer(layer.name.clone(), Some(name));
        let longest = axis.window(axis.canvas).longest;
        let wanted = Wanted {
            least: 0,
            longest,
            few: Some(1),
        };
        if axis
            .words(line.pattern, wanted, &mut Budget::new(100_000))
            .is_empty()
        {
            problems.push(Problem::error(
                part,
                too_long(layer, &axis, line.pattern, number),
            ));
        }
    }
    if problems.is_empty() && budget.exhausted {
        let message =
            format!("no layout along {name} was found in the steps that a search may take");
        problems.push(Problem::error(Part::Facade, message).help(advice(facade, &axis)));
    } else if problems.is_empty() {
        let message = format!(
            "the layers cannot be aligned along {name}: their symbols' qualifiers and sizes leave no layout on a canvas of {}",
            axis.canvas
        );
        problems.push(Problem::error(Part::Facade, message));
    }
    problems
}

fn too_long(layer: &Layer, axis: &Axis, pattern: usize, number: usize) -> String {
    let name = &layer.patterns[number].name;
    let wanted = Wanted {
        least: 0,
        longest: i64::MAX / 4,
        few: Some(16),
    };
    let word = || {
        axis.words(pattern, wanted, &mut Budget::new(20_000))
            .into_iter()
            .map(|w| w.sized)
            .min()
    };
    let is_too_long = |steps: &i64| *steps as f64 * axis.grid.step > axis.canvas;
    match Some(axis.shortest(pattern))
        .filter(is_too_long)
        .or_else(word)
    {
        Some(steps) => {
            let length = steps as f64 * axis.grid.step;
            format!(
                "no word of pattern `{name}` fits layer `{}`: the shortest is {length:.4} long, {:.4} more than the canvas, which is {}",
                layer.name,
                length - axis.canvas,
                axis.canvas
            )
        }
        None => format!(
            "pattern `{name}` of layer `{}` has no word that is not empty",
            layer.name
        ),
    }
}
