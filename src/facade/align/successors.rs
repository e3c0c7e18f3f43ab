//! The successors of a node: the columns that may come next (rule R6), and the nodes after them.
//!
//! # The grammar of a column
//!
//! A column has one entry in each row, chosen from the uppermost row down:
//!
//! ```text
//! column = entry in row 1, entry in row 2, …
//! entry  = empty    if some entry above is opaque, and no letter beside the gap is attached
//!        | solid    one or more solid letters, none of them unoccludable if some entry above is
//!                   solid but not opaque
//!        | piece    a part of the transparent run that the row is in
//! ```
//!
//! At least one entry must be opaque. The error of the column is the difference of its longest and
//! its shortest solid entry. Pieces and empty entries have no part in it.
//!
//! Once the entries are chosen, each run with a piece in the column either goes on, or it ends with
//! the column, or, if its row yields, it ends at one of its own letters and the next entry of the row
//! is empty: the letters after that one follow the gap (rule R7). A run that ends must be as long as
//! the columns that it passed. What is missing is paid for, and the wildcards in it take whichever
//! lengths are left to them.
//!
//! For example, let the base be `A B A` with sizes 2 3 2, all opaque, and the row above it `C e C`
//! with C = 2 and a transparent `e` of size 4. The first column is A below C, with error 0. In the
//! second one, the base has the entries B or BA, of lengths 3 and 5, and the row has a piece of `e`.
//! With B, the run may end there: it is 4 long in a column of 3, so the column is made longer at a
//! cost of 1. The last column is A below C again, and the error of this alignment is 1. With BA, the
//! base would be at its end, and nothing opaque would be left for a column with the last C.
//!
//! # Columns that are left out
//!
//! Among alignments of one error, those with more columns are better (rule R9). So a column that
//! can be divided into two without a greater error is left out: the same letters are reached by the
//! two columns, one after the other. `is_divisible` recognizes this while entries are still chosen
//! (then all longer columns are left out as well), `is_reducible` once they are.

use super::network::Network;
use super::place::{ENDLESS, Entry, Passed, Place, Reading, State};
use super::row::Row;
use crate::budget::Budget;

impl Network {
    /// Calls `sink` with every node that one more column can lead to from `state`, and with a lower
    /// bound of the whole error through that node. Nodes whose bound is above `bound` are left out,
    /// and columns that can be divided at no cost.
    pub fn expand(
        &self,
        state: &State,
        bound: i64,
        budget: &mut Budget,
        sink: &mut dyn FnMut(&State, i64),
    ) {
        let next = state.clone();
        let entries = vec![Entry::Empty; self.rows.len()];
        let mut columns = Columns {
            network: self,
            from: state,
            bound,
            next,
            entries,
            pieces: Vec::new(),
            budget,
            sink,
        };
        columns.choose(0, None, Above::default());
    }
}

/// What is known of the entries above while a column is put together.
#[derive(Clone, Copy, Default)]
struct Above {
    /// Whether one of them is wholly opaque.
    opaque: bool,
    /// Whether one of them is solid, but not wholly opaque.
    sparse: bool,
}

/// The columns after a node.
struct Columns<'a> {
    network: &'a Network,
    from: &'a State,
    bound: i64,
    /// The node that is being put together.
    next: State,
    /// The entry of each row.
    entries: Vec<Entry>,
    /// The rows with a piece in the column. It is decided in this order which runs end.
    pieces: Vec<usize>,
    budget: &'a mut Budget,
    sink: &'a mut dyn FnMut(&State, i64),
}

