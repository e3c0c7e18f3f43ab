//! How far polylines are from the curves that they stand for, where a spec does not say.

use fretwork_action::Definition;
use fretwork_language::Unit;

/// What nobody sees on an object or on paper, and hardly any machine can make.
const FINE_MM: f64 = 0.01;
/// Of something very large no file and no machine shows a smaller part than this.
const FINEST_PART: f64 = 1e-6;

/// The tolerance for something whose longer side is `size`: this `part` of it, and no more than `fine`, the length that
/// nobody sees, so that what is small in a large drawing stays round. All in one unit.
///
/// ```
/// use fretwork_primitive::default_tolerance;
/// assert_eq!(default_tolerance(5.0, 1e-3, 0.01), 0.005);
/// assert_eq!(default_tolerance(400.0, 1e-3, 0.01), 0.01);
/// assert_eq!(default_tolerance(4e6, 1e-3, 0.01), 4.0);
/// assert_eq!(default_tolerance(400.0, 1e-3, f64::INFINITY), 0.4);
/// ```
pub fn default_tolerance(size: f64, part: f64, fine: f64) -> f64 {
    let relative = if size > 0.0 { size * part } else { part };
    relative.min(fine.max(size * FINEST_PART))
}

/// The length that nobody sees on an object, in its `unit`: 0.01 mm.
pub fn fine_on_object(unit: Unit) -> f64 {
    FINE_MM / unit.millimetres()
}

/// The length that nobody sees of a drawing in the plane of a node, in `unit`: 0.01 mm, in maps with a scale on paper. In a
/// map without one it is any length, since how large its ground will be on paper or on a screen is not known.
///
/// The node must be one that sees the scale of its map.
pub fn fine_in_plane(definition: &Definition, unit: Unit) -> f64 {
    match &definition.map {
        None => fine_on_object(unit),
        Some(map) => map
            .scale
            .map_or(f64::INFINITY, |scale| fine_on_object(unit) / scale.0),
    }
}
