//! Closed curves (Zhou 2014, section 3.6.3): the cheapest cycle of pieces. One graph is searched
//! for each piece that a cycle may be said to begin with.

use super::search::Search;
use super::states::States;
use super::strategy::{cheapest, varied};
use super::task::{Failure, Found, Problem, Sequence};
use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;

/// Where repetition is weighed, the loops that begin like this many of the cheapest are searched.
/// A single one may be a loop that can only repeat itself; each more costs one whole search.
const VARIED_BEGINNINGS: usize = 2;

/// The cheapest loop, or one that also repeats itself little.
///
/// Every loop is found from the first of its pieces in a fixed order. Pieces with the fewest
/// portals on the left come first, because they have the fewest states. The search from one piece
/// uses none of those before it, and the last search is over when the pieces that are left form no
/// cycle.
///
/// # Errors
/// As for open patterns. Where loops drift from every beginning, the least height is reported.
pub fn solve(problem: &Problem) -> Result<Sequence, Failure> {
    let found = cheapest_of_each_beginning(problem)?;
    if problem.task.variety <= 0.0 {
        let first = found.loops.into_iter().next();
        return first.map(|l| l.found.sequence).ok_or(found.failure);
    }
    let mut best: Option<Found> = None;
    for Loop { found, allowed } in found.loops.into_iter().take(VARIED_BEGINNINGS) {
        let first = found.sequence.pieces[0];
        let states = States::closed(problem, first, allowed)?;
        let search = Search {
            problem: *problem,
            states: &states,
            first,
        };
        best = Found::better(best, Some(varied(&search, found.sequence)?));
    }
    best.map(|found| found.sequence).ok_or(found.failure)
}

/// A loop, and the pieces that loops with this beginning may use.
struct Loop {
    found: Found,
    allowed: Vec<bool>,
}

/// The cheapest loops, the best first, and what to report where there is none.
struct Loops {
    loops: Vec<Loop>,
    failure: Failure,
}

fn cheapest_of_each_beginning(problem: &Problem) -> Result<Loops, Failure> {
    let mut loops: Vec<Loop> = Vec::new();
    let mut failure = Failure::Impossible;
    for (first, allowed) in beginnings(problem.pieces, problem.seams) {
        let states = States::closed(problem, first, allowed.clone())?;
        // Only the best matters where repetition is not weighed.
        let best = loops.first().map(|l| &l.found);
        let rival = best.filter(|_| problem.task.variety <= 0.0);
        let search = Search {
            problem: *problem,
            states: &states,
            first,
        };
        match cheapest(&search, rival) {
            Ok(found) => {
                // Of equals the earlier beginning stays first.
                let at = loops.partition_point(|l| l.found.rank <= found.rank);
                loops.insert(at, Loop { found, allowed });
            }
            Err(Failure::Drift(height)) => match failure {
                Failure::Drift(least) if least <= height => {}
                _ => failure = Failure::Drift(height),
            },
            Err(Failure::Impossible) => {}
            Err(other) => return Err(other),
        }
    }
    Ok(Loops { loops, failure })
}

/// The pieces that loops begin with, each with those that may follow.
pub fn beginnings(pieces: &[Piece], seams: &Seams) -> Vec<(usize, Vec<bool>)> {
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(|&p| (pieces[p].left.len(), p));
    let mut allowed = vec![true; pieces.len()];
    let mut list = Vec::new();
    for first in order {
        prune(seams, &mut allowed);
        if allowed[first] {
            list.push((first, allowed.clone()));
            allowed[first] = false;
        }
    }
    list
}

/// Forbids the pieces that lie on no cycle because none can follow them or precede them.
fn prune(seams: &Seams, allowed: &mut [bool]) {
    loop {
        let follows =
            |i: usize| (0..allowed.len()).any(|j| allowed[j] && seams.get(i, j).is_some());
        let leads = |i: usize| (0..allowed.len()).any(|j| allowed[j] && seams.get(j, i).is_some());
        let Some(dead) = (0..allowed.len()).find(|&i| allowed[i] && !(follows(i) && leads(i)))
        else {
            return;
        };
        allowed[dead] = false;
    }
}
