//! The direction of the principal stress on a surface: where a pattern's up points that shall follow
//! the forces (S5).
//!
//! The stress in the voxels of a body through its wall about each voxel of its surface is seen in the
//! tangent plane, where its mean square has two principal values. A principal direction has no sign, so that
//! directions are not averaged as vectors but as the squares of complex numbers are: as tensors d dᵀ.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::{Voxel, Voxels};
use nalgebra::{Matrix2, Matrix3, SymmetricEigen, Vector3};
use rayon::prelude::*;

use crate::analyse::Stress;
use crate::connect::SurfaceGraph;
use crate::finish::Thickness;

/// Principal values that differ by less than this part of the larger tell no direction.
const DISTINCT: f64 = 0.05;
/// A pull and a pressure that differ by less than this part are those of shear.
const ALIKE: f64 = 0.25;
/// Rounds of smoothing, over the neighbours of a voxel each.
const ROUNDS: usize = 12;

/// For each voxel of the surface a unit vector of its tangent plane along which the principal stress of the
/// largest absolute value acts, without a sign. `stresses` belong to the voxels of `body`. Where a place
/// has no direction of its own, or is not stressed, those around decide. The body is a `wall` of the surface.
pub fn principal_directions(
    graph: &SurfaceGraph<'_>,
    (body, wall): (&Voxels, Thickness),
    stresses: &[Stress],
) -> Vec<[f32; 3]> {
    let count = graph.len() as u32;
    let reach = (wall.thickness + graph.pitch()) / 2.0;
    let place = |voxel: u32| {
        let out = Point3::from(graph.surface.normals[voxel as usize].map(f64::from));
        (voxel, graph.center(voxel) + out * wall.offset(), reach)
    };
    let mut tensors: Vec<Matrix3<f64>> = (0..count)
        .into_par_iter()
        .map(|voxel| own_tensor(graph, place(voxel), body, stresses))
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

/// The tensor of the direction at a voxel, by the stress about the middle of its wall; zero where there is none.
fn own_tensor(
    graph: &SurfaceGraph<'_>,
    (voxel, middle, reach): (u32, Point3, f64),
    body: &Voxels,
    stresses: &[Stress],
) -> Matrix3<f64> {
    let [right, up] = tangents(normal(graph, voxel));
    let [mean, squares] = in_plane(middle, reach, (body, stresses), [right, up]);
    let sizes = SymmetricEigen::new(squares);
    let size = |n: usize| sizes.eigenvalues[n].max(0.0).sqrt();
    let main = usize::from(size(1) > size(0));
    let (largest, other) = (size(main), size(1 - main));
    if largest == 0.0 {
        return Matrix3::zeros();
    }
    let signed = SymmetricEigen::new(mean);
    let tension = usize::from(signed.eigenvalues[1] > signed.eigenvalues[0]);
    let (pulled, pressed) = (
        signed.eigenvalues[tension],
        -signed.eigenvalues[1 - tension],
    );
    // Under shear two directions are stressed alike, one pulled and one pressed: that which is pulled counts.
    let is_sheared = pulled.min(pressed) > (1.0 - ALIKE) * pulled.max(pressed)
        && pulled > (1.0 - ALIKE) * largest;
    let along = if is_sheared {
        signed.eigenvectors.column(tension)
    } else if largest - other < DISTINCT * largest {
        return Matrix3::zeros();
    } else {
        sizes.eigenvectors.column(main)
    };
    let direction = right * along[0] + up * along[1];
    direction * direction.transpose()
}

/// The mean stress in a tangent plane, and the mean of its squares, of the body's voxels no farther than `reach` from `center`. Where a
/// wall is bent its sides are pulled and pressed, which cancels in the mean and not in that of squares.
fn in_plane(
    center: Point3,
    reach: f64,
    (body, stresses): (&Voxels, &[Stress]),
    [right, up]: [Vector3<f64>; 2],
) -> [Matrix2<f64>; 2] {
    let far = Point3::new(reach, reach, reach);
    let cell_of = |p: Point3| body.lattice.place(p).map(|c| c.floor().max(0.0) as u16);
    let (low, high) = (cell_of(center - far), cell_of(center + far));
    let (mut mean, mut squares, mut count) = (Matrix2::zeros(), Matrix2::zeros(), 0.0);
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                let cell: Voxel = [x, y, z];
                let is_near = body.lattice.center(cell).distance(center) <= reach;
                let Some(number) = body.find(cell).filter(|_| is_near) else {
                    continue;
                };
                let [xx, yy, zz, xy, xz, yz] = stresses[number];
                let stress = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                let seen = |a: &Vector3<f64>, b: &Vector3<f64>| (a.transpose() * stress * b)[0];
                let across = seen(&right, &up);
                let plane = Matrix2::new(seen(&right, &right), across, across, seen(&up, &up));
                mean += plane;
                squares += plane * plane;
                count += 1.0;
            }
        }
    }
    if count == 0.0 {
        return [mean, squares];
    }
    [mean / count, squares / count]
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
