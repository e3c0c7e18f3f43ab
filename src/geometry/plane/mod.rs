//! The plane: points, polylines, polygons with holes, regions, drawings, and what they measure.

mod along;
mod curves;
pub mod drawing;
pub mod flatten;
mod label;
pub mod letters;
pub mod neck;
mod point;
pub mod polygon;
pub mod polyline;
mod region;
pub mod topology;

pub use along::along_others;
pub use curves::{Curve, CurveLabels, Curves};
pub use label::LabelSet;
pub use point::{Affine, Bounds, Point};
pub use region::{Attribute, Feature, Region, Tile};
