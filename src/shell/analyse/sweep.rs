//! One body under gravity from all sides.

use super::analysis::{Analysis, Summary};
use super::case::Case;
use super::conjugate_gradients::Quality;
use super::element::Quad;
use super::error::AnalysisError;
use super::model::{Forces, Model, Response};
use super::preconditioner::Workspace;
use super::together::{
    Fours, Products, Solved, TOGETHER, products, response, weighted, weighted_product,
};
use super::vector::{add, dot, norm};

/// What gravity from fourteen directions does to a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Each direction, of length one, and how the body takes it.
    pub directions: Vec<([f64; 3], Summary)>,
}

/// Directions towards the faces and the corners of a cube.
fn directions() -> impl Iterator<Item = [f64; 3]> {
    let faces = (0..3).flat_map(|axis| {
        [-1.0, 1.0].map(|sign| {
            let mut direction = [0.0; 3];
            direction[axis] = sign;
            direction
        })
    });
    let side = 1.0 / 3f64.sqrt();
    let corners =
        (0..8).map(move |corner| [4, 2, 1].map(|bit| if corner & bit == 0 { -side } else { side }));
    faces.chain(corners)
}

/// Forces that are asked for by number: those of the case, then gravity along each axis.
type Asked<'a> = &'a dyn Fn(usize) -> Result<Forces, AnalysisError>;

/// The solutions that those of all directions are sums of.
enum Basis {
    /// Solved together: their displacements, the lengths of their forces, and what the quality of a sum
    /// follows from.
    Together(Fours, [f64; TOGETHER], Box<Judge>),
    /// Solved one by one, where the memory does not allow more.
    Apart(Vec<Response>),
}

/// Products of forces, displacements, residuals and errors, of which lengths of sums are made.
struct Judge {
    forces: Products,
    work: Products,
    residuals: Products,
    energy: Products,
    iterations: usize,
}

impl Model {
    /// Analyses a load case, and the same loads under gravity as strong in fourteen directions, towards the faces
    /// and the corners of a cube.
    ///
    /// Displacements are linear in the forces: those of the case and of gravity along the axes, solved together, are
    /// combined to those of all directions. So are residuals and errors, whose lengths then need no further
    /// product with the matrix.
    ///
    /// # Errors
    /// As [`Model::analyse`].
    pub fn sweep(&self, case: &Case) -> Result<(Analysis, Sweep), AnalysisError> {
        let size = case.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let forces = |n: usize| match n.checked_sub(1) {
            None => self.forces(case),
            Some(axis) => {
                let mut gravity = [0.0; 3];
                gravity[axis] = size;
                self.weight(gravity)
            }
        };
        let (own, basis) = self.basis(&forces)?;
        let mut swept = Vec::new();
        for direction in directions() {
            let weights = weights(case, size, direction);
            let response = match &basis {
                Basis::Together(displacements, scales, judge) => judge.sum(
                    displacements,
                    std::array::from_fn(|n| weights[n] * scales[n]),
                ),
                Basis::Apart(responses) => self.sum(responses, &forces, &weights)?,
            };
            swept.push((direction, self.analysis(&response).summary));
        }
        Ok((own, Sweep { directions: swept }))
    }

    /// The analysis of the case, and the solutions of all that sums are made of.
    fn basis(&self, forces: Asked) -> Result<(Analysis, Basis), AnalysisError> {
        if self.fits_together() {
            let solved = self.solve_together(forces)?;
            let judge = self.judge(&solved, forces)?;
            let own = self.analysis(&response(&solved, 0));
            let (solution, scales) = solved;
            let basis = Basis::Together(solution.displacement, scales, Box::new(judge));
            return Ok((own, basis));
        }
        let mesh = &self.inverse.mesh;
        let (voxels, nodes) = (mesh.elements.len(), mesh.nodes.len());
        self.limit
            .check_sweep(voxels, nodes, self.inverse.factor_bytes())?;
        let responses: Result<Vec<Response>, AnalysisError> =
            (0..TOGETHER).map(|n| self.solve(&|| forces(n))).collect();
        let responses = responses?;
        Ok((self.analysis(&responses[0]), Basis::Apart(responses)))
    }

