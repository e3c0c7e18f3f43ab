//! The best alignment of one candidate (rules R6, R7, R9): the shortest path through the alignment
//! decision network. Lengths of wildcards are found on the way. The search goes on from the node
//! with the least bound of the error first; nodes that are no better than another one at the same
//! place are given up. When the exact search is too long, a narrow one takes only the most promising
//! nodes of each depth.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, HashMap};
use std::hash::{BuildHasherDefault, Hasher};

use super::budget::Budget;
use super::network::{ENDLESS, Network, Passed, Place, Reading, State};

/// An alignment, and how good it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alignment {
    /// The error, in steps.
    pub error: i64,
    /// The lengths that each wildcard can have.
    pub lengths: Vec<(i64, i64)>,
    /// Where the rows are read to: at the start, and after every column.
    pub path: Vec<Vec<Place>>,
}

/// The steps that a narrow search may take for one node.
const NODE_STEPS: u64 = 400;

/// How widely to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// All that can lead to the best.
    Exact,
    /// At most this many nodes at each depth.
    Narrow(usize),
    /// At most this many nodes at each depth, and only those that sizes can be found for: see `constrained`.
    Sizable(usize),
}

/// The alignment of least error up to `bound`; among these, of the least total length of wildcards;
/// among these, of most columns. Where wildcards are kept, one alignment per set of their lengths
/// that no better one has too.
pub fn align(network: &Network, bound: i64, width: Width, budget: &mut Budget) -> Vec<Alignment> {
    let mut search = Search {
        network,
        bound,
        labels: Vec::new(),
        table: HashMap::default(),
        ends: Vec::new(),
        kept: network.wildcards.iter().any(|w| w.kept),
    };
    let start = network.start();
    let Some((ahead, span)) = network.ahead(&start) else { return Vec::new() };
    if ahead > bound || span > network.longest {
        return Vec::new();
    }
    search.insert(&start, ahead, None);
    match width {
        Width::Exact => search.best_first(budget),
        Width::Narrow(width) | Width::Sizable(width) => search.by_depth(width, budget),
    }
    search.ends.iter().map(|end| search.alignment(*end)).collect()
}

/// How a path reached a node.
struct Label {
    places: Box<[Place]>,
    /// Of the rows that are inside of a transparent run, in order.
    passed: Box<[Passed]>,
    lengths: Box<[(i64, i64)]>,
    error: i64,
    span: i64,
    rank: Rank,
    columns: i64,
    parent: Option<u32>,
    alive: bool,
}

/// What is sought first: bound of the error, length of the wildcards so far, minus a bound of the columns.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    error: i64,
    length: i64,
    columns: i64,
}

struct Search<'a> {
    network: &'a Network,
    bound: i64,
    labels: Vec<Label>,
    table: HashMap<u64, Vec<u32>, BuildHasherDefault<Identity>>,
    ends: Vec<u32>,
    kept: bool,
}

/// The kinds of transparent runs that differ in what matters when two paths are compared.
enum Run {
    /// All three sums matter; more than the length in `most` does not.
    Sized(i64),
    /// One loose wildcard: only whether its least length is reached.
    Free(i64),
}

