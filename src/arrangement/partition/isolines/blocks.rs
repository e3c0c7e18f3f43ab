//! The squares of an isoline's lattice, in blocks: what is sampled at a time, and where lines are divided.

use std::ops::Range;

use crate::error::ArrangementError;
use crate::limit::LIMIT;
use fretwork_geometry::{Bounds, Point};

/// Squares along a side of a block. A window of a field of any size is drawn from the blocks that it meets.
pub const SIDE: usize = 2048;

/// A part of a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// The column and row of its first sample, counted from the origin of the plane.
    pub first: [i64; 2],
    /// How many squares it has across and up.
    pub squares: [usize; 2],
}

/// The blocks of the lattice of squares with middles of samples at their corners that covers a box, counted from its lower
/// left corner, row by row.
pub struct Blocks {
    step: Point,
    first: [i64; 2],
    squares: [usize; 2],
    /// Squares along a side of a whole block.
    side: usize,
}

impl Blocks {
    /// Those that cover a box with squares of the size `step`.
    ///
    /// # Errors
    /// When their numbers are too large.
    pub fn over(bounds: &Bounds, step: Point, side: usize) -> Result<Blocks, ArrangementError> {
        let index = |v: f64, step: f64| (v / step - 0.5).floor();
        let (low, high) = (bounds.min, bounds.max);
        let first = [index(low.x, step.x), index(low.y, step.y)];
        let last = [index(high.x, step.x), index(high.y, step.y)];
        let squares = [last[0] - first[0] + 1.0, last[1] - first[1] + 1.0];
        let farthest = first
            .iter()
            .chain(&last)
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        // Numbers beyond it are not told apart.
        if farthest >= 1e15 {
            return Err(too_many(squares[0] * squares[1]));
        }
        Ok(Blocks {
            step,
            first: first.map(|first| first as i64),
            squares: squares.map(|squares| squares as usize),
            side,
        })
    }

    /// How many squares all blocks have.
    pub fn square_count(&self) -> f64 {
        self.squares[0] as f64 * self.squares[1] as f64
    }

    /// How many blocks there are.
    pub fn count(&self) -> usize {
        let along = |squares: usize| squares.div_ceil(self.side);
        along(self.squares[0]) * along(self.squares[1])
    }

    /// How many blocks have squares that meet a room.
    pub fn meeting_count(&self, room: &Bounds) -> usize {
        let [columns, rows] = [0, 1].map(|axis| self.meeting_along(axis, Some(room)).len());
        columns * rows
    }

    /// The blocks whose squares meet a room, or all.
    ///
    /// # Errors
    /// When they have too many squares together.
    pub fn meeting(&self, room: Option<&Bounds>) -> Result<Vec<Block>, ArrangementError> {
        let [columns, rows] = [0, 1].map(|axis| self.meeting_along(axis, room));
        let squares = |axis: usize, blocks: &Range<usize>| {
            let end = (blocks.end * self.side).min(self.squares[axis]);
            end.saturating_sub(blocks.start * self.side) as f64
        };
        let count = squares(0, &columns) * squares(1, &rows);
        if count > 4.0 * LIMIT as f64 {
            return Err(too_many(count));
        }
        let block = |x: usize, y: usize| {
            let [across, up] = [(0, x), (1, y)].map(|(axis, at)| {
                let from = at * self.side;
                let squares = self.side.min(self.squares[axis] - from);
                (self.first[axis] + from as i64, squares)
            });
            Block {
                first: [across.0, up.0],
                squares: [across.1, up.1],
            }
        };
        let in_row = |y: usize| columns.clone().map(move |x| block(x, y));
        Ok(rows.flat_map(in_row).collect())
    }

    /// The numbers of the blocks along an axis that meet a room.
    fn meeting_along(&self, axis: usize, room: Option<&Bounds>) -> Range<usize> {
        let all = self.squares[axis].div_ceil(self.side);
        let Some(room) = room else { return 0..all };
        let of = |p: Point| if axis == 0 { p.x } else { p.y };
        // Numbers of squares, with one more on either side for what is rounded.
        let square = |v: f64| v / of(self.step) - 0.5 - self.first[axis] as f64;
        let block = |square: f64| (square / self.side as f64).floor();
        let low = block(square(of(room.min)) - 1.0).max(0.0) as usize;
        let high = (block(square(of(room.max)) + 1.0) + 1.0).max(0.0) as usize;
        low.min(all)..high.min(all)
    }
}

fn too_many(count: f64) -> ArrangementError {
    ArrangementError::TooMany {
        what: "squares of an isoline's lattice",
        count,
    }
}
