//! Gravity from all sides, and several load cases at once.

use fretwork_geometry::{Point3, Seed};

use super::super::{AnalysisError, Case, Load, MemoryLimit, Model, Summary, analyse};
use super::{ABS, block, is_near, millimetres, on_floor, random_body};

#[track_caller]
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

fn is_high(p: Point3) -> bool {
    p.z == 12.0
}

fn pulled(force: [f64; 3]) -> Vec<Load<'static>> {
    match force {
        [0.0, 0.0, 0.0] => Vec::new(),
        force => vec![Load {
            at: &is_high,
            force,
        }],
    }
}

/// A bar, with memory for all solutions at once, or for one after the other only.
fn bar(limit: MemoryLimit) -> Model {
    let voxels = block([4, 3, 12]);
    Model::new(&millimetres(&voxels), &ABS, &on_floor, limit).unwrap()
}

/// A limit that holds one solution of the bar and the displacements of four, and not the vectors of four.
const ONE_BY_ONE: MemoryLimit = MemoryLimit(180_000);

#[test]
fn combined_solutions_are_those_of_each_direction() {
    for limit in [MemoryLimit::default(), ONE_BY_ONE] {
        let model = bar(limit);
        assert_eq!(model.fits_together(), limit != ONE_BY_ONE);
        for (force, fall) in [
            ([0.0; 3], [0.0, 0.0, -9.81]),
            ([1e-2, 0.0, 0.0], [0.0, 0.0, -9.81]),
            ([1e-2, 0.0, 0.0], [9.81 * 0.6, 9.81 * -0.8, 0.0]),
        ] {
            let loads = pulled(force);
            let case = Case {
                gravity: fall,
                loads: loads.clone(),
            };
            let (own, sweep) = model.sweep(&case).unwrap();
            assert_near(&own.summary, &model.analyse(&case).unwrap().summary);
            assert_eq!(sweep.directions.len(), 14);
            for (direction, found) in &sweep.directions {
                let case = Case {
                    gravity: direction.map(|x| 9.81 * x),
                    loads: loads.clone(),
                };
                assert_near(found, &model.analyse(&case).unwrap().summary);
                assert!(found.residual < 1e-5, "{}", found.residual);
                assert!(found.energy_error < 1e-5, "{}", found.energy_error);
            }
            assert_worst(&model, &case);
        }
    }
}

/// The worst direction is that of the greatest stress: the bar bends most easily along y, and the load pulls
/// along x.
#[track_caller]
fn assert_worst(model: &Model, case: &Case) {
    let sweep = model.sweep(case).unwrap().1;
    let stress = |(_, summary): &&([f64; 3], Summary)| summary.stress_sums.p99;
    let all = sweep.directions.iter();
    let worst = all
        .max_by(|a, b| stress(a).total_cmp(&stress(b)))
        .unwrap()
        .0;
    let [x, y, _] = worst;
    let is_worst = if case.loads.is_empty() {
        y.abs() > 0.5
    } else {
        x > 0.5
    };
    assert!(is_worst, "{worst:?}");
}

/// Residuals of sums are those that a product with the matrix gives.
#[test]
fn qualities_of_sums_are_true() {
    let case = Case {
        gravity: [0.0, 3.0, -9.0],
        loads: pulled([1e-2, 2e-3, 0.0]),
    };
    let together = bar(MemoryLimit::default()).sweep(&case).unwrap().1;
    let apart = bar(ONE_BY_ONE).sweep(&case).unwrap().1;
    for ((_, a), (_, b)) in together.directions.iter().zip(&apart.directions) {
        assert!(a.residual > 0.0 && b.residual > 0.0);
        // The two have rounded in other places on their way; both end a little below the target.
        assert!(
            is_near(a.residual, b.residual, 0.2),
            "{} for {}",
            a.residual,
            b.residual
        );
        assert!(
            is_near(a.energy_error, b.energy_error, 0.2),
            "{} for {}",
            a.energy_error,
            b.energy_error
        );
    }
}

/// Without gravity all directions are the case itself; without anything nothing moves.
#[test]
fn a_sweep_without_gravity_is_the_case() {
    for force in [[0.0; 3], [1e-2, 0.0, 0.0]] {
        let case = Case {
            gravity: [0.0; 3],
            loads: pulled(force),
        };
        let (own, sweep) = bar(MemoryLimit::default()).sweep(&case).unwrap();
        for (_, found) in &sweep.directions {
            for (a, b) in [
                (found.largest_displacement, own.summary.largest_displacement),
                (found.stress_sums.p99, own.summary.stress_sums.p99),
            ] {
                assert!(is_near(a, b, 1e-12), "{a} for {b}");
            }
        }
        assert_eq!(own.summary.largest_displacement == 0.0, force == [0.0; 3]);
    }
}

/// One to nine load cases of random bodies, those without forces among them, are as if each was alone.
#[test]
fn load_cases_do_not_mix() {
    for count in 1..10 {
        let seed = Seed::root(40 + count);
        let voxels = random_body(seed);
        let body = millimetres(&voxels);
        let cases: Vec<Case> = (0..count)
            .map(|n| {
                let some = |k: u64| 20.0 * seed.unit(100 + 3 * n + k) - 10.0;
                let gravity = if n == 1 {
                    [0.0; 3]
                } else {
                    [some(0), some(1), some(2)]
                };
                Case {
                    gravity,
                    loads: Vec::new(),
                }
            })
            .collect();
        let all = analyse(&body, &ABS, &on_floor, &cases).unwrap();
        assert_eq!(all.len(), cases.len());
        for (case, found) in cases.iter().zip(&all) {
            let alone = analyse(&body, &ABS, &on_floor, std::slice::from_ref(case)).unwrap();
            assert_near(&found.summary, &alone[0].summary);
            assert_eq!(found.summary.iterations, alone[0].summary.iterations);
        }
    }
}

#[test]
fn a_load_that_misses_is_told_of_any_case() {
    let voxels = block([2, 2, 4]);
    let nowhere = |_: Point3| false;
    let miss = Case {
        gravity: [0.0; 3],
        loads: vec![Load {
            at: &nowhere,
            force: [1.0; 3],
        }],
    };
    let cases = [Case::default(), miss];
    let found = analyse(&millimetres(&voxels), &ABS, &on_floor, &cases);
    assert_eq!(found.unwrap_err(), AnalysisError::LoadMisses { load: 0 });
}
