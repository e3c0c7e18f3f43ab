//! Sizes against an oracle that tries every set of symbols held at the least size, and the
//! conditions of an optimum.

use crate::size::least_squares::{Equation, LEAST, Preference, size};
use fretwork_geometry::Seed;

const CANVAS: f64 = 10.0;

/// Solves a square system; `None` when it is singular.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()))?;
        if a[pivot][k].abs() < 1e-9 {
            return None;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[i][k] / a[k][k];
            let pivot = a[k].clone();
            a[i].iter_mut()
                .zip(&pivot)
                .for_each(|(x, y)| *x -= factor * y);
            b[i] -= factor * b[k];
        }
    }
    Some((0..n).map(|k| b[k] / a[k][k]).collect())
}

/// The solution with the symbols of `held` at the least size: sizes and multipliers, from the
/// conditions of Karush, Kuhn and Tucker. Equations must be independent.
fn stationary(
    preferences: &[Preference],
    equations: &[Equation],
    held: &[usize],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let (n, m) = (preferences.len(), equations.len() + held.len());
    let mut a = vec![vec![0.0; n + m]; n + m];
    let mut b = vec![0.0; n + m];
    for (i, p) in preferences.iter().enumerate() {
        a[i][i] = 2.0 * p.weight;
        b[i] = 2.0 * p.weight * p.size.unwrap_or(0.0);
    }
    for (k, equation) in equations.iter().enumerate() {
        for (i, factor) in &equation.terms {
            a[n + k][*i] = *factor as f64;
            a[*i][n + k] = *factor as f64;
        }
        b[n + k] = if equation.is_canvas { CANVAS } else { 0.0 };
    }
    for (k, i) in held.iter().enumerate() {
        a[n + equations.len() + k][*i] = 1.0;
        a[*i][n + equations.len() + k] = 1.0;
        b[n + equations.len() + k] = CANVAS * LEAST;
    }
    let mut x = solve(a, b)?;
    let multipliers = x.split_off(n);
    Some((x, multipliers))
}

#[test]
fn the_optimum_of_all_sets_of_bounds_is_found() {
    let (mut bounded, mut infeasible) = (0, 0);
    for round in 0..400 {
        let seed = Seed::root(round).name("sizes");
        let pick = |n: u64, most: u64| (seed.unit(n) * most as f64) as u64;
        let n = 3 + pick(0, 3) as usize;
        let preferences: Vec<Preference> = (0..n as u64)
            .map(|i| Preference {
                size: Some(0.2 + seed.unit(10 + i) * 4.0),
                weight: [1.0, 1.0, 0.1, 3.0][pick(20 + i, 4) as usize],
                fixed: false,
            })
            .collect();
        let mut equations = vec![Equation {
            terms: (0..n)
                .map(|i| (i, 1 + pick(30 + i as u64, 3) as i64))
                .collect(),
            is_canvas: true,
        }];
        if pick(50, 3) > 0 {
            let terms = (0..n)
                .map(|i| (i, pick(60 + i as u64, 5) as i64 - 2))
                .filter(|(_, f)| *f != 0)
                .collect();
            equations.push(Equation {
                terms,
                is_canvas: false,
            });
        }
        let oracle = (0..1usize << n).filter_map(|set| {
            let held: Vec<usize> = (0..n).filter(|i| set >> i & 1 == 1).collect();
            let (x, _) = stationary(&preferences, &equations, &held)?;
            let fits = x.iter().all(|v| *v >= CANVAS * LEAST - 1e-9);
            fits.then(|| {
                preferences
                    .iter()
                    .zip(&x)
                    .map(|(p, x)| p.weight * (x - p.size.unwrap_or(0.0)).powi(2))
                    .sum()
            })
        });
        let best = oracle.min_by(|a: &f64, b: &f64| a.total_cmp(b));
        let found = size(&preferences, &equations, CANVAS);
        match (best, &found) {
            (None, None) => infeasible += 1,
            (Some(best), Some(found)) => {
                assert!(
                    (found.error - best).abs() <= 1e-7 * best.max(1.0),
                    "{round}: {} {best}",
                    found.error
                );
                bounded += usize::from(check_optimum(&preferences, &equations, &found.of));
            }
            // A vanishing equation or a corner that the oracle's square systems do not describe.
            (None, Some(found)) => assert!(residual(&equations, &found.of) < 1e-6, "{round}"),
            (Some(best), None) => panic!("{round}: no sizes, but {best}"),
        }
    }
    assert!(bounded > 20 && infeasible > 5, "{bounded} {infeasible}");
}

/// The conditions of an optimum; whether a size is at its bound.
fn check_optimum(preferences: &[Preference], equations: &[Equation], x: &[f64]) -> bool {
    assert!(residual(equations, x) < 1e-7);
    let held: Vec<usize> = (0..x.len())
        .filter(|i| x[*i] <= CANVAS * LEAST * (1.0 + 1e-6))
        .collect();
    assert!(x.iter().all(|v| *v >= CANVAS * LEAST * (1.0 - 1e-6)));
    if let Some((exact, multipliers)) = stationary(preferences, equations, &held) {
        assert!(
            exact.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-5),
            "{exact:?} {x:?}"
        );
        // The gradient pushes against the bounds that hold.
        assert!(
            multipliers[equations.len()..].iter().all(|m| *m <= 1e-5),
            "{multipliers:?}"
        );
    }
    !held.is_empty()
}

fn residual(equations: &[Equation], x: &[f64]) -> f64 {
    let gap = |e: &Equation| {
        e.terms.iter().map(|(i, f)| *f as f64 * x[*i]).sum::<f64>()
            - if e.is_canvas { CANVAS } else { 0.0 }
    };
    equations.iter().map(|e| gap(e).abs()).fold(0.0, f64::max)
}

#[test]
fn fixed_sizes_weights_and_contradictions() {
    let of = |size: f64, weight: f64, fixed: bool| Preference {
        size: Some(size),
        weight,
        fixed,
    };
    let full = Equation {
        terms: vec![(0, 2), (1, 1)],
        is_canvas: true,
    };
    let sizes = size(
        &[of(3.0, 1.0, true), of(5.0, 1.0, false)],
        std::slice::from_ref(&full),
        CANVAS,
    )
    .expect("sizes");
    assert!((sizes.of[0] - 3.0).abs() < 1e-12 && (sizes.of[1] - 4.0).abs() < 1e-12);
    assert!((sizes.error - 1.0).abs() < 1e-9);
    let stiff = size(
        &[of(3.0, 1000.0, false), of(5.0, 0.001, false)],
        std::slice::from_ref(&full),
        CANVAS,
    )
    .expect("sizes");
    assert!((stiff.of[0] - 3.0).abs() < 1e-5);
    assert!(
        size(
            &[of(3.0, 1.0, true), of(5.0, 1.0, true)],
            std::slice::from_ref(&full),
            CANVAS
        )
        .is_none()
    );
    let nothing = Equation {
        terms: vec![(0, 1)],
        is_canvas: false,
    };
    assert!(
        size(
            &[of(3.0, 1.0, false), of(5.0, 1.0, false)],
            &[full.clone(), nothing],
            CANVAS
        )
        .is_none()
    );
    let wild = Preference {
        size: None,
        weight: 1.0,
        fixed: false,
    };
    let sizes = size(&[of(3.0, 1.0, false), wild], &[full], CANVAS).expect("sizes");
    assert!(sizes.error < 1e-15 && (sizes.of[1] - 4.0).abs() < 1e-9);
}
