//! Samples on a grid, and functions of the plane.

mod extremes;
mod field;
mod grid;
mod lattice;
#[cfg(test)]
mod lattice_tests;
mod of_features;
mod pixels;

pub use field::{Field, Relief, VectorField, aspect};
pub use grid::Raster;
pub use lattice::{Lattice, Place, Samples};
pub use pixels::Pixels;
