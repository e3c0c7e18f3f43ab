//! A facade from its description to its grid of shapes: both axes are solved, and the lines of each
//! layer are multiplied (rules R2, R12 and R13). What to say when there is no layout is in `explain`.

mod explain;
mod shared_counters;

use crate::axis::Axis;
use crate::budget::Budget;
use crate::candidate::axis_task::AxisTask;
use crate::description::{Description, Layer};
use crate::pattern::prepare::Prepared;
use crate::problem::{Part, Problem};
use crate::select::positions::Placed;
use crate::select::tolerance::{Solved, solve};
use fretwork_geometry::{FacadeCell, FacadeLayout};

/// The most shapes that a facade may have, and the most rectangles between the sides of shapes. They
/// are all held in memory, at about a hundred bytes each.
const MOST_SHAPES: usize = 4_000_000;
/// The steps of an exact search for one axis, for one layer. Two layers get a quarter of it, and so on:
/// the more there are, the less likely a search is to be completed. A step takes about a tenth of a
/// microsecond.
const EXACT_STEPS: u64 = 16_000_000;
/// The least number of steps. It counts from nine layers on, where the quotient would soon be too
/// small for an exact search of even a simple facade.
const LEAST_STEPS: u64 = 200_000;
/// The greatest number of steps, a third of a second. It counts for one and two layers, whose searches
/// either end before it or have so many words that twice the steps would not help.
const MOST_STEPS: u64 = 3_000_000;

/// The mistakes and warnings of a facade that need no layout: about its patterns, symbols and
/// ranges.
pub fn check(description: &Description) -> Vec<Problem> {
    Prepared::new(description).map_or_else(|problems| problems, |(_, warnings)| warnings)
}

/// Lays out a facade: the layout, and warnings.
///
/// It takes at most a fixed number of search steps. If they do not suffice, the best layout found so
/// far is returned, with a warning that names the counters to be limited.
///
/// # Errors
/// All mistakes of the description, or why nothing fits the canvas.
pub fn lay_out(description: &Description) -> Result<(FacadeLayout, Vec<Problem>), Vec<Problem>> {
    let (prepared, mut warnings) = Prepared::new(description)?;
    let tasks = Axis::BOTH.map(|axis| AxisTask::new(description, &prepared, axis));
    let tasks = match tasks {
        [Some(x), Some(y)] => [x, y],
        tasks => return Err(explain::without_sizes(&tasks)),
    };
    let shared = prepared.shared_counters();
    let solved = if shared.is_empty() {
        each_axis(description, &tasks)?
    } else {
        shared_counters::solve_shared(&tasks, &shared, || budget(description))
            .ok_or_else(|| explain::no_shared_value(&shared))?
    };
    for axis in Axis::BOTH {
        if solved[axis].is_cut_short {
            warnings.push(explain::cut_short(axis, &tasks[axis], &solved[axis]));
        }
    }
    match shape_count(&solved) {
        count if count > MOST_SHAPES => {
            let message = format!("the facade has {count} shapes, more than {MOST_SHAPES}");
            let help = "use larger symbols, or fewer layers";
            Err(vec![Problem::error(Part::Facade, message).help(help)])
        }
        _ => Ok((multiply(description, &tasks, &solved), warnings)),
    }
}

/// Solves both axes, which have no counter in common.
fn each_axis(
    description: &Description,
    tasks: &[AxisTask; 2],
) -> Result<[Solved; 2], Vec<Problem>> {
    let mut budgets = [budget(description), budget(description)];
    let solved = Axis::BOTH.map(|axis| solve(&tasks[axis], 1.0, &mut budgets[axis]));
    match solved {
        [Some(x), Some(y)] => Ok([x, y]),
        failed => Err(Axis::BOTH
            .into_iter()
            .filter(|axis| failed[*axis].is_none())
            .flat_map(|axis| {
                let task = &tasks[axis];
                explain::no_layout(description, axis, task, &budgets[axis])
            })
            .collect()),
    }
}

/// The steps that one axis may take.
fn budget(description: &Description) -> Budget {
    let layers = description.layers.len() as u64;
    let steps = EXACT_STEPS / (layers * layers).max(1);
    Budget::new(steps.clamp(LEAST_STEPS, MOST_STEPS))
}

/// The number of shapes of all layers, or of the rectangles between their sides if those are more.
fn shape_count(solved: &[Solved; 2]) -> usize {
    let sides = |axis: &Solved| {
        let letters = axis.lines.iter().flatten();
        let mut all: Vec<f64> = letters.map(|placed| placed.start).collect();
        all.sort_by(f64::total_cmp);
        let slack = 1e-9 * axis.borders.last().copied().unwrap_or(0.0);
        all.dedup_by(|b, a| *b - *a <= slack);
        all.len() + 1
    };
    let [x, y] = solved;
    let lines = x.lines.iter().zip(&y.lines);
    let shapes: usize = lines.map(|(x, y)| x.len() * y.len()).sum();
    shapes.max(sides(x) * sides(y))
}

/// The outer products of the lines of each layer (rule R13).
fn multiply(
    description: &Description,
    tasks: &[AxisTask; 2],
    solved: &[Solved; 2],
) -> FacadeLayout {
    let [x, y] = solved;
    let mut cells = Vec::new();
    // Lines begin with the uppermost layer, cells with the lowest.
    let lines = x.lines.iter().zip(&y.lines).rev();
    for (number, (layer, (line_x, line_y))) in description.layers.iter().zip(lines).enumerate() {
        for b in drawn(layer, Axis::Y, &tasks[Axis::Y], line_y) {
            for a in drawn(layer, Axis::X, &tasks[Axis::X], line_x) {
                let along_x = &tasks[Axis::X].symbols[a.symbol];
                let along_y = &tasks[Axis::Y].symbols[b.symbol];
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
        width: description.canvas[Axis::X],
        height: description.canvas[Axis::Y],
        x: x.borders.clone(),
        y: y.borders.clone(),
        layers: description
            .layers
            .iter()
            .map(|layer| layer.name.clone())
            .collect(),
        cells,
        alignment_error: x.alignment_error + y.alignment_error,
        size_error: x.size_error + y.size_error,
    }
}

/// The letters of a line that the layer's mask lets through.
fn drawn<'a>(
    layer: &'a Layer,
    axis: Axis,
    task: &'a AxisTask,
    line: &'a [Placed],
) -> impl Iterator<Item = &'a Placed> {
    let mask = layer.visible[axis].as_ref();
    line.iter()
        .filter(move |p| mask.is_none_or(|mask| mask.contains(&task.symbols[p.symbol].name)))
}
