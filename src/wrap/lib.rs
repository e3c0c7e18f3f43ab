//! Drawings laid on surfaces: a planar area becomes a cutout that lies on a mesh.
//!
//! The way of one wrap, from its area to its cutout:
//!
//! 1. `chart` unrolls the surface, or the part of it around a place: each triangle gets a place in the drawing.
//! 2. `copies` puts the area there, once or as often as it goes around, and closes the ring.
//! 3. `press` divides the triangles along the outline and tells which are filled.
//! 4. `count` counts components and holes again, on the surface.
//!
//! What is made of the cutout is known to the room `solid`.
//!
#![doc = include_str!("SEMANTICS.md")]

mod chart;
mod copies;
mod count;
mod error;
mod press;
mod wrap;

#[cfg(test)]
mod tests;

pub use copies::{Around, Laying};
pub use error::WrapError;
pub use wrap::{Drawn, wrap};
