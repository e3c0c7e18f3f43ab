//! Dominance between labels: which of two paths to one node can be dropped because the other one is as
//! good, whatever follows (rule R9).
//!
//! A label says how a path reached its places: the error so far, what was passed of the transparent
//! runs that are still open, and the lengths that wildcards can still have. Label `a` dominates label
//! `b` at the same places if it can follow each completion of `b` and come out no worse.
//!
//! # Conditions
//!
//! 1. Each wildcard whose length still matters can have every length after `a` that it can have after
//!    `b`.
//! 2. `a` can pay to have passed all that `b` has: with its last column made `longer`, and earlier ones
//!    made `shorter`, the interval from the least to the most that each open run has passed covers
//!    that of `b`. Lengths beyond the end of a run do not count. As much can be shortened later, and
//!    the columns are not too long for the canvas.
//! 3. The error of `a` with this payment is at most the error of `b`.
//! 4. A row with several wildcards can become as long after `a` as after `b`, as far as rule R5 needs.
//! 5. If the errors are equal after the payment, `a` is not worse in what is compared next: the length of
//!    wildcards, then the number of columns. If the lengths that wildcards can have differ, it must
//!    be no worse in both, as the order of the two may change on the way.
//!
//! # Proof
//!
//! Take any completion of `b`, a list of columns to the end. Which columns may follow depends on the
//! places alone, and so does the error of the entries of each. So `a` with its payment can follow
//! the same columns. What remains is the cost at the end of each run. It is the distance from the
//! length of the run to the interval of what was passed. The columns after the node add the same to
//! both intervals, so that by (2) the interval of `a` still covers that of `b` when the run ends, and
//! the distance is no greater. What is paid there widens the intervals of all other open runs by as
//! much; if `a` pays less than `b`, the difference is a payment as in (2) that it can still make. So
//! after each column `a` still dominates. By (1), the wildcards in the run can have the same lengths.
//! At the end, (4) and the canvas hold for `a` as they do for `b`. By (3) its error is at most that
//! of `b`, and if it is equal, (5) decides in favour of `a`. ∎

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::network::Network;
use super::place::{ENDLESS, Passed, Place, Reading, State, depth};
use super::row::Row;

/// The way in which a path reached its places.
pub struct Label {
    /// The place in each row.
    pub places: Box<[Place]>,
    /// What was passed of transparent runs, for those rows in order that are inside of one.
    passed: Box<[Passed]>,
    /// The least and the greatest length that each wildcard can have.
    pub lengths: Box<[(i64, i64)]>,
    /// The error so far.
    pub error: i64,
    /// The sum of the longest entries so far.
    pub span: i64,
    /// The order in which labels are followed.
    pub rank: Rank,
    columns: i64,
    /// The label before the last column.
    pub parent: Option<u32>,
    /// Whether no other label dominates it.
    pub alive: bool,
}

/// The order in which labels are followed: the least first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    /// A lower bound of the whole error.
    pub error: i64,
    /// The length of the wildcards so far.
    length: i64,
    /// Minus an upper bound of the number of columns.
    columns: i64,
}

impl Label {
    /// The number of letters read.
    pub fn depth(&self) -> usize {
        depth(&self.places)
    }

    /// The node of the network.
    pub fn state(&self) -> State {
        let mut inside = self.passed.iter();
        let mut passed = |p: &Place| {
            if p.is_inside() {
                inside.next().copied().unwrap_or_default()
            } else {
                Passed::default()
            }
        };
        State {
            places: self.places.to_vec(),
            passed: self.places.iter().map(&mut passed).collect(),
            lengths: self.lengths.to_vec(),
            error: self.error,
            span: self.span,
        }
    }
}

/// The labels of a search.
pub struct Labels<'a> {
    network: &'a Network,
    bound: i64,
    all: Vec<Label>,
    /// Labels by the hash of their places. Different places may share a hash.
    table: HashMap<u64, Vec<u32>, BuildHasherDefault<Identity>>,
    /// How many comparisons of labels were made.
    pub compared: u64,
}

/// The two kinds of transparent runs in a comparison of two labels.
enum Run {
    /// All that was passed matters, but what is above this length in the greatest sum.
    Sized(i64),
    /// The run is a single loose wildcard: all that matters is whether this least length is reached.
    Free(i64),
}

