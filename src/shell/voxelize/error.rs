//! Why a mesh has no voxels.

use fretwork_geometry::{MeshError, Point3};

use super::estimate::Estimate;

/// Why a mesh has no voxels.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VoxelizeError {
    /// The mesh is empty, or has a coordinate that is not finite.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// No triangle has an area.
    #[error("none of the {triangles} triangles of the mesh has an area")]
    NoArea {
        /// How many there are.
        triangles: usize,
    },
    /// The pitch is not a positive length.
    #[error("{pitch} is no side of a voxel: it must be a positive length")]
    Pitch {
        /// What was asked for.
        pitch: f64,
    },
    /// More voxels along a side than can be numbered.
    #[error("{voxels:.0} voxels along a side are too many: at most {limit} can be numbered")]
    OutOfRange {
        /// Voxels along the longest side of the mesh.
        voxels: f64,
        /// How many there may be.
        limit: usize,
    },
    /// The voxels would not fit into memory. Told before anything is allocated.
    #[error(
        "about {:.0} thousand voxels would take about {:.1} GB, more than the {:.1} GB a surface may take: \
         lower the resolution, or allow for more by `--budget`",
        .estimate.voxels as f64 / 1e3, .estimate.bytes as f64 / 1e9, *.limit as f64 / 1e9
    )]
    TooLarge {
        /// What it would take.
        estimate: Estimate,
        /// How many bytes there may be.
        limit: u64,
    },
    /// Most voxels hold two sides of the body: it is thinner than they are.
    #[error(
        "the body is thinner than a voxel: {thin} of {voxels} voxels hold both of its sides, one near \
         ({:.3}, {:.3}, {:.3}); raise the resolution", .near.x, .near.y, .near.z
    )]
    TooThin {
        /// How many voxels hold two sides that face apart.
        thin: usize,
        /// How many voxels there are.
        voxels: usize,
        /// The middle of the first.
        near: Point3,
    },
}
