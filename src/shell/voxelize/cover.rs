//! Which closed cubes a triangle meets.

use fretwork_geometry::voxel::{Lattice, Voxel};
use fretwork_geometry::{Mesh, Point3, mesh};
use rayon::prelude::*;

/// How far outside a cube, in pitches, a triangle still meets it: above what rounding moves the
/// coordinates of the largest lattice by, and far below what anybody sees.
const TOLERANCE: f64 = 1e-9;

/// Triangles that a task takes at once.
const GRAIN: usize = 512;

/// That a triangle meets a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Piece {
    /// The voxel, its coordinates packed so that numbers are in the order of voxels.
    pub cell: u64,
    /// The triangle.
    pub triangle: u32,
}

impl Piece {
    /// The voxel.
    pub(super) fn voxel(&self) -> Voxel {
        [32, 16, 0].map(|shift| (self.cell >> shift) as u16)
    }
}

/// The corners of a triangle in pitches from the lattice's origin.
pub(super) fn placed(mesh: &Mesh, lattice: &Lattice, triangle: u32) -> [[f64; 3]; 3] {
    mesh.corners(mesh.triangles[triangle as usize])
        .map(|corner| lattice.place(corner))
}

/// What meets what, by voxel and then by triangle, and how many triangles have no area.
pub(super) fn pieces(mesh: &Mesh, lattice: &Lattice) -> (Vec<Piece>, usize) {
    let numbers: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    let tasks: Vec<(Vec<Piece>, usize)> = numbers
        .par_chunks(GRAIN)
        .map(|numbers| {
            let (mut found, mut skipped) = (Vec::new(), 0);
            for &triangle in numbers {
                let corners = placed(mesh, lattice, triangle);
                match Slabs::new(corners) {
                    Some(slabs) => slabs.visit(|[x, y, z]| {
                        let cell = (u64::from(x) << 32) | (u64::from(y) << 16) | u64::from(z);
                        found.push(Piece { cell, triangle });
                    }),
                    None => skipped += 1,
                }
            }
            (found, skipped)
        })
        .collect();
    let skipped = tasks.iter().map(|task| task.1).sum();
    let mut all = Vec::with_capacity(tasks.iter().map(|task| task.0.len()).sum());
    for (found, _) in tasks {
        all.extend(found);
    }
    all.par_sort_unstable();
    (all, skipped)
}

/// A direction in which a triangle reaches from `low` to `high`; `radius` is how far the unit cube
/// reaches from its middle.
#[derive(Clone, Copy, Default)]
struct Slab {
    axis: [f64; 3],
    low: f64,
    high: f64,
}

impl Slab {
    fn new(axis: [f64; 3], corners: &[[f64; 3]; 3]) -> Slab {
        let radius = (0.5 + TOLERANCE) * axis.iter().map(|a| a.abs()).sum::<f64>();
        let at = corners.map(|corner| dot(axis, corner));
        Slab {
            axis,
            low: at[0].min(at[1]).min(at[2]) - radius,
            high: at[0].max(at[1]).max(at[2]) + radius,
        }
    }

    fn holds(&self, center: [f64; 3]) -> bool {
        let at = dot(self.axis, center);
        self.low <= at && at <= self.high
    }
}

/// A triangle as what separates it from cubes: the separating-axis theorem. Along the axes of the
/// lattice its box is tested, and the rest are its normal and the nine products of edges and axes. Each
/// slab is grown by the cube's reach, so that a cube is met when its middle lies in all of them.
pub(super) struct Slabs {
    corners: [[f64; 3]; 3],
    plane: Slab,
    edges: [Slab; 9],
    /// The axis along which the normal is longest, and the other two.
    axes: [usize; 3],
}

