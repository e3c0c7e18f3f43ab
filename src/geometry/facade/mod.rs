//! Facades: which cells there are on the canvas, and what stands in them. How a layout was found, and
//! how a facade is written, is not known here.

mod cover;
mod moulding;
mod shape;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use cover::Cover;
pub use moulding::{Moulding, Run};
pub use shape::{Facade, FacadeBody, FacadeShape, Relief};

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
        let cover = Cover::new(self, |cell| self.cells[cell].opaque);
        self.cells.iter().map(|cell| cover.hides(cell)).collect()
    }

    /// The layout without cells that nobody sees.
    pub fn culled(mut self) -> FacadeLayout {
        let mut hidden = self.hidden().into_iter();
        self.cells.retain(|_| !hidden.next().unwrap_or(false));
        self
    }
}
