//! The columns that may come next (rule R6): entries are chosen row by row from the top, then it is
//! decided which transparent runs end (rule R7). See `network` for what the nodes hold.

use super::budget::Budget;
use super::network::{ENDLESS, Entry, Network, Passed, Place, Reading, State};
use super::row::Row;

impl Network {
    /// Every node that one column more can lead to from `state` with an error of at most `bound` in
    /// the end, as far as [`ahead`](Network::ahead) can tell. A column that could be parted in two
    /// at no cost is left out. Each node comes with its bound of the whole error.
    pub fn expand(
        &self,
        state: &State,
        bound: i64,
        budget: &mut Budget,
        sink: &mut dyn FnMut(&State, i64),
    ) {
        let next = state.clone();
        let entries = vec![Entry::Empty; self.rows.len()];
        let mut arcs = Arcs {
            network: self,
            from: state,
            bound,
            next,
            entries,
            pieces: Vec::new(),
            budget,
            sink,
        };
        arcs.choose(0, None, Above::default());
    }
}

/// What is known of the entries above, while a column is put together.
#[derive(Clone, Copy, Default)]
struct Above {
    /// One of them is wholly opaque.
    opaque: bool,
    /// One of them is solid and not wholly opaque.
    sparse: bool,
}

struct Arcs<'a> {
    network: &'a Network,
    from: &'a State,
    bound: i64,
    next: State,
    entries: Vec<Entry>,
    pieces: Vec<usize>,
    budget: &'a mut Budget,
    sink: &'a mut dyn FnMut(&State, i64),
}

impl Arcs<'_> {
    /// Chooses the entries from row `i` down; `range` holds the shortest and the longest solid entry.
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
            Reading::Before(at) if at == row.letters() => {}
            Reading::Before(at) if !row.is_transparent(at) => self.solid(i, at, range, above),
            Reading::Before(at) | Reading::Inside(at) => {
                self.entries[i] = Entry::Piece(at);
                self.choose(i + 1, range, above);
            }
        }
    }

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

    /// Whether every column that begins with the entry of row `i`, the first solid one, and is longer
    /// than `length` falls in two there.
    fn is_divisible(&self, i: usize, length: i64, left: i64) -> bool {
        let rows = self.network.rows.iter().zip(&self.from.places).enumerate();
        rows.into_iter()
            .all(|(j, (row, place))| match place.reading() {
                Reading::Before(at) if at < row.letters() && !row.is_transparent(at) => {
                    j <= i || left == 0 && row.has_border(at, row.run_end(at) + 1, length)
                }
                Reading::Before(at) | Reading::Inside(at) if at < row.letters() => {
                    left == 0 || self.is_free(row, at) || self.from.passed[j].spare + length > left
                }
                _ => true,
            })
    }

    /// Takes the column that was put together.
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
        // Wildcards last: what the other runs add to the column costs them nothing.
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

    /// Whether the column is two columns of the same error together: they are reached one by one.
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

    /// Decides, for the transparent runs from the `n`-th passed one on, whether they end here.
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

    /// Whether a row brings more than the bound from its next place on.
    fn is_beyond(&self, row: usize) -> bool {
        let outlook = self.network.outlook.as_ref();
        outlook.is_some_and(|o| self.next.error + o.least_of(row, &self.next.places) > self.bound)
    }

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

    /// Ends the `n`-th passed run: it is `sized` and its wildcards long.
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

    /// Ends the `n`-th passed run, which is `length` long, and goes on with the next one.
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
