//! Which voxels of a surface touch. What is solid is not known here: the graph is made once for a
//! surface, whatever becomes of the pattern.

use fretwork_geometry::Point3;
use fretwork_geometry::index::Rows;
use fretwork_geometry::voxel::{Voxel, VoxelSurface};

/// Lengths in the graph are whole numbers of this part of a pitch. Whole numbers add up to the same
/// sum in any order, so that which of two paths is shorter never hangs on rounding. Finer would
/// overflow on paths through a whole surface, coarser would show in the distances.
pub const UNIT: u32 = 4096;

/// A step along an axis, across a face's diagonal, across a voxel's diagonal: 1, √2 and √3 pitches.
const STEPS: [u32; 3] = [UNIT, 5793, 7094];

/// How closely voxels must touch to count as joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// In a corner, an edge or a face: 26 neighbours.
    Corner,
    /// In a face: 6 neighbours.
    Face,
}

/// The voxels of a surface as a graph: two are joined when they touch, by the distance of their
/// middles (Dumas 2015, 5.1).
#[derive(Clone, Debug)]
pub struct SurfaceGraph<'a> {
    /// The voxels that are its vertices, by number.
    pub surface: &'a VoxelSurface,
    rows: Rows,
}

impl<'a> SurfaceGraph<'a> {
    /// The graph of `surface`. Linear time: the voxels are in order, so that their neighbours in each
    /// of nine columns are found by walking beside them.
    pub fn new(surface: &'a VoxelSurface) -> SurfaceGraph<'a> {
        let cells = &surface.voxels.cells;
        let rows = Rows::fill(cells.len(), |filler| {
            let mut walks = [0; 9];
            for (v, &cell) in cells.iter().enumerate() {
                for (column, walk) in walks.iter_mut().enumerate() {
                    let least = least_of_column(cell, column);
                    while *walk < cells.len() && wide(cells[*walk]) < least {
                        *walk += 1;
                    }
                    let end = [least[0], least[1], least[2] + 2];
                    let near = cells[*walk..].iter().take_while(|c| wide(**c) <= end);
                    (*walk..)
                        .zip(near)
                        .filter(|(w, _)| *w != v)
                        .for_each(|(w, _)| {
                            filler.put(v, w as u32);
                        });
                }
            }
        });
        SurfaceGraph { surface, rows }
    }

    /// How many voxels there are.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The voxels that touch the voxel numbered `v`, ascending.
    #[inline]
    pub fn neighbours(&self, v: u32) -> &[u32] {
        self.rows.row(v as usize)
    }

    /// The voxels that touch `v` so closely.
    pub fn touching(&self, v: u32, touch: Touch) -> impl Iterator<Item = u32> + '_ {
        let wanted = move |w: &u32| touch == Touch::Corner || self.step(v, *w) == UNIT;
        self.neighbours(v).iter().copied().filter(wanted)
    }

    /// The distance of two voxels that touch, in units of a pitch's 4096th part.
    #[inline]
    pub fn step(&self, v: u32, w: u32) -> u32 {
        let (a, b) = (self.cell(v), self.cell(w));
        let axes = (0..3).filter(|&k| a[k] != b[k]).count();
        STEPS[axes.clamp(1, 3) - 1]
    }

    /// The place of a voxel in the lattice.
    #[inline]
    pub fn cell(&self, v: u32) -> Voxel {
        self.surface.voxels.cells[v as usize]
    }

    /// The middle of a voxel.
    pub fn center(&self, v: u32) -> Point3 {
        self.surface.voxels.lattice.center(self.cell(v))
    }

    /// The side of a voxel, as a length.
    pub fn pitch(&self) -> f64 {
        self.surface.voxels.lattice.pitch
    }

    /// The longest side of the voxels' bounding box, in pitches.
    pub fn extent(&self) -> f64 {
        let cells = &self.surface.voxels.cells;
        let side = |k: usize| {
            let least = cells.iter().map(|c| c[k]).min().unwrap_or(0);
            let greatest = cells.iter().map(|c| c[k]).max().unwrap_or(0);
            f64::from(greatest - least) + 1.0
        };
        (0..3).map(side).fold(0.0, f64::max)
    }

    /// The area of surface that a voxel stands for, in square pitches. A plane with unit normal n meets
    /// |nx| + |ny| + |nz| closed cubes for each square pitch, so that slanted voxels stand for less.
    pub fn area(&self, v: u32) -> f64 {
        let normal = self.surface.normals[v as usize];
        let sum: f64 = normal.iter().map(|n| f64::from(n.abs())).sum();
        if sum.is_finite() {
            1.0 / sum.clamp(1.0, 3f64.sqrt())
        } else {
            1.0
        }
    }
}

/// A voxel with room for the neighbours of those at 0.
fn wide(cell: Voxel) -> [i32; 3] {
    cell.map(i32::from)
}

/// The lowest of the three voxels that touch `cell` or are it, in one of the nine columns along z.
fn least_of_column(cell: Voxel, column: usize) -> [i32; 3] {
    let [x, y, z] = wide(cell);
    let (dx, dy) = (column as i32 / 3 - 1, column as i32 % 3 - 1);
    [x + dx, y + dy, z - 1]
}
