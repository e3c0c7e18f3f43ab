//! Why no sequence of pieces meets a task, with what could be had instead. The advice that goes
//! with it is in `diagnose`.

use std::collections::BTreeSet;

use super::feasible::feasible;
use super::task::{Failure, Problem, Task, TooManyStates};

/// A length with its tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The length of the curve.
    pub length: f64,
    /// How far a pattern's length may be from it.
    pub tolerance: f64,
}

impl std::fmt::Display for Span {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} ± {} long",
            number(self.length),
            number(self.tolerance)
        )
    }
}

/// Why no sequence meets a task.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unsolvable {
    /// Not even one piece fits.
    #[error(
        "the curve, {} long, is shorter than the narrowest piece of the exemplar, {} wide",
        number(*.length),
        number(*.narrowest)
    )]
    TooShort {
        /// The length of the curve.
        length: f64,
        /// The width of the narrowest piece.
        narrowest: f64,
    },
    /// No sequence has the length, whatever its counts.
    #[error(
        "no sequence of pieces that {} is {span}",
        if *.closed { "form a closed pattern" } else { "can be chained" }
    )]
    Length {
        /// The length asked for.
        span: Span,
        /// Whether the curve is closed.
        closed: bool,
        /// The nearest lengths below and above that can be had.
        nearest: Vec<f64>,
    },
    /// No sequence of the length has so many components.
    #[error("no sequence of pieces {span} forms {}", plural(*.wanted, "component"))]
    Components {
        /// The length asked for.
        span: Span,
        /// The number asked for.
        wanted: u32,
        /// The numbers that can be had.
        possible: BTreeSet<u32>,
    },
    /// No sequence of the length has so many holes.
    #[error(
        "no sequence of pieces {span} has {}{}",
        plural(*.wanted, "hole"),
        if *.in_one { " in one component" } else { "" }
    )]
    Holes {
        /// The length asked for.
        span: Span,
        /// The number asked for.
        wanted: u32,
        /// Whether one component was asked for as well.
        in_one: bool,
        /// The numbers that can be had.
        possible: BTreeSet<u32>,
    },
    /// Each count can be had, but not both in one sequence.
    #[error(
        "no sequence of pieces {span} has {} at once{}",
        counts(*.components, *.holes),
        if *.around { " and runs round the curve" } else { "" }
    )]
    AtOnce {
        /// The length asked for.
        span: Span,
        /// The number of components asked for.
        components: Option<u32>,
        /// The number of holes asked for.
        holes: Option<u32>,
        /// Whether a component must run round the curve.
        around: bool,
    },
    /// Every sequence leaves the band (rule B5).
    #[error(
        "the pieces cannot be put together within the band: \
         aligned one after the other they drift out of it"
    )]
    Drift {
        /// The height of a band in which one stays.
        height: f64,
    },
    /// The exemplar's portals can be connected in too many ways.
    #[error("the exemplar is too intricate: {0}")]
    TooManyStates(#[from] TooManyStates),
    /// The curve is too long for the exemplar.
    #[error(
        "a pattern of length {} would take too many pieces of this exemplar",
        number(*.length)
    )]
    TooLong {
        /// The length of the curve.
        length: f64,
    },
}

/// Finds out why a task failed.
pub fn explain(failure: Failure, problem: &Problem) -> Unsolvable {
    match failure {
        Failure::Impossible => explain_impossible(problem),
        Failure::Drift(height) => Unsolvable::Drift { height },
        Failure::States(error) => Unsolvable::TooManyStates(error),
        Failure::TooLong => Unsolvable::TooLong {
            length: problem.task.length,
        },
    }
}

fn explain_impossible(problem: &Problem) -> Unsolvable {
    let Problem { pieces, task, .. } = *problem;
    let widths = pieces.iter().map(|p| p.width);
    let narrowest = widths.fold(f64::INFINITY, f64::min);
    let (length, tolerance) = (task.length, task.tolerance);
    if length + tolerance < narrowest {
        return Unsolvable::TooShort { length, narrowest };
    }
    let span = Span { length, tolerance };
    let found = feasible(problem);
    if !found
        .lengths
        .iter()
        .any(|&l| (l - length).abs() <= tolerance)
    {
        return Unsolvable::Length {
            span,
            closed: task.closed,
            nearest: nearest(&found.lengths, task),
        };
    }
    let demand = task.demand;
    if let Some(wanted) = demand.components.filter(|n| !found.components.contains(n)) {
        return Unsolvable::Components {
            span,
            wanted,
            possible: found.components,
        };
    }
    if let Some(wanted) = demand.holes.filter(|n| !found.holes.contains(n)) {
        return Unsolvable::Holes {
            span,
            wanted,
            in_one: demand.components == Some(1),
            possible: found.holes,
        };
    }
    Unsolvable::AtOnce {
        span,
        components: demand.components,
        holes: demand.holes,
        around: demand.around,
    }
}

/// The nearest lengths below and above the curve's, where there are any.
fn nearest(lengths: &[f64], task: &Task) -> Vec<f64> {
    let lengths = || lengths.iter().copied();
    let below = lengths().filter(|&l| l < task.length);
    let above = lengths().filter(|&l| l > task.length);
    let nearest = [
        below.fold(f64::NEG_INFINITY, f64::max),
        above.fold(f64::INFINITY, f64::min),
    ];
    nearest.into_iter().filter(|l| l.is_finite()).collect()
}

/// The counts that were asked for, in words.
fn counts(components: Option<u32>, holes: Option<u32>) -> String {
    let counts = [
        components.map(|n| plural(n, "component")),
        holes.map(|n| plural(n, "hole")),
    ];
    let counts: Vec<String> = counts.into_iter().flatten().collect();
    counts.join(" and ")
}

/// A number with at most three digits after the point.
pub fn number(x: f64) -> String {
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