impl<'a> Labels<'a> {
    /// No labels yet, for a search for errors of at most `bound`.
    pub fn new(network: &'a Network, bound: i64) -> Labels<'a> {
        Labels {
            network,
            bound,
            all: Vec::new(),
            table: HashMap::default(),
            compared: 0,
        }
    }

    /// The label with this number.
    pub fn get(&self, id: u32) -> &Label {
        &self.all[id as usize]
    }

    /// Adds a label for a node unless another one dominates it, and drops those that it dominates.
    /// `bound` is the lower bound of its whole error.
    pub fn insert(&mut self, state: &State, bound: i64, parent: Option<u32>) -> Option<u32> {
        let columns = parent.map_or(0, |p| self.get(p).columns + 1);
        let rank = Rank {
            error: bound,
            length: self.length(state),
            columns: -(columns + self.columns_ahead(&state.places)),
        };
        let inside = state
            .places
            .iter()
            .zip(&state.passed)
            .filter(|(place, _)| place.is_inside());
        let label = Label {
            places: state.places.clone().into(),
            passed: inside.map(|(_, passed)| *passed).collect(),
            lengths: state.lengths.clone().into(),
            error: state.error,
            span: state.span,
            rank,
            columns,
            parent,
            alive: true,
        };
        let deciding = self.deciding(&state.places);
        let key = hash(&label.places);
        let mut others = self.table.remove(&key).unwrap_or_default();
        others.retain(|o| self.get(*o).alive);
        self.compared += others.len() as u64;
        let alike = |other: &Label| other.alive && other.places == label.places;
        let is_dominated = others
            .iter()
            .map(|o| self.get(*o))
            .any(|other| alike(other) && self.dominates(other, &label, &deciding));
        let id = self.all.len() as u32;
        if !is_dominated {
            let dominated: Vec<u32> = (others.iter().copied())
                .filter(|o| alike(self.get(*o)) && self.dominates(&label, self.get(*o), &deciding))
                .collect();
            for other in dominated {
                self.all[other as usize].alive = false;
            }
            others.push(id);
            self.all.push(label);
        }
        self.table.insert(key, others);
        (!is_dominated).then_some(id)
    }

    /// The wildcards whose lengths after these places still matter.
    fn deciding(&self, places: &[Place]) -> Vec<usize> {
        let pending = |w: usize| {
            let rows = self.network.rows.iter().zip(places);
            rows.into_iter().any(|(row, p)| {
                row.wildcards
                    .iter()
                    .any(|(at, v)| *v == w && *at >= p.letter())
            })
        };
        let wildcards = self.network.wildcards.iter().enumerate();
        wildcards
            .filter(|(w, wildcard)| wildcard.kept || !wildcard.loose && pending(*w))
            .map(|(w, _)| w)
            .collect()
    }

    /// Whether `a` dominates `b`, which is at the same places; see the proof above. `deciding` are the
    /// wildcards whose lengths matter.
    fn dominates(&self, a: &Label, b: &Label, deciding: &[usize]) -> bool {
        if a.error > b.error {
            return false;
        }
        let mut is_same = true;
        for w in deciding {
            let (x, y) = (a.lengths[*w], b.lengths[*w]);
            if x.0 > y.0 || x.1 < y.1 {
                return false;
            }
            is_same &= x == y;
        }
        let Some(payment) = self.payment(a, b) else {
            return false;
        };
        if a.error + payment > b.error {
            return false;
        }
        let reach = |row| self.reach(a, row) >= self.reach(b, row);
        let needy =
            (0..self.network.rows.len()).filter(|i| self.network.rows[*i].wildcards.len() > 1);
        if !needy.into_iter().all(reach) {
            return false;
        }
        let (x, y) = (
            (a.rank.length, a.rank.columns),
            (b.rank.length, b.rank.columns),
        );
        a.error + payment < b.error
            || if is_same {
                x <= y
            } else {
                x.0 <= y.0 && x.1 <= y.1
            }
    }

    /// The error that `a` must add to have passed all that `b` has; `None` if it cannot.
    fn payment(&self, a: &Label, b: &Label) -> Option<i64> {
        let (mut longer, mut shorter) = (0i64, 0i64);
        let inside = || {
            a.places
                .iter()
                .zip(&self.network.rows)
                .filter(|(p, _)| p.is_inside())
        };
        for (n, (place, row)) in inside().enumerate() {
            let (x, y) = (a.passed[n], b.passed[n]);
            match self.run(row, place.letter()) {
                Run::Free(least) => longer = longer.max(y.most.min(least) - x.most),
                Run::Sized(most) => {
                    longer = longer.max(y.most.min(most) - x.most);
                    shorter = shorter.max(x.least - y.least);
                }
            }
        }
        if a.span + longer > b.span && !self.is_span_idle(a) {
            return None;
        }
        for (n, (place, row)) in inside().enumerate() {
            if let Run::Sized(_) = self.run(row, place.letter())
                && a.passed[n].spare - shorter < b.passed[n].spare
            {
                return None;
            }
        }
        Some(longer + shorter)
    }

    /// The kind of the run that begins at the letter `at`.
    fn run(&self, row: &Row, at: usize) -> Run {
        let end = row.run_end(at);
        let wild = row.wildcards.iter().filter(|(i, _)| (at..end).contains(i));
        match wild.map(|(_, w)| *w).collect::<Vec<_>>()[..] {
            [] => Run::Sized(row.steps(at, end)),
            [w] if end == at + 1 && self.network.wildcards[w].loose && row.wildcards.len() == 1 => {
                Run::Free(self.network.wildcards[w].least)
            }
            _ => Run::Sized(ENDLESS),
        }
    }

    /// Whether no alignment within the bound can be too long for the canvas. The uppermost row is never
    /// empty, so that the columns are at most as long as it and the error.
    fn is_span_idle(&self, label: &Label) -> bool {
        let row = &self.network.rows[0];
        row.wildcards.is_empty()
            && row.steps(0, row.count()) + self.bound <= self.network.longest
            && label.error <= self.bound
    }

    /// The greatest length of the wildcards that were read in a row, as far as the row needs it.
    fn reach(&self, label: &Label, row: usize) -> i64 {
        let letter = label.places[row].letter();
        let row = &self.network.rows[row];
        let read = row.wildcards.iter().filter(|(at, _)| *at < letter);
        read.fold(0i64, |sum, (_, w)| sum.saturating_add(label.lengths[*w].1))
            .min(row.need)
    }

    /// The least total length of the letters of wildcards, as far as it is known.
    fn length(&self, state: &State) -> i64 {
        let mut least: Vec<i64> = state.lengths.iter().map(|(least, _)| *least).collect();
        for (i, (row, place)) in self.network.rows.iter().zip(&state.places).enumerate() {
            if let Reading::Inside(at) = place.reading()
                && let Some((_, w)) = row.wildcards.iter().find(|(j, _)| *j == at)
                && row.run_end(at) == at + 1
            {
                least[*w] = least[*w].max(state.passed[i].least - state.passed[i].spare);
            }
        }
        let copies = self.network.wildcards.iter().map(|w| w.copies);
        copies.zip(least).fold(0i64, |sum, (n, least)| {
            sum.saturating_add(n.saturating_mul(least))
        })
    }

    /// An upper bound of the number of columns that can follow. A row that never yields and is solid
    /// to its end has at least one letter in each column; otherwise each column reads an opaque letter
    /// of some row.
    fn columns_ahead(&self, places: &[Place]) -> i64 {
        let mut opaque = 0;
        for (row, place) in self.network.rows.iter().zip(places) {
            let (at, n) = (place.letter(), row.count());
            if !row.yields && (at == n || !row.is_transparent(at) && row.run_end(at) == n) {
                return (n - at) as i64;
            }
            opaque += (n - at) as i64;
        }
        opaque
    }
}

/// A hash of places, like FNV-1a with a rotation for each number.
fn hash(places: &[Place]) -> u64 {
    let places = places
        .iter()
        .map(|p| (p.letter() as u64) << 8 | u64::from(p.is_inside()));
    places.fold(0xcbf2_9ce4_8422_2325, |hash: u64, value| {
        (hash ^ value)
            .wrapping_mul(0x0000_0100_0000_01b3)
            .rotate_left(17)
    })
}

/// A hasher for keys that are hashes already.
#[derive(Default)]
struct Identity(u64);

impl Hasher for Identity {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 << 8) ^ u64::from(*byte);
        }
    }

    fn write_u64(&mut self, value: u64) {
        self.0 = value.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}
