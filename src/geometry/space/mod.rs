//! Space: points, affine maps and boxes.

mod place;
mod point3;

pub use place::{Affine3, Bounds3};
pub use point3::Point3;
