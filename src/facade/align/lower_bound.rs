//! A lower bound of the error that is still to come after a node: the A* heuristic of the search.
//!
//! One row that is solid all along serves as the base; usually it is the background. For each other
//! row, a table holds the least error of aligning that row with the base alone, from every pair of
//! their places to the end. It is filled from the end back, like the table of an edit distance, in
//! O(n m) places for n and m letters.
//!
//! The bound is admissible. The error of a column is the difference of its longest and its shortest
//! entry, so it is never less than the difference of any two of its entries. An alignment of all
//! rows contains an alignment of each pair, whose error is therefore no greater. The greatest of the
//! pairs' errors bounds the whole. The lengths of transparent letters are ignored, which only makes
//! the bound smaller, and any entry below an opaque letter of a third row may be as long as that.

use super::place::{ENDLESS, Place, Reading};
use super::row::Row;

/// The lower bounds of all rows, each aligned with one base row.
#[derive(Clone, Debug)]
pub struct LowerBound {
    base: usize,
    /// The table of each row; none for the base, and for rows with too many places.
    tables: Vec<Option<Table>>,
}

/// The most entries of one table, which is enough for two words of 76 letters. A greater limit lets
/// the tables of long words eat the budget before the search begins; a lesser one leaves shorter
/// words without bounds, and the search without direction.
const MOST_PLACES: usize = 6000;

impl LowerBound {
    /// The bounds for a search for errors of at most `bound`; `None` if no row is solid all along. The
    /// number is the work done, in entries of tables.
    pub fn new(rows: &[Row], bound: i64) -> (Option<LowerBound>, u64) {
        let numbered = rows.iter().enumerate().rev();
        let solid = numbered.filter(|(_, row)| {
            row.count() > 0 && row.run_end(0) == row.count() && !row.is_transparent(0)
        });
        let Some((base, _)) = solid.max_by_key(|(_, row)| row.count()) else {
            return (None, 0);
        };
        let mut work = 0;
        let mut table = |(i, row): (usize, &Row)| {
            let places = (row.count() + 1) * (rows[base].count() + 1);
            (i != base && places <= MOST_PLACES).then(|| {
                work += places as u64;
                Pair {
                    rows,
                    pair: [i, base],
                    bound,
                }
                .table()
            })
        };
        let tables = rows.iter().enumerate().map(&mut table).collect();
        (Some(LowerBound { base, tables }), work)
    }

    /// A lower bound of the error after these places.
    pub fn least(&self, places: &[Place]) -> i64 {
        (0..places.len())
            .map(|row| self.least_of(row, places))
            .max()
            .unwrap_or(0)
    }

    /// The sum of what all rows bring after these places: an estimate of the error, but no bound.
    pub fn sum(&self, places: &[Place]) -> i64 {
        (0..places.len()).fold(0i64, |sum, row| {
            sum.saturating_add(self.least_of(row, places))
        })
    }

    /// A lower bound of the error that one row brings after these places.
    pub fn least_of(&self, row: usize, places: &[Place]) -> i64 {
        let Some(table) = &self.tables[row] else {
            return 0;
        };
        table.least(places[row], places[self.base].letter())
    }
}

/// The least errors of aligning a row with the base. Entries are numbered by the place of the row
/// times `width`, plus the place of the base.
#[derive(Clone, Debug)]
struct Table {
    /// For each letter of the row: the end of its run.
    ends: Vec<usize>,
    /// The number of places of the base.
    width: usize,
    /// The least error from these places on.
    exact: Vec<i64>,
    /// The least error from this place of the row and any place of the base that is not before this
    /// one.
    later: Vec<i64>,
}

impl Table {
    fn least(&self, place: Place, base: usize) -> i64 {
        match place.reading() {
            Reading::Before(at) => self.exact[at * self.width + base],
            Reading::Gap(at) => self.later[at * self.width + base],
            Reading::Inside(at) => self.later[self.ends[at] * self.width + base],
        }
    }
}

/// A row and the base among all rows.
struct Pair<'a> {
    rows: &'a [Row],
    /// The numbers of the row and of the base.
    pair: [usize; 2],
    bound: i64,
}

