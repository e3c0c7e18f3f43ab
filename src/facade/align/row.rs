//! A word on the grid with the sums and flags that each step of the search asks for. All queries take
//! constant or logarithmic time; making a row takes linear time.

use crate::candidate::letter::{Length, MeasuredLetter};

/// A word and sums over its letters.
#[derive(Clone, Debug)]
pub struct Row {
    /// The letters.
    pub letters: Vec<MeasuredLetter>,
    /// Whether a row above has an opaque letter, so that entries of this row may be empty.
    pub yields: bool,
    /// The least length of the word (rule R5).
    pub need: i64,
    /// The letters of wildcards: the place of each, and the number of its wildcard.
    pub wildcards: Vec<(usize, usize)>,
    /// Up to each letter: the length of the sized letters.
    before: Vec<i64>,
    /// From each letter on: the length of the opaque letters.
    opaque_after: Vec<i64>,
    /// From each letter on: the first letter that is not opaque.
    opaque_until: Vec<usize>,
    /// From each letter on: the first letter that is unoccludable.
    next_unoccludable: Vec<usize>,
    /// For each letter: the end of its run of transparent, or of solid, letters.
    run_end: Vec<usize>,
    /// For each border between letters: whether an empty entry may lie there.
    gap: Vec<bool>,
}

impl Row {
    /// The row of these letters.
    pub fn new(letters: Vec<MeasuredLetter>, yields: bool, need: i64) -> Row {
        let n = letters.len();
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
            letters,
        };
        for i in 0..n {
            let steps = match row.letters[i].length {
                Length::Steps(steps) => steps,
                Length::Wildcard(w) => {
                    row.wildcards.push((i, w));
                    0
                }
            };
            row.before[i + 1] = row.before[i].saturating_add(steps);
        }
        for i in (0..n).rev() {
            let (letter, same) = (
                row.letters[i],
                i + 1 < n && row.letters[i + 1].transparent == row.letters[i].transparent,
            );
            let steps = row.before[i + 1] - row.before[i];
            row.opaque_after[i] = row.opaque_after[i + 1] + if letter.opaque { steps } else { 0 };
            row.opaque_until[i] = if letter.opaque {
                row.opaque_until[i + 1]
            } else {
                i
            };
            row.next_unoccludable[i] = if letter.unoccludable {
                i
            } else {
                row.next_unoccludable[i + 1]
            };
            row.run_end[i] = if same { row.run_end[i + 1] } else { i + 1 };
        }
        for i in 0..=n {
            row.gap[i] =
                !(i > 0 && row.letters[i - 1].attached || i < n && row.letters[i].attached);
        }
        row
    }

    /// The number of letters.
    pub fn count(&self) -> usize {
        self.letters.len()
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
        self.letters[at].transparent
    }

    /// The end of the run of letters that are transparent, or solid, like the letter `at`.
    pub fn run_end(&self, at: usize) -> usize {
        self.run_end[at]
    }

    /// The begin of the run of transparent letters that the letter `at` belongs to.
    pub fn run_start(&self, at: usize) -> usize {
        (0..at)
            .rev()
            .find(|i| !self.letters[*i].transparent)
            .map_or(0, |i| i + 1)
    }

    /// Whether an empty entry may lie before the letter `at`, or after the last one.
    pub fn may_gap(&self, at: usize) -> bool {
        self.gap[at]
    }

    /// How many solid letters, from `from` on, can be taken so that their length lies between `least`
    /// and `most`.
    pub fn prefixes(&self, from: usize, least: i64, most: i64) -> std::ops::Range<usize> {
        let (start, ends) = (
            self.before[from],
            &self.before[from + 1..=self.run_end[from]],
        );
        let first = ends.partition_point(|end| end - start < least);
        let last = ends.partition_point(|end| end - start <= most);
        first + 1..last.max(first) + 1
    }

    /// Whether a border between letters lies `steps` after the begin of letter `from` and before
    /// letter `to`.
    pub fn has_border(&self, from: usize, to: usize, steps: i64) -> bool {
        self.before[from + 1..to]
            .binary_search(&(self.before[from] + steps))
            .is_ok()
    }
}
