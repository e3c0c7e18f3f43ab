//! The direction of the principal stress on a surface: where a pattern's up points that shall follow
//! the forces (S5).
//!
//! The stress in the voxels of a body about each voxel of its surface is averaged and seen in the
//! tangent plane, where it has two principal values. A principal direction has no sign, so that
//! directions are not averaged as vectors but as the squares of complex numbers are: as tensors d dᵀ.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::{Voxel, Voxels};
use nalgebra::{Matrix2, Matrix3, SymmetricEigen, Vector3};
use rayon::prelude::*;

use crate::analyse::Stress;
use crate::connect::SurfaceGraph;

/// Principal values that differ by less than this part of the larger tell no direction.
const DISTINCT: f64 = 0.05;
/// Rounds of smoothing, over the neighbours of a voxel each.
const ROUNDS: usize = 12;

/// For each voxel of the surface a unit vector of its tangent plane along which the principal stress of the
/// largest absolute value acts, without a sign. `stresses` belong to the voxels of `body`. Where a place
/// has no direction of its own, or is not stressed, those around decide.
pub fn principal_directions(
    graph: &SurfaceGraph<'_>,
    body: &Voxels,
    stresses: &[Stress],
) -> Vec<[f32; 3]> {
    let count = graph.len() as u32;
    let mut tensors: Vec<Matrix3<f64>> = (0..count)
        .into_par_iter()
        .map(|voxel| own_tensor(graph, voxel, body, stresses))
        .collect();
    for _ in 0..ROUNDS {
        tensors = (0..count)
            .into_par_iter()
            .map(|voxel| {
                let around = graph.neighbours(voxel).iter();
                let sum = around.fold(tensors[voxel as usize], |sum, w| sum + tensors[*w as usize]);
                let size = sum.trace();
                // Undecided places take the directions around them with full weight in time.
                if size > 0.0 { sum / size } else { sum }
            })
            .collect();
    }
    (0..count)
        .into_par_iter()
        .map(|voxel| strongest(normal(graph, voxel), &tensors[voxel as usize]))
        .collect()
}

fn normal(graph: &SurfaceGraph<'_>, voxel: u32) -> Vector3<f64> {
    Vector3::from(graph.surface.normals[voxel as usize].map(f64::from))
}

/// Two unit vectors of the plane with this normal.
fn tangents(normal: Vector3<f64>) -> [Vector3<f64>; 2] {
    let other = if normal.z.abs() < 0.9 {
        Vector3::z()
    } else {
        Vector3::x()
    };
    let right = other.cross(&normal).normalize();
    [right, normal.cross(&right)]
}

/// The tensor of the direction at a voxel; zero where there is none.
fn own_tensor(
    graph: &SurfaceGraph<'_>,
    voxel: u32,
    body: &Voxels,
    stresses: &[Stress],
) -> Matrix3<f64> {
    let stress = mean_stress(graph.center(voxel), graph.pitch(), body, stresses);
    let [right, up] = tangents(normal(graph, voxel));
    let seen = |a: &Vector3<f64>, b: &Vector3<f64>| (a.transpose() * stress * b)[0];
    let plane = Matrix2::new(
        seen(&right, &right),
        seen(&right, &up),
        seen(&right, &up),
        seen(&up, &up),
    );
    let eigen = SymmetricEigen::new(plane);
    let sizes = [eigen.eigenvalues[0].abs(), eigen.eigenvalues[1].abs()];
    let main = usize::from(sizes[1] > sizes[0]);
    if sizes[main] - sizes[1 - main] < DISTINCT * sizes[main] || sizes[main] == 0.0 {
        return Matrix3::zeros();
    }
    let along = eigen.eigenvectors.column(main);
    let direction = right * along[0] + up * along[1];
    direction * direction.transpose()
}

/// The mean stress of the body's voxels within a voxel of the surface about `center`.
fn mean_stress(center: Point3, pitch: f64, body: &Voxels, stresses: &[Stress]) -> Matrix3<f64> {
    let half = pitch / 2.0;
    let reach = Point3::new(half, half, half);
    let low = body
        .lattice
        .place(center - reach)
        .map(|c| c.floor().max(0.0) as u16);
    let high = body
        .lattice
        .place(center + reach)
        .map(|c| c.floor().max(0.0) as u16);
    let mut sum = Matrix3::zeros();
    let mut count = 0.0;
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                let cell: Voxel = [x, y, z];
                if let Some(number) = body.find(cell) {
                    let [xx, yy, zz, xy, xz, yz] = stresses[number];
                    sum += Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                    count += 1.0;
                }
            }
        }
    }
    if count > 0.0 { sum / count } else { sum }
}

/// The direction of a tensor, in the plane with this normal; zero without one.
fn strongest(normal: Vector3<f64>, tensor: &Matrix3<f64>) -> [f32; 3] {
    let [right, up] = tangents(normal);
    let seen = |a: &Vector3<f64>, b: &Vector3<f64>| (a.transpose() * tensor * b)[0];
    let plane = Matrix2::new(
        seen(&right, &right),
        seen(&right, &up),
        seen(&right, &up),
        seen(&up, &up),
    );
    if plane.trace() <= 0.0 {
        return [0.0; 3];
    }
    let eigen = SymmetricEigen::new(plane);
    let main = usize::from(eigen.eigenvalues[1] > eigen.eigenvalues[0]);
    let along = eigen.eigenvectors.column(main);
    let direction = right * along[0] + up * along[1];
    [direction.x as f32, direction.y as f32, direction.z as f32]
}
