//! What can keep a planar map from being built. Degenerate geometry is not among it.

use super::super::Point;

/// Why no planar map could be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlanarMapError {
    /// The resolution is not a power of two, or so small or large that the grid has no exact numbers.
    #[error("{0} is no resolution of a planar map: it must be a power of two from 2^-900 to 2^900")]
    Resolution(f64),
    /// A coordinate is NaN or infinite.
    #[error("point ({}, {}) of curve {curve} is not finite", .point.x, .point.y)]
    NotFinite {
        /// The number of the curve.
        curve: usize,
        /// The point.
        point: Point,
    },
    /// A point is farther from the origin, or from the rest of the curves, than the grid reaches.
    #[error("point ({}, {}) of curve {curve} is out of the range of a map with resolution {resolution}", .point.x, .point.y)]
    OutOfRange {
        /// The number of the curve.
        curve: usize,
        /// The point.
        point: Point,
        /// The resolution asked for.
        resolution: f64,
    },
    /// There are more curves, points or crossings than indices of 32 bits can number.
    #[error("{count} {what} are more than a planar map can number")]
    TooLarge {
        /// What there is too much of.
        what: &'static str,
        /// How many there are, or at least are.
        count: usize,
    },
    /// Snapping did not come to rest: the curves are a thicket finer than the resolution.
    #[error(
        "the curves do not come apart at resolution {resolution}: they are denser than it over and over"
    )]
    Unresolved {
        /// The resolution asked for.
        resolution: f64,
    },
}
