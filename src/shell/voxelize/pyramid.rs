//! Coarser and coarser layers of voxels above those of a surface.

use fretwork_geometry::index::Rows;
use fretwork_geometry::voxel::{Lattice, Voxel, VoxelSurface, Voxels};

/// A pyramid ends with a level of at most this many voxels along each axis.
const FEW: u16 = 8;

/// A level of a pyramid. Each voxel of a level but the finest has up to eight children on the level below.
#[derive(Clone, Debug)]
pub struct Level {
    /// The voxels, twice as wide as those of the level below, with the mean of their children's normals.
    pub surface: VoxelSurface,
    /// For each voxel its parent on the level above; empty on the coarsest.
    pub parents: Vec<u32>,
    /// For each voxel its children on the level below, ascending; no rows on the finest.
    pub children: Rows,
}

/// The levels above `surface`, which is the first, to one that is about eight voxels across or less
/// (Dumas et al. 2015, section 4). O(n log n).
pub fn pyramid(surface: VoxelSurface) -> Vec<Level> {
    let mut levels = vec![Level {
        surface,
        parents: Vec::new(),
        children: Rows::default(),
    }];
    loop {
        let level = levels.last_mut().expect("the finest level is there");
        if across(&level.surface.voxels.cells) <= FEW {
            return levels;
        }
        let (above, parents) = coarser(&level.surface);
        level.parents = parents;
        levels.push(above);
    }
}

/// How many voxels there are along the longest axis.
fn across(cells: &[Voxel]) -> u16 {
    let along = |axis: usize| {
        let at = || cells.iter().map(move |cell| cell[axis]);
        at().max().unwrap_or(0) - at().min().unwrap_or(0) + 1
    };
    along(0).max(along(1)).max(along(2))
}

/// The level of voxels twice as wide, and the parents of the voxels below.
fn coarser(surface: &VoxelSurface) -> (Level, Vec<u32>) {
    let below = &surface.voxels;
    let lattice = Lattice {
        origin: below.lattice.origin,
        pitch: 2.0 * below.lattice.pitch,
    };
    let halved = |cell: &Voxel| cell.map(|n| n / 2);
    let voxels = Voxels::new(lattice, below.cells.iter().map(halved).collect());
    let number = |cell: &Voxel| {
        let at = voxels.find(halved(cell));
        at.expect("the halves of all cells are in the set") as u32
    };
    let parents: Vec<u32> = below.cells.iter().map(number).collect();
    let children = Rows::fill(voxels.len(), |filler| {
        for (child, &parent) in (0u32..).zip(&parents) {
            filler.put(parent as usize, child);
        }
    });
    let normals = (0..voxels.len()).map(|parent| mean(&surface.normals, children.row(parent)));
    let level = Level {
        surface: VoxelSurface {
            normals: normals.collect(),
            voxels,
        },
        parents: Vec::new(),
        children,
    };
    (level, parents)
}

/// The unit vector along the sum of some normals; the first of them where they cancel.
fn mean(normals: &[[f32; 3]], of: &[u32]) -> [f32; 3] {
    let mut sum = [0f32; 3];
    for &number in of {
        for (s, n) in sum.iter_mut().zip(normals[number as usize]) {
            *s += n;
        }
    }
    let length = sum.iter().map(|s| s * s).sum::<f32>().sqrt();
    if length > 1e-3 {
        sum.map(|s| s / length)
    } else {
        normals[of[0] as usize]
    }
}
