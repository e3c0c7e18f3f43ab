//! Sums and updates of vectors at nodes, in chunks that never depend on the number of threads.

use rayon::prelude::*;

use super::number::Columns;

/// How many nodes a thread takes at once: large enough to hide the handing out, small enough to stay in
/// its cache.
pub(super) const CHUNK: usize = 8192;

/// The scalar product of each column. Chunks are summed by themselves, then added in order.
pub(super) fn dot<T: Columns, const D: usize>(a: &[[T; D]], b: &[[T; D]]) -> T {
    let sum = |(a, b): (&[[T; D]], &[[T; D]])| {
        let products = a.iter().zip(b);
        products.fold(T::default(), |sum, (p, q)| {
            sum + (p[0] * q[0] + p[1] * q[1] + p[2] * q[2])
        })
    };
    let chunks = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    let sums: Vec<T> = chunks.map(sum).collect();
    sums.into_iter().fold(T::default(), |sum, part| sum + part)
}

/// The euclidean length of each column.
pub(super) fn norm<T: Columns, const D: usize>(a: &[[T; D]]) -> T {
    let square = dot(a, a);
    T::of_columns(|column| square.column(column).sqrt())
}

/// Calls `change` for each pair of elements.
pub(super) fn update<A: Send, B: Sync>(a: &mut [A], b: &[B], change: impl Fn(&mut A, &B) + Sync) {
    a.par_chunks_mut(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .for_each(|(a, b)| a.iter_mut().zip(b).for_each(|(a, b)| change(a, b)));
}

/// `a + k·b`, into `a`.
pub(super) fn add<T: Columns, const D: usize>(a: &mut [[T; D]], k: T, b: &[[T; D]]) {
    update(a, b, |a, b| {
        for q in 0..D {
            a[q] += k * b[q];
        }
    });
}
