//! Samples of a field at the corners of squares, and the isolines through these squares, by marching squares.
//!
//! A square that lacks values at some of its corners is where the samples of a raster end. A sample stands in the
//! middle of its pixel, so that the field goes on for half a square: the square is marched in quarters, those of the
//! corners that have a value.

use super::blocks::Block;
use super::square::{Segment, SideId, Square, Way};
use crate::error::ArrangementError;
use fretwork_geometry::Point;
use fretwork_geometry::budget;

/// Steps for a sample of a field, which may be a formula.
const SAMPLE: u64 = 30;

/// How far from the middle of a square, as a part of the way to a corner, it is asked whether the corner's pixel reaches it.
const NUDGE: f64 = 1e-6;

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

    /// Where the field has `value` on a side; the same for the squares, or quarters, on either side of it.
    pub fn crossing(&self, side: SideId, value: f64) -> Point {
        let ((a, from), (b, to)) = self.ends(side);
        let part = (value - a) / (b - a);
        from.lerp(to, part.clamp(0.0, 1.0))
    }

    /// The values and the places at the ends of a side.
    fn ends(&self, side: SideId) -> ((f64, Point), (f64, Point)) {
        let sample = |i: usize| (self.values[i], self.at(i));
        let SideId { first, way } = side;
        match way {
            Way::Right => (sample(first), sample(first + 1)),
            Way::Up => (sample(first), sample(first + self.columns)),
            Way::Inward(n) => {
                let n = usize::from(n);
                let corners = self.corners(first);
                let places = self.around(first).map(|k| self.at(k));
                let middle = places[n].lerp(places[(n + 1) % 4], 0.5);
                let center = places[0].lerp(places[2], 0.5);
                let [a, b] = [corners[n], corners[(n + 1) % 4]];
                ((mean(&[a, b]), middle), (mean(&corners), center))
            }
        }
    }

    /// The samples at the corners of the square of which this is the lower left one, counter-clockwise.
    fn around(&self, first: usize) -> [usize; 4] {
        [
            first,
            first + 1,
            first + self.columns + 1,
            first + self.columns,
        ]
    }

    fn corners(&self, first: usize) -> [f64; 4] {
        self.around(first).map(|k| self.values[k])
    }

    /// The sides of the square, counter-clockwise, the n-th from corner n to the next.
    fn sides(&self, first: usize) -> [SideId; 4] {
        [
            SideId::right(first),
            SideId::up(first + 1),
            SideId::right(first + self.columns),
            SideId::up(first),
        ]
    }

    /// The quarters of a square at the corners that have a value as far as its middle.
    fn quarters(&self, first: usize, value: impl Fn(Point) -> f64) -> Vec<Square> {
        let (corners, sides) = (self.corners(first), self.sides(first));
        let places = self.around(first).map(|k| self.at(k));
        let center = places[0].lerp(places[2], 0.5);
        let has_quarter = |n: &usize| {
            corners[*n].is_finite() && value(center.lerp(places[*n], NUDGE)).is_finite()
        };
        let quarter = |n: usize| {
            let (before, after) = ((n + 3) % 4, (n + 1) % 4);
            Square {
                corners: [
                    corners[n],
                    mean(&[corners[n], corners[after]]),
                    mean(&corners),
                    mean(&[corners[before], corners[n]]),
                ],
                sides: [
                    sides[n],
                    SideId::inner(first, n),
                    SideId::inner(first, before),
                    sides[before],
                ],
            }
        };
        (0..4).filter(has_quarter).map(quarter).collect()
    }

    /// All pieces, by level and then by where they begin, besides so many of other blocks. `value` is the field between
    /// the samples; a field that has none there ends at its last samples.
    ///
    /// # Errors
    /// When there are too many.
    pub fn segments(
        &self,
        value: impl Fn(Point) -> f64,
        every: f64,
        others: usize,
    ) -> Result<Vec<Segment>, ArrangementError> {
        let mut segments = Vec::new();
        let rows = self.values.len() / self.columns;
        let firsts = (0..rows - 1)
            .flat_map(|row| (0..self.columns - 1).map(move |column| row * self.columns + column));
        for first in firsts {
            let (corners, sides) = (self.corners(first), self.sides(first));
            if corners.iter().all(|v| v.is_finite()) {
                Square { corners, sides }.add_isolines(every, others, &mut segments)?;
                continue;
            }
            for quarter in self.quarters(first, &value) {
                quarter.add_isolines(every, others, &mut segments)?;
            }
        }
        segments.sort_unstable();
        Ok(segments)
    }
}

/// The lines that the pieces of one level, sorted by where they begin, make up, as the sides that
/// they cross; a closed one repeats its first side.
pub fn join(segments: &[Segment]) -> Vec<Vec<SideId>> {
    let next = |side: SideId| segments.binary_search_by_key(&side, |s| s.from).ok();
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

/// The mean of the values that there are.
fn mean(values: &[f64]) -> f64 {
    let known = || values.iter().filter(|v| v.is_finite());
    known().sum::<f64>() / known().count() as f64
}
