//! A lower bound of the error that is still to come: what it takes to align one row with the
//! background alone, for every two places of theirs. Whatever the other rows do, no column costs
//! less than two of its entries differ by. Lengths of transparent letters are not looked at.

use super::network::{ENDLESS, Network, Place, Reading};
use super::row::Row;

/// The bounds of all rows against one.
#[derive(Clone, Debug)]
pub struct Outlook {
    base: usize,
    tables: Vec<Option<Table>>,
}

/// More places of two rows than this are not looked at.
const MOST_PLACES: usize = 6000;

impl Outlook {
    /// The bounds up to `bound`, or none where no row is solid all along. The number says how many places were looked at.
    pub fn new(network: &Network, bound: i64) -> (Option<Outlook>, u64) {
        let rows = network.rows.iter().enumerate().rev();
        let solid = rows.filter(|(_, row)| {
            row.letters() > 0 && row.run_end(0) == row.letters() && !row.is_transparent(0)
        });
        let Some((base, _)) = solid.max_by_key(|(_, row)| row.letters()) else {
            return (None, 0);
        };
        let mut work = 0;
        let mut table = |(i, row): (usize, &Row)| {
            let places = (row.letters() + 1) * (network.rows[base].letters() + 1);
            (i != base && places <= MOST_PLACES).then(|| {
                work += places as u64;
                Pair {
                    network,
                    rows: [i, base],
                    bound,
                }
                .table()
            })
        };
        let tables = network.rows.iter().enumerate().map(&mut table).collect();
        (Some(Outlook { base, tables }), work)
    }

    /// A lower bound of the error after these places.
    pub fn least(&self, places: &[Place]) -> i64 {
        (0..places.len())
            .map(|row| self.least_of(row, places))
            .max()
            .unwrap_or(0)
    }

    /// What all rows bring one by one after these places: a guess of the error, no bound.
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

/// The least errors for two rows.
#[derive(Clone, Debug)]
struct Table {
    /// Per letter of the row: where its transparent letters end.
    ends: Vec<usize>,
    /// Places of the base per place of the row.
    width: usize,
    /// From these places.
    exact: Vec<i64>,
    /// From this place of the row and any later one of the base.
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

/// A row and the base, and what stands around them.
struct Pair<'a> {
    network: &'a Network,
    rows: [usize; 2],
    bound: i64,
}

impl Pair<'_> {
    fn table(&self) -> Table {
        let [row, base] = self.rows.map(|i| &self.network.rows[i]);
        let (n, width) = (row.letters(), base.letters() + 1);
        let none = ENDLESS;
        let ends = (0..n).map(|at| row.run_end(at)).collect();
        let mut table = Table {
            ends,
            width,
            exact: vec![none; (n + 1) * width],
            later: vec![none; (n + 1) * width],
        };
        let over = self.rows.map(|i| self.opaque_lengths(i));
        for at in (0..=n).rev() {
            for from in (0..width).rev() {
                let mut least = if at == n && from + 1 == width {
                    0
                } else {
                    none
                };
                if at < n && row.is_transparent(at) {
                    // The base may be empty there too.
                    let next = if base.yields { from } else { from + 1 };
                    let later = if next < width {
                        table.later[table.ends[at] * width + next]
                    } else {
                        none
                    };
                    least = least.min(later);
                } else if at < n {
                    least = least.min(self.solid(&table, at, from, &over[1]));
                }
                if row.yields && row.may_gap(at) {
                    least = least.min(self.gap(&table, at, from, &over[0]));
                }
                let cell = at * width + from;
                table.exact[cell] = least;
                table.later[cell] = if from + 1 < width {
                    least.min(table.later[cell + 1])
                } else {
                    least
                };
            }
        }
        table
    }

    /// The least error if the next entry of the row is solid; `over` may be as long as opaque entries above the base.
    fn solid(&self, table: &Table, at: usize, from: usize, over: &[i64]) -> i64 {
        let [row, base] = self.rows.map(|i| &self.network.rows[i]);
        let is_above = self.rows[0] < self.rows[1];
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

    /// The least error if the next entry of the row is empty, under one of the `over`.
    fn gap(&self, table: &Table, at: usize, from: usize, over: &[i64]) -> i64 {
        let base = &self.network.rows[self.rows[1]];
        let mut least = ENDLESS;
        for to in from + 1..table.width {
            let own = self.rows[1] < self.rows[0] && base.is_opaque(from, to);
            let cost = if own {
                0
            } else {
                nearest(over, base.steps(from, to))
            };
            least = least.min(cost + table.exact[at * table.width + to]);
        }
        least.min(ENDLESS)
    }

    /// The lengths that wholly opaque entries above a row can have.
    fn opaque_lengths(&self, below: usize) -> Vec<i64> {
        let mut lengths = Vec::new();
        for row in &self.network.rows[..below] {
            for from in 0..row.letters() {
                let opaque = (from + 1..=row.letters()).take_while(|to| row.is_opaque(from, *to));
                lengths.extend(opaque.map(|to| row.steps(from, to)));
            }
            lengths.sort_unstable();
            lengths.dedup();
        }
        lengths
    }
}

/// How far the nearest of some ascending lengths is.
fn nearest(lengths: &[i64], length: i64) -> i64 {
    let next = lengths.partition_point(|other| *other < length);
    let around = lengths[next.saturating_sub(1)..lengths.len().min(next + 1)].iter();
    around
        .map(|other| (other - length).abs())
        .min()
        .unwrap_or(ENDLESS)
}
