//! Samples of a wall on a lattice, only where the wall may be.

use rayon::prelude::*;

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::{Lattice, VoxelSurface};

use super::wall::Wall;

/// The value of a sample that was not taken: outside.
const FAR: f32 = 1e30;

/// How far from the wall a sample may be for how far it is to matter, in spacings: one that is taken in lies beside one
/// inside.
const OUTSIDE: f64 = 3.0;

/// A sample of a plane: `y · size[2] + z`, and the value.
#[derive(Clone, Copy)]
struct Sample {
    at: u32,
    value: f32,
}

/// Samples of a function of space on the points of a lattice.
pub struct Samples {
    /// The lattice whose corners are the points.
    pub lattice: Lattice,
    /// How many points there are along each axis. No sample on the outermost ones is inside.
    pub size: [usize; 3],
    /// For each x the samples that were taken, in order.
    planes: Vec<Vec<Sample>>,
}

impl Samples {
    /// The values of `wall` on points one `spacing` apart, wherever a solid voxel is near enough for the
    /// wall to reach. `reach` is how far the wall is from its surface at most.
    pub fn of(
        wall: &Wall<'_>,
        surface: &VoxelSurface,
        solid: &[bool],
        spacing: f64,
        reach: f64,
    ) -> Samples {
        let pitch = surface.voxels.lattice.pitch;
        let around = reach + pitch + 2.0 * spacing;
        let lattice = Lattice {
            origin: surface.voxels.lattice.origin - Point3::new(1.0, 1.0, 1.0) * (around + spacing),
            pitch: spacing,
        };
        let solids: Vec<[f64; 3]> = surface
            .voxels
            .cells
            .iter()
            .zip(solid)
            .filter(|(_, solid)| **solid)
            .map(|(cell, _)| lattice.place(surface.voxels.lattice.center(*cell)))
            .collect();
        let radius = around / spacing;
        let size = std::array::from_fn(|axis| {
            let far = solids.iter().map(|c| c[axis]).fold(0.0, f64::max);
            (far + radius).ceil() as usize + 3
        });
        let planes = (0..size[0])
            .into_par_iter()
            .map(|x| plane(wall, &lattice, &solids, (x, radius, size)))
            .collect();
        Samples {
            lattice,
            size,
            planes,
        }
    }

    /// How many points the lattice has.
    pub fn points(&self) -> usize {
        self.size.iter().product()
    }

    /// Where the point with this number is, along each axis.
    pub fn place(&self, index: usize) -> [usize; 3] {
        let (layer, row) = (self.size[1] * self.size[2], self.size[2]);
        [index / layer, index % layer / row, index % row]
    }

    /// The value at a point by its number.
    pub fn value(&self, index: usize) -> f64 {
        f64::from(self.find(index).map_or(FAR, |sample| sample.value))
    }

    /// How far the border is from an inner point up or down an axis, in spacings, where the point beyond is outside: half
    /// of one where the point was taken in.
    pub fn border(&self, at: [usize; 3], axis: usize, up: bool) -> f64 {
        let number = |at: [usize; 3]| (at[0] * self.size[1] + at[1]) * self.size[2] + at[2];
        let mut beyond = at;
        beyond[axis] = if up { at[axis] + 1 } else { at[axis] - 1 };
        let (low, high) = (self.value(number(at)), self.value(number(beyond)));
        if low >= 0.0 || high <= 0.0 {
            return 0.5;
        }
        low / (low - high.min(self.lattice.pitch))
    }

    fn find(&self, index: usize) -> Option<&Sample> {
        let layer = self.size[1] * self.size[2];
        let plane = &self.planes[index / layer];
        let at = (index % layer) as u32;
        let found = plane.binary_search_by_key(&at, |sample| sample.at);
        found.ok().map(|n| &plane[n])
    }

    /// The numbers of the points inside, in order.
    pub fn inside(&self) -> impl Iterator<Item = usize> + '_ {
        let layer = self.size[1] * self.size[2];
        self.planes.iter().enumerate().flat_map(move |(x, plane)| {
            let inside = plane.iter().filter(|sample| sample.value < 0.0);
            inside.map(move |sample| x * layer + sample.at as usize)
        })
    }
}

/// The samples of one x. The solids within its reach are found in order of x.
fn plane(
    wall: &Wall<'_>,
    lattice: &Lattice,
    solids: &[[f64; 3]],
    (x, radius, size): (usize, f64, [usize; 3]),
) -> Vec<Sample> {
    let at = x as f64;
    let from = solids.partition_point(|c| c[0] < at - radius);
    let to = solids.partition_point(|c| c[0] <= at + radius);
    let mut marks = vec![false; size[1] * size[2]];
    for c in &solids[from..to] {
        let squared = radius * radius - (c[0] - at) * (c[0] - at);
        let wide = squared.max(0.0).sqrt();
        let (first, last) = ((c[1] - wide).ceil(), (c[1] + wide).floor());
        for y in first as usize..=last as usize {
            let tall = (squared - (c[1] - y as f64) * (c[1] - y as f64))
                .max(0.0)
                .sqrt();
            let (low, high) = (
                (c[2] - tall).ceil() as usize,
                (c[2] + tall).floor() as usize,
            );
            marks[y * size[2] + low..=y * size[2] + high].fill(true);
        }
    }
    let marked = (0..marks.len()).filter(|n| marks[*n]);
    let (mut near, far) = (0, OUTSIDE * lattice.pitch);
    marked
        .map(|n| {
            let (y, z) = (n / size[2], n % size[2]);
            let value = wall.value(lattice.point([at, y as f64, z as f64]), &mut near, far);
            Sample {
                at: n as u32,
                value: value.min(f64::from(FAR)) as f32,
            }
        })
        .collect()
}
