//! The kernel: what a point, a curve, a region, a planar map is. Pure values and functions; no
//! names of a spec, no files, no randomness but the counter-based [`Seed`].

mod curves;
pub mod cutout;
pub mod drawing;
pub mod facade;
mod field;
pub mod flatten;
pub mod index;
mod label;
pub mod mesh;
pub mod neck;
pub mod numeric;
pub mod planar_map;
mod point;
pub mod polygon;
mod raster;
mod region;
mod ribbon;
mod seed;
mod space;
mod space_curve;
mod surface_curve;
pub mod topology;

pub use curves::{Curve, CurveLabels, Curves};
pub use cutout::{Carrier, Cutout, Measures, Synthesis};
pub use drawing::{Drawing, FillRule, Shape};
pub use facade::{Facade, FacadeBody, FacadeCell, FacadeLayout, FacadeShape};
pub use field::{Field, Relief, VectorField};
pub use label::LabelSet;
pub use mesh::{Affine3, Bounds3, Mesh, MeshError, MeshTopology, Model};
pub use planar_map::{EdgeId, FaceId, HalfEdge, PlanarMap, PlanarMapError, VertexId};
pub use point::{Affine, Bounds, Point};
pub use polygon::{Polygon, Ring};
pub use raster::Raster;
pub use region::{Region, Tile};
pub use ribbon::{Across, Fold, Frame, Ribbon, RibbonError};
pub use seed::{Seed, Snap};
pub use space::Point3;
pub use space_curve::{SpaceCurve, SpaceCurveError};
pub use surface_curve::{SurfaceCurve, SurfaceCurveError, surface_curve};
pub use topology::{Topology, TopologyError};
