//! Why a pattern cannot be made, in words.

use std::collections::BTreeSet;

use fretwork_diagnostic::Diagnostic;

use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;
use crate::solve::feasible::reach;
use crate::solve::search::{Failure, Task};

/// What is said where only a higher band would do.
pub const DRIFT: &str = "they drift out of it";

/// The error for a task that failed.
pub fn explain(failure: Failure, pieces: &[Piece], seams: &Seams, task: &Task) -> Diagnostic {
    match failure {
        Failure::Impossible => impossible(pieces, seams, task),
        Failure::Drift(height) => Diagnostic::error(format!(
            "the pieces cannot be put together within the band: aligned one after the other {DRIFT}"
        ))
        .help(format!(
            "a height of {} would do",
            number(height * (1.0 + 1e-6))
        )),
        Failure::States(error) => {
            Diagnostic::error(format!("the exemplar is too intricate: {error}"))
                .help("use a simpler exemplar, or fewer cuts")
        }
        Failure::TooLong => Diagnostic::error(format!(
            "a pattern of length {} would take too many pieces of this exemplar",
            number(task.length)
        ))
        .help("use a larger exemplar, or a shorter curve"),
    }
}

fn impossible(pieces: &[Piece], seams: &Seams, task: &Task) -> Diagnostic {
    let narrowest = pieces.iter().map(|p| p.width).fold(f64::INFINITY, f64::min);
    if task.length + task.tolerance < narrowest {
        return Diagnostic::error(format!(
            "the curve, {} long, is shorter than the narrowest piece of the exemplar, {} wide",
            number(task.length),
            number(narrowest)
        ));
    }
    let found = reach(pieces, seams, task);
    let off = |l: f64| (l - task.length).abs() - task.tolerance;
    if !found.lengths.iter().any(|&l| off(l) <= 0.0) {
        return no_length(&found.lengths, task);
    }
    let length = format!("{} ± {} long", number(task.length), number(task.tolerance));
    let demand = task.demand;
    if let Some(n) = demand.components.filter(|n| !found.components.contains(n)) {
        return Diagnostic::error(format!(
            "no sequence of pieces {length} forms {}",
            plural(n, "component")
        ))
        .help(format!(
            "numbers of components that can be had: {}",
            list(&found.components)
        ));
    }
    if let Some(n) = demand.holes.filter(|n| !found.holes.contains(n)) {
        let with = demand
            .components
            .filter(|&n| n == 1)
            .map_or(String::new(), |_| " in one component".into());
        return Diagnostic::error(format!(
            "no sequence of pieces {length} has {}{with}",
            plural(n, "hole")
        ))
        .help(format!(
            "numbers of holes that can be had: {}",
            list(&found.holes)
        ));
    }
    let counts = [
        demand.components.map(|n| plural(n, "component")),
        demand.holes.map(|n| plural(n, "hole")),
    ];
    let counts: Vec<String> = counts.into_iter().flatten().collect();
    let around = if demand.around {
        " and runs round the curve"
    } else {
        ""
    };
    Diagnostic::error(format!(
        "no sequence of pieces {length} has {} at once{around}",
        counts.join(" and ")
    ))
    .help("each can be had alone; ask for `any` of one of them")
}

fn no_length(lengths: &[f64], task: &Task) -> Diagnostic {
    let below = lengths
        .iter()
        .copied()
        .filter(|&l| l < task.length)
        .fold(f64::NEG_INFINITY, f64::max);
    let above = lengths
        .iter()
        .copied()
        .filter(|&l| l > task.length)
        .fold(f64::INFINITY, f64::min);
    let near: Vec<String> = [below, above]
        .iter()
        .filter(|l| l.is_finite())
        .map(|&l| number(l))
        .collect();
    let what = if task.closed {
        "form a closed pattern"
    } else {
        "can be chained"
    };
    let error = Diagnostic::error(format!(
        "no sequence of pieces that {what} is {} ± {} long",
        number(task.length),
        number(task.tolerance)
    ));
    if near.is_empty() {
        error.help(
            "no piece can follow another so that the pattern goes on; `slicing: { uniform: 12 }` cuts other pieces",
        )
    } else {
        error.help(format!(
            "the nearest lengths are {}; or raise `length_tolerance`",
            near.join(" and ")
        ))
    }
}

/// Three digits after the point at most.
fn number(x: f64) -> String {
    let text = format!("{x:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

fn plural(n: u32, what: &str) -> String {
    if n == 1 {
        format!("1 {what}")
    } else {
        format!("{n} {what}s")
    }
}

/// The members of a set; of large ones the ends.
fn list(set: &BTreeSet<u32>) -> String {
    let names: Vec<String> = set.iter().map(u32::to_string).collect();
    match (names.len(), set.first(), set.last()) {
        (0, _, _) => "none".into(),
        (13.., Some(a), Some(b)) => format!("{} of those from {a} to {b}", names.len()),
        _ => names.join(", "),
    }
}
