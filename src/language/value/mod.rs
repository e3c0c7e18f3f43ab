//! Shapes that values share: one or many, ranges, points, maps of names, constants or fields.

mod arguments;
mod label;
mod list;
mod varying;
mod vector;

pub use arguments::Arguments;
pub use label::{LabelCycle, WeightedLabels};
pub use list::{List, Named, NonEmpty, OneOrMany};
pub use varying::{Range, Target, Varying};
pub use vector::{Direction, PlanePoint, SpacePoint, Vector};
