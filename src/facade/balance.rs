//! What an alignment demands of the sizes (rule R10), read off column by column: the solid entries
//! of a column are equally long, and a transparent run is as long as the columns it passes. Solving
//! the equations is in `sizing`.

use std::collections::{BTreeMap, BTreeSet};

use super::network::{Entry, Network, Place, Reading};
use super::row::Row;
use super::sizing::Equation;

/// Sums of symbols, sorted, without zeros.
type Terms = Vec<(usize, i64)>;

/// The equations of the columns so far.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Balance {
    /// Those that are complete.
    pub equations: BTreeSet<Terms>,
    /// The columns of the transparent runs that are not passed yet, by row.
    open: BTreeMap<usize, Terms>,
}

impl Balance {
    /// Adds the column between two nodes. `idle` tells the symbols whose only letter may have any
    /// length: a run of one says nothing, unless it is needed to tell the length of the canvas.
    pub fn pass(&mut self, network: &Network, from: &[Place], to: &[Place], idle: &[bool]) {
        let entries: Vec<Entry> = (0..from.len())
            .map(|i| network.entry(i, from[i], to[i]))
            .collect();
        let solid = entries
            .iter()
            .enumerate()
            .filter_map(|(i, entry)| match entry {
                Entry::Solid(a, b) => Some(letters(&network.rows[i], *a, *b)),
                _ => None,
            });
        let mut solid = solid.collect::<Vec<_>>().into_iter();
        // Every column holds an opaque entry.
        let Some(length) = solid.next() else { return };
        for other in solid {
            self.demand(combine(&length, &other, -1));
        }
        let canvas = canvas_row(network, idle);
        for (i, entry) in entries.iter().enumerate() {
            if let Entry::Piece(start) = entry
                && (i == canvas || !is_idle(&network.rows[i], *start, idle))
            {
                let sum = self.open.entry(i).or_default();
                *sum = combine(sum, &length, 1);
            }
            // A run of which some letters follow a gap goes on.
            if let (Some(sum), Reading::Before(at)) = (self.open.get(&i), to[i].reading())
                && is_run_over(&network.rows[i], at)
            {
                let row = &network.rows[i];
                let run = letters(row, row.run_start(at - 1), at);
                let demand = combine(&run, sum, -1);
                self.open.remove(&i);
                self.demand(demand);
            }
        }
    }

    /// The equations of a whole path.
    pub fn of_path(network: &Network, path: &[Vec<Place>], idle: &[bool]) -> Balance {
        let mut balance = Balance::default();
        path.windows(2)
            .for_each(|pair| balance.pass(network, &pair[0], &pair[1], idle));
        balance
    }

    /// Whether whatever meets `other` meets this too.
    pub fn covers(&self, other: &Balance) -> bool {
        self.open == other.open && self.equations.is_subset(&other.equations)
    }

    fn demand(&mut self, mut terms: Terms) {
        let Some((_, first)) = terms.first() else {
            return;
        };
        let divisor = terms.iter().fold(0, |d, (_, f)| divide(d, f.abs())) * first.signum();
        terms.iter_mut().for_each(|(_, f)| *f /= divisor);
        self.equations.insert(terms);
    }
}

/// The equation that the columns fill the canvas: a row without empty entries does.
pub fn canvas_equation(network: &Network, idle: &[bool]) -> Equation {
    let row = &network.rows[canvas_row(network, idle)];
    Equation {
        terms: letters(row, 0, row.letters()),
        is_canvas: true,
    }
}

/// What holds in every alignment: rows that are never empty fill the canvas.
pub fn common_equations(network: &Network) -> Vec<Equation> {
    let rigid = network.rows.iter().filter(|row| !row.yields);
    let mut all: Vec<Equation> = rigid
        .map(|row| Equation {
            terms: letters(row, 0, row.letters()),
            is_canvas: true,
        })
        .collect();
    all.sort();
    all.dedup();
    all
}

fn canvas_row(network: &Network, idle: &[bool]) -> usize {
    let plain = |row: &Row| !row.yields && row.cells.iter().all(|cell| !idle[cell.symbol]);
    network.rows.iter().position(plain).unwrap_or(0)
}

fn is_idle(row: &Row, start: usize, idle: &[bool]) -> bool {
    row.run_end(start) == start + 1 && idle[row.cells[start].symbol]
}

fn is_run_over(row: &Row, at: usize) -> bool {
    at > 0 && row.is_transparent(at - 1) && (at == row.letters() || !row.is_transparent(at))
}

fn letters(row: &Row, from: usize, to: usize) -> Terms {
    let mut sum = BTreeMap::new();
    row.cells[from..to]
        .iter()
        .for_each(|cell| *sum.entry(cell.symbol).or_insert(0) += 1);
    sum.into_iter().collect()
}

/// `a + factor · b`.
fn combine(a: &Terms, b: &Terms, factor: i64) -> Terms {
    let mut sum: BTreeMap<usize, i64> = a.iter().copied().collect();
    b.iter()
        .for_each(|(symbol, n)| *sum.entry(*symbol).or_insert(0) += factor * n);
    sum.into_iter().filter(|(_, n)| *n != 0).collect()
}

fn divide(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { divide(b, a % b) }
}
