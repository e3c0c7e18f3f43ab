//! Alignments of random small candidates against an oracle that tries every column of every
//! length, cut by cut, for every length of the wildcards.

use std::collections::{BTreeMap, BTreeSet};

use crate::align::build_network::build_network;
use crate::align::network::Network;
use crate::align::place::Entry;
use crate::align::row::Row;
use crate::align::search::{Effort, align};
use crate::budget::Budget;
use crate::candidate::axis_task::Window;
use crate::candidate::letter::{Length, MeasuredLetter};
use crate::candidate::words::Word;
use crate::pattern::word::Environment;
use crate::select::co_optimal::co_optimal;
use fretwork_geometry::Seed;

/// A row as the oracle sees it: a letter number per step.
struct Plain<'a> {
    cells: &'a [MeasuredLetter],
    owner: Vec<usize>,
}

impl Plain<'_> {
    fn of<'a>(cells: &'a [MeasuredLetter], lengths: &[i64]) -> Plain<'a> {
        let length = |cell: &MeasuredLetter| match cell.length {
            Length::Steps(steps) => steps,
            Length::Wildcard(w) => lengths[w],
        };
        let owner = cells
            .iter()
            .enumerate()
            .flat_map(|(i, cell)| vec![i; length(cell) as usize])
            .collect();
        Plain { cells, owner }
    }

    fn is_border(&self, at: usize) -> bool {
        at == 0 || at == self.owner.len() || self.owner[at - 1] != self.owner[at]
    }

    /// Where an entry that begins `at` may end; the same place for an empty one.
    fn ends(&self, at: usize) -> Vec<usize> {
        let attached = |i: usize| self.cells[self.owner[i]].attached;
        let gap = self.is_border(at)
            && !(at > 0 && attached(at - 1))
            && !(at < self.owner.len() && attached(at));
        let mut ends = if gap { vec![at] } else { Vec::new() };
        for end in at + 1..=self.owner.len() {
            let kind = |i: usize| self.cells[self.owner[i]].transparent;
            if kind(end - 1) != kind(at) {
                break;
            }
            if kind(at) || self.is_border(end) {
                ends.push(end);
            }
        }
        ends
    }

    fn all(&self, from: usize, to: usize, test: fn(&MeasuredLetter) -> bool) -> bool {
        (from..to).all(|i| test(&self.cells[self.owner[i]]))
    }
}

/// Whether a column keeps constraints 1 and 3, and where empty entries may be.
fn is_column(rows: &[Plain], from: &[usize], to: &[usize]) -> bool {
    let opaque = |i: usize| to[i] > from[i] && rows[i].all(from[i], to[i], |c| c.opaque);
    let clear = |i: usize| rows[i].all(from[i], to[i], |c| c.transparent);
    (0..rows.len()).any(opaque)
        && (0..rows.len()).all(|i| {
            (to[i] > from[i] || (0..i).any(opaque))
                && (rows[i].all(from[i], to[i], |c| !c.unoccludable)
                    || (0..i).all(|h| clear(h) || opaque(h)))
        })
}

type Best = Option<(i64, i64)>;

/// The least error of the columns that follow, and the most columns (negative).
fn exhaust(
    rows: &[Plain],
    from: &[usize],
    room: i64,
    memo: &mut BTreeMap<(Vec<usize>, i64), Best>,
) -> Best {
    if rows
        .iter()
        .zip(from)
        .all(|(row, at)| row.owner.len() == *at)
    {
        return Some((0, 0));
    }
    let key = (from.to_vec(), room);
    if let Some(known) = memo.get(&key) {
        return *known;
    }
    let choices: Vec<Vec<usize>> = rows
        .iter()
        .zip(from)
        .map(|(row, at)| row.ends(*at))
        .collect();
    let mut best: Best = None;
    let count: usize = choices.iter().map(Vec::len).product();
    for number in 0..count {
        let mut rest = number;
        let to: Vec<usize> = choices
            .iter()
            .map(|c| {
                let end = c[rest % c.len()];
                rest /= c.len();
                end
            })
            .collect();
        let lengths = || {
            from.iter()
                .zip(&to)
                .map(|(a, b)| (b - a) as i64)
                .filter(|l| *l > 0)
        };
        let (Some(shortest), Some(longest)) = (lengths().min(), lengths().max()) else {
            continue;
        };
        if longest <= room
            && is_column(rows, from, &to)
            && let Some((error, columns)) = exhaust(rows, &to, room - longest, memo)
        {
            let new = (error + longest - shortest, columns - 1);
            best = Some(best.map_or(new, |old| old.min(new)));
        }
    }
    memo.insert(key, best);
    best
}

