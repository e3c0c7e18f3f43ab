//! The alignment decision network of the paper's section 5.2: its nodes are how far each row is
//! read, its arcs the columns that may come next under the five constraints of rule R6. The arcs
//! are found by [`Network::expand`]; which of them to follow is the business of `search` and `ties`.
//!
//! Cuts of transparent letters (rule R7) are not nodes. While a run of transparent letters is being
//! passed, only the least and the most that its columns can take is kept: an entry of it may be as
//! long as anything between the shortest and the longest solid entry of its column at no cost. Where
//! the run ends, its length must lie between the two sums. If it does not, the last column is made
//! longer, or the last columns are made shorter, by what is missing: since all runs that are passed
//! at that time share these columns, no other choice of columns costs less (the constraint matrix
//! has consecutive ones, and right ends are met in order).

use super::budget::Budget;
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
    fn new(reading: Reading) -> Place {
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

    /// Whether all rows are read.
    pub fn is_end(&self, places: &[Place]) -> bool {
        places.iter().zip(&self.rows).all(|(p, row)| *p == Place::new(Reading::Before(row.letters())))
    }

    /// The entry between two places of a row that one column lies between.
    pub fn entry(&self, row: usize, from: Place, to: Place) -> Entry {
        let row = &self.rows[row];
        match (from.reading(), to.reading()) {
            (Reading::Before(a) | Reading::Gap(a), Reading::Before(b)) if a == b => Entry::Empty,
            (Reading::Before(a) | Reading::Gap(a), _) if !row.is_transparent(a) => Entry::Solid(a, to.letter()),
            _ => Entry::Piece(row.run_start(from.letter())),
        }
    }

    /// A lower bound of the error, and of the span, that is still to come; `None` at a dead end.
    pub fn ahead(&self, state: &State) -> Option<(i64, i64)> {
        let (mut opaque, mut longest, mut room) = (0i64, 0i64, ENDLESS);
        let mut stuck = false;
        let mut unfinished = false;
        for (i, (row, place)) in self.rows.iter().zip(&state.places).enumerate() {
            let from = place.letter();
            let sized = row.steps(from, row.letters());
            let (mut least, mut most) = (sized, sized);
            for (_, w) in row.wildcards.iter().filter(|(at, _)| *at >= from) {
                least = least.saturating_add(state.lengths[*w].0);
                most = most.saturating_add(state.lengths[*w].1);
            }
            least -= state.passed[i].most;
            most -= state.passed[i].least;
            longest = longest.max(least);
            room = room.min(most.saturating_add(if row.yields { opaque } else { 0 }));
            if from == row.letters() {
                stuck |= !row.yields || opaque == 0 || !row.may_gap(from);
            } else {
                unfinished = true;
            }
            opaque = opaque.saturating_add(row.opaque_after(from));
        }
        if stuck && unfinished { None } else { Some(((longest - room).max(0), longest.max(0))) }
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

    /// Every node that one column more can lead to from `state` with an error of at most `bound` in
    /// the end, as far as [`ahead`](Network::ahead) can tell. A column that could be parted in two
    /// at no cost is left out. Each node comes with its bound of the whole error.
    pub fn expand(&self, state: &State, bound: i64, budget: &mut Budget, sink: &mut dyn FnMut(&State, i64)) {
        let next = state.clone();
        let entries = vec![Entry::Empty; self.rows.len()];
        let mut arcs = Arcs { network: self, from: state, bound, next, entries, pieces: Vec::new(), budget, sink };
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
        let (least, most) = range.map_or((0, ENDLESS), |(shortest, longest)| (longest - left, shortest + left));
        for count in row.prefixes(at, least, most) {
            let to = at + count;
            if above.sparse && row.is_unoccludable(at, to) {
                return;
            }
            let length = row.steps(at, to);
            let opaque = row.is_opaque(at, to);
            let range = range.map_or((length, length), |(a, b)| (a.min(length), b.max(length)));
            self.entries[i] = Entry::Solid(at, to);
            self.choose(i + 1, Some(range), Above { opaque: above.opaque | opaque, sparse: above.sparse | !opaque });
        }
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
            row.wildcards.iter().any(|(at, _)| (start..row.run_end(start)).contains(at))
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
            .filter_map(|(row, entry)| if let Entry::Solid(a, b) = entry { Some((row, *a, *b)) } else { None })
            .collect();
        let Some(((row, from, to), others)) = solid.split_first() else { return false };
        let shared = |steps: i64| others.iter().all(|(r, a, b)| r.has_border(*a, *b, steps));
        let from_end = |rest: i64| others.iter().all(|(r, a, b)| r.has_border(*a, *b, r.steps(*a, *b) - rest));
        (from + 1..*to)
            .any(|middle| shared(row.steps(*from, middle)) || longest > shortest && from_end(row.steps(middle, *to)))
    }

    /// Whether the transparent run at `at` takes any length: it is one loose wildcard.
    fn is_free(&self, row: &Row, at: usize) -> bool {
        row.run_end(at) == at + 1 && row.wildcards.iter().any(|(i, w)| *i == at && self.network.wildcards[*w].loose)
    }

    /// Decides, for the transparent runs from the `n`-th passed one on, whether they end here.
    fn close(&mut self, n: usize) {
        if !self.budget.spend(1) {
            return;
        }
        let Some(&i) = self.pieces.get(n) else { return self.finish() };
        let row = &self.network.rows[i];
        let start = self.next.places[i].letter();
        let end = row.run_end(start);
        if self.may_stay(i, start, end) {
            self.close(n + 1);
        }
        let first = if row.yields { start + 1 } else { end };
        for border in first..=end {
            let reading = if border == end { Reading::Before(end) } else { Reading::Gap(border) };
            self.next.places[i] = Place::new(reading);
            let mut wildcards: Vec<(usize, i64)> = Vec::new();
            for (_, w) in row.wildcards.iter().filter(|(at, _)| (start..border).contains(at)) {
                match wildcards.iter_mut().find(|(other, _)| other == w) {
                    Some((_, count)) => *count += 1,
                    None => wildcards.push((*w, 1)),
                }
            }
            self.stretch(n, row.steps(start, border), &wildcards);
        }
        self.next.places[i] = Place::new(Reading::Inside(start));
    }

    fn may_stay(&self, i: usize, start: usize, end: usize) -> bool {
        let row = &self.network.rows[i];
        let passed = self.next.passed[i];
        let wild = row.wildcards.iter().filter(|(at, _)| (start..end).contains(at));
        let length = wild.fold(row.steps(start, end), |sum, (_, w)| sum.saturating_add(self.next.lengths[*w].1));
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
        let longer = (high + 1).max(least)..=most.min((passed.most + left - sized).div_euclid(count));
        let shorter = (least..=most.min(low - 1)).rev();
        let only_nearest = self.network.wildcards[w].loose;
        let free = low.max(least) <= high.min(most);
        let take = if !only_nearest { usize::MAX } else { usize::from(!free) };
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
        let (longer, shorter) = ((length - passed.most).max(0), (passed.least - length).max(0));
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
