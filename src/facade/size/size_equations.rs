//! The equations that an alignment demands of the sizes (rule R10), read off column by column. The
//! solid entries of a column are equally long, and a transparent run is as long as the columns that
//! it passes. The equations are solved in `least_squares`.
//!
//! For example, take a base `A B A` and a row `C t C` above it, with a transparent `t` of some size, in
//! three columns. The first and the third column demand A = C, and the second adds the demand t = B, since
//! the run ends there. With the canvas as the sum of a row, 2 A + B = canvas, all is said.

use std::collections::{BTreeMap, BTreeSet};

use super::least_squares::Equation;
use crate::align::network::Network;
use crate::align::place::{Entry, Place, Reading};
use crate::align::row::Row;
use fretwork_geometry::numeric::gcd;

/// A sum of multiples of symbols, sorted by symbol, without zeros.
type Terms = Vec<(usize, i64)>;

/// The equations of the columns up to some place. Each says that a sum is 0.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct SizeEquations {
    /// The equations that are complete.
    pub equations: BTreeSet<Terms>,
    /// For each row with a transparent run that has not ended: the columns that it has passed.
    open: BTreeMap<usize, Terms>,
}

impl SizeEquations {
    /// Adds the column between two nodes, given by their places. `idle` marks wildcards with a single
    /// letter: a run of that letter demands nothing, as it may have any length, unless its row is the
    /// one that says how long the canvas is.
    pub fn add_column(&mut self, network: &Network, [from, to]: [&[Place]; 2], idle: &[bool]) {
        let entries: Vec<Entry> = (0..from.len())
            .map(|i| network.entry(i, from[i], to[i]))
            .collect();
        let solid = entries.iter().zip(&network.rows);
        let solid = solid.filter_map(|(entry, row)| match entry {
            Entry::Solid(a, b) => Some(letters(row, *a, *b)),
            _ => None,
        });
        let mut solid = solid.collect::<Vec<_>>().into_iter();
        // Every column holds an opaque entry, so there is a first one.
        let Some(length) = solid.next() else { return };
        for other in solid {
            self.demand(combine(&length, &other, -1));
        }
        let canvas = canvas_row(network, idle);
        for (i, (entry, row)) in entries.iter().zip(&network.rows).enumerate() {
            if let Entry::Piece(start) = entry
                && (i == canvas || !is_idle(row, *start, idle))
            {
                let sum = self.open.entry(i).or_default();
                *sum = combine(sum, &length, 1);
            }
            // A run goes on after an empty entry if letters of it are left.
            if let (Some(sum), Reading::Before(at)) = (self.open.get(&i), to[i].reading())
                && is_run_over(row, at)
            {
                let run = letters(row, row.run_start(at - 1), at);
                let demand = combine(&run, sum, -1);
                self.open.remove(&i);
                self.demand(demand);
            }
        }
    }

    /// The equations of a whole path, which is a list of nodes.
    pub fn of_path(network: &Network, path: &[Vec<Place>], idle: &[bool]) -> SizeEquations {
        let mut all = SizeEquations::default();
        for pair in path.windows(2) {
            all.add_column(network, [&pair[0], &pair[1]], idle);
        }
        all
    }

    /// Whether all sizes that meet `other` meet these equations too.
    pub fn implied_by(&self, other: &SizeEquations) -> bool {
        self.open == other.open && self.equations.is_subset(&other.equations)
    }

    /// Adds an equation in its lowest terms.
    fn demand(&mut self, mut terms: Terms) {
        let Some((_, first)) = terms.first() else {
            return;
        };
        let divisor = terms.iter().fold(0, |d, (_, f)| gcd(d, f.unsigned_abs()));
        let divisor = divisor as i64 * first.signum();
        terms.iter_mut().for_each(|(_, f)| *f /= divisor);
        self.equations.insert(terms);
    }
}

/// The equation which says that the columns fill the canvas, as a row without empty entries does.
pub fn canvas_equation(network: &Network, idle: &[bool]) -> Equation {
    let row = &network.rows[canvas_row(network, idle)];
    Equation {
        terms: letters(row, 0, row.count()),
        is_canvas: true,
    }
}

/// The equations that hold in every alignment: rows without empty entries fill the canvas.
pub fn common_equations(network: &Network) -> Vec<Equation> {
    let rigid = network.rows.iter().filter(|row| !row.yields);
    let mut all: Vec<Equation> = rigid
        .map(|row| Equation {
            terms: letters(row, 0, row.count()),
            is_canvas: true,
        })
        .collect();
    all.sort();
    all.dedup();
    all
}

/// The row that says how long the canvas is.
fn canvas_row(network: &Network, idle: &[bool]) -> usize {
    let plain = |row: &Row| !row.yields && row.letters.iter().all(|letter| !idle[letter.symbol]);
    network.rows.iter().position(plain).unwrap_or(0)
}

/// Whether the run that begins at `start` is a single letter of a symbol that is idle.
fn is_idle(row: &Row, start: usize, idle: &[bool]) -> bool {
    row.run_end(start) == start + 1 && idle[row.letters[start].symbol]
}

/// Whether a transparent run ends just before the letter `at`.
fn is_run_over(row: &Row, at: usize) -> bool {
    at > 0 && row.is_transparent(at - 1) && (at == row.count() || !row.is_transparent(at))
}

/// The sum of the letters from `from` up to `to`.
fn letters(row: &Row, from: usize, to: usize) -> Terms {
    let mut sum = BTreeMap::new();
    row.letters[from..to]
        .iter()
        .for_each(|letter| *sum.entry(letter.symbol).or_insert(0) += 1);
    sum.into_iter().collect()
}

/// The sum of `a` and `factor` times `b`.
fn combine(a: &Terms, b: &Terms, factor: i64) -> Terms {
    let mut sum: BTreeMap<usize, i64> = a.iter().copied().collect();
    b.iter()
        .for_each(|(symbol, n)| *sum.entry(*symbol).or_insert(0) += factor * n);
    sum.into_iter().filter(|(_, n)| *n != 0).collect()
}
