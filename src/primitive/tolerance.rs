//! How far polylines are from the curves that they stand for, where a spec does not say.

/// What nobody sees on an object and hardly any machine can make.
const FINE_MM: f64 = 0.01;
/// Of something very large no file and no machine shows a smaller part than this.
const FINEST_PART: f64 = 1e-6;

/// The tolerance for something whose longer side is `size` units of `unit_mm` millimetres: this `part` of it, and no more
/// than 0.01 mm, so that what is small in a large drawing stays round.
///
/// ```
/// use fretwork_primitive::default_tolerance;
/// assert_eq!(default_tolerance(5.0, 1e-3, 1.0), 0.005);
/// assert_eq!(default_tolerance(400.0, 1e-3, 1.0), 0.01);
/// assert_eq!(default_tolerance(4e6, 1e-3, 1.0), 4.0);
/// ```
pub fn default_tolerance(size: f64, part: f64, unit_mm: f64) -> f64 {
    let relative = if size > 0.0 { size * part } else { part };
    relative.min((FINE_MM / unit_mm).max(size * FINEST_PART))
}
