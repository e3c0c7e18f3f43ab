//! Solids: closed meshes made of areas, profiles and one another. Files, names of a spec and where things
//! stand are not known here. Every function gives closed, orientable meshes whose triangles face outward (but `sheet`, which
//! gives an open one), or says why it cannot.

mod boolean;
mod carve;
mod carving;
mod engrave;
mod error;
mod extrude;
mod films;
mod frame;
mod inlay;
mod parts;
mod plate;
mod primitive;
mod relief;
mod sheet;
mod shell;
mod slices;
mod strip;
mod thicken;

pub use boolean::{Operation, combine, unite_touching};
pub use carve::{Carved, carve};
pub use carving::{AtCutout, Carving, Keep};
pub use engrave::engrave_imprint;
pub use error::SolidError;
pub use extrude::extrude;
pub use frame::{farthest_rim, near_rim};
pub use inlay::{carve_imprint, emboss_imprint};
pub use primitive::{ball, cuboid, cylinder};
pub use relief::{Relief, emboss, intersect_cuts};
pub use sheet::sheet;
pub use shell::{capped, shell};
pub use slices::{SliceError, Slicing, slices};
pub use thicken::{Overlap, thicken, thicken_between};
