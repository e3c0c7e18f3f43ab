//! Cutting: curves by the faces of other curves (`faces`), and by the border of a region (`crop`).
//! Both go through the planar map of the two (`overlay`); `region_raster` spares most cells this
//! exact way.

pub(crate) mod crop;
pub(crate) mod faces;
pub(crate) mod overlay;
pub(crate) mod region_raster;

pub use faces::{by_region, by_rim, inside, outside};
