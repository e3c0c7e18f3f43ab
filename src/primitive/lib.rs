//! Regions, curves, surfaces, fields and exemplars, made from their kinds: what other nodes
//! are made of. Each file here is the stage of one section. What a file of another program holds is
//! read in `source`, and what shapes are is known in `geometry`.

mod baseline;
pub mod curve;
pub mod exemplar;
mod features;
pub mod field;
mod geodata;
mod joined;
mod lettering;
pub mod mesh_faults;
pub mod pixels;
pub mod placement;
pub mod plane;
mod raster;
pub mod region;
mod stencil;
pub mod surface;
pub mod text;
mod tolerance;
mod zone;

pub use exemplar::LEAST_TOLERANCE_MM;
pub use tolerance::{default_tolerance, fine_in_plane, fine_on_object};