/// The least error, then the least total length of wildcards, then the most columns (negative).
fn oracle(words: &[Word], wildcards: usize, window: Window) -> Option<(i64, i64, i64)> {
    let mut best = None;
    let most = window.longest;
    let total = (most as usize).pow(wildcards as u32);
    for number in 0..total {
        let lengths: Vec<i64> = (0..wildcards)
            .map(|w| 1 + number as i64 / most.pow(w as u32) % most)
            .collect();
        let rows: Vec<Plain> = words
            .iter()
            .map(|w| Plain::of(&w.measured, &lengths))
            .collect();
        let mut above = 0;
        let fits = rows.iter().zip(words).all(|(row, word)| {
            let length = row.owner.len() as i64;
            let fits = (window.shortest - above..=window.longest).contains(&length);
            above += word.opaque;
            fits
        });
        let used: i64 = words
            .iter()
            .flat_map(|w| &w.wildcards)
            .map(|(w, count)| lengths[*w] * count)
            .sum();
        if fits
            && let Some((error, columns)) = exhaust(
                &rows,
                &vec![0; rows.len()],
                window.longest,
                &mut BTreeMap::new(),
            )
        {
            let new = (error, used, columns);
            best = Some(best.map_or(new, |old: (i64, i64, i64)| old.min(new)));
        }
    }
    best
}

/// Random words, the uppermost first.
fn candidate(seed: Seed, rows: u64, wildcards: u64) -> Vec<Word> {
    let pick = |seed: Seed, n: u64, most: u64| (seed.unit(n) * most as f64) as u64;
    let word = |i: u64| {
        let seed = seed.number(i as i64);
        let cells: Vec<MeasuredLetter> = (0..1 + pick(seed, 0, 5))
            .map(|j| {
                let seed = seed.number(100 + j as i64);
                let wild = wildcards > 0 && i + 1 < rows && pick(seed, 0, 4) == 0;
                let transparent = wild || i + 1 < rows && pick(seed, 1, 4) == 0;
                MeasuredLetter {
                    symbol: pick(seed, 2, 5) as usize,
                    length: if wild {
                        Length::Wildcard(pick(seed, 3, wildcards) as usize)
                    } else {
                        Length::Steps(1 + pick(seed, 4, 3) as i64)
                    },
                    opaque: !transparent
                        && (i + 1 == rows && pick(seed, 5, 8) > 0 || pick(seed, 6, 3) == 0),
                    attached: !transparent && pick(seed, 7, 6) == 0,
                    unoccludable: !transparent && pick(seed, 8, 6) == 0,
                    transparent,
                }
            })
            .collect();
        word_of(cells)
    };
    (0..rows).map(word).collect()
}

fn word_of(cells: Vec<MeasuredLetter>) -> Word {
    let mut word = Word {
        counters: Environment::new(),
        letters: Vec::new(),
        sized: 0,
        opaque: 0,
        wildcards: BTreeMap::new(),
        measured: cells,
    };
    for cell in &word.measured {
        match cell.length {
            Length::Steps(steps) => {
                word.sized += steps;
                word.opaque += if cell.opaque { steps } else { 0 };
            }
            Length::Wildcard(w) => *word.wildcards.entry(w).or_insert(0) += 1,
        }
    }
    word
}

fn network(words: &[Word], wildcards: usize, window: Window) -> Network {
    build_network(
        wildcards,
        &words.iter().collect::<Vec<_>>(),
        window,
        &BTreeSet::new(),
    )
    .network
}