impl Columns<'_> {
    /// Chooses the entries from row `i` down. `range` holds the shortest and the longest solid entry
    /// above.
    fn choose(&mut self, i: usize, range: Option<(i64, i64)>, above: Above) {
        if !self.budget.spend(1) {
            return;
        }
        let Some(row) = self.network.rows.get(i) else {
            if let (Some((shortest, longest)), true) = (range, above.opaque) {
                self.column(shortest, longest);
            }
            return;
        };
        let reading = self.from.places[i].reading();
        if let Reading::Before(at) | Reading::Gap(at) = reading
            && above.opaque
            && row.yields
            && row.may_gap(at)
        {
            self.entries[i] = Entry::Empty;
            self.choose(i + 1, range, above);
        }
        match reading {
            Reading::Gap(_) => {}
            Reading::Before(at) if at == row.count() => {}
            Reading::Before(at) if !row.is_transparent(at) => self.solid(i, at, range, above),
            Reading::Before(at) | Reading::Inside(at) => {
                self.entries[i] = Entry::Piece(at);
                self.choose(i + 1, range, above);
            }
        }
    }

    /// Chooses solid letters from the letter `at` on for row `i`.
    fn solid(&mut self, i: usize, at: usize, range: Option<(i64, i64)>, above: Above) {
        let row = &self.network.rows[i];
        let left = self.bound - self.from.error;
        let (least, most) = range.map_or((0, ENDLESS), |(shortest, longest)| {
            (longest - left, shortest + left)
        });
        let first = range.is_none();
        for count in row.prefixes(at, least, most) {
            let to = at + count;
            if above.sparse && row.is_unoccludable(at, to) {
                return;
            }
            let length = row.steps(at, to);
            let opaque = row.is_opaque(at, to);
            let range = range.map_or((length, length), |(a, b)| (a.min(length), b.max(length)));
            self.entries[i] = Entry::Solid(at, to);
            self.choose(
                i + 1,
                Some(range),
                Above {
                    opaque: above.opaque | opaque,
                    sparse: above.sparse | !opaque,
                },
            );
            if first && self.is_divisible(i, length, left) {
                return;
            }
        }
    }

    /// Whether every column whose entry in row `i`, the first solid one, is longer than `length` can
    /// be divided there.
    fn is_divisible(&self, i: usize, length: i64, left: i64) -> bool {
        let rows = self.network.rows.iter().zip(&self.from.places).enumerate();
        rows.into_iter()
            .all(|(j, (row, place))| match place.reading() {
                Reading::Before(at) if at < row.count() && !row.is_transparent(at) => {
                    j <= i || left == 0 && row.has_border(at, row.run_end(at) + 1, length)
                }
                Reading::Before(at) | Reading::Inside(at) if at < row.count() => {
                    left == 0 || self.is_free(row, at) || self.from.passed[j].spare + length > left
                }
                _ => true,
            })
    }

    /// Makes nodes of the entries that were chosen.
    fn column(&mut self, shortest: i64, longest: i64) {
        self.next.clone_from(self.from);
        self.next.error += longest - shortest;
        self.next.span += longest;
        if self.next.error > self.bound || self.is_reducible(shortest, longest) {
            return;
        }
        self.pieces.clear();
        for (i, entry) in self.entries.iter().enumerate() {
            let reading = match *entry {
                Entry::Empty => Reading::Before(self.from.places[i].letter()),
                Entry::Solid(_, to) => Reading::Before(to),
                Entry::Piece(at) => {
                    let passed = &mut self.next.passed[i];
                    passed.least += shortest;
                    passed.most += longest;
                    passed.spare += shortest - 1;
                    self.pieces.push(i);
                    Reading::Inside(at)
                }
            };
            self.next.places[i] = Place::new(reading);
        }
        // Runs with wildcards are decided last: they cost nothing in whatever the others add to the
        // column.
        let from = self.from;
        let wild = |i: &usize| {
            let row = &self.network.rows[*i];
            let start = from.places[*i].letter();
            row.wildcards
                .iter()
                .any(|(at, _)| (start..row.run_end(start)).contains(at))
        };
        self.pieces.sort_by_key(wild);
        self.close(0);
    }

    /// Whether the column can be divided into two columns of the same error.
    fn is_reducible(&self, shortest: i64, longest: i64) -> bool {
        let left = self.bound - self.next.error;
        let scarce = |i: &usize| {
            let (row, at) = (&self.network.rows[*i], self.from.places[*i].letter());
            matches!(self.entries[*i], Entry::Piece(_))
                && self.from.passed[*i].spare + shortest - 2 < left
                && !self.is_free(row, at)
        };
        if left > 0 && (0..self.entries.len()).any(|i| scarce(&i)) {
            return false;
        }
        let solid: Vec<(&Row, usize, usize)> = (self.network.rows.iter().zip(&self.entries))
            .filter_map(|(row, entry)| {
                if let Entry::Solid(a, b) = entry {
                    Some((row, *a, *b))
                } else {
                    None
                }
            })
            .collect();
        let Some(((row, from, to), others)) = solid.split_first() else {
            return false;
        };
        let shared = |steps: i64| others.iter().all(|(r, a, b)| r.has_border(*a, *b, steps));
        let from_end = |rest: i64| {
            others
                .iter()
                .all(|(r, a, b)| r.has_border(*a, *b, r.steps(*a, *b) - rest))
        };
        (from + 1..*to).any(|middle| {
            shared(row.steps(*from, middle))
                || longest > shortest && from_end(row.steps(middle, *to))
        })
    }

    /// Whether the transparent run at `at` takes any length: it is one loose wildcard.
    fn is_free(&self, row: &Row, at: usize) -> bool {
        row.run_end(at) == at + 1
            && row
                .wildcards
                .iter()
                .any(|(i, w)| *i == at && self.network.wildcards[*w].loose)
    }

    /// Decides for the runs from the `n`-th piece on where they end.
    fn close(&mut self, n: usize) {
        if !self.budget.spend(1) {
            return;
        }
        let Some(&i) = self.pieces.get(n) else {
            return self.finish();
        };
        let row = &self.network.rows[i];
        let start = self.next.places[i].letter();
        let end = row.run_end(start);
        if self.may_stay(i, start, end) && !self.is_beyond(i) {
            self.close(n + 1);
        }
        let first = if row.yields { start + 1 } else { end };
        for border in first..=end {
            let reading = if border == end {
                Reading::Before(end)
            } else {
                Reading::Gap(border)
            };
            self.next.places[i] = Place::new(reading);
            if self.is_beyond(i) {
                continue;
            }
            let mut wildcards: Vec<(usize, i64)> = Vec::new();
            for (_, w) in row
                .wildcards
                .iter()
                .filter(|(at, _)| (start..border).contains(at))
            {
                match wildcards.iter_mut().find(|(other, _)| other == w) {
                    Some((_, count)) => *count += 1,
                    None => wildcards.push((*w, 1)),
                }
            }
            self.stretch(n, row.steps(start, border), &wildcards);
        }
        self.next.places[i] = Place::new(Reading::Inside(start));
    }

    /// Whether a row brings too great an error from its next place on.
    fn is_beyond(&self, row: usize) -> bool {
        let lower_bound = self.network.lower_bound.as_ref();
        lower_bound
            .is_some_and(|o| self.next.error + o.least_of(row, &self.next.places) > self.bound)
    }

    /// Whether the run of row `i` can go on: the columns that it passed, made as short as the bound
    /// allows, are not yet as long as the whole run.
    fn may_stay(&self, i: usize, start: usize, end: usize) -> bool {
        let row = &self.network.rows[i];
        let passed = self.next.passed[i];
        let wild = row
            .wildcards
            .iter()
            .filter(|(at, _)| (start..end).contains(at));
        let length = wild.fold(row.steps(start, end), |sum, (_, w)| {
            sum.saturating_add(self.next.lengths[*w].1)
        });
        passed.least - passed.spare.min(self.bound - self.next.error) < length
    }

    /// Ends the run of the `n`-th piece, whose length is `sized` and that of its wildcards. Each
    /// wildcard comes with the number of its letters.
    fn stretch(&mut self, n: usize, sized: i64, wildcards: &[(usize, i64)]) {
        match wildcards {
            [] => self.settle(n, sized),
            [(w, count)] => self.stretch_one(n, sized, *w, *count),
            [(w, count), rest @ ..] => {
                let (least, most) = self.next.lengths[*w];
                let others: i64 = rest.iter().map(|(w, c)| self.next.lengths[*w].0 * c).sum();
                let left = self.bound - self.next.error;
                let room = self.next.passed[self.pieces[n]].most + left - sized - others;
                for length in least..=most.min(room / count) {
                    if !self.budget.spend(1) {
                        break;
                    }
                    self.next.lengths[*w] = (length, length);
                    self.stretch(n, sized + length * count, rest);
                }
                self.next.lengths[*w] = (least, most);
            }
        }
    }

    /// Ends the run of the `n`-th piece, whose last undecided wildcard is `w` with `count` letters.
    /// Lengths that cost nothing stay open as an interval; each length that costs something is tried
    /// alone, the cheapest first.
    fn stretch_one(&mut self, n: usize, sized: i64, w: usize, count: i64) {
        let passed = self.next.passed[self.pieces[n]];
        let (least, most) = self.next.lengths[w];
        let missing = passed.least - sized;
        let low = missing.div_euclid(count) + i64::from(missing.rem_euclid(count) != 0);
        let high = (passed.most - sized).div_euclid(count);
        let left = self.bound - self.next.error;
        if low.max(least) <= high.min(most) {
            self.next.lengths[w] = (low.max(least), high.min(most));
            self.close(n + 1);
        }
        let longer =
            (high + 1).max(least)..=most.min((passed.most + left - sized).div_euclid(count));
        let shorter = (least..=most.min(low - 1)).rev();
        let only_nearest = self.network.wildcards[w].loose || self.network.is_thrifty;
        let free = low.max(least) <= high.min(most);
        let take = if !only_nearest {
            usize::MAX
        } else {
            usize::from(!free)
        };
        for length in longer.take(take) {
            self.next.lengths[w] = (length, length);
            self.settle(n, sized + length * count);
        }
        for length in shorter.take(take) {
            if passed.least - (sized + length * count) > left.min(passed.spare) {
                break;
            }
            self.next.lengths[w] = (length, length);
            self.settle(n, sized + length * count);
        }
        self.next.lengths[w] = (least, most);
    }

    /// Ends the run of the `n`-th piece, which is `length` long, and goes on with the next one.
    fn settle(&mut self, n: usize, length: i64) {
        let passed = self.next.passed[self.pieces[n]];
        let (longer, shorter) = (
            (length - passed.most).max(0),
            (passed.least - length).max(0),
        );
        if shorter > passed.spare || self.next.error + longer + shorter > self.bound {
            return;
        }
        if longer + shorter == 0 {
            return self.close(n + 1);
        }
        let before: Vec<Passed> = self.pieces.iter().map(|i| self.next.passed[*i]).collect();
        for i in &self.pieces {
            let passed = &mut self.next.passed[*i];
            let less = shorter.min(passed.spare);
            passed.least -= less;
            passed.spare -= less;
            passed.most += longer;
        }
        self.next.error += longer + shorter;
        self.next.span += longer;
        self.close(n + 1);
        self.next.error -= longer + shorter;
        self.next.span -= longer;
        for (i, passed) in self.pieces.iter().zip(before) {
            self.next.passed[*i] = passed;
        }
    }

    /// Gives the node to the sink, unless its bound is too great.
    fn finish(&mut self) {
        let mut state = self.next.clone();
        for (i, place) in state.places.iter().enumerate() {
            let passed = &mut state.passed[i];
            if !place.is_inside() {
                *passed = Passed::default();
            }
            passed.spare = passed.spare.min(self.bound - state.error);
        }
        if let Some((error, span)) = self.network.ahead(&state)
            && state.error + error <= self.bound
            && state.span + span <= self.network.longest
        {
            (self.sink)(&state, state.error + error);
        }
    }
}