impl Search<'_> {
    fn best_first(&mut self, budget: &mut Budget) {
        let mut queue = BinaryHeap::new();
        let entry = |labels: &[Label], id: u32| {
            let label = &labels[id as usize];
            let depth: usize = label.places.iter().map(|p| p.letter()).sum();
            Reverse((label.rank, Reverse(depth), id))
        };
        queue.push(entry(&self.labels, 0));
        while let Some(Reverse((_, _, id))) = queue.pop() {
            if !self.labels[id as usize].alive {
                continue;
            }
            let label = &self.labels[id as usize];
            if self.network.is_end(&label.places) {
                if self.network.settle(&label.lengths).is_some() {
                    self.ends.push(id);
                    if !self.kept {
                        return;
                    }
                }
                continue;
            }
            for new in self.follow(id, budget) {
                queue.push(entry(&self.labels, new));
            }
            if budget.exhausted {
                return;
            }
        }
    }

    fn by_depth(&mut self, width: usize, budget: &mut Budget) {
        let mut open: BTreeMap<usize, Vec<u32>> = BTreeMap::from([(0, vec![0])]);
        while let Some((_, mut ids)) = open.pop_first() {
            ids.retain(|id| self.labels[*id as usize].alive);
            ids.sort_by_key(|id| (self.labels[*id as usize].rank, *id));
            ids.truncate(width);
            for id in ids {
                let label = &self.labels[id as usize];
                if self.network.is_end(&label.places) {
                    if self.network.settle(&label.lengths).is_some() {
                        self.ends = vec![id];
                        return;
                    }
                    continue;
                }
                // One node may not take what all the others need.
                let mut part = budget.part(NODE_STEPS);
                let followers = self.follow(id, &mut part);
                budget.charge(&part);
                for new in followers {
                    let depth = self.labels[new as usize].places.iter().map(|p| p.letter()).sum();
                    open.entry(depth).or_default().push(new);
                }
            }
            if !budget.spend(1) {
                return;
            }
        }
    }

    /// Makes the labels that follow `id`.
    fn follow(&mut self, id: u32, budget: &mut Budget) -> Vec<u32> {
        let state = self.state(id);
        let mut found: Vec<(State, i64)> = Vec::new();
        self.network.expand(&state, self.bound, budget, &mut |next, bound| found.push((next.clone(), bound)));
        found.iter().filter_map(|(next, bound)| self.insert(next, *bound, Some(id))).collect()
    }

    fn state(&self, id: u32) -> State {
        let label = &self.labels[id as usize];
        let mut inside = label.passed.iter();
        let passed = label
            .places
            .iter()
            .map(|p| if p.is_inside() { inside.next().copied().unwrap_or_default() } else { Passed::default() })
            .collect();
        State {
            places: label.places.to_vec(),
            passed,
            lengths: label.lengths.to_vec(),
            error: label.error,
            span: label.span,
        }
    }

    /// Adds a label unless one like it is as good; takes away those that it makes useless.
    fn insert(&mut self, state: &State, bound: i64, parent: Option<u32>) -> Option<u32> {
        let columns = parent.map_or(0, |p| self.labels[p as usize].columns + 1);
        let rank =
            Rank { error: bound, length: self.length(state), columns: -(columns + self.columns_ahead(&state.places)) };
        let inside = state.places.iter().zip(&state.passed).filter(|(place, _)| place.is_inside());
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
        let key = hash(&label, &deciding);
        let others = self.table.get(&key).cloned().unwrap_or_default();
        let same = |other: &Label| {
            other.places == label.places && deciding.iter().all(|w| other.lengths[*w] == label.lengths[*w])
        };
        let alike: Vec<u32> = others.into_iter().filter(|o| same(&self.labels[*o as usize])).collect();
        if alike.iter().any(|o| self.labels[*o as usize].alive && self.is_as_good(&self.labels[*o as usize], &label)) {
            return None;
        }
        for other in alike {
            if self.labels[other as usize].alive && self.is_as_good(&label, &self.labels[other as usize]) {
                self.labels[other as usize].alive = false;
            }
        }
        let id = self.labels.len() as u32;
        let labels = &self.labels;
        let list = self.table.entry(key).or_default();
        list.retain(|o| labels[*o as usize].alive);
        list.push(id);
        self.labels.push(label);
        Some(id)
    }

    /// The wildcards whose lengths so far decide what can follow.
    fn deciding(&self, places: &[Place]) -> Vec<usize> {
        let pending = |w: usize| {
            let rows = self.network.rows.iter().zip(places);
            rows.into_iter().any(|(row, p)| row.wildcards.iter().any(|(at, v)| *v == w && *at >= p.letter()))
        };
        let wildcards = self.network.wildcards.iter().enumerate();
        wildcards.filter(|(w, wildcard)| wildcard.kept || !wildcard.loose && pending(*w)).map(|(w, _)| w).collect()
    }

    /// Whether whatever follows `b` can follow `a` and comes out no worse.
    fn is_as_good(&self, a: &Label, b: &Label) -> bool {
        let (mut longer, mut shorter) = (0i64, 0i64);
        let inside = a.places.iter().zip(&self.network.rows).filter(|(p, _)| p.is_inside());
        for (n, (place, row)) in inside.enumerate() {
            let (x, y) = (a.passed[n], b.passed[n]);
            match self.run(row, place.letter()) {
                Run::Free(least) => longer = longer.max(y.most.min(least) - x.most),
                Run::Sized(most) => {
                    longer = longer.max(y.most.min(most) - x.most);
                    shorter = shorter.max(x.least - y.least);
                }
            }
        }
        if a.error + longer + shorter > b.error || a.span + longer > b.span && !self.is_span_idle(a) {
            return false;
        }
        let inside = a.places.iter().zip(&self.network.rows).filter(|(p, _)| p.is_inside());
        for (n, (place, row)) in inside.enumerate() {
            if let Run::Sized(_) = self.run(row, place.letter())
                && a.passed[n].spare - shorter < b.passed[n].spare
            {
                return false;
            }
        }
        let reach = |row| self.reach(a, row) >= self.reach(b, row);
        let needy = (0..self.network.rows.len()).filter(|i| self.network.rows[*i].wildcards.len() > 1);
        if !needy.into_iter().all(reach) {
            return false;
        }
        a.error + longer + shorter < b.error || (a.rank.length, a.rank.columns) <= (b.rank.length, b.rank.columns)
    }

    fn run(&self, row: &super::row::Row, at: usize) -> Run {
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
        read.fold(0i64, |sum, (_, w)| sum.saturating_add(label.lengths[*w].1)).min(row.need)
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
        copies.zip(least).fold(0i64, |sum, (n, least)| sum.saturating_add(n.saturating_mul(least)))
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

    fn alignment(&self, end: u32) -> Alignment {
        let last = &self.labels[end as usize];
        let mut path = vec![last.places.to_vec()];
        let mut label = last;
        while let Some(parent) = label.parent {
            label = &self.labels[parent as usize];
            path.push(label.places.to_vec());
        }
        path.reverse();
        Alignment { error: last.error, lengths: last.lengths.to_vec(), path }
    }
}

/// FNV-1a over what tells nodes apart.
fn hash(label: &Label, deciding: &[usize]) -> u64 {
    let lengths = deciding.iter().flat_map(|w| [label.lengths[*w].0 as u64, label.lengths[*w].1 as u64]);
    let places = label.places.iter().map(|p| (p.letter() as u64) << 8 | u64::from(p.is_inside()));
    places.chain(lengths).fold(0xcbf2_9ce4_8422_2325, |hash: u64, value| {
        (hash ^ value).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(17)
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
