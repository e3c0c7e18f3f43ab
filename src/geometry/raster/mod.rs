//! Samples on a grid, and functions of the plane.

mod extremes;
mod field;
mod grid;

pub use field::{Field, Relief, VectorField};
pub use grid::Raster;
