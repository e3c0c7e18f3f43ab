//! Buckets: which segments come near which cell of a uniform grid. Cells are half-open, so that
//! every site belongs to exactly one.

use super::exact::Segment;
use super::lattice::{RESOLUTION, Site};

/// How far beyond a cell a segment may pass and still be in its bucket, in grid units: whatever
/// lies within a resolution (and the slack of `noding`) of a site of the cell is in the cell's bucket.
const MARGIN: f64 = RESOLUTION * 1.25;

/// A rectangle cut into columns × rows square cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    corner: Site,
    per_unit: f64,
    pub columns: usize,
    pub rows: usize,
}

impl Cells {
    /// Cells of side `side` from `corner` on, enough to reach `far`.
    pub fn covering(corner: Site, far: Site, side: f64) -> Cells {
        let count = |k: usize| ((far[k] - corner[k]) / side) as usize + 1;
        Cells { corner, per_unit: 1.0 / side, columns: count(0), rows: count(1) }
    }

    /// Cells that hold about eight segments each if these are spread evenly; there must be one at least.
    pub fn suited(segments: &[Segment]) -> Cells {
        let mut corner = [f64::INFINITY; 2];
        let mut far = [f64::NEG_INFINITY; 2];
        let mut length = 0.0;
        for s in segments {
            for k in 0..2 {
                corner[k] = corner[k].min(s.a[k]).min(s.b[k]);
                far[k] = far[k].max(s.a[k]).max(s.b[k]);
                // A sum of integers below 2^53 does not depend on the order; larger ones are only a guess.
                length += (s.b[k] - s.a[k]).abs();
            }
        }
        let n = segments.len() as f64;
        let (width, height) = (far[0] - corner[0] + 1.0, far[1] - corner[1] + 1.0);
        // length·h + n·h² = 8·area
        let area = width * height;
        let side = ((length * length + 32.0 * n * area).sqrt() - length) / (2.0 * n);
        let floor = (area / (4.0 * n)).sqrt().max(width.max(height) / (4.0 * n)).max(4096.0);
        Cells::covering(corner, far, side.max(floor))
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// The cell that owns a site; sites outside belong to the border cells.
    pub fn owner(&self, s: Site) -> usize {
        self.row(s[1]) * self.columns + self.column(s[0])
    }

    /// The x where a column begins.
    pub fn left(&self, column: usize) -> f64 {
        self.corner[0] + column as f64 / self.per_unit
    }

    /// The column of an x.
    pub fn column(&self, x: f64) -> usize {
        (((x - self.corner[0]) * self.per_unit).max(0.0) as usize).min(self.columns - 1)
    }

    /// The row of a y.
    pub fn row(&self, y: f64) -> usize {
        (((y - self.corner[1]) * self.per_unit).max(0.0) as usize).min(self.rows - 1)
    }

    /// Calls `visit` with every cell that the segment may come near.
    pub fn near(&self, s: &Segment, mut visit: impl FnMut(usize)) {
        let (first, last) = (self.column(s.a[0] - MARGIN), self.column(s.b[0] + MARGIN));
        let (low, high) = if s.a[1] < s.b[1] { (s.a[1], s.b[1]) } else { (s.b[1], s.a[1]) };
        let (bottom, top) = (self.row(low - MARGIN), self.row(high + MARGIN));
        if first == last || bottom == top {
            for row in bottom..=top {
                (first..=last).for_each(|column| visit(row * self.columns + column));
            }
            return;
        }
        let (d, side) = (s.delta(), 1.0 / self.per_unit);
        for column in first..=last {
            // A column's left border may be off by the rounding of 1 / side, which the margin swallows.
            let left = self.corner[0] + column as f64 * side;
            let height = |x: f64| s.a[1] + ((x - s.a[0]) / d[0]).clamp(0.0, 1.0) * d[1];
            let (y0, y1) = if d[0] > 0.0 {
                (height(left - 2.0 * MARGIN), height(left + side + 2.0 * MARGIN))
            } else {
                (s.a[1], s.b[1])
            };
            let (bottom, top) = (self.row(y0.min(y1) - MARGIN), self.row(y0.max(y1) + MARGIN));
            (bottom..=top).for_each(|row| visit(row * self.columns + column));
        }
    }
}

/// The buckets of all cells, one after the other.
pub(super) struct Bins {
    pub cells: Cells,
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Bins {
    /// Sorts the numbered segments into `cells`.
    pub fn fill<'a>(cells: Cells, segments: impl Iterator<Item = (u32, &'a Segment)> + Clone) -> Bins {
        let mut starts = vec![0u32; cells.len() + 1];
        for (_, s) in segments.clone() {
            cells.near(s, |cell| starts[cell] += 1);
        }
        let mut total = 0u32;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        let mut members = vec![0u32; total as usize];
        for (i, s) in segments {
            cells.near(s, |cell| {
                starts[cell] -= 1;
                members[starts[cell] as usize] = i;
            });
        }
        Bins { cells, starts, members }
    }

    /// The numbers of the segments near a cell.
    pub fn members(&self, cell: usize) -> &[u32] {
        &self.members[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}
