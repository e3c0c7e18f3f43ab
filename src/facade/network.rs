//! The alignment decision network of the paper's section 5.2: its nodes are how far each row is
//! read, its arcs the columns that may come next under the five constraints of rule R6. The arcs
//! are found in `column`; which of them to follow is the business of `search` and `ties`.
//!
//! Cuts of transparent letters (rule R7) are not nodes. While a run of transparent letters is being
//! passed, only the least and the most that its columns can take is kept: an entry of it may be as
//! long as anything between the shortest and the longest solid entry of its column at no cost. Where
//! the run ends, its length must lie between the two sums. If it does not, the last column is made
//! longer, or the last columns are made shorter, by what is missing: since all runs that are passed
//! at that time share these columns, no other choice of columns costs less (the constraint matrix
//! has consecutive ones, and right ends are met in order).

use std::sync::Arc;

use super::budget::Budget;
use super::outlook::Outlook;
use super::row::Row;

/// Rows to align, the uppermost first, and the wildcards in them.
#[derive(Clone, Debug)]
pub struct Network {
    /// The rows.
    pub rows: Vec<Row>,
    /// The wildcards.
    pub wildcards: Vec<Wildcard>,
    /// The most steps that the columns may take together.
    pub longest: i64,
    /// Whether a wildcard whose length would cost something takes only the cheapest one.
    pub is_thrifty: bool,
    /// Bounds of the error that rows bring, where they are known.
    pub outlook: Option<Arc<Outlook>>,
}

/// A symbol without a size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wildcard {
    /// The least length, at least 1.
    pub least: i64,
    /// Whether it stands in one place only, so that nothing later depends on its length.
    pub loose: bool,
    /// Whether its length matters beyond this network.
    pub kept: bool,
    /// How many letters it has in the facade.
    pub copies: i64,
}

/// A length that no facade has.
pub const ENDLESS: i64 = i64::MAX / 16;

/// How far a row is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place(u32);

/// What a [`Place`] stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// Before this letter.
    Before(usize),
    /// Before this letter, and the next entry is empty.
    Gap(usize),
    /// In the transparent letters that begin with this one.
    Inside(usize),
}

impl Place {
    /// The place of a reading.
    pub fn new(reading: Reading) -> Place {
        let (letter, kind) = match reading {
            Reading::Before(letter) => (letter, 0),
            Reading::Gap(letter) => (letter, 1),
            Reading::Inside(letter) => (letter, 2),
        };
        Place((letter as u32) << 2 | kind)
    }

    /// What it stands for.
    pub fn reading(self) -> Reading {
        match self.0 & 3 {
            0 => Reading::Before(self.letter()),
            1 => Reading::Gap(self.letter()),
            _ => Reading::Inside(self.letter()),
        }
    }

    /// The letters wholly read.
    pub fn letter(self) -> usize {
        (self.0 >> 2) as usize
    }

    /// Whether a transparent run is being passed.
    pub fn is_inside(self) -> bool {
        self.0 & 3 == 2
    }
}

/// What the columns passed since a transparent run began can take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Passed {
    /// The sum of the shortest entries.
    pub least: i64,
    /// The sum of the longest entries.
    pub most: i64,
    /// How much the shortest entries could be made shorter still, at a cost.
    pub spare: i64,
}

/// A node: between two columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// Per row.
    pub places: Vec<Place>,
    /// Per row; zero outside of transparent runs.
    pub passed: Vec<Passed>,
    /// Per wildcard: the lengths that it can have at the error so far.
    pub lengths: Vec<(i64, i64)>,
    /// The error so far.
    pub error: i64,
    /// The sum of the longest entries so far.
    pub span: i64,
}

/// A column's part in one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Entry {
    /// Nothing: room is made for an opaque entry above.
    Empty,
    /// The solid letters from the first up to the second number.
    Solid(usize, usize),
    /// A part of the transparent letters that begin with this one.
    Piece(usize),
}

/// What a row still has to take.
struct Need {
    least: i64,
    most: i64,
    /// How much shorter the least can be if columns that were passed are made shorter.
    shorter: i64,
    /// The letters to come that are as long as what was passed.
    copies: i64,
}

impl Need {
    /// A lower bound of the error where another row has no more than `room`. Columns that are made shorter by a step cost
    /// that step; they shorten each copy by it, and may give the step to the other row.
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

    /// The same with an outlook, for a search for errors of at most `bound`.
    pub fn with_outlook(&self, bound: i64, budget: &mut Budget) -> Network {
        let mut network = self.clone();
        if bound > 0 {
            let (outlook, work) = Outlook::new(self, bound);
            budget.spend(work);
            network.outlook = outlook.map(Arc::new);
        }
        network
    }

    /// What the error may come to, as far as that can be told without a search; no bound.
    pub fn guess(&self, bound: i64, budget: &mut Budget) -> i64 {
        let start = self.start();
        self.with_outlook(bound, budget)
            .outlook
            .map_or(0, |outlook| outlook.sum(&start.places))
    }

    /// The parts of the canvas that a narrow search goes by: half of a usual letter of the row with the most letters.
    pub fn part(&self) -> i64 {
        let row = self.rows.iter().max_by_key(|row| row.letters());
        row.map_or(1, |row| {
            row.steps(0, row.letters()) / (2 * row.letters() as i64).max(1)
        })
        .max(1)
    }

    /// What of `budget` may be spent on the nodes about a place, so that the end is reached.
    pub fn share(&self, span: i64, budget: &Budget) -> Budget {
        let parts = (self.longest - span).max(0) / (2 * self.part());
        budget.fraction(parts as u64 + 2)
    }

    /// Whether all rows are read.
    pub fn is_end(&self, places: &[Place]) -> bool {
        places
            .iter()
            .zip(&self.rows)
            .all(|(p, row)| *p == Place::new(Reading::Before(row.letters())))
    }

    /// The entry between two places of a row that one column lies between.
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

    /// A lower bound of the error, and of the span, that is still to come; `None` at a dead end.
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
            if from == row.letters() {
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
            .outlook
            .as_ref()
            .map_or(0, |outlook| outlook.least(&state.places));
        let error = needs
            .iter()
            .map(|need| need.excess(room))
            .fold(known, i64::max);
        Some((error, longest.max(0)))
    }

    /// What is left of a row.
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
        let (mut own, mut rest) = (row.steps(from, end), row.steps(end, row.letters()));
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

    /// The wildcard of the transparent run that begins at `start` and is being passed, if it has one alone, and the
    /// least length that it has after what was passed, without and with columns that are made shorter: its other letters
    /// are as long.
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

    /// The shortest lengths of wildcards within `lengths` that make every row as long as rule R5 asks.
    pub fn settle(&self, lengths: &[(i64, i64)]) -> Option<Vec<i64>> {
        let mut chosen: Vec<i64> = lengths.iter().map(|l| l.0).collect();
        for row in self.rows.iter().filter(|row| !row.wildcards.is_empty()) {
            let wild: i64 = row.wildcards.iter().map(|(_, w)| chosen[*w]).sum();
            let mut missing = row.need - row.steps(0, row.letters()) - wild;
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
