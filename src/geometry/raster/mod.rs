//! Samples on a grid, and functions of the plane.

mod extremes;
mod field;
mod grid;
mod pixels;

pub use field::{Field, Relief, VectorField};
pub use grid::Raster;
pub use pixels::Pixels;
