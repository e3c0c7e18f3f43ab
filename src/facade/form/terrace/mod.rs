//! Solids of vertical walls and level tops, over one level back. `terrain` holds the heights, `faces`
//! makes triangles of them, and `corners` sees to it that what meets in an edge shares its corners.

mod corners;
mod faces;
mod terrain;

pub use terrain::{Patch, PatchHeight, Terrace, TerraceError};
