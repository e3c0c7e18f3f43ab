//! Preconditioned conjugate gradients, until the residual itself is small. Several load cases go side by side, each
//! with steps of its own, and share every product with the matrix.

use fretwork_geometry::budget;

use super::error::AnalysisError;
use super::number::Columns;
use super::preconditioner::{Preconditioner, Workspace};
use super::vector::{add, dot, norm, update};

/// The residual that is asked for, as a part of the load.
const RESIDUAL: f64 = 1e-6;

/// On bodies that are so floppy that rounding hides the residual, this error of the strain energy's
/// root counts instead.
const ENERGY_ERROR: f64 = 1e-8;

/// More iterations than any body has been seen to need, by twenty times.
const ITERATIONS: usize = 800;

/// Steps of the budget for each voxel in an iteration: it takes one microsecond.
const STEPS: u64 = 100;

/// How good a solution is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quality {
    pub(super) iterations: usize,
    /// The work of the load f·u.
    pub(super) work: f64,
    /// The length of the true residual, as a part of the load's.
    pub(super) residual: f64,
    /// The estimated error in the energy norm, as a part of the solution's.
    pub(super) energy_error: f64,
}

impl Quality {
    /// Whether the residual is small enough or, where rounding leaves no better, the error.
    pub(super) fn is_good(&self) -> bool {
        self.residual <= RESIDUAL || self.energy_error <= ENERGY_ERROR
    }
}

/// The displacements under some loads, and how good each of them is.
pub(super) struct Solution<T, const D: usize> {
    /// The displacement of each node.
    pub(super) displacement: Vec<[T; D]>,
    /// The true residual: what the displacement leaves of the load.
    pub(super) residual: Vec<[T; D]>,
    /// The preconditioned residual: about the error.
    pub(super) error: Vec<[T; D]>,
    /// How good each column is.
    pub(super) qualities: Vec<Quality>,
}

/// Forces at nodes that are asked for more than once.
pub(super) type Forces<'a, T, const D: usize> = &'a dyn Fn() -> Result<Vec<[T; D]>, AnalysisError>;

/// What iterations change.
struct State<'a, T: Columns, const D: usize> {
    inverse: &'a Preconditioner,
    /// The displacement.
    x: Vec<[T; D]>,
    /// The residual, by recursion.
    r: Vec<[T; D]>,
    /// The preconditioned residual.
    z: Vec<[T; D]>,
    work: Workspace<T, D>,
    /// Iterations of all columns, and of each until it was good.
    iterations: usize,
    of_column: Vec<usize>,
}

/// The displacements under the forces `load`, which are zero at clamped nodes; a column without forces stays at
/// rest. They are asked for again when a residual is worked out, and not kept meanwhile: on a large body no
/// vector is one too many.
///
/// The residual of the recursion drifts from the true one on floppy bodies. When it is small, the true
/// one is worked out, and the iteration starts again from it until that no longer helps. A column that is done
/// stays as it is while others go on.
///
/// # Errors
/// Those of `load`.
pub(super) fn solve<T: Columns, const D: usize>(
    inverse: &Preconditioner,
    load: Forces<T, D>,
) -> Result<Solution<T, D>, AnalysisError> {
    let mut state = State::new(inverse, load()?);
    let length = norm(&state.r);
    let part = |r: T, column: usize| match length.column(column) {
        0.0 => 0.0,
        length => r.column(column) / length,
    };
    let mut targets: Vec<f64> = (0..T::COUNT)
        .map(|column| RESIDUAL * length.column(column))
        .collect();
    let mut residuals = vec![1.0; T::COUNT];
    let work = loop {
        state.run(&targets);
        let load = load()?;
        inverse.residual(&load, &state.x, &mut state.r);
        let now = norm(&state.r);
        for column in 0..T::COUNT {
            let before = std::mem::replace(&mut residuals[column], part(now, column));
            let helps = residuals[column] <= 0.5 * before;
            if residuals[column] <= RESIDUAL || !helps {
                targets[column] = f64::INFINITY;
            }
        }
        if state.iterations >= ITERATIONS || targets.iter().all(|t| *t == f64::INFINITY) {
            break dot(&load, &state.x);
        }
    };
    inverse.apply(&state.r, &mut state.z, &mut state.work);
    let energy = dot(&state.r, &state.z);
    let quality = |column: usize| {
        let work = work.column(column);
        let error = (energy.column(column) / work).abs().sqrt();
        Quality {
            iterations: state.of_column[column],
            work,
            residual: residuals[column],
            energy_error: if length.column(column) == 0.0 {
                0.0
            } else {
                error
            },
        }
    };
    Ok(Solution {
        qualities: (0..T::COUNT).map(quality).collect(),
        displacement: state.x,
        residual: state.r,
        error: state.z,
    })
}

impl<T: Columns, const D: usize> State<'_, T, D> {
    fn new(inverse: &Preconditioner, load: Vec<[T; D]>) -> State<'_, T, D> {
        let zero = || vec![[T::default(); D]; load.len()];
        State {
            inverse,
            x: zero(),
            z: zero(),
            work: Workspace::new(load.len()),
            r: load,
            iterations: 0,
            of_column: vec![0; T::COUNT],
        }
    }

    /// Iterates until the residual by recursion of each column is a little below its target, or is no number.
    fn run(&mut self, targets: &[f64]) {
        self.inverse.apply(&self.r, &mut self.z, &mut self.work);
        // The direction of search, and the matrix times it.
        let mut p = self.z.clone();
        let mut product = vec![[T::default(); D]; p.len()];
        let mut decrease = dot(&self.r, &self.z);
        let (mesh, stiffness) = (&self.inverse.mesh, self.inverse.stiffness());
        loop {
            let open = self.open(targets);
            if self.iterations >= ITERATIONS || !open.contains(&true) {
                break;
            }
            budget::spend("rounds of an analysis", STEPS * mesh.elements.len() as u64);
            mesh.apply(&stiffness, &p, &mut product);
            let step = quotient(decrease, dot(&p, &product), &open);
            add(&mut self.x, step, &p);
            add(&mut self.r, T::of(-1.0) * step, &product);
            self.iterations += 1;
            for (count, open) in self.of_column.iter_mut().zip(&open) {
                *count += usize::from(*open);
            }
            self.inverse.apply(&self.r, &mut self.z, &mut self.work);
            // The flexible form (Notay 2000) forgives the single precision of the smoother.
            let turn = T::of(-1.0) * step * dot(&product, &self.z);
            let beta = quotient(turn, decrease, &open);
            decrease = dot(&self.r, &self.z);
            update(&mut p, &self.z, |p, z| {
                for k in 0..D {
                    p[k] = z[k] + beta * p[k];
                }
            });
        }
    }

    /// Which columns are to go on.
    fn open(&self, targets: &[f64]) -> Vec<bool> {
        let length = norm(&self.r);
        let is_open = |(column, target): (usize, &f64)| {
            let length = length.column(column);
            length > 0.9 * target && length.is_finite()
        };
        targets.iter().enumerate().map(is_open).collect()
    }
}

/// The quotient of each open column; zero, which changes nothing, in the others.
fn quotient<T: Columns>(a: T, b: T, open: &[bool]) -> T {
    T::of_columns(|column| match open[column] {
        true => a.column(column) / b.column(column),
        false => 0.0,
    })
}
