//! Regular partitions of a region: stripes, grids, isolines of a field, packed copies of elements.
//! `lines` knows the families of parallel lines, `boundary` cuts the contour of a region at them,
//! `coverage` says how much of each cell of a grid is inside, `period` whether they fit a tile.

pub(crate) mod boundary;
pub(crate) mod coverage;
pub(crate) mod grid;
pub(crate) mod isolines;
pub(crate) mod lines;
pub(crate) mod packed;
pub(crate) mod period;
pub(crate) mod properties;
pub(crate) mod stripes;
