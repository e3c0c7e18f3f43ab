//! Closed curves (Zhou 2014, section 3.6.3): the cheapest cycle of pieces, by one table per piece
//! that a cycle may be said to begin with.

use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;
use crate::solve::autocorrelation::vary;
use crate::solve::search::{Failure, Found, Search, Sequence, Task};
use crate::solve::states::States;

/// The cheapest loop, or one that also repeats itself little.
///
/// Every loop is found from the first of its pieces in a fixed order (fewest portals on the left first, as they
/// have the fewest states): the search from a piece uses none of those before it, and ends
/// when the pieces that are left form no cycle. Where repetition is weighed, the loops that begin like the two cheapest are searched.
pub fn solve(pieces: &[Piece], seams: &Seams, task: &Task) -> Result<Sequence, Failure> {
    let mut found: Vec<(Found, Vec<bool>)> = Vec::new();
    let mut failure = Failure::Impossible;
    for (first, allowed) in beginnings(pieces, seams) {
        let states = States::closed(pieces, seams, task.demand, first, allowed.clone())?;
        let rival = if task.variety > 0.0 {
            None
        } else {
            found.first().map(|f| &f.0)
        };
        match (Search {
            pieces,
            seams,
            task,
            states: &states,
            first,
        })
        .cheapest(rival)
        {
            Ok(one) => {
                // Of equal ones the earlier beginning stays first.
                let at = found.partition_point(|f| f.0.rank <= one.rank);
                found.insert(at, (one, allowed));
            }
            Err(Failure::Drift(height)) => match failure {
                Failure::Drift(least) if least <= height => {}
                _ => failure = Failure::Drift(height),
            },
            Err(Failure::Impossible) => {}
            Err(other) => return Err(other),
        }
    }
    if task.variety <= 0.0 {
        return found
            .into_iter()
            .next()
            .map(|f| f.0.sequence)
            .ok_or(failure);
    }
    let mut best: Option<Found> = None;
    for (cheapest, allowed) in found.into_iter().take(2) {
        let first = cheapest.sequence.pieces[0];
        let states = States::closed(pieces, seams, task.demand, first, allowed)?;
        let search = Search {
            pieces,
            seams,
            task,
            states: &states,
            first,
        };
        best = Found::better(best, Some(vary(&search, cheapest.sequence)?));
    }
    best.map(|found| found.sequence).ok_or(failure)
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

/// Forbids the pieces that lie on no cycle because nothing may follow them, or be followed by them.
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
