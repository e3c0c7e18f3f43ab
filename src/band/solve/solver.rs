//! The solver's front: open patterns here, loops in `closed`.

use super::closed;
use super::search::Search;
use super::states::States;
use super::strategy;
use super::task::{Failure, Problem, Sequence};

/// The cheapest sequence that meets the task.
///
/// F is counted in units of 2^-20. Where all lengths are multiples of one length, as with uniform
/// slicing, nothing is cheaper: the table holds every combination of length, last piece, descriptor
/// and counts. Where they are not, the length of a sequence is off by the rounding of its steps, at
/// most e for all of them, and F is the least of all sequences whose length is within the tolerance
/// less 2 e (`Units::rounding` is e for one step). Of equal costs the length nearest to the curve's
/// is taken. When the cheapest sequence leaves the band, offsets enter the table too, rounded to
/// levels, and sequences with exact offsets are searched along it. What is found then stays in the
/// band, also with its final offsets where such a sequence is found, but need not be the cheapest.
///
/// # Errors
/// Every [`Failure`]; `unsolvable` finds out what could be had instead.
pub fn solve(problem: &Problem) -> Result<Sequence, Failure> {
    if problem.task.closed {
        return closed::solve(problem);
    }
    let states = States::open(problem)?;
    strategy::solve(&Search {
        problem: *problem,
        states: &states,
        first: 0,
    })
}
