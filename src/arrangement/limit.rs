//! Limits that several operators share.

/// The most cells, lines or sample points that one operator makes. Ten million cells take about a
/// gigabyte; a spec that asks for more has almost always a length in the wrong unit.
pub const LIMIT: usize = 10_000_000;

/// Bytes that a cell or a line of a partition takes with its planar map.
pub(crate) const CELL: usize = 1200;

/// A cell counts as inside when at most this part of its area is outside, and the other way round.
/// Snapping a corner to the planar map changes a cell of a thousandth of the region by less than a
/// millionth, so a cell that touches the border only with a side must pass. Above a thousandth, slivers
/// that are seen would be taken for nothing.
pub(crate) const NEGLIGIBLE: f64 = 1e-6;
