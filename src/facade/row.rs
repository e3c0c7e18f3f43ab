//! A word on the grid, as the alignment reads it: letters with sizes in steps, what may be empty
//! where, and the sums that every step of the search asks for.

/// A letter of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    /// Number of its symbol on the axis.
    pub symbol: usize,
    /// Its length.
    pub length: Length,
    /// Covers the whole of its column; never set on a transparent letter, as the next two.
    pub opaque: bool,
    /// Bears no empty entry beside it.
    pub attached: bool,
    /// Bears only opaque letters above it.
    pub unoccludable: bool,
    /// Is not drawn, and may be cut.
    pub transparent: bool,
}

/// How long a letter is meant to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Length {
    /// This many steps.
    Steps(i64),
    /// As long as the solver finds good: the number of a wildcard. Only transparent letters are.
    Wildcard(usize),
}

/// A word with its sums.
#[derive(Clone, Debug)]
pub struct Row {
    /// The letters.
    pub cells: Vec<Cell>,
    /// Whether a letter of a row above is opaque, so that entries of this row may be empty.
    pub yields: bool,
    /// The least length of the word (rule R5).
    pub need: i64,
    /// The wildcards in the word: where, and which.
    pub wildcards: Vec<(usize, usize)>,
    before: Vec<i64>,
    opaque_after: Vec<i64>,
    opaque_until: Vec<usize>,
    next_unoccludable: Vec<usize>,
    run_end: Vec<usize>,
    gap: Vec<bool>,
}

impl Row {
    /// The row of these letters.
    pub fn new(cells: Vec<Cell>, yields: bool, need: i64) -> Row {
        let n = cells.len();
        let mut row = Row {
            yields,
            need,
            wildcards: Vec::new(),
            before: vec![0; n + 1],
            opaque_after: vec![0; n + 1],
            opaque_until: vec![n; n + 1],
            next_unoccludable: vec![n; n + 1],
            run_end: vec![n; n + 1],
            gap: vec![true; n + 1],
            cells,
        };
        for i in 0..n {
            let cell = row.cells[i];
            let steps = match cell.length {
                Length::Steps(steps) => steps,
                Length::Wildcard(w) => {
                    row.wildcards.push((i, w));
                    0
                }
            };
            row.before[i + 1] = row.before[i].saturating_add(steps);
        }
        for i in (0..n).rev() {
            let (cell, same) = (
                row.cells[i],
                i + 1 < n && row.cells[i + 1].transparent == row.cells[i].transparent,
            );
            let steps = row.before[i + 1] - row.before[i];
            row.opaque_after[i] = row.opaque_after[i + 1] + if cell.opaque { steps } else { 0 };
            row.opaque_until[i] = if cell.opaque {
                row.opaque_until[i + 1]
            } else {
                i
            };
            row.next_unoccludable[i] = if cell.unoccludable {
                i
            } else {
                row.next_unoccludable[i + 1]
            };
            row.run_end[i] = if same { row.run_end[i + 1] } else { i + 1 };
        }
        for i in 0..=n {
            row.gap[i] = !(i > 0 && row.cells[i - 1].attached || i < n && row.cells[i].attached);
        }
        row
    }

    /// The number of letters.
    pub fn letters(&self) -> usize {
        self.cells.len()
    }

    /// The length of the sized letters from `from` up to `to`.
    pub fn steps(&self, from: usize, to: usize) -> i64 {
        self.before[to] - self.before[from]
    }

    /// The length of the opaque letters from `from` on.
    pub fn opaque_after(&self, from: usize) -> i64 {
        self.opaque_after[from]
    }

    /// Whether all letters from `from` up to `to` are opaque.
    pub fn is_opaque(&self, from: usize, to: usize) -> bool {
        self.opaque_until[from] >= to
    }

    /// Whether one of the letters from `from` up to `to` is unoccludable.
    pub fn is_unoccludable(&self, from: usize, to: usize) -> bool {
        self.next_unoccludable[from] < to
    }

    /// Whether the letter `at` is transparent.
    pub fn is_transparent(&self, at: usize) -> bool {
        self.cells[at].transparent
    }

    /// Where the letters that are transparent, or solid, like the letter `at`, end.
    pub fn run_end(&self, at: usize) -> usize {
        self.run_end[at]
    }

    /// Where the transparent letters around the letter `at` begin.
    pub fn run_start(&self, at: usize) -> usize {
        (0..at)
            .rev()
            .find(|i| !self.cells[*i].transparent)
            .map_or(0, |i| i + 1)
    }

    /// Whether an empty entry may lie before the letter `at` (or after the last one).
    pub fn may_gap(&self, at: usize) -> bool {
        self.gap[at]
    }

    /// The numbers of letters, from `from` on, whose lengths lie between `least` and `most`; only
    /// solid letters are taken.
    pub fn prefixes(&self, from: usize, least: i64, most: i64) -> std::ops::Range<usize> {
        let (start, ends) = (
            self.before[from],
            &self.before[from + 1..=self.run_end[from]],
        );
        let first = ends.partition_point(|end| end - start < least);
        let last = ends.partition_point(|end| end - start <= most);
        first + 1..last.max(first) + 1
    }

    /// Whether a letter border lies `steps` after the letter `from`, before the letter `to`.
    pub fn has_border(&self, from: usize, to: usize, steps: i64) -> bool {
        self.before[from + 1..to]
            .binary_search(&(self.before[from] + steps))
            .is_ok()
    }
}
