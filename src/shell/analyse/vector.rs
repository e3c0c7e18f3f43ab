//! Sums and updates of vectors at nodes, in chunks that never depend on the number of threads.

use rayon::prelude::*;

use super::element::Quad;

/// How many nodes a thread takes at once: large enough to hide the handing out, small enough to stay in
/// its cache.
pub(super) const CHUNK: usize = 8192;

/// The scalar product. Chunks are summed by themselves, then added in order.
pub(super) fn dot(a: &[Quad<f64>], b: &[Quad<f64>]) -> f64 {
    let sum = |(a, b): (&[Quad<f64>], &[Quad<f64>])| -> f64 {
        let products = a.iter().zip(b);
        products
            .map(|(p, q)| p[0] * q[0] + p[1] * q[1] + p[2] * q[2])
            .sum()
    };
    let sums: Vec<f64> = a
        .par_chunks(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .map(sum)
        .collect();
    sums.iter().sum()
}

/// The euclidean length.
pub(super) fn norm(a: &[Quad<f64>]) -> f64 {
    dot(a, a).sqrt()
}

/// Calls `change` for each pair of elements.
pub(super) fn update<A: Send, B: Sync>(a: &mut [A], b: &[B], change: impl Fn(&mut A, &B) + Sync) {
    a.par_chunks_mut(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .for_each(|(a, b)| a.iter_mut().zip(b).for_each(|(a, b)| change(a, b)));
}

/// `a + k·b`, into `a`.
pub(super) fn add(a: &mut [Quad<f64>], k: f64, b: &[Quad<f64>]) {
    update(a, b, |a, b| {
        for q in 0..4 {
            a[q] += k * b[q];
        }
    });
}
