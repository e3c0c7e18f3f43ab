//! Why a mesh has no voxels.

use fretwork_geometry::{MeshError, Point3, budget};

use super::estimate::Estimate;

/// Why a mesh has no voxels.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VoxelizeError {
    /// The mesh is empty, or has a coordinate that is not finite.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// No triangle has an area.
    #[error("{} of the mesh has an area", match .triangles { 1 => "not the one triangle".to_owned(), many => format!("none of the {many} triangles") })]
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
        "about {} voxels would take about {}, more than the {} a surface may take: \
         lower the resolution, or allow for more by `--budget`",
        many(.estimate.voxels), budget::size(&.estimate.bytes), budget::size(.limit)
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

/// A large count for people.
fn many(count: u64) -> String {
    match count {
        0..1_000_000 => format!("{} thousand", count.div_ceil(1_000)),
        _ => format!("{} million", count / 1_000_000),
    }
}
