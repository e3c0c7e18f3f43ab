//! What a user is told when there is no layout, or when it may not be the best one.

use std::collections::BTreeSet;

use crate::axis::Axis;
use crate::budget::Budget;
use crate::candidate::axis_task::AxisTask;
use crate::candidate::words::Wanted;
use crate::description::{Description, Layer};
use crate::problem::{Part, Problem};
use crate::select::tolerance::Solved;

/// The steps for asking whether a pattern has any word that fits.
const ANY_WORD_STEPS: u64 = 100_000;
/// The steps for finding a short word that does not fit.
const LONG_WORD_STEPS: u64 = 20_000;
/// The words of which the shortest is named.
const LONG_WORDS: usize = 16;

/// The warning that a search was cut short.
pub fn cut_short(axis: Axis, task: &AxisTask, solved: &Solved) -> Problem {
    let counters = solved.counters.iter();
    let counters: String = counters.map(|(c, k)| format!(", {c} = {k}")).collect();
    let message = format!(
        "the layout along {} may not be the best one: the search for it was cut short (tolerance {:.4}{counters})",
        axis.name(),
        solved.tolerance,
    );
    Problem::warning(Part::Facade, message).help(advice(task))
}

/// Why an axis has no task.
pub fn without_sizes(tasks: &[Option<AxisTask>; 2]) -> Vec<Problem> {
    let axes = Axis::BOTH.into_iter().filter(|axis| tasks[*axis].is_none());
    axes.map(|axis| {
        let message = format!("no symbol along {} has a size", axis.name());
        Problem::error(Part::Facade, message)
    })
    .collect()
}

/// Why counters that both axes share have no value.
pub fn no_shared_value(shared: &[char]) -> Vec<Problem> {
    let message = format!("no value of {} fits both axes", list(shared));
    vec![Problem::error(Part::Facade, message)]
}

/// Why nothing fits along an axis: the words of some layers are all too long, or the layers do not go
/// together.
pub fn no_layout(
    description: &Description,
    axis: Axis,
    task: &AxisTask,
    budget: &Budget,
) -> Vec<Problem> {
    let name = axis.name();
    let mut problems = Vec::new();
    for (layer, line) in description.layers.iter().rev().zip(&task.lines) {
        let wanted = Wanted {
            least: 0,
            longest: task.window(task.canvas).longest,
            few: Some(1),
        };
        let mut budget = Budget::new(ANY_WORD_STEPS);
        if task.words(line.pattern, wanted, &mut budget).is_empty() {
            let part = Part::Layer(layer.name.clone(), Some(name));
            problems.push(Problem::error(
                part,
                too_long(layer, axis, task, line.pattern),
            ));
        }
    }
    if problems.is_empty() && budget.exhausted {
        let message =
            format!("no layout along {name} was found in the steps that a search may take");
        problems.push(Problem::error(Part::Facade, message).help(advice(task)));
    } else if problems.is_empty() {
        let message = format!(
            "the layers cannot be aligned along {name}: their symbols' qualifiers and sizes leave no layout on a canvas of {}",
            task.canvas
        );
        problems.push(Problem::error(Part::Facade, message));
    }
    problems
}

/// That no word of a layer's pattern fits, and by how much the shortest is too long.
fn too_long(layer: &Layer, axis: Axis, task: &AxisTask, pattern: usize) -> String {
    let name = &layer.patterns[axis].name;
    let wanted = Wanted {
        least: 0,
        longest: i64::MAX / 4,
        few: Some(LONG_WORDS),
    };
    let word = || {
        task.words(pattern, wanted, &mut Budget::new(LONG_WORD_STEPS))
            .into_iter()
            .map(|w| w.sized)
            .min()
    };
    let is_too_long = |steps: &i64| *steps as f64 * task.grid.step > task.canvas;
    match Some(task.shortest(pattern))
        .filter(is_too_long)
        .or_else(word)
    {
        Some(steps) => {
            let length = steps as f64 * task.grid.step;
            format!(
                "no word of pattern `{name}` fits layer `{}`: the shortest is {length:.4} long, {:.4} more than the canvas, which is {}",
                layer.name,
                length - task.canvas,
                task.canvas
            )
        }
        None => format!(
            "pattern `{name}` of layer `{}` has no word that is not empty",
            layer.name
        ),
    }
}

/// What makes a search shorter.
fn advice(task: &AxisTask) -> String {
    match &free_counters(task)[..] {
        [] => "use fewer alternations and symbols without a size".to_owned(),
        free => format!("limit the free {} under `counters`", list(free)),
    }
}

/// The counters that may take several values.
fn free_counters(task: &AxisTask) -> Vec<char> {
    let used: BTreeSet<char> = task.patterns.iter().flat_map(|p| p.counters()).collect();
    used.into_iter()
        .filter(|c| task.range(*c).max != Some(task.range(*c).min))
        .collect()
}

fn list(counters: &[char]) -> String {
    let names: Vec<String> = counters.iter().map(|c| format!("`{c}`")).collect();
    let plural = if counters.len() == 1 { "" } else { "s" };
    format!("counter{plural} {}", names.join(", "))
}
