//! Which voxels are near which: the other voxels of the 5×5×5 cubes about them.

use fretwork_geometry::voxel::{Voxel, VoxelSurface};
use rayon::prelude::*;

/// How far a neighbourhood reaches.
const REACH: i32 = 2;

/// The cosine above which normals count as of one side: sheets that lie back to back are not neighbours,
/// the sides of a sharp edge are.
const SAME_SIDE: f32 = -0.3;

/// Voxels that a task takes at once.
const GRAIN: usize = 4096;

/// The neighbours of all voxels, row after row.
pub(super) struct Neighbors {
    starts: Vec<u32>,
    numbers: Vec<u32>,
}

impl Neighbors {
    /// The neighbours of the voxels of a surface; being one is mutual. O(n).
    pub(super) fn of(surface: &VoxelSurface) -> Neighbors {
        let count = surface.voxels.len();
        let tasks: Vec<(Vec<u32>, Vec<u32>)> = (0..count.div_ceil(GRAIN))
            .into_par_iter()
            .map(|task| part(surface, task * GRAIN..((task + 1) * GRAIN).min(count)))
            .collect();
        let mut starts = Vec::with_capacity(count + 1);
        let mut numbers = Vec::with_capacity(tasks.iter().map(|task| task.1.len()).sum());
        for (ends, found) in tasks {
            let first = numbers.len() as u32;
            starts.extend(ends.iter().map(|start| first + start));
            numbers.extend(found);
        }
        starts.push(numbers.len() as u32);
        Neighbors { starts, numbers }
    }

    /// The neighbours of a voxel, ascending.
    #[inline]
    pub(super) fn row(&self, voxel: usize) -> &[u32] {
        &self.numbers[self.starts[voxel] as usize..self.starts[voxel + 1] as usize]
    }
}

/// The rows of some voxels: where each begins, and all their numbers.
///
/// Voxels are in order, so the voxels that stand one step away from them in some direction are in order
/// too: a place in the list for each of the 25 columns around only ever moves on.
fn part(surface: &VoxelSurface, voxels: std::ops::Range<usize>) -> (Vec<u32>, Vec<u32>) {
    let cells = &surface.voxels.cells;
    let columns: Vec<[i32; 2]> = (-REACH..=REACH)
        .flat_map(|x| (-REACH..=REACH).map(move |y| [x, y]))
        .collect();
    let wide = |cell: Voxel| cell.map(i32::from);
    let first_of = |[x, y, z]: [i32; 3], [dx, dy]: [i32; 2]| [x + dx, y + dy, z - REACH];
    let from = wide(cells[voxels.start]);
    let mut places: Vec<usize> = columns
        .iter()
        .map(|&column| cells.partition_point(|cell| wide(*cell) < first_of(from, column)))
        .collect();
    let (mut starts, mut numbers) = (Vec::with_capacity(voxels.len()), Vec::new());
    for voxel in voxels {
        starts.push(numbers.len() as u32);
        let at = wide(cells[voxel]);
        for (place, &column) in places.iter_mut().zip(&columns) {
            let first = first_of(at, column);
            let last = [first[0], first[1], at[2] + REACH];
            while cells.get(*place).is_some_and(|cell| wide(*cell) < first) {
                *place += 1;
            }
            let mut other = *place;
            while cells.get(other).is_some_and(|cell| wide(*cell) <= last) {
                if other != voxel && is_one_side(surface, voxel, other) {
                    numbers.push(other as u32);
                }
                other += 1;
            }
        }
    }
    (starts, numbers)
}

fn is_one_side(surface: &VoxelSurface, a: usize, b: usize) -> bool {
    let (a, b) = (surface.normals[a], surface.normals[b]);
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > SAME_SIDE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::voxelize::{tests::shapes, voxelize};

    #[test]
    fn neighbours_are_those_of_the_oracle() {
        let surface = voxelize(&shapes::torus(3.0, 1.0, 32), 0.2).unwrap();
        let neighbors = Neighbors::of(&surface);
        let cells = &surface.voxels.cells;
        for (voxel, cell) in cells.iter().enumerate() {
            let near = |other: &usize| {
                let off = (0..3).map(|axis| cells[*other][axis].abs_diff(cell[axis]));
                *other != voxel && off.max() <= Some(2) && is_one_side(&surface, voxel, *other)
            };
            let expected: Vec<u32> = (0..cells.len()).filter(near).map(|n| n as u32).collect();
            assert_eq!(neighbors.row(voxel), expected, "{cell:?}");
        }
    }
}
