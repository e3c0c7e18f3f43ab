//! Space: points, affine maps, boxes and views.

mod place;
mod point3;
mod view;

pub use place::{Affine3, Bounds3};
pub use point3::Point3;
pub use view::View;
