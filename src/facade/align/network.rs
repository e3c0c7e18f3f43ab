//! The alignment decision network of section 5.2: the rows to align, and bounds of what is still to
//! come after a node. The arcs, which are the columns allowed by rule R6, are listed in
//! `successors`; `search` and `select::co_optimal` decide which of them to follow.
//!
//! # Cuts of transparent letters
//!
//! A transparent letter may be cut at any column border (rule R7), but the places of its cuts are not
//! nodes, which would multiply the network by the length of the letter. While columns pass a
//! transparent run, its row keeps only two sums: those of the shortest and of the longest solid
//! entries of these columns. A part of the run costs nothing in a column as long as its length lies
//! between the column's shortest and longest entry. So the run costs nothing if its whole length
//! lies between the two sums.
//!
//! If the run is longer than the greater sum, the difference is added to the last column; if it is
//! shorter than the lesser one, parts of the columns are made shorter. Either costs exactly the
//! difference, and no other choice of columns costs less: all runs that are being passed share these
//! columns, and they end in the order of their right ends. The constraint matrix of such a problem
//! has consecutive ones, so that a greedy choice at each right end is optimal.

use std::sync::Arc;

use super::lower_bound::LowerBound;
use super::place::{ENDLESS, Entry, Passed, Place, Reading, State};
use super::row::Row;
use crate::budget::Budget;

/// The rows to align and the wildcards in them. Lengths are in steps of the axis's grid.
#[derive(Clone, Debug)]
pub struct Network {
    /// The rows, the uppermost first.
    pub rows: Vec<Row>,
    /// The wildcards.
    pub wildcards: Vec<Wildcard>,
    /// The greatest length of all columns together.
    pub longest: i64,
    /// Whether a wildcard whose length costs something takes the cheapest length only. This loses
    /// alignments, so only a beam search does it.
    pub is_thrifty: bool,
    /// Lower bounds of the error that rows bring, once they are computed.
    pub lower_bound: Option<Arc<LowerBound>>,
}

/// A symbol without a size, whose length the alignment finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wildcard {
    /// The least length that rule R5 leaves it, at least 1.
    pub least: i64,
    /// Whether it has one letter only, so that nothing later depends on its length.
    pub loose: bool,
    /// Whether its length matters beyond this network.
    pub kept: bool,
    /// The number of its letters in all lines of the group.
    pub copies: i64,
}

/// The length that a row still needs.
struct Need {
    least: i64,
    most: i64,
    /// How much less the least can be if columns that were passed are made shorter.
    shorter: i64,
    /// The number of letters to come that are as long as what was passed.
    copies: i64,
}

impl Need {
    /// A lower bound of the error if another row cannot be longer than `room`. To make a passed
    /// column shorter by a step costs one; it shortens each copy by that step, and may give the step
    /// to the other row.
    fn excess(&self, room: i64) -> i64 {
        let excess = (self.least - room).max(0);
        if self.shorter == 0 {
            excess
        } else {
            (excess + self.copies) / (self.copies + 1)
        }
    }
}

impl Network {
    /// The node before the first column.
    pub fn start(&self) -> State {
        State {
            places: vec![Place::new(Reading::Before(0)); self.rows.len()],
            passed: vec![Passed::default(); self.rows.len()],
            lengths: self.wildcards.iter().map(|w| (w.least, ENDLESS)).collect(),
            error: 0,
            span: 0,
        }
    }

    /// The same network with lower bounds, for a search for errors of at most `bound`.
    pub fn with_lower_bound(&self, bound: i64, budget: &mut Budget) -> Network {
        let mut network = self.clone();
        if bound > 0 {
            let (lower_bound, work) = LowerBound::new(&self.rows, bound);
            budget.spend(work);
            network.lower_bound = lower_bound.map(Arc::new);
        }
        network
    }

    /// An estimate of the error without a search. It is no bound.
    pub fn guess(&self, bound: i64, budget: &mut Budget) -> i64 {
        let start = self.start();
        self.with_lower_bound(bound, budget)
            .lower_bound
            .map_or(0, |lower_bound| lower_bound.sum(&start.places))
    }

    /// The length of the parts of the canvas that a beam search goes by: half the mean letter of the
    /// row with the most letters. With longer parts, nodes compete that are too unlike; with shorter
    /// ones, few nodes meet in a part, and the beam keeps bad ones.
    pub fn part(&self) -> i64 {
        let row = self.rows.iter().max_by_key(|row| row.count());
        row.map_or(1, |row| {
            row.steps(0, row.count()) / (2 * row.count() as i64).max(1)
        })
        .max(1)
    }

    /// The steps of `budget` that the nodes of the part of the canvas at `span` may take, so that
    /// enough is left to reach the end. The budget is divided by half the number of the parts that
    /// are left, and two more: early parts may take more than their share, as a wrong turn there
    /// costs most.
    pub fn share(&self, span: i64, budget: &Budget) -> Budget {
        let parts = (self.longest - span).max(0) / (2 * self.part());
        budget.fraction(parts as u64 + 2)
    }

