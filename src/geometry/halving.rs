//! How much of something is still possible, where only trying tells: for the advice of errors.

/// How often the range is halved: what is found is within a thousandth of it.
const HALVINGS: usize = 10;

/// The largest part of `limit` that `holds`, but for a thousandth of the limit; none where no part is found. It is found by halving, as
/// if less held wherever more does. Ten calls of `holds`.
///
/// ```
/// let found = fretwork_geometry::halving::largest(8.0, |x| x < 3.0).unwrap();
/// assert!((2.99..3.0).contains(&found));
/// assert_eq!(fretwork_geometry::halving::largest(8.0, |_| false), None);
/// ```
pub fn largest(limit: f64, holds: impl Fn(f64) -> bool) -> Option<f64> {
    let (mut most, mut beyond) = (0.0, limit);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (most + beyond);
        if holds(middle) {
            most = middle;
        } else {
            beyond = middle;
        }
    }
    (most > 0.0).then_some(most)
}
