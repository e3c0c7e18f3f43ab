//! Stresses in the middle of voxels, and the numbers that are made of a stress.

use super::element::{Corners, gradient, lame};
use super::material::AcrossLayers;

/// The components xx, yy, zz, xy, xz, yz of a symmetric stress, in pascals.
pub type Stress = [f64; 6];

/// The stress in the middle of an element of side and Young's modulus one.
pub(super) fn stress(displacement: Corners<f64>, poisson_ratio: f64) -> Stress {
    let (lambda, mu) = lame(poisson_ratio);
    let g = gradient(displacement);
    let trace = lambda * (g[0][0] + g[1][1] + g[2][2]);
    let along = |k: usize| trace + 2.0 * mu * g[k][k];
    let shear = |i: usize, k: usize| mu * (g[i][k] + g[k][i]);
    [
        along(0),
        along(1),
        along(2),
        shear(0, 1),
        shear(0, 2),
        shear(1, 2),
    ]
}

/// Shear of this part of the stress changes principal stresses by less than rounding does: they depend on its
/// square.
const NOTHING: f64 = 1e-12;

/// The principal stresses, from the greatest to the least.
///
/// Cyclic Jacobi rotations: they converge quadratically, so eight sweeps leave nothing but rounding, and
/// equal stresses need no care. Four are mostly enough.
pub fn principal_stresses(stress: &Stress) -> [f64; 3] {
    let [xx, yy, zz, xy, xz, yz] = *stress;
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    for _ in 0..8 {
        let size = a[0][0].abs() + a[1][1].abs() + a[2][2].abs();
        let rest = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
        if rest <= NOTHING * size {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, p, q);
        }
    }
    let mut values = [a[0][0], a[1][1], a[2][2]];
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values
}

/// Turns the axes p and q so that `a[p][q]` vanishes (Golub and Van Loan, section 8.5).
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    for row in a.iter_mut() {
        let (x, y) = (row[p], row[q]);
        (row[p], row[q]) = (cosine * x - sine * y, sine * x + cosine * y);
    }
    let (x, y) = (a[p], a[q]);
    a[p] = [0, 1, 2].map(|k| cosine * x[k] - sine * y[k]);
    a[q] = [0, 1, 2].map(|k| sine * x[k] + cosine * y[k]);
}

/// |σ1| + |σ2| + |σ3|, in pascals.
pub fn stress_sum(stress: &Stress) -> f64 {
    principal_stresses(stress).iter().map(|x| x.abs()).sum()
}

/// Von Mises' equivalent stress, in pascals.
pub fn von_mises(stress: &Stress) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = *stress;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    let shear = xy * xy + xz * xz + yz * yz;
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// What is compared with the yield strength: von Mises' stress or, where layers part more easily than
/// the material yields, the tension and shear between layers by their own strength, combined as von
/// Mises' stress combines them. Pressure does not part layers.
pub(super) fn equivalent_stress(stress: &Stress, layers: Option<&AcrossLayers>) -> f64 {
    let within = von_mises(stress);
    let Some(layers) = layers else { return within };
    let [xx, yy, zz, xy, xz, yz] = *stress;
    let d = layers.direction;
    let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    let n = d.map(|x| x / length);
    let traction = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        .map(|row| row[0] * n[0] + row[1] * n[1] + row[2] * n[2]);
    let normal: f64 = (0..3).map(|k| traction[k] * n[k]).sum();
    let square: f64 = traction.iter().map(|x| x * x).sum();
    let shear = (square - normal * normal).max(0.0);
    let tension = normal.max(0.0);
    within.max((tension * tension + 3.0 * shear).sqrt() / layers.strength)
}
