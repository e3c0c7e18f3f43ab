//! Blocks of 3 × 3 on vectors of four numbers, and the blocks on the diagonal of the stiffness matrix.

use super::element::{Corners, Quad, Stiffness};
use super::number::Real;

/// A matrix of 3 × 3, filled up with zeros.
pub(super) type Block<T> = [Quad<T>; 4];

/// What the smoother divides by: the blocks of nodes on the diagonal.
///
/// A block depends only on which of the eight elements around a node are there, so there are 256.
pub(super) struct Diagonal {
    /// The inverse block of each pattern of elements; bit c is set when the node is corner c of one.
    pub(super) inverse: Vec<Block<f64>>,
    /// An upper bound of the eigenvalues of the inverse diagonal times the matrix: that of one
    /// element, since the quotient of sums is at most the largest quotient (Wathen 1987).
    pub(super) largest_eigenvalue: f64,
}

impl Diagonal {
    /// The diagonal for elements of this stiffness.
    pub(super) fn new(stiffness: &Stiffness<f64>) -> Diagonal {
        let blocks: [[[f64; 3]; 3]; 8] = std::array::from_fn(|corner| own_block(stiffness, corner));
        let of_pattern = |pattern: usize| {
            let mut sum = [[0.0; 3]; 3];
            for block in (0..8).filter(|c| pattern >> c & 1 == 1).map(|c| blocks[c]) {
                for i in 0..3 {
                    for j in 0..3 {
                        sum[i][j] += block[i][j];
                    }
                }
            }
            inverse(sum)
        };
        let none = [[0.0; 4]; 4];
        let inverse = std::iter::once(none).chain((1..256).map(of_pattern));
        Diagonal {
            inverse: inverse.collect(),
            largest_eigenvalue: largest_eigenvalue(stiffness, &blocks),
        }
    }
}

/// The forces at a corner for displacements of that corner alone, transposed (it is symmetric).
fn own_block(stiffness: &Stiffness<f64>, corner: usize) -> [[f64; 3]; 3] {
    std::array::from_fn(|axis| {
        let mut u: Corners<f64> = [[0.0; 4]; 8];
        u[corner][axis] = 1.0;
        let [x, y, z, _] = stiffness.forces(u)[corner];
        [x, y, z]
    })
}

/// The largest eigenvalue of an element's inverse diagonal times its matrix, by the power method.
///
/// The other eigenvalues are far enough below for 500 steps to leave nothing of them.
fn largest_eigenvalue(stiffness: &Stiffness<f64>, blocks: &[[[f64; 3]; 3]; 8]) -> f64 {
    let inverses = blocks.map(inverse);
    // Some vector that no symmetry of the cube leaves unchanged.
    let some = |c: usize, step: usize, of: usize, less: f64| (c * step % of) as f64 - less;
    let mut u: Corners<f64> = std::array::from_fn(|c| {
        [
            some(c, 7, 5, 1.7),
            some(c, 3, 7, 2.9),
            some(c, 5, 11, 4.0),
            0.0,
        ]
    });
    let mut eigenvalue = 0.0;
    for _ in 0..500 {
        let forces = stiffness.forces(u);
        for c in 0..8 {
            u[c] = times(&inverses[c], forces[c]);
        }
        eigenvalue = u.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        u.iter_mut().flatten().for_each(|x| *x /= eigenvalue);
    }
    eigenvalue
}

/// The inverse of a regular matrix, by its cofactors.
fn inverse(d: [[f64; 3]; 3]) -> Block<f64> {
    let cofactor = |i: usize, j: usize| {
        let (a, b, e, f) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        d[a][e] * d[b][f] - d[a][f] * d[b][e]
    };
    let determinant: f64 = (0..3).map(|j| d[0][j] * cofactor(0, j)).sum();
    let mut inverse = [[0.0; 4]; 4];
    for (i, row) in inverse.iter_mut().take(3).enumerate() {
        for (j, value) in row.iter_mut().take(3).enumerate() {
            *value = cofactor(j, i) / determinant;
        }
    }
    inverse
}

/// A block times a vector.
#[inline(always)]
pub(super) fn times<T: Real, const D: usize>(block: &Block<T::Plain>, v: [T; D]) -> [T; D] {
    std::array::from_fn(|i| {
        let row = &block[i];
        v[0].scaled(row[0]) + v[1].scaled(row[1]) + v[2].scaled(row[2])
    })
}
