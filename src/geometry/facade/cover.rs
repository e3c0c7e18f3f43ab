//! What opaque cells hide of the layers below them.

use super::{FacadeCell, FacadeLayout};

/// The uppermost opaque layer in every rectangle between the sides of the cells.
pub struct Cover {
    x: Vec<f64>,
    y: Vec<f64>,
    top: Vec<Option<u32>>,
    slack: f64,
}

/// A rectangle: its corner of least and that of greatest coordinates.
pub type Box2 = ([f64; 2], [f64; 2]);

impl Cover {
    /// The cover of the cells that hide what is below them.
    pub fn new(layout: &FacadeLayout, hides: impl Fn(usize) -> bool) -> Cover {
        let slack = 1e-9 * layout.width.max(layout.height);
        let sides = |low: fn(&FacadeCell) -> f64, size: fn(&FacadeCell) -> f64| {
            let mut all: Vec<f64> = layout
                .cells
                .iter()
                .flat_map(|c| [low(c), low(c) + size(c)])
                .collect();
            all.sort_by(f64::total_cmp);
            all.dedup_by(|b, a| *b - *a <= slack);
            all
        };
        let (x, y) = (sides(|c| c.x, |c| c.width), sides(|c| c.y, |c| c.height));
        let mut cover = Cover {
            top: vec![None; x.len() * y.len()],
            x,
            y,
            slack,
        };
        for (number, cell) in layout.cells.iter().enumerate() {
            if hides(number) {
                for at in cover.within(cell) {
                    cover.top[at] = cover.top[at].max(Some(cell.layer));
                }
            }
        }
        cover
    }

    /// Whether a cell is wholly covered by layers above it.
    pub fn hides(&self, cell: &FacadeCell) -> bool {
        self.within(cell)
            .into_iter()
            .all(|at| self.top[at] > Some(cell.layer))
    }

    /// The rectangles of a cell that are not covered; none when it is not covered at all.
    pub fn uncovered(&self, cell: &FacadeCell) -> Option<Vec<Box2>> {
        let all = self.within(cell);
        let free: Vec<usize> = all
            .iter()
            .copied()
            .filter(|at| self.top[*at] <= Some(cell.layer))
            .collect();
        let corners = |at: usize| {
            let (column, row) = (at % self.x.len(), at / self.x.len());
            let beyond = |sides: &[f64], i: usize| sides.get(i + 1).copied().unwrap_or(sides[i]);
            (
                [self.x[column], self.y[row]],
                [beyond(&self.x, column), beyond(&self.y, row)],
            )
        };
        (free.len() < all.len()).then(|| free.into_iter().map(corners).collect())
    }

    /// The numbers of the rectangles that a cell consists of.
    fn within(&self, cell: &FacadeCell) -> Vec<usize> {
        let span = |sides: &[f64], low: f64, size: f64| {
            let first = sides.partition_point(|s| *s < low - self.slack);
            first..sides.partition_point(|s| *s < low + size - self.slack)
        };
        let columns = span(&self.x, cell.x, cell.width);
        let rows = span(&self.y, cell.y, cell.height);
        rows.flat_map(|row| {
            columns
                .clone()
                .map(move |column| row * self.x.len() + column)
        })
        .collect()
    }
}
