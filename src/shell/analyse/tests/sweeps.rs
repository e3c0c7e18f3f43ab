//! Gravity from all sides.

use fretwork_geometry::Point3;

use super::super::{Case, Load, MemoryLimit, Model, Summary};
use super::{ABS, block, is_near, millimetres, on_floor};

fn assert_near(found: &Summary, expected: &Summary) {
    for (a, b) in [
        (found.stress_sums.p99, expected.stress_sums.p99),
        (found.stress_sums.max, expected.stress_sums.max),
        (found.von_mises.mean, expected.von_mises.mean),
        (found.largest_displacement, expected.largest_displacement),
        (found.compliance, expected.compliance),
        (found.mass, expected.mass),
    ] {
        assert!(is_near(a, b, 1e-4), "{a} for {b}");
    }
}

#[test]
fn combined_solutions_are_those_of_each_direction() {
    let voxels = block([4, 3, 12]);
    let model = Model::new(
        &millimetres(&voxels),
        &ABS,
        &on_floor,
        MemoryLimit::default(),
    )
    .unwrap();
    let is_high = |p: Point3| p.z == 12.0;
    for force in [[0.0; 3], [1e-2, 0.0, 0.0]] {
        let loads = [Load {
            at: &is_high,
            force,
        }];
        let sweep = model.sweep(9.81, &loads).unwrap();
        assert_eq!(sweep.directions.len(), 14);
        for (direction, found) in &sweep.directions {
            let case = Case {
                gravity: direction.map(|x| 9.81 * x),
                loads: loads.to_vec(),
            };
            assert_near(found, &model.analyse(&case).unwrap().summary);
            assert!(found.residual < 1e-5, "{}", found.residual);
        }
        let worst = sweep.directions[sweep.worst].1.stress_sums.p99;
        assert!(
            sweep
                .directions
                .iter()
                .all(|(_, s)| s.stress_sums.p99 <= worst)
        );
        // The bar bends most easily along y, and the load pulls along x.
        let worst = sweep.directions[sweep.worst].0;
        let [x, y, _] = worst;
        let is_worst = if force[0] == 0.0 {
            y.abs() > 0.5
        } else {
            x > 0.5
        };
        assert!(is_worst, "{worst:?} under {force:?}");
    }
}
