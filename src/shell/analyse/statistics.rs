//! A few numbers that stand for many.

use fretwork_geometry::Point3;
use rayon::prelude::*;

/// How a quantity is distributed over the voxels of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// The arithmetic mean.
    pub mean: f64,
    /// Half are at most this.
    pub median: f64,
    /// 99 % are at most this.
    pub p99: f64,
    /// The greatest.
    pub max: f64,
    /// The middle of the first voxel that has the greatest, in units of the lattice.
    pub at: Point3,
}

impl Statistics {
    /// The statistics of at least one value; `place` gives the place of a value by its number.
    /// Between two values percentiles are interpolated linearly.
    pub(super) fn new(values: &[f64], place: impl Fn(usize) -> Point3) -> Statistics {
        let mut sorted = values.to_vec();
        sorted.par_sort_unstable_by(f64::total_cmp);
        let last = sorted.len() - 1;
        let percentile = |part: f64| {
            let at = part * last as f64;
            let low = at as usize;
            let (a, b) = (sorted[low], sorted[(low + 1).min(last)]);
            a + (at - low as f64) * (b - a)
        };
        let max = sorted[last];
        let first = values.iter().position(|x| *x == max);
        Statistics {
            mean: values.iter().sum::<f64>() / values.len() as f64,
            median: percentile(0.5),
            p99: percentile(0.99),
            max,
            at: place(first.unwrap_or(0)),
        }
    }
}
