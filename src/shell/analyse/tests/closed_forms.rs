//! Bodies whose displacements are known in closed form.

use fretwork_geometry::{Point3, Seed};

use super::super::element::{Quad, Stiffness};
use super::super::mesh::{Mesh, corners};
use super::super::stress::stress;
use super::super::{Case, Load, Material, analyse};
use super::{ABS, block, is_near, millimetres, on_floor, random_body};

/// The patch test: a linear displacement has constant stress, and no forces inside of a body.
#[test]
fn a_linear_displacement_is_exact() {
    let gradient = [[0.3, -0.2, 0.1], [0.5, 0.7, -0.4], [-0.6, 0.2, 0.9]];
    let linear = |node: [u32; 3]| -> Quad<f64> {
        let [x, y, z] = gradient.map(|row| (0..3).map(|k| row[k] * f64::from(node[k])).sum());
        [x, y, z, 0.0]
    };
    let (lambda, mu) = super::super::element::lame(0.35);
    let trace: f64 = lambda * (0..3).map(|k| gradient[k][k]).sum::<f64>();
    let of = |i: usize, k: usize| {
        mu * (gradient[i][k] + gradient[k][i]) + if i == k { trace } else { 0.0 }
    };
    let expected = [of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2)];
    let mesh = Mesh::new(&block([4, 3, 5]).cells, |_| false);
    let u: Vec<Quad<f64>> = mesh.nodes.iter().map(|node| linear(*node)).collect();
    let mut forces = u.clone();
    mesh.apply(&Stiffness::<f64>::new(0.35), &u, &mut forces);
    let mut inside = 0;
    for (force, pattern) in forces.iter().zip(&mesh.patterns) {
        if *pattern == 255 {
            inside += 1;
            assert!(force.iter().all(|x| x.abs() < 1e-13), "{force:?}");
        }
    }
    assert_eq!(inside, 3 * 2 * 4);
    for element in &mesh.elements {
        let found = stress(corners(element).map(|node| u[node]), 0.35);
        for (a, b) in found.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-13, "{found:?}");
        }
    }
}

#[test]
fn rigid_motions_take_no_force() {
    let mesh = Mesh::new(&random_body(Seed::root(5)).cells, |_| false);
    let turned = |[x, y, z]: [f64; 3]| [1.0 - 2.0 * y + z, 2.0 * x - 3.0 * z, 3.0 * y - x, 0.0];
    let u: Vec<Quad<f64>> = mesh
        .nodes
        .iter()
        .map(|n| turned(n.map(f64::from)))
        .collect();
    let mut forces = u.clone();
    mesh.apply(&Stiffness::<f64>::new(0.35), &u, &mut forces);
    assert!(forces.iter().flatten().all(|x| x.abs() < 1e-12));
}

/// Without lateral strain a bar is one-dimensional, where linear elements are exact at their nodes:
/// u = ρ g L² / 2E at the top, σ = ρ g (L - z).
#[test]
fn a_bar_under_its_own_weight_is_exact() {
    let voxels = block([3, 2, 30]);
    let material = Material {
        poisson_ratio: 0.0,
        ..ABS
    };
    let case = Case {
        gravity: [0.0, 0.0, -9.81],
        loads: Vec::new(),
    };
    let found = analyse(&millimetres(&voxels), &material, &on_floor, &[case]).unwrap();
    let (analysis, summary) = (&found[0], found[0].summary);
    let (weight, length) = (1040.0 * 9.81, 0.03);
    let expected = weight * length * length / 2.0 / 2.3e9;
    assert!(is_near(summary.largest_displacement, expected, 1e-6));
    assert_eq!(summary.largest_displacement_at.z, 30.0);
    for (cell, stress) in voxels.cells.iter().zip(&analysis.stresses) {
        let expected = -weight * (length - (f64::from(cell[2]) + 0.5) * 1e-3);
        assert!(is_near(stress[2], expected, 1e-4), "{cell:?}: {stress:?}");
    }
    assert!(is_near(summary.stress_sums.max, weight * 0.0295, 1e-5));
    assert_eq!(summary.stress_sums.at.z, 0.5);
    assert!(is_near(summary.mass, 1040.0 * 180e-9, 1e-12));
    assert!(!summary.is_sag_large);
    let safety = summary.safety.unwrap();
    assert!(is_near(safety.least, 40e6 / (weight * 0.0295), 1e-5));
}

/// Timoshenko's beam: w = F L³ / 3 E I + F L / κ G A with κ = 10 (1 + ν) / (12 + 11 ν). Ten elements through
/// the depth are about 1 % too stiff.
#[test]
fn a_cantilever_bends_as_a_beam() {
    let voxels = block([80, 10, 10]);
    let is_held = |p: Point3| p.x == 0.0;
    let is_tip = |p: Point3| p.x == 80.0;
    let case = Case {
        gravity: [0.0; 3],
        loads: vec![Load {
            at: &is_tip,
            force: [0.0, 0.0, -5.0],
        }],
    };
    let found = analyse(&millimetres(&voxels), &ABS, &is_held, &[case]).unwrap();
    let (e, nu, length, side) = (2.3e9, 0.35, 0.08f64, 0.01f64);
    let bending = 5.0 * length.powi(3) / (3.0 * e * side.powi(4) / 12.0);
    let shear_modulus = e / 2.0 / (1.0 + nu);
    let kappa = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    let shear = 5.0 * length / (kappa * shear_modulus * side * side);
    let summary = found[0].summary;
    assert!(
        is_near(summary.largest_displacement, bending + shear, 0.02),
        "{} for {}",
        summary.largest_displacement,
        bending + shear
    );
    // The moment in the middle of the outermost layer, away from the clamp.
    let at = voxels.find([20, 5, 9]).unwrap();
    let expected = 5.0 * (length - 0.0205) * 0.0045 / (side.powi(4) / 12.0);
    assert!(is_near(found[0].stresses[at][0], expected, 0.02));
}

#[test]
fn a_large_sag_is_told() {
    let voxels = block([40, 2, 2]);
    let is_held = |p: Point3| p.x == 0.0;
    let is_tip = |p: Point3| p.x == 40.0;
    let sag = |force: f64| {
        let loads = vec![Load {
            at: &is_tip,
            force: [0.0, 0.0, force],
        }];
        let case = Case {
            loads,
            ..Case::default()
        };
        let found = analyse(&millimetres(&voxels), &ABS, &is_held, &[case]).unwrap();
        (
            found[0].summary.largest_displacement,
            found[0].summary.is_sag_large,
        )
    };
    let (small, is_large) = sag(-0.1);
    assert!(small < 0.004 && !is_large);
    let (large, is_large) = sag(-0.1 * 0.0041 / small);
    assert!(is_near(large, 0.0041, 1e-3) && is_large);
}
