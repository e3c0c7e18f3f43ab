//! The sizes that change least (rules R10 and R11): the least squares of section 5.3.
//!
//! There is one unknown for each symbol. Equations between sums of symbols say that columns and rows
//! meet; `size_equations` reads them off an alignment. They are reduced by Gaussian elimination to a
//! form in which some unknowns depend on the others. The free unknowns then solve the normal
//! equations of the least squares.
//!
//! In most layouts no size ends at the least size, and this is all. Otherwise the same problem with
//! lower bounds is a quadratic program, which an interior-point solver solves approximately. The
//! sizes that ended at the least size are then held there, and the linear problem is solved again:
//! it gives the same solution to the last digit.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};

/// What the size of a symbol should come near to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preference {
    /// The preferred size; none for a wildcard.
    pub size: Option<f64>,
    /// The factor of the squared difference.
    pub weight: f64,
    /// Whether the size must be the preferred one.
    pub fixed: bool,
}

/// An equation: the sum of `factor · size(symbol)` is 0, or the side of the canvas.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Equation {
    /// Symbols and factors, sorted by symbol. No factor is 0.
    pub terms: Vec<(usize, i64)>,
    /// Whether the right side is the side of the canvas.
    pub is_canvas: bool,
}

/// A size for each symbol.
#[derive(Clone, Debug, PartialEq)]
pub struct Sizes {
    /// The sizes by the numbers of the symbols.
    pub of: Vec<f64>,
    /// The weighted sum of the squared differences from the preferred sizes.
    pub error: f64,
}

/// The least size of anything, as a fraction of the canvas (rule R11). With a lesser one, a symbol
/// that had better vanish becomes a sliver that cannot be seen or made; a greater one would forbid
/// thin joints of large facades.
pub const LEAST: f64 = 1e-4;

/// The sizes that meet `equations` and come nearest to the preferences; `None` if no sizes of at
/// least [`LEAST`] of the canvas meet them.
pub fn size(preferences: &[Preference], equations: &[Equation], canvas: f64) -> Option<Sizes> {
    let system = System::new(preferences, equations, canvas)?;
    let free = system.nearest(&[])?;
    let of = if system.holds(&free) {
        free
    } else {
        system.bounded(&free)?
    };
    let error = preferences
        .iter()
        .zip(&of)
        .map(|(p, x)| p.size.map_or(0.0, |s| p.weight * (x - s) * (x - s)))
        .sum();
    Some(Sizes { of, error })
}

/// Equations that are solved for some of the unknowns, in units of the canvas.
struct System {
    unknowns: usize,
    /// For each equation: the unknown that it is solved for, the factors of the others, which are 0
    /// for unknowns that other equations are solved for, and the right side.
    rows: Vec<(usize, Vec<f64>, f64)>,
    /// The weight and the preferred size of each unknown; both are 0 for a wildcard.
    goals: Vec<(f64, f64)>,
    canvas: f64,
}

/// Factors below this part of the greatest one are rounding errors. If it is too small, a rounding
/// error becomes a pivot and sizes explode; if too large, equations that contradict each other by
/// little pass for consistent. Factors are small whole numbers, so that there is ample room.
const NEGLIGIBLE: f64 = 1e-9;
/// The tolerance for sizes that a linear system gives to be at least the least size, in canvases.
const EXACT_SLACK: f64 = 1e-12;
/// The tolerance for sizes and equations that the interior-point solver gives, in canvases. Its own
/// tolerances are a hundred times as strict, or more.
const PROGRAM_SLACK: f64 = 1e-7;
/// The greatest difference, in canvases, between the solver's sizes and the linear solution that
/// replaces them. More would mean that other sizes are at the least size.
const SAME_SOLUTION: f64 = 1e-5;

impl System {
    fn new(preferences: &[Preference], equations: &[Equation], canvas: f64) -> Option<System> {
        let n = preferences.len();
        let goals = preferences
            .iter()
            .map(|p| p.size.map_or((0.0, 0.0), |s| (p.weight, s / canvas)))
            .collect();
        let mut system = System {
            unknowns: n,
            rows: Vec::new(),
            goals,
            canvas,
        };
        for (i, preference) in preferences.iter().enumerate() {
            if let (true, Some(size)) = (preference.fixed, preference.size) {
                let mut row = vec![0.0; n];
                row[i] = 1.0;
                system.eliminate(row, size / canvas)?;
            }
        }
        for equation in equations {
            let mut row = vec![0.0; n];
            equation
                .terms
                .iter()
                .for_each(|(i, factor)| row[*i] = *factor as f64);
            system.eliminate(row, if equation.is_canvas { 1.0 } else { 0.0 })?;
        }
        Some(system)
    }

