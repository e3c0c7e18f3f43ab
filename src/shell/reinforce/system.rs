//! A sparse system of equations some of whose members change their stiffness from one solution to the next:
//! assembled once, filled again in place (S11). What the members are is not known here.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat, SymbolicSparseColMatRef};
use nalgebra::{DMatrix, DVector};
use nalgebra_sparse::{CooMatrix, CscMatrix};

/// The unknown of what does not move.
pub(super) const FIXED: u32 = u32::MAX;

/// Parts of the greatest stiffness that are lent to all unknowns where they are needed.
const LENT: [f64; 3] = [1e-9, 1e-7, 1e-5];

/// The part of the work that lent stiffness may do.
const MOST_LENT: f64 = 0.1;

/// A part of the body as the system sees it.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// The unknown of each of its rows, or [`FIXED`].
    pub unknowns: Vec<u32>,
    /// Its symmetric stiffness.
    pub stiffness: DMatrix<f64>,
}

/// A positive definite system, of which only the lower triangle is kept.
pub(super) struct System {
    matrix: CscMatrix<f64>,
    /// What the members that never change give for each value of the matrix.
    base: Vec<f64>,
    /// The entries of all members that change, one member after the other, and where each goes.
    entries: Vec<f64>,
    places: Vec<u32>,
    /// Where the entries of each member end.
    ends: Vec<usize>,
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicLlt<usize>,
}

/// An unknown that nothing holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Loose {
    /// Its number.
    pub unknown: usize,
}

/// The entries of a member in the lower triangle: row, column, value.
fn entries(member: &Member) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    let columns = member.unknowns.iter().enumerate();
    columns
        .filter(|(_, c)| **c != FIXED)
        .flat_map(move |(j, c)| {
            let rows = member.unknowns.iter().enumerate();
            rows.filter(move |(_, r)| **r != FIXED && **r >= *c)
                .map(move |(i, r)| (*r as usize, *c as usize, member.stiffness[(i, j)]))
        })
}

/// The matrix of members by triplets, each with its factor: what a refill must agree with.
pub(super) fn assemble<'a>(
    unknowns: usize,
    members: impl Iterator<Item = (&'a Member, f64)>,
) -> CscMatrix<f64> {
    let mut triplets = CooMatrix::new(unknowns, unknowns);
    for (member, factor) in members {
        for (row, column, value) in entries(member) {
            triplets.push(row, column, value * factor);
        }
    }
    CscMatrix::from(&triplets)
}

impl System {
    /// The system of members that stay and members that change.
    ///
    /// # Errors
    /// When its pattern cannot be ordered, which means that memory is short.
    pub fn new(unknowns: usize, stay: &[Member], change: &[Member]) -> Result<System, Loose> {
        let members = stay.iter().chain(change);
        let matrix = assemble(unknowns, members.map(|member| (member, 1.0)));
        let place = |row: usize, column: usize| {
            let begin = matrix.col_offsets()[column];
            let rows = &matrix.row_indices()[begin..matrix.col_offsets()[column + 1]];
            begin
                + rows
                    .binary_search(&row)
                    .expect("the pattern holds all entries")
        };
        let mut base = vec![0.0; matrix.nnz()];
        for (row, column, value) in stay.iter().flat_map(entries) {
            base[place(row, column)] += value;
        }
        let (mut values, mut places, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        for member in change {
            for (row, column, value) in entries(member) {
                values.push(value);
                places.push(place(row, column) as u32);
            }
            ends.push(values.len());
        }
        let (columns, rows) = (matrix.col_offsets(), matrix.row_indices());
        let pattern = SymbolicSparseColMatRef::new_checked(unknowns, unknowns, columns, None, rows);
        let pattern = pattern.to_owned().map_err(|_| Loose { unknown: 0 })?;
        let symbolic = SymbolicLlt::try_new(pattern.as_ref(), faer::Side::Lower);
        Ok(System {
            symbolic: symbolic.map_err(|_| Loose { unknown: 0 })?,
            pattern,
            base,
            entries: values,
            places,
            ends,
            matrix,
        })
    }

    /// Gives each member that changes its factor.
    pub fn refill(&mut self, factors: &[f64]) {
        let values = self.matrix.values_mut();
        values.copy_from_slice(&self.base);
        let mut begin = 0;
        for (end, factor) in self.ends.iter().zip(factors) {
            let entries = self.entries[begin..*end].iter();
            for (entry, place) in entries.zip(&self.places[begin..*end]) {
                values[*place as usize] += factor * entry;
            }
            begin = *end;
        }
    }

    /// The displacements under `load`, by the order of elimination found once. Beams about a sharp edge of
    /// the surface can be turned inside out, which makes the matrix indefinite: it is then lent the least
    /// stiffness that will do, from a few steps.
    ///
    /// # Errors
    /// When that does not make it positive definite either.
    pub fn solve(&self, load: &DVector<f64>) -> Result<DVector<f64>, Loose> {
        let solution = self.factor_and_solve(self.matrix.values(), load);
        // What is loose hangs by the lent stiffness alone, which then does most of the work.
        let holds = |part: f64, u: &DVector<f64>| {
            part * self.greatest() * u.norm_squared() <= MOST_LENT * load.dot(u)
        };
        let lent = || {
            LENT.iter().find_map(|part| {
                let solution = self.factor_and_solve(&self.lent(*part), load);
                solution.filter(|u| holds(*part, u))
            })
        };
        solution.or_else(lent).ok_or_else(|| self.loosest())
    }

    fn greatest(&self) -> f64 {
        self.matrix
            .values()
            .iter()
            .fold(0.0, |a: f64, b| a.max(b.abs()))
    }

    /// The values with a part of the greatest added to the diagonal.
    fn lent(&self, part: f64) -> Vec<f64> {
        let (mut values, greatest) = (self.matrix.values().to_vec(), self.greatest());
        let columns = self.matrix.col_offsets();
        // In a lower triangle each column begins with its diagonal.
        for begin in &columns[..columns.len() - 1] {
            values[*begin] += part * greatest;
        }
        values
    }

    fn factor_and_solve(&self, values: &[f64], load: &DVector<f64>) -> Option<DVector<f64>> {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        let symbolic = self.symbolic.clone();
        let factor = Llt::try_new_with_symbolic(symbolic, matrix, faer::Side::Lower).ok()?;
        let mut solution = faer::Mat::from_fn(load.len(), 1, |i, _| load[i]);
        factor.solve_in_place(&mut solution);
        let solution = DVector::from_fn(load.len(), |i, _| solution[(i, 0)]);
        solution.iter().all(|u| u.is_finite()).then_some(solution)
    }

    /// The unknown that moves most under a load on all when a little stiffness is lent to each. The pivot at
    /// which a factorization breaks off says less: it is where the order of elimination happens to end.
    fn loosest(&self) -> Loose {
        let values = self.lent(1e-9);
        let columns = self.matrix.col_offsets();
        let load = DVector::from_element(columns.len() - 1, 1.0);
        let solution = self.factor_and_solve(&values, &load);
        Loose {
            unknown: solution.map_or(0, |u| u.iamax()),
        }
    }

    /// The matrix as it is filled now: its lower triangle.
    #[cfg(test)]
    pub fn matrix(&self) -> &CscMatrix<f64> {
        &self.matrix
    }
}
