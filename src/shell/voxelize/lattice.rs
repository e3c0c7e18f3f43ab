//! Where the lattice of a surface lies.

use fretwork_geometry::Point3;
use fretwork_geometry::mesh::Bounds3;
use fretwork_geometry::voxel::Lattice;

use super::error::VoxelizeError;

/// How many voxels there may be along an axis: their numbers have sixteen bits, and the neighbours of
/// the last one are numbers too.
const LIMIT: usize = u16::MAX as usize - 8;

/// The lattice about `bounds` with at least one empty voxel on each side.
///
/// A surface that lies in a plane between two layers of voxels meets both. The sides of a box are such
/// planes whenever the pitch divides its length, so each axis puts the middle of the box either on a
/// voxel's middle or between two, whichever keeps the sides farther from the planes.
pub(super) fn around(bounds: &Bounds3, pitch: f64) -> Result<Lattice, VoxelizeError> {
    let size = bounds.size();
    let voxels = bounds.longest_side() / pitch;
    if voxels.is_nan() || voxels > LIMIT as f64 {
        return Err(VoxelizeError::OutOfRange {
            voxels,
            limit: LIMIT,
        });
    }
    let below = [size.x, size.y, size.z].map(|side| below_middle(side / pitch) * pitch);
    Ok(Lattice {
        origin: bounds.center() - Point3::from(below),
        pitch,
    })
}

/// How many pitches the lattice begins below the middle of a side of `length` pitches.
fn below_middle(length: f64) -> f64 {
    let half = 0.5 * length;
    // The distance of the side from the nearest plane is that of `half` from a whole number when the
    // middle lies between two voxels, and half a pitch less that otherwise.
    let from_plane = (half - half.round()).abs();
    let is_between = from_plane >= 0.25;
    if is_between {
        half.ceil() + 1.0
    } else {
        half.round() + 1.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_keep_off_the_planes_and_an_empty_voxel_surrounds_them() {
        for n in 0..1000 {
            let length = 0.013 * f64::from(n);
            let below = below_middle(length);
            let [first, last] = [below - 0.5 * length, below + 0.5 * length];
            for side in [first, last] {
                assert!((side - side.round()).abs() > 0.2499, "{length}: {side}");
            }
            assert!(first > 1.0 && first < 2.01, "{length}: {first}");
        }
    }
}
