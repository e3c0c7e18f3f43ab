//! The stiffness matrix of a body times a vector, without the matrix.

use rayon::prelude::*;

use super::element::{Quad, Real, Stiffness};
use super::mesh::{Mesh, Slab};
use super::vector::CHUNK;

impl Mesh {
    /// The forces at the nodes that hold the displacements `x`, into `y`; zero at clamped nodes. `x` must be
    /// zero there.
    pub(super) fn apply<T: Real>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[Quad<T>],
        y: &mut [Quad<T>],
    ) {
        y.par_chunks_mut(CHUNK)
            .for_each(|chunk| chunk.fill([T::default(); 4]));
        self.sum::<T, false>(stiffness, x, y);
    }

    /// As [`Mesh::apply`], but takes the forces away from what is in `y`.
    pub(super) fn subtract<T: Real>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[Quad<T>],
        y: &mut [Quad<T>],
    ) {
        self.sum::<T, true>(stiffness, x, y);
    }

    /// Adds the forces to `y`, or takes them away.
    ///
    /// Even slabs write to parts of `y` that do not overlap, then odd ones add theirs: parallel
    /// without locks, and in one order of sums.
    fn sum<T: Real, const IS_LESS: bool>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[Quad<T>],
        y: &mut [Quad<T>],
    ) {
        for parity in 0..2 {
            let (mut rest, mut at, mut jobs) = (&mut *y, 0, Vec::new());
            for slab in self.slabs.iter().skip(parity).step_by(2) {
                let (begin, end) = slab.nodes;
                let (part, tail) = rest.split_at_mut(end - at);
                jobs.push((slab, part.split_at_mut(begin - at).1));
                (rest, at) = (tail, end);
            }
            jobs.into_par_iter()
                .for_each(|(slab, out)| self.sum_slab::<T, IS_LESS>(stiffness, x, slab, out));
        }
        for node in &self.clamped {
            y[*node as usize] = [T::default(); 4];
        }
    }

    /// The part of one slab, added to its nodes or taken away.
    ///
    /// The body is compiled once more for AVX2 and for AVX-512. It reorders and fuses no sum, so the bits
    /// are the same on each.
    fn sum_slab<T: Real, const IS_LESS: bool>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[Quad<T>],
        slab: &Slab,
        out: &mut [Quad<T>],
    ) {
        let (begin, end) = slab.elements;
        let first = slab.nodes.0;
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || {
                for element in &self.elements[begin..end] {
                    let mut u = [[T::default(); 4]; 8];
                    for (pair, node) in element.iter().enumerate() {
                        let at = *node as usize;
                        u[2 * pair..2 * pair + 2].copy_from_slice(&x[at..at + 2]);
                    }
                    let forces = stiffness.forces(u);
                    for (pair, node) in element.iter().enumerate() {
                        let at = *node as usize - first;
                        let sums = &mut out[at..at + 2];
                        for i in 0..2 {
                            for k in 0..4 {
                                let force = forces[2 * pair + i][k];
                                if IS_LESS {
                                    sums[i][k] -= force;
                                } else {
                                    sums[i][k] += force;
                                }
                            }
                        }
                    }
                }
            },
        );
    }
}
