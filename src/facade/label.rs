//! What the search knows of the ways to its nodes, and which of two ways to one node may be given
//! up (rule R9): a way that another one is as good as, whatever follows.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::network::{ENDLESS, Network, Passed, Place, Reading, State};
use super::row::Row;

/// How a path reached a node.
pub struct Label {
    /// How far each row is read.
    pub places: Box<[Place]>,
    /// Of the rows that are inside of a transparent run, in order.
    passed: Box<[Passed]>,
    /// The lengths that each wildcard can have.
    pub lengths: Box<[(i64, i64)]>,
    /// The error so far.
    pub error: i64,
    /// The sum of the longest entries so far.
    pub span: i64,
    /// What is sought first.
    pub rank: Rank,
    columns: i64,
    /// The label that it follows.
    pub parent: Option<u32>,
    /// Whether no other label makes it useless.
    pub alive: bool,
}

/// What is sought first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    /// Bound of the error.
    pub error: i64,
    /// Length of the wildcards so far.
    length: i64,
    /// Minus a bound of the columns.
    columns: i64,
}

impl Label {
    /// The letters read.
    pub fn depth(&self) -> usize {
        self.places.iter().map(|p| p.letter()).sum()
    }

    /// The node.
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
    /// Labels by the hash of their places.
    table: HashMap<u64, Vec<u32>, BuildHasherDefault<Identity>>,
    /// How many labels were compared with others.
    pub compared: u64,
}

/// The kinds of transparent runs that differ in what matters when two paths are compared.
enum Run {
    /// All three sums matter; more than the length in `most` does not.
    Sized(i64),
    /// One loose wildcard: only whether its least length is reached.
    Free(i64),
}

impl<'a> Labels<'a> {
    /// No labels yet. Errors are at most `bound`.
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

    /// Adds a label unless one like it is as good; takes away those that it makes useless.
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
        let beaten = others
            .iter()
            .any(|o| alike(self.get(*o)) && self.is_as_good(self.get(*o), &label, &deciding));
        let id = self.all.len() as u32;
        if !beaten {
            let useless: Vec<u32> = (others.iter().copied())
                .filter(|o| alike(self.get(*o)) && self.is_as_good(&label, self.get(*o), &deciding))
                .collect();
            useless
                .into_iter()
                .for_each(|o| self.all[o as usize].alive = false);
            others.push(id);
            self.all.push(label);
        }
        self.table.insert(key, others);
        (!beaten).then_some(id)
    }

    /// The wildcards whose lengths so far decide what can follow.
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

    /// Whether whatever follows `b` can follow `a` and comes out no worse. The places are the same.
    fn is_as_good(&self, a: &Label, b: &Label, deciding: &[usize]) -> bool {
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
        let Some(dearer) = self.dearer(a, b) else {
            return false;
        };
        if a.error + dearer > b.error {
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
        a.error + dearer < b.error
            || if is_same {
                x <= y
            } else {
                x.0 <= y.0 && x.1 <= y.1
            }
    }

    /// What `a` must pay to have passed all that `b` has; `None` where it cannot.
    fn dearer(&self, a: &Label, b: &Label) -> Option<i64> {
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

    /// Whether no alignment within the bound can be too long: a row that is never empty tells.
    fn is_span_idle(&self, label: &Label) -> bool {
        let row = &self.network.rows[0];
        row.wildcards.is_empty()
            && row.steps(0, row.letters()) + self.bound <= self.network.longest
            && label.error <= self.bound
    }

    /// How long a row with several wildcards can become, as far as it is read and needed.
    fn reach(&self, label: &Label, row: usize) -> i64 {
        let letter = label.places[row].letter();
        let row = &self.network.rows[row];
        let read = row.wildcards.iter().filter(|(at, _)| *at < letter);
        read.fold(0i64, |sum, (_, w)| sum.saturating_add(label.lengths[*w].1))
            .min(row.need)
    }

    /// The total length of the letters of wildcards, as far as it is known.
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

    /// No more columns than this can follow.
    fn columns_ahead(&self, places: &[Place]) -> i64 {
        let mut opaque = 0;
        for (row, place) in self.network.rows.iter().zip(places) {
            let (at, n) = (place.letter(), row.letters());
            if !row.yields && (at == n || !row.is_transparent(at) && row.run_end(at) == n) {
                return (n - at) as i64;
            }
            opaque += (n - at) as i64;
        }
        opaque
    }
}

/// FNV-1a over what tells nodes apart.
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

/// Takes keys that are hashes already.
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