    /// Adds an equation; `None` if it contradicts the others.
    fn eliminate(&mut self, mut row: Vec<f64>, mut right: f64) -> Option<()> {
        let scale = row.iter().fold(1.0f64, |m, v| m.max(v.abs()));
        for (pivot, other, r) in &self.rows {
            let factor = row[*pivot];
            if factor != 0.0 {
                row.iter_mut()
                    .zip(other)
                    .for_each(|(a, b)| *a -= factor * b);
                row[*pivot] = 0.0;
                right -= factor * r;
            }
        }
        // Wildcards come first: no preference decides them, so they must follow from the rest.
        let present = (0..self.unknowns).filter(|i| row[*i].abs() > NEGLIGIBLE * scale);
        let rank = |i: &usize| (self.goals[*i].0 == 0.0, row[*i].abs());
        let Some(best) = present.max_by(|a, b| {
            rank(a)
                .0
                .cmp(&rank(b).0)
                .then(rank(a).1.total_cmp(&rank(b).1))
        }) else {
            return (right.abs() <= NEGLIGIBLE * scale).then_some(());
        };
        let pivot = row[best];
        row.iter_mut().for_each(|v| *v /= pivot);
        right /= pivot;
        for (_, other, r) in &mut self.rows {
            let factor = other[best];
            if factor != 0.0 {
                other
                    .iter_mut()
                    .zip(&row)
                    .for_each(|(a, b)| *a -= factor * b);
                other[best] = 0.0;
                *r -= factor * right;
            }
        }
        self.rows.push((best, row, right));
        Some(())
    }

    /// The unknowns that come nearest to their goals, without lower bounds, if those in `held` are at
    /// the least size.
    fn nearest(&self, held: &[usize]) -> Option<Vec<f64>> {
        let mut system = System {
            rows: self.rows.clone(),
            goals: self.goals.clone(),
            ..*self
        };
        for i in held {
            let mut row = vec![0.0; self.unknowns];
            row[*i] = 1.0;
            system.eliminate(row, LEAST)?;
        }
        let solved: Vec<usize> = system.rows.iter().map(|(pivot, ..)| *pivot).collect();
        let free: Vec<usize> = (0..self.unknowns).filter(|i| !solved.contains(i)).collect();
        let (matrix, right) = system.normal(&free);
        let y = factorize(matrix, right);
        let mut x = vec![0.0; self.unknowns];
        free.iter().zip(&y).for_each(|(i, v)| x[*i] = *v);
        // A size that nothing depends on may as well be small.
        let is_unbound = |i: &usize| {
            system.goals[*i].0 == 0.0 && system.rows.iter().all(|(_, row, _)| row[*i] == 0.0)
        };
        free.iter()
            .filter(|i| is_unbound(i))
            .for_each(|i| x[*i] = LEAST);
        for (pivot, row, r) in &system.rows {
            let rest: f64 = free.iter().map(|i| row[*i] * x[*i]).sum();
            x[*pivot] = r - rest;
        }
        Some(x.iter().map(|v| v * self.canvas).collect())
    }

    /// The normal equations of the free unknowns.
    fn normal(&self, free: &[usize]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let m = free.len();
        let (mut matrix, mut right) = (vec![vec![0.0; m]; m], vec![0.0; m]);
        for (a, i) in free.iter().enumerate() {
            matrix[a][a] += self.goals[*i].0;
            right[a] += self.goals[*i].0 * self.goals[*i].1;
        }
        for (pivot, row, r) in &self.rows {
            let (weight, goal) = self.goals[*pivot];
            if weight == 0.0 {
                continue;
            }
            for (a, i) in free.iter().enumerate().filter(|(_, i)| row[**i] != 0.0) {
                right[a] -= weight * row[*i] * (goal - r);
                free.iter()
                    .enumerate()
                    .for_each(|(b, j)| matrix[a][b] += weight * row[*i] * row[*j]);
            }
        }
        (matrix, right)
    }

