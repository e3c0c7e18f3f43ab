//! One step of two levels: smooth, correct on the coarse space, smooth.

use rayon::prelude::*;

use super::block::{Block, Diagonal, times};
use super::coarse::Coarse;
use super::element::Stiffness;
use super::error::AnalysisError;
use super::memory::MemoryLimit;
use super::mesh::Mesh;
use super::number::{Columns, Real};
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
    poisson_ratio: f64,
    diagonal: Diagonal,
    single_inverse: Vec<Block<f32>>,
    coarse: Coarse,
}

/// Vectors that are written anew in each step.
pub(super) struct Workspace<T: Columns, const D: usize> {
    first: Vec<[T; D]>,
    second: Vec<[T; D]>,
    third: Vec<[T; D]>,
    single: SinglePair<T, D>,
}

/// Two vectors of single precision.
type SinglePair<T, const D: usize> = [Vec<[<T as Columns>::Single; D]>; 2];

impl<T: Columns, const D: usize> Workspace<T, D> {
    pub(super) fn new(nodes: usize) -> Workspace<T, D> {
        let double = || vec![[T::default(); D]; nodes];
        Workspace {
            first: double(),
            second: double(),
            third: double(),
            single: std::array::from_fn(|_| vec![[T::Single::default(); D]; nodes]),
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
        let stiffness = Stiffness::<f64>::new(poisson_ratio);
        let diagonal = Diagonal::new(&stiffness);
        let single = |block: &Block<f64>| block.map(|row| row.map(|x| x as f32));
        Ok(Preconditioner {
            coarse: Coarse::new(&mesh, &stiffness, &diagonal, limit)?,
            mesh,
            poisson_ratio,
            single_inverse: diagonal.inverse.iter().map(single).collect(),
            diagonal,
        })
    }

    /// The stiffness of an element.
    pub(super) fn stiffness<T: Real>(&self) -> Stiffness<T> {
        Stiffness::new(self.poisson_ratio)
    }

    /// How many bytes the factor of the coarse matrix takes.
    pub(super) fn factor_bytes(&self) -> u64 {
        self.coarse.factor_bytes()
    }

    /// An approximate solution for the residual `r`, into `z`.
    ///
    /// Motions are smoothed by one Jacobi step on their way down and up, as they are in the coarse
    /// matrix: otherwise the step would not be symmetric.
    pub(super) fn apply<T: Columns, const D: usize>(
        &self,
        r: &[[T; D]],
        z: &mut [[T; D]],
        work: &mut Workspace<T, D>,
    ) {
        let Workspace {
            first,
            second,
            third,
            single,
        } = work;
        let stiffness = self.stiffness();
        let omega = self.coarse.omega;
        z.par_chunks_mut(CHUNK)
            .for_each(|chunk| chunk.fill([T::default(); D]));
        self.smooth(r, z, single);
        self.residual(r, z, first);
        // Down: (1 - ω A D⁻¹) of the residual.
        self.divide(first, third, |out, divided| *out = scaled(divided, omega));
        self.residual(first, third, second);
        self.coarse.correct(&self.mesh, second, third);
        // Up: (1 - ω D⁻¹ A) of the motion, of which `third` has the motion itself.
        self.mesh.apply(&stiffness, third, second);
        self.divide(second, third, |out, divided| {
            subtract(out, scaled(divided, omega))
        });
        self.mesh.subtract(&stiffness, third, first);
        add(z, T::of(1.0), third);
        self.smooth(first, z, single);
    }

    /// `r - A x`, into `out`.
    pub(super) fn residual<T: Columns, const D: usize>(
        &self,
        r: &[[T; D]],
        x: &[[T; D]],
        out: &mut [[T; D]],
    ) {
        update(out, r, |out, r| *out = *r);
        self.mesh.subtract(&self.stiffness(), x, out);
    }

    /// Gives `x` divided by the diagonal, or by more, to `take`, beside the elements of `out`: that of a node is taken as
    /// if all elements around it had the greatest weight that one of them has. So the bound of the eigenvalues holds.
    fn divide<T: Columns, const D: usize>(
        &self,
        x: &[[T; D]],
        out: &mut [[T; D]],
        take: impl Fn(&mut [T; D], [T; D]) + Sync,
    ) {
        let inverse = &self.diagonal.inverse;
        let mesh = &self.mesh;
        let read = mesh
            .patterns
            .par_chunks(CHUNK)
            .zip(mesh.lightness.par_chunks(CHUNK))
            .zip(x.par_chunks(CHUNK));
        let chunks = out.par_chunks_mut(CHUNK).zip(read);
        chunks.for_each(|(out, ((patterns, lightness), x))| {
            for (i, out) in out.iter_mut().enumerate() {
                let divided = times(&inverse[patterns[i] as usize], x[i]);
                take(out, scaled(divided, f64::from(lightness[i])));
            }
        });
    }

    /// A Chebyshev polynomial of D⁻¹ A, times D⁻¹ r, added to `z` (Adams, Brezina, Hu, Tuminaro 2003). Its steps are
    /// in single precision: half the memory to read.
    fn smooth<T: Columns, const D: usize>(
        &self,
        r: &[[T; D]],
        z: &mut [[T; D]],
        work: &mut SinglePair<T, D>,
    ) {
        let [rest, step] = work;
        let stiffness = self.stiffness();
        let high = self.diagonal.largest_eigenvalue;
        let low = high / RANGE;
        let (middle, half) = ((high + low) / 2.0, (high - low) / 2.0);
        update(rest, r, |rest, r| *rest = r.map(T::single));
        self.advance(z, step, rest, [0.0, (1.0 / middle) as f32]);
        let mut rho = half / middle;
        for _ in 1..DEGREE {
            self.mesh.subtract(&stiffness, step, rest);
            let next = 1.0 / (2.0 * middle / half - rho);
            let weights = [(next * rho) as f32, (2.0 * next / half) as f32];
            self.advance(z, step, rest, weights);
            rho = next;
        }
    }

    /// `step = a·step + b·D⁻¹·rest`, then `z + step` into `z`.
    fn advance<T: Columns, const D: usize>(
        &self,
        z: &mut [[T; D]],
        step: &mut [[T::Single; D]],
        rest: &[[T::Single; D]],
        [a, b]: [f32; 2],
    ) {
        let read = rest
            .par_chunks(CHUNK)
            .zip(self.mesh.patterns.par_chunks(CHUNK))
            .zip(self.mesh.lightness.par_chunks(CHUNK));
        let written = z.par_chunks_mut(CHUNK).zip(step.par_chunks_mut(CHUNK));
        written
            .zip(read)
            .for_each(|((z, step), ((rest, patterns), lightness))| {
                for i in 0..z.len() {
                    let scaled = times(&self.single_inverse[patterns[i] as usize], rest[i]);
                    for k in 0..D {
                        step[i][k] = step[i][k].scaled(a) + scaled[k].scaled(b * lightness[i]);
                        z[i][k] += T::double(step[i][k]);
                    }
                }
            });
    }
}

/// `x` times a number.
fn scaled<T: Columns, const D: usize>(x: [T; D], by: f64) -> [T; D] {
    x.map(|part| part.scaled(by))
}

/// `x` without `y`, into `x`.
fn subtract<T: Columns, const D: usize>(x: &mut [T; D], y: [T; D]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x -= y;
    }
}