impl Slabs {
    /// None of a triangle without area.
    pub(super) fn new(corners: [[f64; 3]; 3]) -> Option<Slabs> {
        let normal = mesh::doubled_normal(corners.map(Point3::from)).unit()?;
        let normal = [normal.x, normal.y, normal.z];
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| normal[b].abs().total_cmp(&normal[a].abs()));
        let edges = std::array::from_fn(|n| {
            let (side, axis) = (n / 3, n % 3);
            let [a, b] = [corners[side], corners[(side + 1) % 3]];
            let edge = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let (next, back) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut across = [0.0; 3];
            across[next] = -edge[back];
            across[back] = edge[next];
            Slab::new(across, &corners)
        });
        Some(Slabs {
            plane: Slab::new(normal, &corners),
            edges,
            corners,
            axes,
        })
    }

    fn holds(&self, center: [f64; 3]) -> bool {
        self.plane.holds(center) && self.edges.iter().all(|slab| slab.holds(center))
    }

    /// The first and the last voxel along an axis that the box of the triangle meets.
    fn reach(&self, axis: usize) -> (i64, i64) {
        let at = self.corners.map(|corner| corner[axis]);
        cells(at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]))
    }

    /// Visits every voxel that the triangle meets. Row by row only the part of the triangle in that row
    /// is looked at, and in a column only the cubes that its plane meets, so that the cost is that of
    /// what is found, however long and thin the triangle is.
    pub(super) fn visit(&self, mut found: impl FnMut(Voxel)) {
        let [deep, wide, row_axis] = self.axes;
        let deep_reach = self.reach(deep);
        let (first, last) = self.reach(row_axis);
        for row in first..=last {
            let (from, to) = self.columns(row);
            for column in from..=to {
                let mut center = [0.0; 3];
                center[row_axis] = row as f64 + 0.5;
                center[wide] = column as f64 + 0.5;
                let (low, high) = self.depths(center);
                for depth in low.max(deep_reach.0)..=high.min(deep_reach.1) {
                    center[deep] = depth as f64 + 0.5;
                    if self.holds(center) {
                        found(center.map(|c| c as u16));
                    }
                }
            }
        }
    }

    /// The first and the last column that the part of the triangle in a row meets.
    fn columns(&self, row: i64) -> (i64, i64) {
        let [_, wide, row_axis] = self.axes;
        let (floor, ceiling) = (row as f64 - TOLERANCE, row as f64 + 1.0 + TOLERANCE);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for side in 0..3 {
            let [a, b] = [self.corners[side], self.corners[(side + 1) % 3]];
            let along = b[row_axis] - a[row_axis];
            let mut part = [0.0, 1.0];
            if along != 0.0 {
                let mut cuts = [floor, ceiling].map(|at| (at - a[row_axis]) / along);
                cuts.sort_by(f64::total_cmp);
                part = [cuts[0].max(0.0), cuts[1].min(1.0)];
            } else if a[row_axis] < floor || a[row_axis] > ceiling {
                continue;
            }
            if part[0] > part[1] {
                continue;
            }
            for t in part {
                let at = a[wide] + t * (b[wide] - a[wide]);
                low = low.min(at);
                high = high.max(at);
            }
        }
        if low > high {
            return (0, -1);
        }
        // Rounding of the cuts is far below a thousandth of a voxel; the slabs decide.
        cells(low - 1e-3, high + 1e-3)
    }

    /// The first and the last cube of a column that the plane of the triangle meets.
    fn depths(&self, center: [f64; 3]) -> (i64, i64) {
        let deep = self.axes[0];
        let at = dot(self.plane.axis, center);
        let slope = self.plane.axis[deep];
        let mut ends = [self.plane.low, self.plane.high].map(|end| (end - at) / slope);
        ends.sort_by(f64::total_cmp);
        (
            (ends[0] - 0.501).ceil() as i64,
            (ends[1] - 0.499).floor() as i64,
        )
    }
}

/// The first and the last closed cell of a row that [low, high] meets.
fn cells(low: f64, high: f64) -> (i64, i64) {
    (
        (low - TOLERANCE - 1.0).ceil() as i64,
        (high + TOLERANCE).floor() as i64,
    )
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