    /// Whether all sizes are at least the least size.
    fn holds(&self, x: &[f64]) -> bool {
        x.iter().all(|v| *v >= self.canvas * (LEAST - EXACT_SLACK))
    }

    /// The solution with lower bounds; it is exact if it is clear which sizes end at the least size.
    fn bounded(&self, free: &[f64]) -> Option<Vec<f64>> {
        let x = self.program()?;
        let held: Vec<usize> = (0..self.unknowns)
            .filter(|i| x[*i] <= self.canvas * (LEAST + PROGRAM_SLACK))
            .collect();
        if let Some(exact) = self.nearest(&held)
            && self.holds(&exact)
            && exact
                .iter()
                .zip(&x)
                .all(|(a, b)| (a - b).abs() <= SAME_SOLUTION * self.canvas)
        {
            return Some(exact);
        }
        debug_assert_eq!(free.len(), x.len());
        Some(x)
    }

    /// The approximate solution of the quadratic program; `None` if it has none.
    fn program(&self) -> Option<Vec<f64>> {
        let (n, m) = (self.unknowns, self.rows.len());
        let (mut rows, mut columns, mut values, mut right) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (r, (_, row, b)) in self.rows.iter().enumerate() {
            for (j, v) in row.iter().enumerate().filter(|(_, v)| **v != 0.0) {
                rows.push(r);
                columns.push(j);
                values.push(*v);
            }
            right.push(*b);
        }
        for j in 0..n {
            rows.push(m + j);
            columns.push(j);
            values.push(-1.0);
            right.push(-LEAST);
        }
        let constraints = CscMatrix::new_from_triplets(m + n, n, rows, columns, values);
        let weights = self.goals.iter().map(|(w, _)| 2.0 * w).collect();
        let quadratic =
            CscMatrix::new_from_triplets(n, n, (0..n).collect(), (0..n).collect(), weights);
        let linear: Vec<f64> = self.goals.iter().map(|(w, goal)| -2.0 * w * goal).collect();
        let cones = [ZeroConeT(m), NonnegativeConeT(n)];
        let settings = DefaultSettings {
            verbose: false,
            tol_gap_abs: 1e-11,
            tol_gap_rel: 1e-11,
            tol_feas: 1e-10,
            ..DefaultSettings::default()
        };
        let mut solver =
            DefaultSolver::new(&quadratic, &linear, &constraints, &right, &cones, settings).ok()?;
        solver.solve();
        let solution = &solver.solution;
        let x: Vec<f64> = solution.x.iter().map(|v| v * self.canvas).collect();
        let solved = matches!(
            solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved
        );
        let sound = x
            .iter()
            .all(|v| v.is_finite() && *v >= self.canvas * (LEAST - PROGRAM_SLACK));
        (solved && sound && self.residual(&x) <= PROGRAM_SLACK).then_some(x)
    }

    /// The greatest violation of an equation, in canvases.
    fn residual(&self, x: &[f64]) -> f64 {
        let gap = |row: &[f64], r: f64| {
            row.iter()
                .zip(x)
                .map(|(a, b)| a * b / self.canvas)
                .sum::<f64>()
                - r
        };
        self.rows
            .iter()
            .map(|(_, row, r)| gap(row, *r).abs())
            .fold(0.0, f64::max)
    }
}

/// Solves a symmetric, positive semidefinite system by Gaussian elimination. Unknowns that no
/// equation determines become 0.
fn factorize(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    let scale = (0..n).map(|i| a[i][i]).fold(0.0, f64::max);
    let mut idle = vec![false; n];
    for k in 0..n {
        if a[k][k] <= NEGLIGIBLE * scale {
            idle[k] = true;
            continue;
        }
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            if factor != 0.0 {
                let (upper, lower) = a.split_at_mut(i);
                lower[0][k..]
                    .iter_mut()
                    .zip(&upper[k][k..])
                    .for_each(|(x, y)| *x -= factor * y);
                b[i] -= factor * b[k];
            }
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev().filter(|k| !idle[*k]).collect::<Vec<_>>() {
        let rest: f64 = (k + 1..n).map(|j| a[k][j] * x[j]).sum();
        x[k] = (b[k] - rest) / a[k][k];
    }
    x
}
