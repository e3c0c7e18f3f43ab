//! Solids: closed meshes made of areas, profiles and one another. Files, names of a spec and where things
//! stand are not known here. Every function gives closed, orientable meshes whose triangles face outward, or
//! says why it cannot.

mod boolean;
mod error;
mod extrude;
mod frame;
mod inlay;
mod parts;
mod primitive;
mod relief;
mod shell;
mod slices;
mod thicken;

pub use boolean::{Operation, combine, unite_touching};
pub use error::SolidError;
pub use extrude::extrude;
pub use frame::{farthest_rim, near_rim};
pub use inlay::{Keep, carve_imprint, emboss_imprint};
pub use primitive::{ball, cuboid, cylinder};
pub use relief::{Carved, Relief, carve, emboss, intersect_cuts};
pub use shell::{capped, shell};
pub use slices::{SliceError, Slicing, slices};
pub use thicken::{Overlap, thicken, thicken_between};