    /// Whether all rows are read to their ends.
    pub fn is_end(&self, places: &[Place]) -> bool {
        places
            .iter()
            .zip(&self.rows)
            .all(|(p, row)| *p == Place::new(Reading::Before(row.count())))
    }

    /// The entry of a column that leads from one place of a row to another.
    pub fn entry(&self, row: usize, from: Place, to: Place) -> Entry {
        let row = &self.rows[row];
        match (from.reading(), to.reading()) {
            (Reading::Before(a) | Reading::Gap(a), Reading::Before(b)) if a == b => Entry::Empty,
            (Reading::Before(a) | Reading::Gap(a), _) if !row.is_transparent(a) => {
                Entry::Solid(a, to.letter())
            }
            _ => Entry::Piece(row.run_start(from.letter())),
        }
    }

    /// Lower bounds of the error and of the span that are still to come; `None` at a dead end.
    pub fn ahead(&self, state: &State) -> Option<(i64, i64)> {
        let (mut opaque, mut longest, mut room) = (0i64, 0i64, ENDLESS);
        let mut needs = Vec::with_capacity(self.rows.len());
        let mut stuck = false;
        let mut unfinished = false;
        for (i, (row, place)) in self.rows.iter().zip(&state.places).enumerate() {
            let from = place.letter();
            let need = self.need(i, state);
            longest = longest.max(need.least - need.shorter);
            room = room.min(
                need.most
                    .saturating_add(if row.yields { opaque } else { 0 }),
            );
            needs.push(need);
            if from == row.count() {
                stuck |= !row.yields || opaque == 0 || !row.may_gap(from);
            } else {
                unfinished = true;
            }
            opaque = opaque.saturating_add(row.opaque_after(from));
        }
        if stuck && unfinished {
            return None;
        }
        let known = self
            .lower_bound
            .as_ref()
            .map_or(0, |lower_bound| lower_bound.least(&state.places));
        let error = needs
            .iter()
            .map(|need| need.excess(room))
            .fold(known, i64::max);
        Some((error, longest.max(0)))
    }

    /// The length that row `i` still needs.
    fn need(&self, i: usize, state: &State) -> Need {
        let (row, place, passed) = (&self.rows[i], state.places[i], state.passed[i]);
        let from = place.letter();
        let end = if place.is_inside() {
            row.run_end(from)
        } else {
            from
        };
        let passing = place
            .is_inside()
            .then(|| self.least_inside(row, from, passed))
            .flatten();
        let (mut own, mut rest) = (row.steps(from, end), row.steps(end, row.count()));
        let mut need = Need {
            least: 0,
            most: own + rest,
            shorter: 0,
            copies: 0,
        };
        for (at, w) in row.wildcards.iter().filter(|(at, _)| *at >= from) {
            let (mut least, most) = state.lengths[*w];
            need.most = need.most.saturating_add(most);
            if let Some((_, whole, short)) = passing.filter(|(passed, ..)| passed == w) {
                let copies = i64::from(*at >= end && whole > least);
                need.shorter += copies * (whole - short.max(least));
                need.copies += copies;
                least = least.max(whole);
            }
            let part = if *at < end { &mut own } else { &mut rest };
            *part = part.saturating_add(least);
        }
        need.least = rest.saturating_add((own - passed.most).max(0));
        need.most -= passed.least;
        need
    }

    /// If the transparent run that begins at `start` has letters of one wildcard only: the wildcard,
    /// and the least length that it has after what was passed. The second length is the one with
    /// columns that are made shorter. All other letters of the wildcard are as long.
    fn least_inside(&self, row: &Row, start: usize, passed: Passed) -> Option<(usize, i64, i64)> {
        let end = row.run_end(start);
        let mut wild = row
            .wildcards
            .iter()
            .filter(|(at, _)| (start..end).contains(at))
            .map(|(_, w)| *w);
        let first = wild.next()?;
        let mut count = 1;
        for w in wild {
            if w != first {
                return None;
            }
            count += 1;
        }
        let each =
            |length: i64| length.div_euclid(count) + i64::from(length.rem_euclid(count) != 0);
        let whole = passed.least - row.steps(start, end);
        Some((first, each(whole), each(whole - passed.spare)))
    }

    /// The shortest lengths of wildcards within `lengths` that make every row as long as rule R5
    /// asks; `None` if no lengths do.
    pub fn settle(&self, lengths: &[(i64, i64)]) -> Option<Vec<i64>> {
        let mut chosen: Vec<i64> = lengths.iter().map(|l| l.0).collect();
        for row in self.rows.iter().filter(|row| !row.wildcards.is_empty()) {
            let wild: i64 = row.wildcards.iter().map(|(_, w)| chosen[*w]).sum();
            let mut missing = row.need - row.steps(0, row.count()) - wild;
            for (_, w) in &row.wildcards {
                let count = row.wildcards.iter().filter(|(_, v)| v == w).count() as i64;
                if missing > 0 {
                    let more = ((missing + count - 1) / count).min(lengths[*w].1 - chosen[*w]);
                    chosen[*w] += more;
                    missing -= more * count;
                }
            }
            if missing > 0 {
                return None;
            }
        }
        Some(chosen)
    }
}
