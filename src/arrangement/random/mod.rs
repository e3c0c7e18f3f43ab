//! Irregular partitions: the Voronoi cells of random points. A density (`density`) thins a Poisson
//! process (`candidates`); `points` makes a point set of it, `voronoi` the diagram of the plane,
//! and `cells` cuts that by the border of a region and draws labels.

pub(crate) mod candidates;
pub(crate) mod cells;
pub(crate) mod density;
pub(crate) mod points;
pub(crate) mod properties;
pub(crate) mod voronoi;
