//! Bodies for the tests of the analysis, and an independent way to solve them.

mod closed_forms;
mod errors;
mod independent;
mod mechanisms;
mod oracle;
mod stresses;
mod sweeps;
mod threads;

use fretwork_geometry::voxel::{Lattice, Voxel, Voxels};
use fretwork_geometry::{Point3, Seed};

use super::{Body, Material};

/// ABS, as the independent solvers had it.
const ABS: Material = Material {
    youngs_modulus: 2.3e9,
    poisson_ratio: 0.35,
    density: 1040.0,
    yield_strength: Some(40e6),
    across_layers: None,
};

/// Voxels of one millimetre, and units of one millimetre.
fn millimetres(voxels: &Voxels) -> Body<'_> {
    Body {
        voxels,
        metres_per_unit: 1e-3,
    }
}

fn set(cells: Vec<Voxel>) -> Voxels {
    let lattice = Lattice {
        origin: Point3::ORIGIN,
        pitch: 1.0,
    };
    Voxels::new(lattice, cells)
}

/// The cells of a block from `low` up to below `high`.
fn cells(low: Voxel, high: Voxel) -> Vec<Voxel> {
    let along = |k: usize| low[k]..high[k];
    along(0)
        .flat_map(|x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])))
        .collect()
}

fn block(size: Voxel) -> Voxels {
    set(cells([0; 3], size))
}

/// Some sixty voxels joined through faces, not convex, with holes at times.
fn random_body(seed: Seed) -> Voxels {
    let mut cells: Vec<Voxel> = vec![[3, 3, 0]];
    let mut draw = 0;
    let mut pick = |count: usize| {
        draw += 1;
        (seed.unit(draw) * count as f64) as usize
    };
    while cells.len() < 60 {
        let mut next = cells[pick(cells.len())];
        let axis = pick(3);
        match pick(2) {
            0 if next[axis] < 6 => next[axis] += 1,
            1 if next[axis] > 0 => next[axis] -= 1,
            _ => {}
        }
        if !cells.contains(&next) {
            cells.push(next);
        }
    }
    set(cells)
}

fn on_floor(p: Point3) -> bool {
    p.z == 0.0
}

/// Whether two numbers differ by at most this part of the second.
fn is_near(found: f64, expected: f64, part: f64) -> bool {
    (found - expected).abs() <= part * expected.abs()
}
