//! The numbers that are made of stresses.

use fretwork_geometry::{Point3, Seed};
use nalgebra::Matrix3;

use super::super::statistics::Statistics;
use super::super::stress::equivalent_stress;
use super::super::{AcrossLayers, Stress, principal_stresses, stress_sum, von_mises};
use super::is_near;

fn random(case: u64) -> Stress {
    std::array::from_fn(|k| (2.0 * Seed::root(case).unit(k as u64) - 1.0) * 1e6)
}

#[test]
fn principal_stresses_are_eigenvalues() {
    for case in 0..200 {
        let stress = random(case);
        let [xx, yy, zz, xy, xz, yz] = stress;
        let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let mut expected = matrix.symmetric_eigenvalues().as_slice().to_vec();
        expected.sort_by(|a, b| b.total_cmp(a));
        let found = principal_stresses(&stress);
        for (a, b) in found.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-8, "{found:?} {expected:?}");
        }
        let sum: f64 = expected.iter().map(|x| x.abs()).sum();
        assert!(is_near(stress_sum(&stress), sum, 1e-12));
        let [a, b, c] = found;
        let by_principal = (((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2)) / 2.0).sqrt();
        assert!(is_near(von_mises(&stress), by_principal, 1e-9));
    }
}

#[test]
fn equal_stresses_and_none_are_exact() {
    assert_eq!(principal_stresses(&[0.0; 6]), [0.0; 3]);
    assert_eq!(
        principal_stresses(&[2.0, 2.0, 2.0, 0.0, 0.0, 0.0]),
        [2.0; 3]
    );
    let [a, b, c] = principal_stresses(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    assert!((a - 1.0).abs() < 1e-15 && b.abs() < 1e-15 && (c + 1.0).abs() < 1e-15);
}

#[test]
fn layers_part_under_tension_and_shear_only() {
    let layers = AcrossLayers {
        strength: 0.5,
        direction: [0.0, 0.0, 3.0],
    };
    let of = |stress: Stress| equivalent_stress(&stress, Some(&layers));
    assert!(is_near(of([0.0, 0.0, 4.0, 0.0, 0.0, 0.0]), 8.0, 1e-12));
    assert!(is_near(of([0.0, 0.0, -4.0, 0.0, 0.0, 0.0]), 4.0, 1e-12));
    assert!(is_near(of([4.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 4.0, 1e-12));
    let shear = 2.0 * 3f64.sqrt();
    assert!(is_near(of([0.0, 0.0, 0.0, 0.0, 1.0, 0.0]), shear, 1e-12));
    assert!(is_near(
        of([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        shear / 2.0,
        1e-12
    ));
    let stress = random(3);
    assert_eq!(equivalent_stress(&stress, None), von_mises(&stress));
}

#[test]
fn percentiles_are_interpolated() {
    let values: Vec<f64> = (0..=200).rev().map(f64::from).collect();
    let place = |i: usize| Point3::new(i as f64, 0.0, 0.0);
    let found = Statistics::new(&values, place);
    let expected = Statistics {
        mean: 100.0,
        median: 100.0,
        p99: 198.0,
        max: 200.0,
        at: Point3::ORIGIN,
    };
    assert_eq!(found, expected);
    assert_eq!(Statistics::new(&[1.0, 2.0], place).median, 1.5);
    assert_eq!(Statistics::new(&[3.0], place).p99, 3.0);
    // Of equal values, the first gives the place.
    assert_eq!(Statistics::new(&[1.0, 5.0, 5.0], place).at.x, 1.0);
}
