//! The kernel: what a point, a curve, a region, a planar map is. Pure values and functions; no
//! names of a spec, no files, no randomness but the counter-based [`Seed`].
//!
//! | folder | what lives there |
//! | --- | --- |
//! | `plane` | points, polylines with labels, polygons, regions, drawings, letters of lines; booleans, offsets, necks, topology |
//! | `space` | points, affine maps, boxes, parallel views |
//! | `curve` | curves in space, curves on a mesh, the strip along a curve |
//! | `mesh` | triangle meshes and what they measure, models of several bodies, triangulation, sections, line drawings |
//! | [`planar_map`] | the arrangement of curves: vertices, edges, faces |
//! | `raster` | samples, scalar and vector fields, pictures of solid and empty pixels |
//! | [`voxel`] | sparse sets of voxels, the voxels of a surface |
//! | [`index`] | spatial indices |
//! | [`numeric`] | disjoint sets, common divisors |
//! | [`counted()`] | counts in sentences |
//! | [`progress`] | what long work is doing |
//! | [`budget`] | what a build may use, in steps and bytes |
//! | [`cutout`], [`facade`], [`shell`], `imprint`, `surface_mesh` | what one room of synthesis hands to another |

pub mod budget;
mod counted;
mod curve;
pub mod cutout;
pub mod facade;
pub mod halving;
mod imprint;
pub mod index;
pub mod mesh;
pub mod numeric;
pub mod planar_map;
mod plane;
pub mod progress;
mod raster;
mod seed;
pub mod shell;
mod space;
mod surface_mesh;
pub mod voxel;

pub use counted::counted;
pub use curve::{Across, Fold, Frame, Ribbon, RibbonError, SpaceCurve, SpaceCurveError};
pub use curve::{SurfaceCurve, SurfaceCurveError, surface_curve};
pub use cutout::{Carrier, Cutout, Measures, Side, Synthesis, Wrapping};
pub use facade::{Facade, FacadeBody, FacadeCell, FacadeLayout, FacadeShape};
pub use imprint::{Imprint, OnMesh};
pub use mesh::{Mesh, MeshError, MeshTopology, Model};
pub use planar_map::{EdgeId, FaceId, HalfEdge, PlanarMap, PlanarMapError, VertexId};
pub use plane::drawing::{Drawing, FillRule, Shape};
pub use plane::polygon::{Polygon, Ring};
pub use plane::topology::{Topology, TopologyError};
pub use plane::{Affine, Attribute, Bounds, Curve, CurveLabels, Curves, Feature};
pub use plane::{LabelSet, Point, Region, Tile, along_others};
pub use plane::{drawing, flatten, letters, neck, polygon, polyline, topology};
pub use raster::{Field, Lattice, Pixels, Place, Raster, Relief, Samples, VectorField, aspect};
pub use seed::{Seed, Snap};
pub use shell::Shell;
pub use space::{Affine3, Bounds3, Point3, View};
pub use surface_mesh::{Form, SurfaceMesh, Swept, Turned};

/// Steps of the coordinates in files that make a millimetre: what is counted before it is written is
/// rounded to them first.
pub const STEPS_PER_MM: f64 = 1e4;
