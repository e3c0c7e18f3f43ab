//! One voxel as a finite element: the trilinear hexahedron with 2 × 2 × 2 integration points, of side
//! one and Young's modulus one. How elements meet at nodes is not known here.
//!
//! The corner `4x + 2y + z` of an element lies at x, y and z of 0 or 1. In the basis 1, x, y, z, xy, yz,
//! xz, xyz with x, y, z of -1 or 1 at the corners, which a Walsh–Hadamard transform reaches with
//! additions alone, the 24 × 24 stiffness matrix is almost diagonal: the strain energy couples the
//! linear terms only with one another, the bilinear terms only in pairs, and the last term with
//! nothing. A product takes about 200 operations instead of 1,152.

use super::number::Real;

/// A vector of space and a zero, so that it fills a register.
pub(super) type Quad<T> = [T; 4];

/// A vector at each corner of an element. Of its `D` numbers only the first three are not zero.
pub(super) type Corners<T, const D: usize = 4> = [[T; D]; 8];

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
    pub(super) fn forces<const D: usize>(&self, mut u: Corners<T, D>) -> Corners<T, D> {
        hadamard(&mut u);
        let Stiffness { lambda, mu, .. } = *self;
        let (x, y, z) = (u[4], u[2], u[1]);
        let trace = lambda * (x[0] + y[1] + z[2]);
        let (xy, xz, yz) = (mu * (x[1] + y[0]), mu * (x[2] + z[0]), mu * (y[2] + z[1]));
        u[0] = [T::default(); D];
        u[4] = vector([trace + (mu + mu) * x[0], xy, xz]);
        u[2] = vector([xy, trace + (mu + mu) * y[1], yz]);
        u[1] = vector([xz, yz, trace + (mu + mu) * z[2]]);
        self.bilinear(&mut u);
        u[7] = u[7].map(|x| self.trilinear * x);
        hadamard_transposed(&mut u);
        u
    }

    /// The part of [`Stiffness::forces`] on the terms xy, yz and xz.
    #[inline(always)]
    fn bilinear<const D: usize>(&self, u: &mut Corners<T, D>) {
        let (l, m) = (self.lambda_third, self.mu_third);
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
        u[6] = vector([k * xy[0] + ty, k * xy[1] + tx, sx + sy]);
        u[5] = vector([k * xz[0] + tz, sx + sz, k * xz[2] + tx]);
        u[3] = vector([sy + sz, k * yz[1] + tz, k * yz[2] + ty]);
    }
}

/// A vector of `D` numbers, zeros beyond the third.
#[inline(always)]
fn vector<T: Real, const D: usize>(three: [T; 3]) -> [T; D] {
    let mut all = [T::default(); D];
    all[..3].copy_from_slice(&three);
    all
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
fn hadamard<T: Real, const D: usize>(u: &mut Corners<T, D>) {
    for (a, b) in PAIRS {
        let (low, high) = (u[a], u[b]);
        u[a] = std::array::from_fn(|k| low[k] + high[k]);
        u[b] = std::array::from_fn(|k| high[k] - low[k]);
    }
}

/// The transposed matrix of [`hadamard`].
#[inline(always)]
fn hadamard_transposed<T: Real, const D: usize>(u: &mut Corners<T, D>) {
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
