//! Surfaces and patterns made of formulas, for tests.

use fretwork_geometry::voxel::{Lattice, Voxel, VoxelSurface, Voxels};
use fretwork_geometry::{Point3, Seed};

use crate::connect::{Pieces, SurfaceGraph, Touch};

/// A surface of these voxels with their normals, of pitch 1.
pub(crate) fn surface(mut cells: Vec<(Voxel, Point3)>) -> VoxelSurface {
    cells.sort_by_key(|(cell, _)| *cell);
    let lattice = Lattice {
        origin: Point3::ORIGIN,
        pitch: 1.0,
    };
    let normals = cells
        .iter()
        .map(|(_, n)| [n.x as f32, n.y as f32, n.z as f32])
        .collect();
    let cells = cells.into_iter().map(|(cell, _)| cell).collect();
    VoxelSurface {
        voxels: Voxels { lattice, cells },
        normals,
    }
}

/// One level of voxels.
pub(crate) fn plane(width: u16, height: u16) -> VoxelSurface {
    let cells = (0..width).flat_map(|x| (0..height).map(move |y| [x, y, 3]));
    surface(
        cells
            .map(|cell| (cell, Point3::new(0.0, 0.0, 1.0)))
            .collect(),
    )
}

/// The voxels within `side` that meet a surface whose distance, with its gradient, `distance` tells: those that
/// meet the plane of the surface's nearest point.
fn implicit(side: u16, distance: impl Fn(Point3) -> (f64, Point3)) -> VoxelSurface {
    let mut cells = Vec::new();
    for x in 0..side {
        for y in 0..side {
            for z in 0..side {
                let middle = Point3::from([x, y, z].map(|c| f64::from(c) + 0.5));
                let (far, n) = distance(middle);
                if far.abs() <= 0.5 * (n.x.abs() + n.y.abs() + n.z.abs()) {
                    cells.push(([x, y, z], n));
                }
            }
        }
    }
    surface(cells)
}

pub(crate) fn sphere(radius: f64) -> VoxelSurface {
    let middle = radius + 2.3;
    implicit((2.0 * middle) as u16 + 1, |p| {
        let d = p - Point3::new(middle, middle, middle);
        (d.length() - radius, d.unit().unwrap_or_default())
    })
}

pub(crate) fn torus(radius: f64, tube: f64) -> VoxelSurface {
    let middle = radius + tube + 2.3;
    implicit((2.0 * middle) as u16 + 1, |p| {
        let d = p - Point3::new(middle, middle, tube + 2.3);
        let flat = Point3::new(d.x, d.y, 0.0).unit().unwrap_or_default();
        let arm = d - flat * radius;
        (arm.length() - tube, arm.unit().unwrap_or_default())
    })
}

/// Solid where `tells` says so of a voxel's middle.
pub(crate) fn pattern(surface: &VoxelSurface, tells: impl Fn(Point3) -> bool) -> Vec<bool> {
    let voxels = &surface.voxels;
    voxels
        .cells
        .iter()
        .map(|cell| tells(voxels.lattice.center(*cell)))
        .collect()
}

/// Disks of a radius round `count` voxels drawn at random.
pub(crate) fn dots(surface: &VoxelSurface, count: usize, radius: f64, seed: Seed) -> Vec<bool> {
    let voxels = &surface.voxels;
    let draw = |n: usize| (seed.unit(n as u64) * voxels.len() as f64) as usize;
    let middles: Vec<Point3> = (0..count)
        .map(|n| voxels.lattice.center(voxels.cells[draw(n)]))
        .collect();
    pattern(surface, |p| {
        middles.iter().any(|middle| middle.distance(p) <= radius)
    })
}

/// Bands between parallel planes.
pub(crate) fn stripes(surface: &VoxelSurface, normal: Point3, period: f64) -> Vec<bool> {
    pattern(surface, |p| (p.dot(normal) / period).rem_euclid(1.0) < 0.4)
}

/// Balls on a lattice, none of which touches another.
pub(crate) fn islands(surface: &VoxelSurface, period: f64) -> Vec<bool> {
    let off = |c: f64| (c / period).rem_euclid(1.0) - 0.5;
    pattern(surface, |p| {
        Point3::new(off(p.x), off(p.y), off(p.z)).length() * period < 0.36 * period
    })
}

/// How many pieces the solid voxels form.
pub(crate) fn count(graph: &SurfaceGraph, solid: &[bool], touch: Touch) -> usize {
    Pieces::of(graph, touch, |v| solid[v as usize]).len()
}
