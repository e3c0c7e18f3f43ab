//! Element textures (Loi 2015): partitions of a region, the cells of the planar maps they give,
//! placement of elements in cells, masks. Plain functions from values to [`Curves`]; their names in
//! scripts are bound elsewhere, and no planar map is built but where a rule needs one.
//!
//! [`Curves`]: fretwork_geometry::Curves

mod boundary;
mod bridges;
mod buckets;
mod candidates;
pub mod cells;
mod connect;
mod coverage;
mod crop;
mod density;
mod distance;
mod error;
mod evaluate;
pub mod from_spec;
mod function;
mod grid;
mod irregular;
mod isolines;
mod lines;
pub mod mask;
mod operators;
mod overlay;
mod packed;
mod period;
mod place;
pub mod placement;
mod points;
mod properties;
mod side_tree;
mod stripes;
mod tiling;
mod transform;
mod voronoi;
mod zone;

pub use connect::connect;
pub use error::ArrangementError;
pub use evaluate::{Argument, Mapper, Script, ScriptArrangement};
pub use function::{Applied, Arrangement};
pub use grid::grid;
pub use irregular::{random, uniform};
pub use isolines::isolines;
pub use packed::{PackedProperties, packed};
pub use place::place;
pub use properties::{Border, Density, IrregularProperties, StripesProperties, Weighted};
pub use stripes::stripes;
pub use transform::transform;
