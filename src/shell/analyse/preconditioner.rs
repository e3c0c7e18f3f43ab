//! One step of two levels: smooth, correct on the coarse space, smooth.

use rayon::prelude::*;

use super::block::{Block, Diagonal, times};
use super::coarse::Coarse;
use super::element::{Quad, Stiffness};
use super::error::AnalysisError;
use super::memory::MemoryLimit;
use super::mesh::Mesh;
use super::vector::{CHUNK, add, update};

/// The degree of the Chebyshev polynomial. One more costs two products of single precision a step, and
/// saves fewer than they cost.
const DEGREE: usize = 3;

/// The smoother damps eigenvalues from the largest down to this part of it; the coarse space has
/// the rest. Wider ranges damp less.
const RANGE: f64 = 12.0;

/// An approximate inverse of the stiffness matrix: symmetric and positive definite, up to the last bits
/// of single precision.
pub(super) struct Preconditioner {
    pub(super) mesh: Mesh,
    pub(super) stiffness: Stiffness<f64>,
    single: Stiffness<f32>,
    diagonal: Diagonal,
    single_inverse: Vec<Block<f32>>,
    coarse: Coarse,
}

/// Vectors that are written anew in each step.
pub(super) struct Workspace {
    first: Vec<Quad<f64>>,
    second: Vec<Quad<f64>>,
    third: Vec<Quad<f64>>,
    single: [Vec<Quad<f32>>; 2],
}

impl Workspace {
    pub(super) fn new(nodes: usize) -> Workspace {
        let double = || vec![[0.0; 4]; nodes];
        Workspace {
            first: double(),
            second: double(),
            third: double(),
            single: std::array::from_fn(|_| vec![[0.0; 4]; nodes]),
        }
    }
}

impl Preconditioner {
    /// The preconditioner of a mesh without mechanisms.
    ///
    /// # Errors
    /// When it would not fit in memory, or the matrix is not positive definite.
    pub(super) fn new(
        mesh: Mesh,
        poisson_ratio: f64,
        limit: MemoryLimit,
    ) -> Result<Preconditioner, AnalysisError> {
        let stiffness = Stiffness::new(poisson_ratio);
        let diagonal = Diagonal::new(&stiffness);
        let single = |block: &Block<f64>| block.map(|row| row.map(|x| x as f32));
        Ok(Preconditioner {
            coarse: Coarse::new(&mesh, &stiffness, &diagonal, limit)?,
            mesh,
            stiffness,
            single: Stiffness::new(poisson_ratio),
            single_inverse: diagonal.inverse.iter().map(single).collect(),
            diagonal,
        })
    }

    /// An approximate solution for the residual `r`, into `z`.
    ///
    /// Motions are smoothed by one Jacobi step on their way down and up, as they are in the coarse
    /// matrix: otherwise the step would not be symmetric.
    pub(super) fn apply(&self, r: &[Quad<f64>], z: &mut [Quad<f64>], work: &mut Workspace) {
        let Workspace {
            first,
            second,
            third,
            single,
        } = work;
        let omega = self.coarse.omega;
        z.par_chunks_mut(CHUNK)
            .for_each(|chunk| chunk.fill([0.0; 4]));
        self.smooth(r, z, single);
        self.residual(r, z, first);
        // Down: (1 - ω A D⁻¹) of the residual.
        third.copy_from_slice(first);
        self.divide(third);
        self.mesh.apply(&self.stiffness, third, second);
        third.copy_from_slice(first);
        add(third, -omega, second);
        self.coarse.correct(&self.mesh, third, second);
        // Up: (1 - ω D⁻¹ A) of the motion, of which `second` has the motion itself.
        self.mesh.apply(&self.stiffness, second, third);
        self.divide(third);
        add(second, -omega, third);
        self.mesh.apply(&self.stiffness, second, third);
        add(first, -1.0, third);
        add(z, 1.0, second);
        self.smooth(first, z, single);
    }

    /// `r - A x`, into `out`.
    pub(super) fn residual(&self, r: &[Quad<f64>], x: &[Quad<f64>], out: &mut [Quad<f64>]) {
        self.mesh.apply(&self.stiffness, x, out);
        update(out, r, |out, r| {
            for k in 0..4 {
                out[k] = r[k] - out[k];
            }
        });
    }

    /// `x` divided by the diagonal.
    fn divide(&self, x: &mut [Quad<f64>]) {
        let inverse = &self.diagonal.inverse;
        update(x, &self.mesh.patterns, |x, p| {
            *x = times(&inverse[*p as usize], *x)
        });
    }

    /// A Chebyshev polynomial of D⁻¹ A, times D⁻¹ r, added to `z` (Adams, Brezina, Hu, Tuminaro 2003). Its steps are
    /// in single precision: half the memory to read.
    fn smooth(&self, r: &[Quad<f64>], z: &mut [Quad<f64>], work: &mut [Vec<Quad<f32>>; 2]) {
        let [rest, step] = work;
        let high = self.diagonal.largest_eigenvalue;
        let low = high / RANGE;
        let (middle, half) = ((high + low) / 2.0, (high - low) / 2.0);
        update(rest, r, |rest, r| *rest = r.map(|x| x as f32));
        self.advance(z, step, rest, [0.0, (1.0 / middle) as f32]);
        let mut rho = half / middle;
        for _ in 1..DEGREE {
            self.mesh.subtract(&self.single, step, rest);
            let next = 1.0 / (2.0 * middle / half - rho);
            let weights = [(next * rho) as f32, (2.0 * next / half) as f32];
            self.advance(z, step, rest, weights);
            rho = next;
        }
    }

    /// `step = a·step + b·D⁻¹·rest`, then `z + step` into `z`.
    fn advance(
        &self,
        z: &mut [Quad<f64>],
        step: &mut [Quad<f32>],
        rest: &[Quad<f32>],
        [a, b]: [f32; 2],
    ) {
        let read = rest
            .par_chunks(CHUNK)
            .zip(self.mesh.patterns.par_chunks(CHUNK));
        let written = z.par_chunks_mut(CHUNK).zip(step.par_chunks_mut(CHUNK));
        written.zip(read).for_each(|((z, step), (rest, patterns))| {
            for i in 0..z.len() {
                let scaled = times(&self.single_inverse[patterns[i] as usize], rest[i]);
                for k in 0..4 {
                    step[i][k] = a * step[i][k] + b * scaled[k];
                    z[i][k] += f64::from(step[i][k]);
                }
            }
        });
    }
}
