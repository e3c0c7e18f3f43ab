//! Several load cases of one body, four at a time: what a product reads of the body, and the factor of the coarse
//! matrix, are read once for all of them.

use rayon::prelude::*;

use super::analysis::Analysis;
use super::case::Case;
use super::conjugate_gradients::{Solution, solve};
use super::element::Quad;
use super::error::AnalysisError;
use super::model::{Forces, Model, Response, converged};
use super::number::Four;
use super::vector::{CHUNK, norm, update};

/// How many load cases are solved together.
pub(super) const TOGETHER: usize = 4;

/// Vectors of four load cases.
pub(super) type Fours = Vec<[Four<f64>; 3]>;

/// The solutions for four forces, each of the length one, and the lengths that they had.
pub(super) type Solved = (Solution<Four<f64>, 3>, [f64; TOGETHER]);

impl Model {
    /// Analyses load cases, several together as far as the memory allows.
    ///
    /// # Errors
    /// As [`Model::analyse`].
    pub fn analyse_all(&self, cases: &[Case]) -> Result<Vec<Analysis>, AnalysisError> {
        let mut found = Vec::new();
        for cases in cases.chunks(TOGETHER) {
            if cases.len() == 1 || !self.fits_together() {
                for case in cases {
                    found.push(self.analyse(case)?);
                }
                continue;
            }
            let forces = |n: usize| match cases.get(n) {
                Some(case) => self.forces(case),
                None => self.weight([0.0; 3]),
            };
            let solved = self.solve_together(&forces)?;
            let responses = (0..cases.len()).map(|n| response(&solved, n));
            found.extend(responses.map(|response| self.analysis(&response)));
        }
        Ok(found)
    }

    /// Whether the limit of memory allows to solve load cases together.
    pub(super) fn fits_together(&self) -> bool {
        let mesh = &self.inverse.mesh;
        let (voxels, nodes) = (mesh.elements.len(), mesh.nodes.len());
        self.limit
            .fits_together(voxels, nodes, self.inverse.factor_bytes())
    }

    /// The displacements under four forces, each divided by its length, and those lengths. Forces of zero move
    /// nothing.
    ///
    /// # Errors
    /// Those of `forces`, which are asked for several times, and equations that cannot be solved.
    pub(super) fn solve_together(
        &self,
        forces: &dyn Fn(usize) -> Result<Forces, AnalysisError>,
    ) -> Result<Solved, AnalysisError> {
        let mut scales = [0.0; TOGETHER];
        for (n, scale) in scales.iter_mut().enumerate() {
            *scale = norm(&forces(n)?);
        }
        let solution = solve(&self.inverse, &|| self.packed(forces, &scales))?;
        solution.qualities.iter().try_for_each(converged)?;
        Ok((solution, scales))
    }

    /// Four forces side by side, each divided by its length.
    pub(super) fn packed(
        &self,
        forces: &dyn Fn(usize) -> Result<Forces, AnalysisError>,
        scales: &[f64; TOGETHER],
    ) -> Result<Fours, AnalysisError> {
        let mut packed = vec![[Four::default(); 3]; self.inverse.mesh.nodes.len()];
        let moving = (0..TOGETHER).filter(|n| scales[*n] != 0.0);
        for n in moving {
            update(&mut packed, &forces(n)?, |all, own| {
                (0..3).for_each(|k| all[k].0[n] = own[k] / scales[n]);
            });
        }
        Ok(packed)
    }
}

/// What one of four forces does.
pub(super) fn response((solution, scales): &Solved, n: usize) -> Response {
    let mut displacement = vec![[0.0; 4]; solution.displacement.len()];
    update(&mut displacement, &solution.displacement, |own, all| {
        (0..3).for_each(|k| own[k] = all[k].0[n]);
    });
    Response {
        displacement,
        quality: solution.qualities[n],
        scale: scales[n],
    }
}

/// The sum of four vectors, each times its weight.
pub(super) fn weighted(vectors: &Fours, weights: &[f64; TOGETHER]) -> Vec<Quad<f64>> {
    let mut sum = vec![[0.0; 4]; vectors.len()];
    update(&mut sum, vectors, |sum, all| {
        for k in 0..3 {
            sum[k] = (0..TOGETHER).map(|n| weights[n] * all[k].0[n]).sum();
        }
    });
    sum
}

/// The scalar products of each of four vectors with each of four others.
pub(super) type Products = [[f64; TOGETHER]; TOGETHER];

/// The scalar products of all pairs of columns. Chunks are summed by themselves, then added in order.
pub(super) fn products(a: &Fours, b: &Fours) -> Products {
    let chunks = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    let sum = |(a, b): (&[[Four<f64>; 3]], &[[Four<f64>; 3]])| {
        let mut sums = [[0.0; TOGETHER]; TOGETHER];
        for (p, q) in a.iter().zip(b) {
            for (i, row) in sums.iter_mut().enumerate() {
                for (j, sum) in row.iter_mut().enumerate() {
                    *sum += (0..3).map(|k| p[k].0[i] * q[k].0[j]).sum::<f64>();
                }
            }
        }
        sums
    };
    let parts: Vec<Products> = chunks.map(sum).collect();
    let mut all = [[0.0; TOGETHER]; TOGETHER];
    for part in parts {
        for (sum, value) in all.iter_mut().flatten().zip(part.iter().flatten()) {
            *sum += value;
        }
    }
    all
}

/// The scalar product of two weighted sums, by the products of their columns.
pub(super) fn weighted_product(products: &Products, weights: &[f64; TOGETHER]) -> f64 {
    let row = |i: usize| -> f64 {
        (0..TOGETHER)
            .map(|j| products[i][j] * weights[i] * weights[j])
            .sum()
    };
    (0..TOGETHER).map(row).sum()
}
