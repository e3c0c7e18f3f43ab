//! What the voxels of a surface would take, before they are made.

use fretwork_geometry::{Mesh, mesh};

/// The most that the voxels of a surface and the synthesis on them may take, in bytes.
pub const MAX_BYTES: u64 = 2 << 30;

/// Bytes a voxel: itself, its normal, its neighbours, its labels and colours on all levels.
const VOXEL_BYTES: f64 = 640.0;

/// Bytes for a triangle that meets a voxel, while voxels are made.
const PIECE_BYTES: f64 = 40.0;

/// What the voxels of a surface would take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// About how many voxels there would be.
    pub voxels: u64,
    /// About how many bytes they would take at most, with all that synthesis keeps for them.
    pub bytes: u64,
}

/// What the voxels of `mesh` would take at a pitch.
///
/// A triangle at a random place meets as many unit cubes as the volume of its Minkowski sum with one
/// says: 1, and its extents along the axes, and the areas of its shadows along them. Of a connected
/// surface the shadows alone remain, and a border. O(n).
pub fn estimate(mesh: &Mesh, pitch: f64) -> Estimate {
    let (mut pieces, mut shadows) = (0.0, 0.0);
    for &triangle in &mesh.triangles {
        let corners = mesh.corners(triangle);
        let normal = mesh::doubled_normal(corners);
        let area = 0.5 * (normal.x.abs() + normal.y.abs() + normal.z.abs());
        let extents = mesh::Bounds3::of(corners).size();
        let extent = extents.x + extents.y + extents.z;
        pieces += 1.0 + extent / pitch + area / (pitch * pitch);
        shadows += area / (pitch * pitch);
    }
    let size = mesh.bounds().size();
    let border = 8.0 * ((size.x + size.y + size.z) / pitch + 1.0);
    let voxels = f64::min(pieces, 1.1 * shadows + border);
    Estimate {
        voxels: voxels as u64,
        bytes: (voxels * VOXEL_BYTES + pieces * PIECE_BYTES) as u64,
    }
}
