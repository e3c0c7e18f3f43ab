//! Facades whose axes have counters in common (rule R2): every value of these counters is tried on
//! both axes.

use std::collections::BTreeMap;

use crate::axis::Axis;
use crate::budget::Budget;
use crate::candidate::axis_task::AxisTask;
use crate::select::tolerance::{Solved, solve};

/// The greatest value of a shared counter that no range limits. Both axes are solved for every value,
/// so that a greater one takes long; a facade that needs more lists the counter.
const MOST_SHARED: i64 = 12;

/// Steps for values that turn out to fit neither axis; searching is limited by itself.
const VALUE_STEPS: u64 = 500;

/// The values of the shared counters that fit both axes best: the least tolerance decides, then the
/// least alignment error, then the least size error. `None` if no values fit.
pub fn solve_shared(
    tasks: &[AxisTask; 2],
    shared: &[char],
    budget: impl Fn() -> Budget,
) -> Option<[Solved; 2]> {
    let range = |counter: &char| {
        let range = tasks[Axis::X].range(*counter);
        (range.min, range.max.unwrap_or(MOST_SHARED.max(range.min)))
    };
    let mut budgets = [budget(), budget()];
    let mut best: Option<(Rank, [Solved; 2])> = None;
    let mut values: BTreeMap<char, i64> = shared.iter().map(|c| (*c, range(c).0)).collect();
    loop {
        fretwork_geometry::budget::spend("values of shared counters", VALUE_STEPS);
        let limit = best.as_ref().map_or(1.0, |(rank, _)| rank.tolerance);
        if let Some(both) = solve_both(tasks, &values, limit, &mut budgets) {
            let rank = Rank::of(tasks, &both);
            if best.as_ref().is_none_or(|(other, _)| rank.is_before(other)) {
                best = Some((rank, both));
            }
        }
        // The last counter that has a value left takes it, and those after it start again.
        let next = shared.iter().rev().find(|c| values[c] < range(c).1);
        let may_go_on = budgets.iter().all(|b| !b.exhausted) || best.is_none();
        let Some(next) = next.filter(|_| may_go_on) else {
            break;
        };
        if budgets.iter().all(|b| b.exhausted) {
            break;
        }
        for c in shared.iter().rev().take_while(|c| *c != next) {
            values.insert(*c, range(c).0);
        }
        values.entry(*next).and_modify(|k| *k += 1);
    }
    best.map(|(_, both)| both)
}

/// Both axes with these values of counters.
fn solve_both(
    tasks: &[AxisTask; 2],
    values: &BTreeMap<char, i64>,
    limit: f64,
    budgets: &mut [Budget; 2],
) -> Option<[Solved; 2]> {
    let mut of = |axis: Axis| {
        let task = tasks[axis].with_counters(values);
        solve(&task, limit, &mut budgets[axis])
    };
    Some([of(Axis::X)?, of(Axis::Y)?])
}

/// How good the layouts of both axes are together.
struct Rank {
    /// The larger of the two tolerances, each as a fraction of its side.
    tolerance: f64,
    alignment_error: f64,
    size_error: f64,
}

impl Rank {
    fn of(tasks: &[AxisTask; 2], [x, y]: &[Solved; 2]) -> Rank {
        let along_x = x.tolerance / tasks[Axis::X].canvas;
        let along_y = y.tolerance / tasks[Axis::Y].canvas;
        Rank {
            tolerance: along_x.max(along_y),
            alignment_error: x.alignment_error + y.alignment_error,
            size_error: x.size_error + y.size_error,
        }
    }

    /// Whether it comes before another; numbers that differ by rounding are equal.
    fn is_before(&self, other: &Rank) -> bool {
        let pairs = [
            (self.tolerance, other.tolerance),
            (self.alignment_error, other.alignment_error),
            (self.size_error, other.size_error),
        ];
        for (a, b) in pairs {
            let slack = 1e-9 * b.abs().max(1e-3);
            if (a - b).abs() > slack {
                return a < b;
            }
        }
        false
    }
}
