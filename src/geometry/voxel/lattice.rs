//! A lattice of cubes, and a set of them.

use serde::{Deserialize, Serialize};

use crate::Point3;

/// A voxel by its place in a lattice, along x, y and z.
pub type Voxel = [u16; 3];

/// A lattice of cubes: the voxel `[i, j, k]` reaches from `origin + pitch·(i, j, k)` one pitch along
/// each axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lattice {
    /// The least corner of the voxel `[0, 0, 0]`.
    pub origin: Point3,
    /// The side of a voxel; positive.
    pub pitch: f64,
}

impl Lattice {
    /// The middle of a voxel.
    #[inline]
    pub fn center(&self, [i, j, k]: Voxel) -> Point3 {
        self.point([i, j, k].map(|n| f64::from(n) + 0.5))
    }

    /// The point that is `at` pitches from the origin.
    #[inline]
    pub fn point(&self, at: [f64; 3]) -> Point3 {
        self.origin + Point3::from(at) * self.pitch
    }

    /// How many pitches `p` is from the origin along each axis.
    #[inline]
    pub fn place(&self, p: Point3) -> [f64; 3] {
        let d = p - self.origin;
        [d.x / self.pitch, d.y / self.pitch, d.z / self.pitch]
    }
}

/// A set of voxels of one lattice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Voxels {
    /// Where they lie.
    pub lattice: Lattice,
    /// Each of them once, in ascending order: by x, then y, then z.
    pub cells: Vec<Voxel>,
}

impl Voxels {
    /// The set of `cells`, in any order and with repeats.
    pub fn new(lattice: Lattice, mut cells: Vec<Voxel>) -> Voxels {
        cells.sort_unstable();
        cells.dedup();
        Voxels { lattice, cells }
    }

    /// How many there are.
    #[inline]
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The number of a voxel in the set, if it is in it. O(log n).
    #[inline]
    pub fn find(&self, voxel: Voxel) -> Option<usize> {
        self.cells.binary_search(&voxel).ok()
    }
}
