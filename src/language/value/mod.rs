//! Shapes that values share: one or many, ranges, points, maps of names, constants or fields, measures.

mod arguments;
mod expected;
mod label;
mod list;
mod measure;
mod page;
mod table;
mod varying;
mod vector;

pub use arguments::Arguments;
pub use expected::{Corners, Expectations, Expected};
pub use label::{LabelCycle, WeightedLabels};
pub use list::{List, Named, NonEmpty, OneOrMany};
pub use measure::{Dimension, shown_measure, shown_number};
pub use page::PageSize;
pub use table::TableValue;
pub use varying::{Range, Target, Varying};
pub use vector::{Direction, PlanePoint, SpacePoint, Vector};
