//! Marching squares: the pieces of an isoline through one square.

use crate::error::ArrangementError;
use crate::limit::LIMIT;
use fretwork_geometry::budget;

/// Bytes for a piece of an isoline until it is part of a line that is cropped.
const PIECE: usize = 150;

/// A side that squares share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SideId {
    /// The number of the sample where it begins, or that is the lower left corner of its square.
    pub first: usize,
    /// Where it leads.
    pub way: Way,
}

/// Where a side leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// To the next sample.
    Right,
    /// To the sample above it.
    Up,
    /// From the middle of this side of a square to the middle of the square.
    Inward(u8),
}

impl SideId {
    /// The side from a sample to the next one.
    pub fn right(first: usize) -> SideId {
        let way = Way::Right;
        SideId { first, way }
    }

    /// The side from a sample to the one above it.
    pub fn up(first: usize) -> SideId {
        let way = Way::Up;
        SideId { first, way }
    }

    /// The line from the middle of the n-th side of a square to the middle of the square.
    pub fn inner(first: usize, n: usize) -> SideId {
        let way = Way::Inward(n as u8);
        SideId { first, way }
    }
}

/// A piece of an isoline through a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Segment {
    /// Its value as a multiple of the distance of isolines.
    pub level: i64,
    /// The side through which it comes in.
    pub from: SideId,
    /// The side through which it leaves.
    pub to: SideId,
}

/// A square, or a quarter of one.
#[derive(Clone, Copy, Debug)]
pub struct Square {
    /// The values at its corners, counter-clockwise.
    pub corners: [f64; 4],
    /// Its sides, the n-th from corner n to the next.
    pub sides: [SideId; 4],
}

impl Square {
    /// Adds the pieces of all isolines, a distance of `every` apart, to `out`, besides so many of other blocks.
    ///
    /// # Errors
    /// When there are too many.
    pub fn add_isolines(
        &self,
        every: f64,
        others: usize,
        out: &mut Vec<Segment>,
    ) -> Result<(), ArrangementError> {
        let (low, high) = (self.corners.iter())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (v.min(low), v.max(high))
            });
        let (first, last) = ((low / every).floor(), (high / every).floor());
        let farthest = first.abs().max(last.abs());
        let held = others + out.len();
        let count = last - first + held as f64;
        if count > 4.0 * LIMIT as f64 || farthest > 1e15 {
            return Err(ArrangementError::TooMany {
                what: "segments of isolines",
                count: if farthest > 1e15 { farthest } else { count },
            });
        }
        let pieces = (last - first) as usize;
        if pieces > 0 {
            budget::hold("segments of isolines", pieces + held, PIECE);
            budget::spend("segments of isolines", 4 * pieces as u64);
        }
        for level in first as i64..=last as i64 {
            self.march(level, level as f64 * every, out);
        }
        Ok(())
    }

    /// Adds the pieces of the isoline of `value`, whose level this is, to `out`.
    fn march(&self, level: i64, value: f64, out: &mut Vec<Segment>) {
        let Square { corners, sides } = *self;
        let above = corners.map(|v| v >= value);
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