    fn judge(&self, (solution, scales): &Solved, forces: Asked) -> Result<Judge, AnalysisError> {
        let load = self.packed(forces, scales)?;
        let iterations = solution.qualities.iter().map(|q| q.iterations).max();
        Ok(Judge {
            forces: products(&load, &load),
            work: products(&load, &solution.displacement),
            residuals: products(&solution.residual, &solution.residual),
            energy: products(&solution.residual, &solution.error),
            iterations: iterations.unwrap_or(0),
        })
    }

    /// The sum of responses, each times its weight, with a residual and an error that are worked out anew.
    fn sum(
        &self,
        responses: &[Response],
        forces: Asked,
        weights: &[f64; TOGETHER],
    ) -> Result<Response, AnalysisError> {
        let nodes = self.inverse.mesh.nodes.len();
        let zero = || vec![[0.0; 4]; nodes];
        let (mut load, mut displacement): (Forces, Vec<Quad<f64>>) = (zero(), zero());
        for (n, (weight, response)) in weights.iter().zip(responses).enumerate() {
            add(&mut load, *weight, &forces(n)?);
            add(
                &mut displacement,
                weight * response.scale,
                &response.displacement,
            );
        }
        let scale = norm(&load);
        if scale > 0.0 {
            for x in [&mut load, &mut displacement] {
                x.iter_mut().flatten().for_each(|x| *x /= scale);
            }
        }
        let (mut rest, mut error) = (zero(), zero());
        self.inverse.residual(&load, &displacement, &mut rest);
        self.inverse
            .apply(&rest, &mut error, &mut Workspace::new(nodes));
        let iterations = responses.iter().map(|r| r.quality.iterations).max();
        let lengths = [
            dot(&load, &displacement),
            dot(&rest, &rest),
            dot(&rest, &error),
        ];
        Ok(Response {
            displacement,
            quality: quality(lengths, iterations.unwrap_or(0)),
            scale,
        })
    }
}

impl Judge {
    /// The sum of responses under forces of the length one, each times its weight.
    fn sum(&self, displacements: &Fours, weights: [f64; TOGETHER]) -> Response {
        let scale = weighted_product(&self.forces, &weights).max(0.0).sqrt();
        let unit = match scale {
            0.0 => [0.0; TOGETHER],
            scale => weights.map(|weight| weight / scale),
        };
        let lengths = [&self.work, &self.residuals, &self.energy]
            .map(|products| weighted_product(products, &unit));
        Response {
            displacement: weighted(displacements, &unit),
            quality: quality(lengths, self.iterations),
            scale,
        }
    }
}

/// The quality of a displacement under forces of the length one, by the work of the forces, the square of the
/// residual, and the square of the error in the energy norm.
fn quality([work, residual, energy]: [f64; 3], iterations: usize) -> Quality {
    if work <= 0.0 {
        return Quality::default();
    }
    Quality {
        iterations,
        work,
        residual: residual.max(0.0).sqrt(),
        energy_error: (energy / work).abs().sqrt(),
    }
}

/// How much of the case and of gravity along each axis a direction takes: the case's own gravity is taken away
/// again, or all of the case where there is nothing but gravity.
fn weights(case: &Case, size: f64, direction: [f64; 3]) -> [f64; TOGETHER] {
    let [x, y, z] = std::array::from_fn(|axis| match size {
        0.0 => 0.0,
        _ if case.loads.is_empty() => direction[axis],
        size => direction[axis] - case.gravity[axis] / size,
    });
    let own = if case.loads.is_empty() { 0.0 } else { 1.0 };
    [own, x, y, z]
}
