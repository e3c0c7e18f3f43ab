//! One voxel as a finite element: the trilinear hexahedron with 2 × 2 × 2 integration points, of side
//! one and Young's modulus one. How elements meet at nodes is not known here.
//!
//! The corner `4x + 2y + z` of an element lies at x, y and z of 0 or 1. In the basis 1, x, y, z, xy, yz,
//! xz, xyz with x, y, z of -1 or 1 at the corners, which a Walsh–Hadamard transform reaches with
//! additions alone, the 24 × 24 stiffness matrix is almost diagonal: the strain energy couples the
//! linear terms only with one another, the bilinear terms only in pairs, and the last term with
//! nothing. A product takes about 200 operations instead of 1,152.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// A number of single or double precision.
pub(super) trait Real:
    Copy
    + Send
    + Sync
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + AddAssign
    + SubAssign
    + 'static
{
    /// The nearest to `x`.
    fn of(x: f64) -> Self;
}

impl Real for f32 {
    #[inline(always)]
    fn of(x: f64) -> f32 {
        x as f32
    }
}

impl Real for f64 {
    #[inline(always)]
    fn of(x: f64) -> f64 {
        x
    }
}

/// A vector of space and a zero, so that it fills a register.
pub(super) type Quad<T> = [T; 4];

/// A vector at each corner of an element.
pub(super) type Corners<T> = [Quad<T>; 8];

/// The stiffness of an element in the basis described above: Lamé's constants, divided by what the
/// two transforms and the integration of the basis contribute.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness<T> {
    lambda: T,
    mu: T,
    lambda_third: T,
    mu_third: T,
    trilinear: T,
}

impl<T: Real> Stiffness<T> {
    /// The stiffness for a Poisson's ratio between -1 and 0.5, exclusive.
    pub(super) fn new(poisson_ratio: f64) -> Stiffness<T> {
        let (lambda, mu) = lame(poisson_ratio);
        let (lambda, mu) = (lambda / 16.0, mu / 16.0);
        Stiffness {
            lambda: T::of(lambda),
            mu: T::of(mu),
            lambda_third: T::of(lambda / 3.0),
            mu_third: T::of(mu / 3.0),
            trilinear: T::of((lambda + 4.0 * mu) / 9.0),
        }
    }

    /// The forces at the corners that hold these displacements.
    #[inline(always)]
    pub(super) fn forces(&self, mut u: Corners<T>) -> Corners<T> {
        hadamard(&mut u);
        let Stiffness { lambda, mu, .. } = *self;
        let zero = T::default();
        let (x, y, z) = (u[4], u[2], u[1]);
        let trace = lambda * (x[0] + y[1] + z[2]);
        let (xy, xz, yz) = (mu * (x[1] + y[0]), mu * (x[2] + z[0]), mu * (y[2] + z[1]));
        u[0] = [zero; 4];
        u[4] = [trace + (mu + mu) * x[0], xy, xz, zero];
        u[2] = [xy, trace + (mu + mu) * y[1], yz, zero];
        u[1] = [xz, yz, trace + (mu + mu) * z[2], zero];
        self.bilinear(&mut u);
        u[7] = u[7].map(|x| self.trilinear * x);
        hadamard_transposed(&mut u);
        u
    }

    /// The part of [`Stiffness::forces`] on the terms xy, yz and xz.
    #[inline(always)]
    fn bilinear(&self, u: &mut Corners<T>) {
        let (l, m) = (self.lambda_third, self.mu_third);
        let zero = T::default();
        let (xy, yz, xz) = (u[6], u[3], u[5]);
        let (tx, ty, tz) = (
            l * (xy[1] + xz[2]),
            l * (xy[0] + yz[2]),
            l * (xz[0] + yz[1]),
        );
        let (sx, sy, sz) = (
            m * (xy[2] + xz[1]),
            m * (xy[2] + yz[0]),
            m * (xz[1] + yz[0]),
        );
        let k = m + m + m;
        u[6] = [k * xy[0] + ty, k * xy[1] + tx, sx + sy, zero];
        u[5] = [k * xz[0] + tz, sx + sz, k * xz[2] + tx, zero];
        u[3] = [sy + sz, k * yz[1] + tz, k * yz[2] + ty, zero];
    }
}

/// Lamé's constants λ and μ for Young's modulus one.
pub(super) fn lame(poisson_ratio: f64) -> (f64, f64) {
    let nu = poisson_ratio;
    (nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu))
}

/// The gradient of a displacement at the middle of an element: `g[i][k]` is the derivative of
/// component i along axis k.
pub(super) fn gradient(mut u: Corners<f64>) -> [[f64; 3]; 3] {
    hadamard(&mut u);
    [0, 1, 2].map(|i| [u[4][i], u[2][i], u[1][i]].map(|sum| sum / 4.0))
}

/// Sums and differences of the corners along x, y and z.
#[inline(always)]
fn hadamard<T: Real>(u: &mut Corners<T>) {
    for (a, b) in PAIRS {
        let (low, high) = (u[a], u[b]);
        u[a] = std::array::from_fn(|k| low[k] + high[k]);
        u[b] = std::array::from_fn(|k| high[k] - low[k]);
    }
}

/// The transposed matrix of [`hadamard`].
#[inline(always)]
fn hadamard_transposed<T: Real>(u: &mut Corners<T>) {
    for (a, b) in PAIRS {
        let (low, high) = (u[a], u[b]);
        u[a] = std::array::from_fn(|k| low[k] - high[k]);
        u[b] = std::array::from_fn(|k| low[k] + high[k]);
    }
}

/// The edges along x, then along y, then along z, each from its low corner to its high one.
const PAIRS: [(usize, usize); 12] = [
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
    (0, 2),
    (1, 3),
    (4, 6),
    (5, 7),
    (0, 1),
    (2, 3),
    (4, 5),
    (6, 7),
];