impl Pair<'_> {
    fn table(&self) -> Table {
        let [row, base] = self.pair.map(|i| &self.rows[i]);
        let (n, width) = (row.count(), base.count() + 1);
        let none = ENDLESS;
        let ends = (0..n).map(|at| row.run_end(at)).collect();
        let mut table = Table {
            ends,
            width,
            exact: vec![none; (n + 1) * width],
            later: vec![none; (n + 1) * width],
        };
        let over = self.pair.map(|i| self.opaque_lengths(i));
        for at in (0..=n).rev() {
            for from in (0..width).rev() {
                let least = self.least(&table, at, from, &over);
                let entry = at * width + from;
                table.exact[entry] = least;
                table.later[entry] = if from + 1 < width {
                    least.min(table.later[entry + 1])
                } else {
                    least
                };
            }
        }
        table
    }

    /// The least error from the place `at` of the row and the place `from` of the base; `over` holds
    /// the lengths of opaque entries above each of the two.
    fn least(&self, table: &Table, at: usize, from: usize, over: &[Vec<i64>; 2]) -> i64 {
        let [row, base] = self.pair.map(|i| &self.rows[i]);
        let n = row.count();
        let mut least = if at == n && from + 1 == table.width {
            0
        } else {
            ENDLESS
        };
        if at < n && row.is_transparent(at) {
            // The run takes at least one column, in which the base too may be empty if it yields.
            let next = if base.yields { from } else { from + 1 };
            if next < table.width {
                least = least.min(table.later[table.ends[at] * table.width + next]);
            }
        } else if at < n {
            least = least.min(self.solid(table, at, from, &over[1]));
        }
        if row.yields && row.may_gap(at) {
            least = least.min(self.gap(table, at, from, &over[0]));
        }
        least
    }

    /// The least error if the next entry of the row is solid; `over` holds the lengths of opaque
    /// entries above the base.
    fn solid(&self, table: &Table, at: usize, from: usize, over: &[i64]) -> i64 {
        let [row, base] = self.pair.map(|i| &self.rows[i]);
        let is_above = self.pair[0] < self.pair[1];
        let mut least = ENDLESS;
        for to in at + 1..=row.run_end(at) {
            let length = row.steps(at, to);
            if from + 1 < table.width {
                for count in base.prefixes(from, length - self.bound, length + self.bound) {
                    let end = from + count;
                    let (upper, upper_part, lower, lower_part) = if is_above {
                        (row, (at, to), base, (from, end))
                    } else {
                        (base, (from, end), row, (at, to))
                    };
                    if !lower.is_unoccludable(lower_part.0, lower_part.1)
                        || upper.is_opaque(upper_part.0, upper_part.1)
                    {
                        let cost = (length - base.steps(from, end)).abs();
                        least = least.min(cost + table.exact[to * table.width + end]);
                    }
                }
            }
            if base.yields && base.may_gap(from) {
                let own = is_above && row.is_opaque(at, to);
                let cost = if own { 0 } else { nearest(over, length) };
                least = least.min(cost + table.exact[to * table.width + from]);
            }
        }
        least.min(ENDLESS)
    }

    /// The least error if the next entry of the row is empty; `over` holds the lengths of opaque
    /// entries above the row.
    fn gap(&self, table: &Table, at: usize, from: usize, over: &[i64]) -> i64 {
        let base = &self.rows[self.pair[1]];
        let mut least = ENDLESS;
        for to in from + 1..table.width {
            let own = self.pair[1] < self.pair[0] && base.is_opaque(from, to);
            let cost = if own {
                0
            } else {
                nearest(over, base.steps(from, to))
            };
            least = least.min(cost + table.exact[at * table.width + to]);
        }
        least.min(ENDLESS)
    }

    /// The lengths that wholly opaque entries above a row can have, ascending.
    fn opaque_lengths(&self, below: usize) -> Vec<i64> {
        let mut lengths = Vec::new();
        for row in &self.rows[..below] {
            for from in 0..row.count() {
                let opaque = (from + 1..=row.count()).take_while(|to| row.is_opaque(from, *to));
                lengths.extend(opaque.map(|to| row.steps(from, to)));
            }
            lengths.sort_unstable();
            lengths.dedup();
        }
        lengths
    }
}

/// The distance from `length` to the nearest of some ascending lengths.
fn nearest(lengths: &[i64], length: i64) -> i64 {
    let next = lengths.partition_point(|other| *other < length);
    let around = lengths[next.saturating_sub(1)..lengths.len().min(next + 1)].iter();
    around
        .map(|other| (other - length).abs())
        .min()
        .unwrap_or(ENDLESS)
}
