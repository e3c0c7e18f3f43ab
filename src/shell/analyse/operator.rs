//! The stiffness matrix of a body times a vector, without the matrix.

use rayon::prelude::*;

use super::element::Stiffness;
use super::mesh::{Mesh, Slab};
use super::number::Real;
use super::vector::CHUNK;

impl Mesh {
    /// The forces at the nodes that hold the displacements `x`, into `y`; zero at clamped nodes. `x` must be
    /// zero there.
    pub(super) fn apply<T: Real, const D: usize>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[[T; D]],
        y: &mut [[T; D]],
    ) {
        y.par_chunks_mut(CHUNK)
            .for_each(|chunk| chunk.fill([T::default(); D]));
        self.sum::<T, D, false>(stiffness, x, y);
    }

    /// As [`Mesh::apply`], but takes the forces away from what is in `y`.
    pub(super) fn subtract<T: Real, const D: usize>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[[T; D]],
        y: &mut [[T; D]],
    ) {
        self.sum::<T, D, true>(stiffness, x, y);
    }

    /// Adds the forces to `y`, or takes them away.
    ///
    /// Even slabs write to parts of `y` that do not overlap, then odd ones add theirs: parallel
    /// without locks, and in one order of sums.
    fn sum<T: Real, const D: usize, const IS_LESS: bool>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[[T; D]],
        y: &mut [[T; D]],
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
                .for_each(|(slab, out)| self.sum_slab::<T, D, IS_LESS>(stiffness, x, slab, out));
        }
        for node in &self.clamped {
            y[*node as usize] = [T::default(); D];
        }
    }

    /// The part of one slab, added to its nodes or taken away.
    fn sum_slab<T: Real, const D: usize, const IS_LESS: bool>(
        &self,
        stiffness: &Stiffness<T>,
        x: &[[T; D]],
        slab: &Slab,
        out: &mut [[T; D]],
    ) {
        let (begin, end) = slab.elements;
        pulp::Arch::new().dispatch(SlabSum::<T, D, IS_LESS> {
            elements: &self.elements[begin..end],
            weights: &self.weights[begin..end],
            first: slab.nodes.0,
            stiffness: *stiffness,
            x,
            out,
        });
    }
}

/// The sum over the elements of a slab.
///
/// It is compiled once more for AVX2. It reorders and fuses no sum, so the bits are the same. What a closure holds
/// would not be inlined into what is compiled so: it is too large.
struct SlabSum<'a, T, const D: usize, const IS_LESS: bool> {
    elements: &'a [[u32; 4]],
    weights: &'a [f32],
    /// The node that `out` begins with.
    first: usize,
    stiffness: Stiffness<T>,
    x: &'a [[T; D]],
    out: &'a mut [[T; D]],
}

impl<T: Real, const D: usize, const IS_LESS: bool> pulp::NullaryFnOnce
    for SlabSum<'_, T, D, IS_LESS>
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (element, weight) in self.elements.iter().zip(self.weights) {
            let weight = T::Plain::of(f64::from(*weight));
            let mut u = [[T::default(); D]; 8];
            for (pair, node) in element.iter().enumerate() {
                let at = *node as usize;
                let two = &self.x[at..at + 2];
                (u[2 * pair], u[2 * pair + 1]) = (two[0], two[1]);
            }
            let forces = self.stiffness.forces(u);
            for (pair, node) in element.iter().enumerate() {
                let at = *node as usize - self.first;
                let sums = &mut self.out[at..at + 2];
                for i in 0..2 {
                    for k in 0..D {
                        let force = forces[2 * pair + i][k].scaled(weight);
                        if IS_LESS {
                            sums[i][k] -= force;
                        } else {
                            sums[i][k] += force;
                        }
                    }
                }
            }
        }
    }
}
