//! Preconditioned conjugate gradients, until the residual itself is small.

use fretwork_geometry::budget;

use super::element::Quad;
use super::error::AnalysisError;
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

/// A solution, and how good it is.
pub(super) struct Solution {
    /// The displacement of each node.
    pub(super) displacement: Vec<Quad<f64>>,
    pub(super) iterations: usize,
    /// The work of the load f·u.
    pub(super) work: f64,
    /// The length of the true residual, as a part of the load's.
    pub(super) residual: f64,
    /// The estimated error in the energy norm, as a part of the solution's.
    pub(super) energy_error: f64,
}

impl Solution {
    /// Whether the residual is small enough or, where rounding leaves no better, the error.
    pub(super) fn is_good(&self) -> bool {
        self.residual <= RESIDUAL || self.energy_error <= ENERGY_ERROR
    }

    /// Nothing moves under no load.
    pub(super) fn zero(nodes: usize) -> Solution {
        Solution {
            displacement: vec![[0.0; 4]; nodes],
            iterations: 0,
            work: 0.0,
            residual: 0.0,
            energy_error: 0.0,
        }
    }

    /// A displacement that was found in some other way, with its residual and error. The load has the
    /// length one, or zero.
    pub(super) fn judged(
        inverse: &Preconditioner,
        load: &[Quad<f64>],
        displacement: Vec<Quad<f64>>,
        iterations: usize,
    ) -> Solution {
        let work = dot(load, &displacement);
        if work <= 0.0 {
            return Solution::zero(load.len());
        }
        budget::spend("rounds of an analysis", STEPS * load.len() as u64);
        let mut r = vec![[0.0; 4]; load.len()];
        let mut z = r.clone();
        inverse.residual(load, &displacement, &mut r);
        inverse.apply(&r, &mut z, &mut Workspace::new(load.len()));
        Solution {
            residual: norm(&r) / norm(load),
            energy_error: (dot(&r, &z) / work).abs().sqrt(),
            displacement,
            iterations,
            work,
        }
    }
}

/// What iterations change.
struct State<'a> {
    inverse: &'a Preconditioner,
    /// The displacement.
    x: Vec<Quad<f64>>,
    /// The residual, by recursion.
    r: Vec<Quad<f64>>,
    /// The preconditioned residual.
    z: Vec<Quad<f64>>,
    work: Workspace,
    iterations: usize,
}

/// The displacements under the forces `load`, which are zero at clamped nodes and not zero everywhere. They are asked
/// for again when a residual is worked out, and not kept meanwhile: on a large body no vector is one too many.
///
/// The residual of the recursion drifts from the true one on floppy bodies. When it is small, the true
/// one is worked out, and the iteration starts again from it until that no longer helps.
///
/// # Errors
/// Those of `load`.
pub(super) fn solve(
    inverse: &Preconditioner,
    load: &dyn Fn() -> Result<Vec<Quad<f64>>, AnalysisError>,
) -> Result<Solution, AnalysisError> {
    let mut state = State::new(inverse, load()?);
    let length = norm(&state.r);
    let mut residual = 1.0;
    let work = loop {
        state.run(RESIDUAL * length);
        let load = load()?;
        inverse.residual(&load, &state.x, &mut state.r);
        let before = std::mem::replace(&mut residual, norm(&state.r) / length);
        let helps = residual <= 0.5 * before;
        if residual <= RESIDUAL || !helps || state.iterations >= ITERATIONS {
            break dot(&load, &state.x);
        }
    };
    inverse.apply(&state.r, &mut state.z, &mut state.work);
    Ok(Solution {
        energy_error: (dot(&state.r, &state.z) / work).abs().sqrt(),
        work,
        iterations: state.iterations,
        displacement: state.x,
        residual,
    })
}

impl State<'_> {
    fn new(inverse: &Preconditioner, load: Vec<Quad<f64>>) -> State<'_> {
        let zero = || vec![[0.0; 4]; load.len()];
        State {
            inverse,
            x: zero(),
            z: zero(),
            work: Workspace::new(load.len()),
            r: load,
            iterations: 0,
        }
    }

    /// Iterates until the residual by recursion is a little below `target`, or is no number.
    fn run(&mut self, target: f64) {
        self.inverse.apply(&self.r, &mut self.z, &mut self.work);
        // The direction of search, and the matrix times it.
        let mut p = self.z.clone();
        let mut product = vec![[0.0; 4]; p.len()];
        let mut decrease = dot(&self.r, &self.z);
        let mut length = norm(&self.r);
        while self.iterations < ITERATIONS && length > 0.9 * target && length.is_finite() {
            let Preconditioner {
                mesh, stiffness, ..
            } = self.inverse;
            budget::spend("rounds of an analysis", STEPS * mesh.elements.len() as u64);
            mesh.apply(stiffness, &p, &mut product);
            let step = decrease / dot(&p, &product);
            add(&mut self.x, step, &p);
            add(&mut self.r, -step, &product);
            self.iterations += 1;
            length = norm(&self.r);
            self.inverse.apply(&self.r, &mut self.z, &mut self.work);
            // The flexible form (Notay 2000) forgives the single precision of the smoother.
            let beta = -step * dot(&product, &self.z) / decrease;
            decrease = dot(&self.r, &self.z);
            update(&mut p, &self.z, |p, z| {
                for k in 0..4 {
                    p[k] = z[k] + beta * p[k];
                }
            });
        }
    }
}
