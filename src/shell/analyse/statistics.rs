//! A few numbers that stand for many.

use fretwork_geometry::Point3;

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
        let max = values.iter().copied().fold(values[0], f64::max);
        let first = values.iter().position(|x| *x == max);
        let [median, p99] = [0.5, 0.99].map(|part| percentile(&mut sorted, part));
        Statistics {
            mean: values.iter().sum::<f64>() / values.len() as f64,
            median,
            p99,
            max,
            at: place(first.unwrap_or(0)),
        }
    }
}

/// The value below which this part of the values lies. They are put in order only as far as that needs.
fn percentile(values: &mut [f64], part: f64) -> f64 {
    let at = part * (values.len() - 1) as f64;
    let low = at as usize;
    let (_, a, above) = values.select_nth_unstable_by(low, f64::total_cmp);
    let b = above.iter().copied().reduce(f64::min).unwrap_or(*a);
    *a + (at - low as f64) * (b - *a)
}
