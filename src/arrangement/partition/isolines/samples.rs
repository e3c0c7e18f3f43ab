//! Samples of a field at the corners of squares, and the isolines through these squares, by marching squares.

use super::blocks::Block;
use crate::error::ArrangementError;
use crate::limit::LIMIT;
use fretwork_geometry::Point;
use fretwork_geometry::budget;

/// Steps for a sample of a field, which may be a formula.
const SAMPLE: u64 = 30;

/// Bytes for a piece of an isoline until it is part of a line that is cropped.
const PIECE: usize = 150;

/// A side between neighbouring samples: twice the number of the first, plus 1 when the other is above it.
pub type GridSide = usize;

/// A piece of an isoline through a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Segment {
    /// Its value as a multiple of the distance of isolines.
    pub level: i64,
    from: GridSide,
    to: GridSide,
}

/// A square between four samples.
#[derive(Clone, Copy)]
struct Square {
    /// The number of the sample at its lower left corner.
    first: usize,
    /// The values at its corners, counter-clockwise.
    corners: [f64; 4],
}

/// Samples of a field on a lattice.
pub struct Samples {
    /// The column and row of the first, counted from the origin of the plane.
    first: [i64; 2],
    step: Point,
    columns: usize,
    values: Vec<f64>,
}

impl Samples {
    /// The samples at the corners of the squares of a block.
    pub fn of(value: impl Fn(Point) -> f64, block: &Block, step: Point) -> Samples {
        let [columns, rows] = block.squares.map(|squares| squares + 1);
        budget::make("squares of a lattice", columns * rows, size_of::<f64>());
        budget::spend("squares of a lattice", SAMPLE * (columns * rows) as u64);
        let mut samples = Samples {
            first: block.first,
            step,
            columns,
            values: Vec::new(),
        };
        samples.values = (0..columns * rows).map(|i| value(samples.at(i))).collect();
        samples
    }

    /// The middle of a square of the plane, the same from whatever block.
    fn at(&self, i: usize) -> Point {
        let along = |first: i64, n: usize, step: f64| ((first + n as i64) as f64 + 0.5) * step;
        Point::new(
            along(self.first[0], i % self.columns, self.step.x),
            along(self.first[1], i / self.columns, self.step.y),
        )
    }

    /// Where the field has `value` between two samples; the same for the squares on either side.
    pub fn crossing(&self, side: GridSide, value: f64) -> Point {
        let (i, j) = (
            side / 2,
            side / 2
                + if side.is_multiple_of(2) {
                    1
                } else {
                    self.columns
                },
        );
        let part = (value - self.values[i]) / (self.values[j] - self.values[i]);
        self.at(i).lerp(self.at(j), part.clamp(0.0, 1.0))
    }

    /// All pieces, by level and then by where they begin, besides so many of other blocks.
    ///
    /// # Errors
    /// When there are too many.
    pub fn segments(&self, every: f64, others: usize) -> Result<Vec<Segment>, ArrangementError> {
        let mut segments = Vec::new();
        let rows = self.values.len() / self.columns;
        for (row, column) in (0..rows - 1).flat_map(|r| (0..self.columns - 1).map(move |c| (r, c)))
        {
            let i = row * self.columns + column;
            let corners =
                [i, i + 1, i + self.columns + 1, i + self.columns].map(|k| self.values[k]);
            let (low, high) = corners
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |r, v| {
                    (r.0.min(*v), r.1.max(*v))
                });
            if corners.iter().any(|v| !v.is_finite()) {
                continue;
            }
            let (first, last) = ((low / every).floor(), (high / every).floor());
            let (count, farthest) = (
                last - first + (others + segments.len()) as f64,
                first.abs().max(last.abs()),
            );
            if count > 4.0 * LIMIT as f64 || farthest > 1e15 {
                let count = if farthest > 1e15 { farthest } else { count };
                return Err(ArrangementError::TooMany {
                    what: "segments of isolines",
                    count,
                });
            }
            let pieces = (last - first) as usize;
            if pieces > 0 {
                budget::hold(
                    "segments of isolines",
                    pieces + others + segments.len(),
                    PIECE,
                );
                budget::spend("segments of isolines", 4 * pieces as u64);
            }
            for level in first as i64..=last as i64 {
                self.march(Square { first: i, corners }, level, every, &mut segments);
            }
        }
        segments.sort_unstable();
        Ok(segments)
    }

    /// Adds the pieces of one level in a square to `out`.
    fn march(&self, square: Square, level: i64, every: f64, out: &mut Vec<Segment>) {
        let Square { first: i, corners } = square;
        let value = level as f64 * every;
        let above = corners.map(|v| v >= value);
        // Sides in counter-clockwise order, the n-th from corner n to the next.
        let sides = [2 * i, 2 * (i + 1) + 1, 2 * (i + self.columns), 2 * i + 1];
        // A line comes in where the corners change from above to below, and leaves where they change
        // back: so what is above is on its left.
        let goes_down: Vec<usize> = (0..4)
            .filter(|n| above[*n] && !above[(n + 1) % 4])
            .collect();
        let goes_up: Vec<usize> = (0..4)
            .filter(|n| !above[*n] && above[(n + 1) % 4])
            .collect();
        let mut add = |from: usize, to: usize| {
            out.push(Segment {
                level,
                from: sides[from],
                to: sides[to],
            })
        };
        match (goes_down.as_slice(), goes_up.as_slice()) {
            ([down], [up]) => add(*down, *up),
            ([first, second], [_, _]) => {
                let [a, b, c, d] = corners.map(|v| v - value);
                // The bilinear surface's saddle is above when the product of the high diagonal is greater.
                let middle_is_above = (a * c - b * d) / (a + c - b - d) >= 0.0;
                // High corners that are connected have the low ones cut off, each by its two sides.
                for down in [*first, *second] {
                    add(
                        down,
                        if middle_is_above {
                            (down + 1) % 4
                        } else {
                            (down + 3) % 4
                        },
                    );
                }
            }
            _ => {}
        }
    }
}

/// The lines that the pieces of one level, sorted by where they begin, make up, as the sides that
/// they cross; a closed one repeats its first side.
pub fn join(segments: &[Segment]) -> Vec<Vec<GridSide>> {
    let next = |side: GridSide| segments.binary_search_by_key(&side, |s| s.from).ok();
    let mut is_continued = vec![false; segments.len()];
    for segment in segments {
        if let Some(n) = next(segment.to) {
            is_continued[n] = true;
        }
    }
    let mut done = vec![false; segments.len()];
    let open = (0..segments.len()).filter(|n| !is_continued[*n]);
    let closed = (0..segments.len()).filter(|n| is_continued[*n]);
    let mut lines = Vec::new();
    for start in open.chain(closed) {
        if done[start] {
            continue;
        }
        let mut line = vec![segments[start].from];
        let mut at = Some(start);
        while let Some(n) = at.filter(|n| !done[*n]) {
            done[n] = true;
            line.push(segments[n].to);
            at = next(segments[n].to);
        }
        lines.push(line);
    }
    lines
}