fn compare(rounds: u64, rows: u64, wildcards: u64, name: &str) -> usize {
    let mut solved = 0;
    for round in 0..rounds {
        let seed = Seed::root(round).name(name);
        let words = candidate(seed, rows, wildcards);
        let canvas = words[0].sized + words[0].wildcards.len() as i64 + (seed.unit(1) * 3.0) as i64;
        let error = 1 + (seed.unit(2) * 4.0) as i64;
        let window = Window {
            longest: canvas + error,
            shortest: canvas - error,
            error,
        };
        let expected = oracle(&words, wildcards as usize, window).filter(|(e, ..)| *e <= error);
        let network = network(&words, wildcards as usize, window);
        let found = align(&network, error, Effort::Exact, &mut Budget::new(u64::MAX));
        let found = found.first().map(|a| {
            let lengths = network.settle(&a.lengths).expect("lengths");
            let used: i64 = words
                .iter()
                .flat_map(|w| &w.wildcards)
                .map(|(w, n)| lengths[*w] * n)
                .sum();
            (a.error, used, 1 - a.path.len() as i64)
        });
        // R5 asks nothing of the words here that the oracle does not: sized rows out of the window.
        let sized_fit = fits(&words, window);
        if sized_fit {
            assert_eq!(found, expected, "{name} {round}: {words:#?} {window:?}");
            solved += usize::from(found.is_some());
        }
        if wildcards == 0 && sized_fit {
            let (error, all) = co_optimal(
                &network,
                error,
                &[false; 5],
                1000,
                &mut Budget::new(u64::MAX),
            );
            let best = all.first().map(|tie| (error, 1 - tie.path.len() as i64));
            assert_eq!(best, expected.map(|(e, _, c)| (e, c)), "{name} {round}");
            all.iter().for_each(|tie| check_path(&network, &tie.path));
        }
    }
    solved
}

fn fits(words: &[Word], window: Window) -> bool {
    let mut above = 0;
    words.iter().all(|word| {
        let fits = !word.wildcards.is_empty()
            || (window.shortest - above..=window.longest).contains(&word.sized);
        above += word.opaque;
        fits
    })
}

/// Every letter is in one entry, in order; every column has an opaque entry.
fn check_path(network: &Network, path: &[Vec<crate::align::place::Place>]) {
    for (i, row) in network.rows.iter().enumerate() {
        let mut at = 0;
        for pair in path.windows(2) {
            match network.entry(i, pair[0][i], pair[1][i]) {
                Entry::Empty => assert!(row.may_gap(at) && row.yields),
                Entry::Solid(from, to) => {
                    assert_eq!(from, at);
                    at = to;
                }
                Entry::Piece(start) => {
                    assert!(row.is_transparent(start));
                    at = pair[1][i].letter().max(at);
                }
            }
        }
        assert_eq!(at, row.count());
    }
}

#[test]
fn two_rows_are_aligned_like_by_the_oracle() {
    assert!(compare(1500, 2, 0, "two") > 200);
}

#[test]
fn three_rows_are_aligned_like_by_the_oracle() {
    assert!(compare(500, 3, 0, "three") > 50);
}

#[test]
fn wildcards_are_found_like_by_the_oracle() {
    assert!(compare(400, 2, 1, "one wildcard") > 80);
    assert!(compare(150, 2, 2, "two wildcards") > 30);
    assert!(compare(200, 3, 1, "wildcard in three") > 10);
}

#[test]
fn rows_keep_their_sums() {
    let cell = |steps: i64, transparent: bool| MeasuredLetter {
        symbol: 0,
        length: Length::Steps(steps),
        opaque: !transparent,
        attached: false,
        unoccludable: false,
        transparent,
    };
    let row = Row::new(
        vec![
            cell(2, false),
            cell(3, false),
            cell(1, true),
            cell(4, true),
            cell(2, false),
        ],
        true,
        0,
    );
    assert_eq!((row.run_end(0), row.run_end(2), row.run_end(4)), (2, 4, 5));
    assert_eq!((row.run_start(3), row.run_start(2)), (2, 2));
    assert_eq!(row.prefixes(0, 0, 100), 1..3);
    assert_eq!(row.prefixes(0, 3, 100), 2..3);
    assert_eq!(row.prefixes(0, 3, 4), 2..2);
    assert!(row.has_border(0, 2, 2) && !row.has_border(0, 2, 5));
    assert_eq!(
        (
            row.opaque_after(0),
            row.opaque_after(1),
            row.opaque_after(4)
        ),
        (7, 5, 2)
    );
}

#[test]
fn a_narrow_search_finds_a_valid_alignment() {
    for round in 0..300 {
        let words = candidate(Seed::root(round).name("narrow"), 3, 0);
        let canvas = words[0].sized;
        let window = Window {
            longest: canvas + 4,
            shortest: canvas - 4,
            error: 4,
        };
        let network = network(&words, 0, window);
        let exact = align(&network, 4, Effort::Exact, &mut Budget::new(u64::MAX));
        let narrow = align(&network, 4, Effort::Beam(4), &mut Budget::new(u64::MAX));
        if let (Some(exact), Some(narrow)) = (exact.first(), narrow.first()) {
            assert!(narrow.error >= exact.error && narrow.error <= 4);
            check_path(&network, &narrow.path);
        }
        assert!(narrow.is_empty() || !exact.is_empty());
    }
}
