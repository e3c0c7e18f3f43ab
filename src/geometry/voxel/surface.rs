//! The voxels of a surface.

use serde::{Deserialize, Serialize};

use super::Voxels;

/// The voxels that a surface passes through, one layer of them, with the surface's normals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VoxelSurface {
    /// The voxels whose closed cubes the surface meets.
    pub voxels: Voxels,
    /// For each voxel the mean normal of what lies in it, weighted by area: a unit vector.
    pub normals: Vec<[f32; 3]>,
}
