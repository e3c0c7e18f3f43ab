//! Voxels: cubes of a lattice, kept sparsely. A set of them grows with what it holds, not with the
//! box around it. How voxels are made of a mesh and what is made of them is not known here.

mod lattice;
mod surface;

pub use lattice::{Lattice, Voxel, Voxels};
pub use surface::VoxelSurface;
