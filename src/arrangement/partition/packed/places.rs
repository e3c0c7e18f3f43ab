//! The squares of a lattice from which darts are thrown. What is done with a dart is not here.

use crate::error::ArrangementError;
use crate::limit::LIMIT;
use fretwork_geometry::budget;
use fretwork_geometry::{Bounds, Point, Seed};

/// Bytes that a place for darts takes.
const PLACE: usize = 48;

/// Square places over a box, row by row.
pub(super) struct Places {
    /// Their side.
    pub side: f64,
    /// How many there are in a row, and how many rows.
    pub size: [u64; 2],
    /// The point that the lattice is anchored at.
    origin: Point,
    /// The number of the first column and row from there.
    first: [i64; 2],
    /// Whether places are known by their numbers in the lattice, whatever the box is.
    is_anchored: bool,
}

impl Places {
    /// The places of this side over `window`: of a lattice that begins at its least corner, or of one of the whole plane that
    /// is anchored at a point.
    ///
    /// # Errors
    /// When there are too many.
    pub fn over(
        window: &Bounds,
        side: f64,
        anchor: Option<Point>,
    ) -> Result<Places, ArrangementError> {
        let origin = anchor.unwrap_or(window.min);
        let number = |v: f64, from: f64| ((v - from) / side).floor();
        let first = match anchor {
            Some(_) => [
                number(window.min.x, origin.x),
                number(window.min.y, origin.y),
            ],
            None => [0.0; 2],
        };
        let count = |high: f64, from: f64, first: f64| ((high - from) / side - first).ceil();
        let columns = count(window.max.x, origin.x, first[0]);
        let rows = count(window.max.y, origin.y, first[1]);
        let all = columns * rows;
        let is_exact = first.iter().all(|n| n.abs() < (1u64 << 50) as f64);
        if all.is_nan() || all > 4.0 * LIMIT as f64 || !is_exact {
            return Err(ArrangementError::TooMany {
                what: "places for copies",
                count: all,
            });
        }
        budget::make("places for copies", all as usize, PLACE);
        Ok(Places {
            side,
            size: [columns as u64, rows as u64],
            origin,
            first: first.map(|n| n as i64),
            is_anchored: anchor.is_some(),
        })
    }

    /// How many there are.
    pub fn count(&self) -> u64 {
        self.size[0] * self.size[1]
    }

    /// The column and the row of a place in the lattice.
    fn number(&self, place: u64) -> [i64; 2] {
        let [columns, _] = self.size;
        [
            self.first[0] + (place % columns) as i64,
            self.first[1] + (place / columns) as i64,
        ]
    }

    /// The point at parts `u` and `v` of the sides of a place.
    pub fn at(&self, place: u64, u: f64, v: f64) -> Point {
        let [i, j] = self.number(place);
        self.origin + Point::new(i as f64, j as f64) * self.side + Point::new(u, v) * self.side
    }

    /// What a place is known by.
    pub fn seed(&self, root: Seed, place: u64) -> Seed {
        if !self.is_anchored {
            return root.number(place as i64);
        }
        let [i, j] = self.number(place);
        root.number(i).number(j)
    }

    /// Where in the random order of a round a place comes.
    pub fn order(&self, root: Seed, place: u64) -> u64 {
        let root = root.name("order");
        match self.is_anchored {
            true => self.seed(root, place).unit(0).to_bits(),
            false => root.unit(place).to_bits(),
        }
    }

    /// The columns and rows, as first and last, that a box meets, of those that there are.
    pub fn meeting(&self, from: Point, to: Point) -> [[u64; 2]; 2] {
        let corner = self.at(0, 0.0, 0.0);
        let index = |v: f64, n: u64| (v / self.side).clamp(0.0, n as f64 - 1.0) as u64;
        let [columns, rows] = self.size;
        [
            [
                index(from.x - corner.x, columns),
                index(to.x - corner.x, columns),
            ],
            [index(from.y - corner.y, rows), index(to.y - corner.y, rows)],
        ]
    }
}
