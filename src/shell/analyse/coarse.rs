//! The coarse space: six smoothed rigid motions a patch, solved directly.
//!
//! A thin shell is a surface, so the factor of its coarse matrix stays small, and one level is enough.
//! The factorization runs on one thread: its sums come in one order on a given processor.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, Par, Side};
use rayon::prelude::*;

use super::block::Diagonal;
use super::element::Stiffness;
use super::error::AnalysisError;
use super::galerkin::{CoarseBlock, Galerkin};
use super::memory::MemoryLimit;
use super::mesh::{Mesh, NONE};
use super::number::Columns;
use super::patches::Patches;
use super::rigid::{Motion, RigidBasis};
use super::vector::CHUNK;

/// Half the widths of patches, in voxels: the least for which the factor fits is taken. Smaller patches
/// take fewer iterations and a larger factor. On a thin shell the first always fits; solid bodies of
/// millions of voxels, whose patches are coupled in three directions, need the others.
const RADII: [f64; 3] = [4.5, 7.0, 11.0];

/// The coarse space of a mesh, with its factor.
pub(super) struct Coarse {
    patches: Patches,
    bases: Vec<RigidBasis>,
    /// The step by which rigid motions are smoothed.
    pub(super) omega: f64,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

/// The lower half of a matrix by columns.
struct Lower {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Coarse {
    /// The coarse space of a mesh without mechanisms.
    ///
    /// # Errors
    /// When no factor would fit, or the matrix is not positive definite.
    pub(super) fn new(
        mesh: &Mesh,
        stiffness: &Stiffness<f64>,
        diagonal: &Diagonal,
        limit: MemoryLimit,
    ) -> Result<Coarse, AnalysisError> {
        let mut coarse = Err(AnalysisError::Empty);
        for radius in RADII {
            coarse = Coarse::of_patches(radius, mesh, stiffness, diagonal, limit);
            if !matches!(coarse, Err(AnalysisError::TooLarge { .. })) {
                break;
            }
        }
        coarse
    }

    fn of_patches(
        radius: f64,
        mesh: &Mesh,
        stiffness: &Stiffness<f64>,
        diagonal: &Diagonal,
        limit: MemoryLimit,
    ) -> Result<Coarse, AnalysisError> {
        let patches = Patches::grow(mesh, radius);
        let basis = |patch: usize| {
            let nodes = patches.nodes(patch).iter();
            RigidBasis::new(nodes.map(|node| mesh.nodes[*node as usize]))
        };
        let bases: Vec<RigidBasis> = (0..patches.len()).into_par_iter().map(basis).collect();
        // The best step of one damped Jacobi iteration on the upper half of the spectrum.
        let omega = 4.0 / 3.0 / diagonal.largest_eigenvalue;
        let galerkin = Galerkin {
            mesh,
            stiffness,
            diagonal,
            patches: &patches,
            bases: &bases,
            omega,
        };
        let lower = Lower::new(galerkin.columns(), &bases);
        let symbolic = lower.analyse()?;
        let (voxels, nodes) = (mesh.elements.len(), mesh.nodes.len());
        limit.check_factor(voxels, nodes, symbolic.len_val() as u64)?;
        Ok(Coarse {
            values: lower.factor(&symbolic)?,
            symbolic,
            patches,
            bases,
            omega,
        })
    }

    /// How many bytes the factor takes.
    pub(super) fn factor_bytes(&self) -> u64 {
        self.values.len() as u64 * 8
    }

    /// Solves for the motions that balance the residual `r`, and gives what they move the nodes by
    /// into `out`.
    pub(super) fn correct<T: Columns, const D: usize>(
        &self,
        mesh: &Mesh,
        r: &[[T; D]],
        out: &mut [[T; D]],
    ) {
        let products: Vec<Motion<T>> = (0..self.bases.len())
            .into_par_iter()
            .map(|patch| {
                let (basis, mut sums) = (&self.bases[patch], [T::default(); 6]);
                for node in self.patches.nodes(patch) {
                    let node = *node as usize;
                    basis.add_products(mesh.nodes[node], r[node], &mut sums);
                }
                basis.of_plain(&sums)
            })
            .collect();
        let motions = self.solve(&products);
        let chunks = out.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, out)| {
            for (i, out) in out.iter_mut().enumerate() {
                let node = chunk * CHUNK + i;
                let patch = self.patches.of_node[node];
                *out = if patch == NONE {
                    [T::default(); D]
                } else {
                    let patch = patch as usize;
                    self.bases[patch].moved(mesh.nodes[node], &motions[patch])
                };
            }
        });
    }

    /// The solution, as combinations of plain motions. The factor is read once for all columns.
    fn solve<T: Columns>(&self, products: &[Motion<T>]) -> Vec<Motion<T>> {
        let mut x = Mat::from_fn(6 * products.len(), T::COUNT, |i, column| {
            products[i / 6][i % 6].column(column)
        });
        let scratch = self
            .symbolic
            .solve_in_place_scratch::<f64>(T::COUNT, Par::Seq);
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            x.as_mut(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        let of_patch = |(patch, basis): (usize, &RigidBasis)| {
            let at = |j: usize| T::of_columns(|column| x[(6 * patch + j, column)]);
            basis.to_plain(&std::array::from_fn(at))
        };
        self.bases.iter().enumerate().map(of_patch).collect()
    }
}

impl Lower {
    /// Puts the blocks together. Motions that a patch does not have are held by a one on the diagonal.
    fn new(columns: Vec<Vec<(u32, CoarseBlock)>>, bases: &[RigidBasis]) -> Lower {
        let mut lower = Lower {
            starts: vec![0],
            rows: Vec::new(),
            values: Vec::new(),
        };
        for (patch, blocks) in columns.iter().enumerate() {
            for j in 0..6 {
                for (row, block) in blocks {
                    let row = *row as usize;
                    let first = if row == patch { j } else { 0 };
                    for (k, couplings) in block.iter().enumerate().skip(first) {
                        let is_diagonal = row == patch && k == j;
                        let is_void = is_diagonal && bases[patch].is_void(j);
                        let value = if is_void { 1.0 } else { couplings[j] };
                        if value != 0.0 || is_diagonal {
                            lower.rows.push(row * 6 + k);
                            lower.values.push(value);
                        }
                    }
                }
                lower.starts.push(lower.rows.len());
            }
        }
        lower
    }

    fn structure(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let size = self.starts.len() - 1;
        SymbolicSparseColMatRef::new_checked(size, size, &self.starts, None, &self.rows)
    }

    fn analyse(&self) -> Result<SymbolicCholesky<usize>, AnalysisError> {
        let structure = self.structure();
        factorize_symbolic_cholesky(
            structure,
            Side::Lower,
            Default::default(),
            Default::default(),
        )
        .map_err(|_| AnalysisError::OutOfMemory)
    }

    fn factor(&self, symbolic: &SymbolicCholesky<usize>) -> Result<Vec<f64>, AnalysisError> {
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut buffer = MemBuffer::try_new(scratch).map_err(|_| AnalysisError::OutOfMemory)?;
        let mut values = vec![0.0; symbolic.len_val()];
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(self.structure(), &self.values),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut buffer),
                Default::default(),
            )
            .map_err(|_| AnalysisError::NotDefinite)?;
        Ok(values)
    }
}
