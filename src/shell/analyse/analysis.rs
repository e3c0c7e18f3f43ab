//! The result of an analysis, made of displacements.

use fretwork_geometry::Point3;
use rayon::prelude::*;

use super::conjugate_gradients::Quality;
use super::element::Quad;
use super::mesh::{Mesh, corners};
use super::statistics::Statistics;
use super::stress::{Stress, equivalent_stress, stress, stress_sum, von_mises};
use super::units::Units;

/// How a body takes one load case. Lists have a value for each voxel, in the order of the voxels; places
/// are in units of the lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// The stress in the middle of each voxel, in pascals.
    pub stresses: Vec<Stress>,
    /// How far the middle of each voxel moves, in metres.
    pub displacements: Vec<[f64; 3]>,
    /// |σ1| + |σ2| + |σ3| of each voxel, in pascals.
    pub stress_sums: Vec<f64>,
    /// Von Mises' stress of each voxel, in pascals.
    pub von_mises: Vec<f64>,
    /// The same in a few numbers.
    pub summary: Summary,
}

/// How a body takes one load case, in a few numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Of |σ1| + |σ2| + |σ3|, in pascals.
    pub stress_sums: Statistics,
    /// Of von Mises' stress, in pascals.
    pub von_mises: Statistics,
    /// How many times stronger the material is than asked; none of one whose strength is not known, or
    /// without stress.
    pub safety: Option<Safety>,
    /// How far the node moves that moves farthest, in metres.
    pub largest_displacement: f64,
    /// Where that node is.
    pub largest_displacement_at: Point3,
    /// Whether the body sags by more than a tenth of its longest side: linear elasticity no longer
    /// describes it.
    pub is_sag_large: bool,
    /// The work of the forces f·u, twice the strain energy, in joules.
    pub compliance: f64,
    /// Kilograms.
    pub mass: f64,
    /// The forces that do not balance, as a part of the load's.
    pub residual: f64,
    /// The estimated error of the displacement in the energy norm, as a part of its norm.
    pub energy_error: f64,
    /// How many iterations of conjugate gradients it took; the most of those that it is combined of.
    pub iterations: usize,
}

/// The yield strength over the stress that is compared with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Safety {
    /// At 99 % of the voxels it is at least this.
    pub at_p99: f64,
    /// The least.
    pub least: f64,
    /// The middle of the voxel that has the least.
    pub at: Point3,
}

/// A body that sags by more than this part of its longest side has left linear elasticity.
const LARGE_SAG: f64 = 0.1;

impl Analysis {
    /// The analysis of a displacement in units of the element, for a load of the length `scale` in them, whose
    /// unit vector the displacement is of.
    pub(super) fn new(
        mesh: &Mesh,
        units: &Units,
        (displacement, quality): (&[Quad<f64>], &Quality),
        scale: f64,
    ) -> Analysis {
        let nu = units.material.poisson_ratio;
        let pascals = units.material.youngs_modulus * scale;
        let metres = units.voxel * scale;
        let moved = |element: &[u32; 4]| corners(element).map(|n| displacement[n]);
        let elements = || mesh.elements.par_iter();
        let stresses: Vec<Stress> = elements()
            .map(|element| stress(moved(element), nu).map(|x| x * pascals))
            .collect();
        let middle = |element: &[u32; 4]| {
            let corners = moved(element);
            [0, 1, 2].map(|k| corners.iter().map(|u| u[k]).sum::<f64>() / 8.0 * metres)
        };
        let stress_sums: Vec<f64> = stresses.par_iter().map(stress_sum).collect();
        let von_mises: Vec<f64> = stresses.par_iter().map(von_mises).collect();
        let place = |voxel: usize| units.lattice.point(middle_of(mesh, voxel));
        let (largest, node) = farthest(displacement);
        let largest_displacement = largest * metres;
        let summary = Summary {
            stress_sums: Statistics::new(&stress_sums, place),
            von_mises: Statistics::new(&von_mises, place),
            safety: safety(units, &stresses, place),
            largest_displacement,
            largest_displacement_at: units.node_place(mesh.nodes[node]),
            is_sag_large: largest_displacement > LARGE_SAG * units.longest_side,
            compliance: quality.work * scale * scale * units.joules(),
            mass: mesh.weights.iter().map(|w| f64::from(*w)).sum::<f64>() * units.voxel_mass(),
            residual: quality.residual,
            energy_error: quality.energy_error,
            iterations: quality.iterations,
        };
        Analysis {
            displacements: elements().map(middle).collect(),
            stresses,
            stress_sums,
            von_mises,
            summary,
        }
    }
}

fn middle_of(mesh: &Mesh, voxel: usize) -> [f64; 3] {
    mesh.nodes[mesh.elements[voxel][0] as usize].map(|n| f64::from(n) + 0.5)
}

/// The length of the longest displacement, and the first node that has it.
fn farthest(displacement: &[Quad<f64>]) -> (f64, usize) {
    let square = |u: &Quad<f64>| u.iter().map(|x| x * x).sum::<f64>();
    let squares = displacement.iter().map(square).enumerate();
    let (node, square) = squares.fold((0, 0.0), |best, (node, square)| match square > best.1 {
        true => (node, square),
        false => best,
    });
    (square.sqrt(), node)
}

fn safety(units: &Units, stresses: &[Stress], place: impl Fn(usize) -> Point3) -> Option<Safety> {
    let material = units.material;
    let strength = material.yield_strength?;
    let layers = material.across_layers.as_ref();
    let equivalent: Vec<f64> = stresses
        .par_iter()
        .map(|stress| equivalent_stress(stress, layers))
        .collect();
    let Statistics { p99, max, at, .. } = Statistics::new(&equivalent, place);
    // Rounding can leave stresses of next to nothing, which no strength can be divided by.
    let divided = |stress: f64| Some(strength / stress).filter(|safety| safety.is_finite());
    Some(Safety {
        at_p99: divided(p99)?,
        least: divided(max)?,
        at,
    })
}
