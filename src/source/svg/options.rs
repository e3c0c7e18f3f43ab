//! How a drawing is read.

/// How a drawing is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SvgOptions {
    /// The largest distance of a chord from the curve it stands for, in spec units.
    pub tolerance: f64,
    /// Millimetres per spec unit.
    pub unit_mm: f64,
}
