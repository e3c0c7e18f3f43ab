//! The figures of independent solvers (CalculiX and scikit-fem) for a block of 10 × 10 × 40 voxels of one
//! millimetre, clamped at its foot.

use super::super::{Analysis, Case, analyse};
use super::{ABS, block, is_near, millimetres, on_floor};

fn under(gravity: [f64; 3]) -> Analysis {
    let voxels = block([10, 10, 40]);
    let case = Case {
        gravity,
        loads: Vec::new(),
    };
    let found = analyse(&millimetres(&voxels), &ABS, &on_floor, &[case]);
    found.unwrap().remove(0)
}

#[test]
fn the_block_stands() {
    let summary = under([0.0, 0.0, -9.81]).summary;
    assert!(is_near(summary.largest_displacement, 3.481126e-9, 1e-6));
    assert!(is_near(summary.compliance, 9.331125e-11, 1e-6));
    assert!(summary.residual <= 1e-6 && summary.iterations < 40);
}

#[test]
fn the_block_lies_on_its_side() {
    let summary = under([9.81, 0.0, 0.0]).summary;
    assert!(is_near(summary.largest_displacement, 1.767154e-7, 1e-6));
    assert!(is_near(summary.compliance, 2.947032e-9, 1e-6));
    assert!(is_near(summary.stress_sums.mean, 1.0547e3, 5e-5));
    assert!(is_near(summary.stress_sums.median, 7.468e2, 1e-4));
    assert!(is_near(summary.stress_sums.p99, 4.963e3, 2e-4));
}
