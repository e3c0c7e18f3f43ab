//! Elements beside what elasticity says of them in closed form.

use nalgebra::{DMatrix, DVector, Matrix3};

use super::super::element::{Element, Vector, bars, element};
use crate::analyse::Material;

pub(super) const PLASTIC: Material = Material {
    youngs_modulus: 2.3e9,
    poisson_ratio: 0.35,
    density: 1040.0,
    yield_strength: None,
    across_layers: None,
};

/// A brick and a wedge out of shape.
fn distorted() -> [Vec<Vector>; 2] {
    let push = |c: usize, k: usize| 0.15 * (((7 * c + 3 * k) % 5) as f64 - 2.0) / 2.0;
    let brick = |c: usize| Vector::from_fn(|k, _| (c >> k & 1) as f64 * 2.0 + push(c, k));
    let corner = [(0.0, 0.0), (2.0, 0.3), (0.4, 1.7)];
    let wedge = |a: usize| {
        let (x, y) = corner[a % 3];
        Vector::new(x + push(a, 0), y + push(a, 1), (a / 3) as f64 + push(a, 2))
    };
    [(0..8).map(brick).collect(), (0..6).map(wedge).collect()]
}

/// Displacements of nodes in a field.
fn field(nodes: &[Vector], at: impl Fn(&Vector) -> Vector) -> DVector<f64> {
    DVector::from_iterator(3 * nodes.len(), nodes.iter().flat_map(|x| at(x).data.0[0]))
}

fn slope() -> Matrix3<f64> {
    Matrix3::new(1e-3, 4e-4, -2e-4, 1e-4, -5e-4, 7e-4, 3e-4, -6e-4, 8e-4)
}

/// The stresses of a slope of displacements, by Hooke's law written with Lamé's constants.
fn hooke(slope: &Matrix3<f64>) -> Matrix3<f64> {
    let (e, nu) = (PLASTIC.youngs_modulus, PLASTIC.poisson_ratio);
    let strain = (slope + slope.transpose()) / 2.0;
    let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    Matrix3::identity() * (lambda * strain.trace()) + strain * (e / (1.0 + nu))
}

fn check_rigid_motions(nodes: &[Vector], element: &Element) {
    let size = element.stiffness.norm();
    for k in 0..3 {
        let axis = Vector::ith(k, 1.0);
        for moved in [field(nodes, |_| axis), field(nodes, |x| axis.cross(x))] {
            assert!((&element.stiffness * &moved).norm() < 1e-12 * size * moved.norm());
            assert!((&element.stress * &moved).norm() < 1e-11 * PLASTIC.youngs_modulus);
        }
    }
    assert!((&element.stiffness - element.stiffness.transpose()).norm() < 1e-12 * size);
}

#[test]
fn what_moves_as_a_whole_feels_no_force() {
    for nodes in distorted() {
        check_rigid_motions(&nodes, &element(&nodes, &PLASTIC).unwrap());
    }
    let [brick, _] = distorted();
    check_rigid_motions(&brick, &bars(&brick, 0.5, &PLASTIC));
}

#[test]
fn elements_resist_everything_else() {
    for nodes in distorted() {
        let stiffness = element(&nodes, &PLASTIC).unwrap().stiffness;
        let values = stiffness.symmetric_eigenvalues();
        let greatest = values.amax();
        assert!(values.iter().all(|v| *v > -1e-12 * greatest));
        assert_eq!(values.iter().filter(|v| **v < 1e-9 * greatest).count(), 6);
    }
}

#[test]
fn a_slope_of_displacements_gives_its_stress_and_energy() {
    let stress = hooke(&slope());
    for nodes in distorted() {
        let element = element(&nodes, &PLASTIC).unwrap();
        let moved = field(&nodes, |x| slope() * x);
        let found = &element.stress * &moved;
        let order = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        for (k, at) in order.into_iter().enumerate() {
            assert!((found[k] - stress[at]).abs() < 1e-9 * stress.norm(), "{k}");
        }
        let volume: f64 = element.volumes.iter().sum();
        let energy = moved.dot(&(&element.stiffness * &moved));
        let exact = volume * slope().component_mul(&stress).sum();
        assert!((energy / exact - 1.0).abs() < 1e-9, "{energy} for {exact}");
    }
}

/// The patch test (Irons 1966): eight bricks round a node out of place; what is linear outside must leave it
/// without a force.
#[test]
fn a_patch_of_bricks_carries_a_constant_stress() {
    let node = |i: usize, j: usize, k: usize| 9 * i + 3 * j + k;
    let mut points: Vec<Vector> = (0..27)
        .map(|n| Vector::new((n / 9) as f64, (n / 3 % 3) as f64, (n % 3) as f64))
        .collect();
    points[13] += Vector::new(0.21, -0.17, 0.13);
    let mut all = DMatrix::<f64>::zeros(81, 81);
    for cell in 0..8 {
        let [i, j, k] = [cell >> 2, cell >> 1 & 1, cell & 1];
        let corner = |c: usize| node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
        let nodes: Vec<usize> = (0..8).map(corner).collect();
        let places: Vec<Vector> = nodes.iter().map(|n| points[*n]).collect();
        let brick = element(&places, &PLASTIC).unwrap();
        for (a, b) in (0..24).flat_map(|a| (0..24).map(move |b| (a, b))) {
            let at = |r: usize| 3 * nodes[r / 3] + r % 3;
            all[(at(a), at(b))] += brick.stiffness[(a, b)];
        }
    }
    let forces: DVector<f64> = &all * field(&points, |x| slope() * x);
    let middle = forces.rows(39, 3).norm();
    assert!(
        middle < 1e-10 * forces.norm(),
        "{middle} of {}",
        forces.norm()
    );
}

#[test]
fn what_is_inside_out_is_no_element() {
    let [mut brick, mut wedge] = distorted();
    brick.swap(0, 1);
    assert!(element(&brick, &PLASTIC).is_none());
    wedge.iter_mut().for_each(|p| p.y = 0.0);
    assert!(element(&wedge, &PLASTIC).is_none());
    // Its second end is upside down, all but exactly: in the middle it has no thickness, and would have any stress.
    let flat = |c: usize| {
        let [x, y, z] = [0, 1, 2].map(|k| (c >> k & 1) as f64);
        let side = if x == 0.0 { 1.0 } else { -1.0 + 1e-9 };
        Vector::new(8.0 * x, y - 0.5, side * (z - 0.5))
    };
    let flat: Vec<Vector> = (0..8).map(flat).collect();
    assert!(element(&flat, &PLASTIC).is_none());
}
