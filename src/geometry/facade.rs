//! The layout of a facade: which shape stands where on the canvas. How it was found, and what the
//! shapes look like, is not known here.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// Shapes on a canvas, y up, the origin in the lower left corner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FacadeLayout {
    /// The width of the canvas.
    pub width: f64,
    /// The height of the canvas.
    pub height: f64,
    /// The borders between columns, ascending, from 0 to the width.
    pub x: Vec<f64>,
    /// The borders between rows, ascending, from 0 to the height.
    pub y: Vec<f64>,
    /// The names of the layers, the lowest first.
    pub layers: Vec<Arc<str>>,
    /// The shapes, by layer, then by y, then by x.
    pub cells: Vec<FacadeCell>,
    /// How far the preferred sizes are from lining up, the sum of both axes.
    pub alignment_error: f64,
    /// The squared differences between sizes and preferred sizes, the sum of both axes.
    pub size_error: f64,
}

/// One shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FacadeCell {
    /// Number of its layer.
    pub layer: u32,
    /// The symbol along x.
    pub symbol_x: char,
    /// The symbol along y.
    pub symbol_y: char,
    /// Its left side.
    pub x: f64,
    /// Its lower side.
    pub y: f64,
    /// Its width.
    pub width: f64,
    /// Its height.
    pub height: f64,
    /// Whether it is turned about a vertical axis.
    pub mirrored_x: bool,
    /// Whether it is turned about a horizontal axis.
    pub mirrored_y: bool,
    /// Whether both its symbols are opaque.
    pub opaque: bool,
}

impl FacadeLayout {
    /// The number of columns.
    pub fn columns(&self) -> usize {
        self.x.len().saturating_sub(1)
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.y.len().saturating_sub(1)
    }

    /// Whether a cell is wholly covered by opaque cells of the layers above it, per cell.
    pub fn hidden(&self) -> Vec<bool> {
        let grid = Cover::new(self);
        self.cells.iter().map(|cell| grid.covers(cell)).collect()
    }

    /// The layout without cells that nobody sees.
    pub fn culled(mut self) -> FacadeLayout {
        let mut hidden = self.hidden().into_iter();
        self.cells.retain(|_| !hidden.next().unwrap_or(false));
        self
    }
}

/// The uppermost opaque layer in every rectangle between the sides of the cells.
struct Cover {
    x: Vec<f64>,
    y: Vec<f64>,
    top: Vec<Option<u32>>,
    slack: f64,
}

impl Cover {
    fn new(layout: &FacadeLayout) -> Cover {
        let slack = 1e-9 * layout.width.max(layout.height);
        let sides = |low: fn(&FacadeCell) -> f64, size: fn(&FacadeCell) -> f64| {
            let mut all: Vec<f64> = layout.cells.iter().flat_map(|c| [low(c), low(c) + size(c)]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup_by(|b, a| *b - *a <= slack);
            all
        };
        let (x, y) = (sides(|c| c.x, |c| c.width), sides(|c| c.y, |c| c.height));
        let mut cover = Cover { top: vec![None; x.len() * y.len()], x, y, slack };
        for cell in layout.cells.iter().filter(|cell| cell.opaque) {
            for at in cover.within(cell) {
                cover.top[at] = cover.top[at].max(Some(cell.layer));
            }
        }
        cover
    }

    /// The rectangles that a cell consists of.
    fn within(&self, cell: &FacadeCell) -> Vec<usize> {
        let span = |sides: &[f64], low: f64, size: f64| {
            let first = sides.partition_point(|s| *s < low - self.slack);
            first..sides.partition_point(|s| *s < low + size - self.slack)
        };
        let columns = span(&self.x, cell.x, cell.width);
        let rows = span(&self.y, cell.y, cell.height);
        rows.flat_map(|row| columns.clone().map(move |column| row * self.x.len() + column)).collect()
    }

    fn covers(&self, cell: &FacadeCell) -> bool {
        self.within(cell).into_iter().all(|at| self.top[at] > Some(cell.layer))
    }
}
