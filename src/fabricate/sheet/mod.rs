//! What is drawn on one plane, and the steps that make it ready for a machine, each from a sheet to
//! a sheet: room for the beam, clipping, no line twice, short ways.

pub mod arc_fit;
mod chains;
pub mod clip;
pub mod deduplicate;
pub mod edges;
pub mod fixed_point;
pub mod inside_first;
pub mod kerf;
pub mod layer;
pub mod lines;
mod nesting;
pub mod optimize;
pub mod prepare;
pub mod rounding;
mod slabs;
pub mod style;
mod travel_order;
mod unite;
pub mod window;
mod window_area;

pub use layer::{Item, Layer, Sheet};
pub use style::{Color, Pen, Role, Style};
