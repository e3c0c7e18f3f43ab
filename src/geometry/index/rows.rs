//! Lists of numbers, one after the other in one array.

use std::ops::Range;

/// Lists of numbers, one after the other in one array ("compressed rows"): two allocations however many lists.
///
/// ```
/// use fretwork_geometry::index::Rows;
/// let pairs = [(2, 7), (0, 5), (2, 4)];
/// let rows = Rows::fill(3, |filler| pairs.iter().for_each(|&(row, number)| filler.put(row, number)));
/// assert_eq!((rows.row(0), rows.row(1), rows.row(2)), (&[5][..], &[][..], &[7, 4][..]));
/// assert_eq!(rows.range(0..3), [5, 7, 4]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// Where each row begins, and where the last one ends.
    starts: Vec<u32>,
    numbers: Vec<u32>,
}

/// Takes the numbers of all rows, first to count them, then to put them in their places.
pub struct Filler {
    /// While counting, how many numbers each row has, one row further on; then where the next one goes.
    next: Vec<u32>,
    numbers: Vec<u32>,
    is_counting: bool,
}

impl Filler {
    /// Adds a number to a row.
    #[inline]
    pub fn put(&mut self, row: usize, number: u32) {
        if self.is_counting {
            self.next[row + 1] += 1;
        } else {
            self.numbers[self.next[row] as usize] = number;
            self.next[row] += 1;
        }
    }
}

impl Rows {
    /// The lists of `count` rows. `visit` is called twice and must put the same numbers both times: first they are counted,
    /// then they are put in their places. A row keeps the order of the calls.
    pub fn fill(count: usize, visit: impl Fn(&mut Filler)) -> Rows {
        let mut filler = Filler {
            next: vec![0u32; count + 1],
            numbers: Vec::new(),
            is_counting: true,
        };
        visit(&mut filler);
        for row in 0..count {
            filler.next[row + 1] += filler.next[row];
        }
        let starts = filler.next.clone();
        filler.numbers = vec![0; starts[count] as usize];
        filler.is_counting = false;
        visit(&mut filler);
        Rows {
            starts,
            numbers: filler.numbers,
        }
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers of one row.
    #[inline]
    pub fn row(&self, row: usize) -> &[u32] {
        self.range(row..row + 1)
    }

    /// The numbers of some rows, one row after the other.
    #[inline]
    pub fn range(&self, rows: Range<usize>) -> &[u32] {
        &self.numbers[self.starts[rows.start] as usize..self.starts[rows.end] as usize]
    }
}
