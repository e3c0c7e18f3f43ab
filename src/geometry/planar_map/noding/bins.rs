//! Buckets: which segments come near which cell of a uniform grid. Cells are half-open, so that
//! every site belongs to exactly one.

use crate::index::Rows;
use crate::planar_map::noding::exact::Segment;
use crate::planar_map::noding::snap_grid::{RESOLUTION, Site};

/// How far beyond a cell a segment may pass and still be in its bucket, in grid units: whatever
/// lies within a resolution (and the slack of `crossings`) of a site of the cell is in the cell's bucket.
const MARGIN: f64 = RESOLUTION * 1.25;

/// Cells are not made smaller than this, in grid units.
const FINEST: f64 = 16.0 * RESOLUTION;

/// The number of segments that a cell should hold.
const FILL: f64 = 8.0;

/// A rectangle cut into columns × rows square cells.
#[derive(Clone, Copy, Debug)]
pub(in crate::planar_map) struct Cells {
    corner: Site,
    side: f64,
    per_unit: f64,
    pub columns: usize,
    pub rows: usize,
}

impl Cells {
    /// Cells that hold about eight segments each if these are spread evenly; not so small that an
    /// average segment comes near more than some twenty. There must be a segment.
    pub fn suited(segments: &[Segment]) -> Cells {
        let mut corner = [f64::INFINITY; 2];
        let mut far = [f64::NEG_INFINITY; 2];
        let mut length = 0.0;
        for s in segments {
            corner = [corner[0].min(s.a[0].min(s.b[0])), corner[1].min(s.a[1])];
            far = [far[0].max(s.a[0].max(s.b[0])), far[1].max(s.b[1])];
            // A sum of integers below 2^53 does not depend on the order; where it is larger its last
            // digits may, and the cells with it, but never what is found in them.
            length += (s.b[0] - s.a[0]).abs() + (s.b[1] - s.a[1]);
        }
        let n = segments.len() as f64;
        let (width, height) = (far[0] - corner[0] + 1.0, far[1] - corner[1] + 1.0);
        let least = (length / (16.0 * n)).max(width.max(height) / (2.0 * n));
        Cells::new(
            corner,
            [width, height],
            side(n, length, width * height).max(least),
        )
    }

    /// The square cells of side `side` or a little more that cover a rectangle.
    fn new(corner: Site, extent: [f64; 2], side: f64) -> Cells {
        let side = side.max(FINEST);
        let count = |extent: f64| (extent / side) as usize + 1;
        Cells {
            corner,
            side,
            per_unit: 1.0 / side,
            columns: count(extent[0]),
            rows: count(extent[1]),
        }
    }

    /// A cell cut into smaller ones that suit the segments near it; None when it is too small.
    pub fn split(&self, cell: usize, segments: impl Iterator<Item = Segment>) -> Option<Cells> {
        let (mut n, mut length) = (0.0, 0.0);
        for s in segments {
            n += 1.0;
            length += (s.b[0] - s.a[0]).abs().min(self.side) + (s.b[1] - s.a[1]).min(self.side);
        }
        let side = side(n, length, self.side * self.side).max(self.side / 64.0);
        let corner = [
            self.left(cell % self.columns),
            self.corner[1] + (cell / self.columns) as f64 * self.side,
        ];
        // The border of a cell is rounded, hence a margin; `owner` takes sites beyond it to the border cells.
        (side.max(FINEST) * 1.5 < self.side).then(|| Cells::new(corner, [self.side; 2], side))
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
        self.corner[0] + column as f64 * self.side
    }

    /// The column of an x.
    pub fn column(&self, x: f64) -> usize {
        (((x - self.corner[0]) * self.per_unit) as usize).min(self.columns - 1)
    }

    /// The row of a y.
    pub fn row(&self, y: f64) -> usize {
        (((y - self.corner[1]) * self.per_unit) as usize).min(self.rows - 1)
    }

    /// The range of cells over [low - MARGIN, high + MARGIN] along one axis; may be empty.
    fn span(&self, low: f64, high: f64, axis: usize) -> std::ops::Range<usize> {
        let count = if axis == 0 { self.columns } else { self.rows };
        let cell = |v: f64| (v - self.corner[axis]) * self.per_unit;
        let (first, last) = (cell(low - MARGIN), cell(high + MARGIN));
        // Casts saturate, so what is before the first cell counts from 0 and what is behind the last ends there.
        let end = if last < 0.0 {
            0
        } else {
            (last as usize + 1).min(count)
        };
        (first as usize).min(count)..end
    }

    /// Calls `visit` with every cell that the segment may come near.
    #[inline]
    pub fn near(&self, s: &Segment, mut visit: impl FnMut(usize)) {
        let rows = self.span(s.a[1], s.b[1], 1);
        let columns = self.span(s.a[0].min(s.b[0]), s.a[0].max(s.b[0]), 0);
        if columns.len() <= 1 || rows.len() <= 1 {
            for row in rows {
                columns
                    .clone()
                    .for_each(|column| visit(row * self.columns + column));
            }
            return;
        }
        let d = s.delta();
        let slope = d[0] / d[1];
        let across = |y: f64| {
            if y <= s.a[1] {
                s.a[0]
            } else if y >= s.b[1] {
                s.b[0]
            } else {
                s.a[0] + (y - s.a[1]) * slope
            }
        };
        for row in rows {
            let bottom = self.corner[1] + row as f64 * self.side;
            let (x0, x1) = if d[1] > 0.0 {
                (
                    across(bottom - 2.0 * MARGIN),
                    across(bottom + self.side + 2.0 * MARGIN),
                )
            } else {
                (s.a[0], s.b[0])
            };
            self.span(x0.min(x1), x0.max(x1), 0)
                .for_each(|column| visit(row * self.columns + column));
        }
    }
}

/// The side h of cells with length·h + n·h² = FILL·area.
fn side(n: f64, length: f64, area: f64) -> f64 {
    ((length * length + 4.0 * FILL * n * area).sqrt() - length) / (2.0 * n)
}

/// The segments near each cell.
pub(in crate::planar_map) struct Bins {
    pub cells: Cells,
    members: Rows,
}

impl Bins {
    /// Sorts the segments numbered 0 to `count` - 1 into `cells`.
    pub fn fill(cells: Cells, count: usize, segment: impl Fn(usize) -> Segment) -> Bins {
        let members = Rows::fill(cells.len(), |filler| {
            for i in 0..count {
                cells.near(&segment(i), |cell| filler.put(cell, i as u32));
            }
        });
        Bins { cells, members }
    }

    /// The numbers of the segments near a cell, ascending.
    pub fn members(&self, cell: usize) -> &[u32] {
        self.members.row(cell)
    }

    /// How many numbers some rows of cells hold in all.
    pub fn size(&self, rows: std::ops::Range<usize>) -> usize {
        let cells = rows.start * self.cells.columns..rows.end * self.cells.columns;
        self.members.range(cells).len()
    }
}
