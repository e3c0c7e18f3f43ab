//! Units: what plain numbers are in, and what may stand after a number in text.

use std::f64::consts::PI;

use super::super::macros::choice;

choice! {
    /// The unit of every plain length in a file.
    pub enum Unit {
        /// Millimetres.
        mm: Millimetre,
        /// Centimetres.
        cm: Centimetre,
        /// Metres.
        m: Metre,
        /// Inches of 25.4 mm.
        in: Inch,
    }
}

impl Unit {
    /// How many millimetres one is.
    pub fn millimetres(self) -> f64 {
        match self {
            Unit::Millimetre => 1.0,
            Unit::Centimetre => 10.0,
            Unit::Metre => 1000.0,
            Unit::Inch => 25.4,
        }
    }

    /// `value` of this unit in `other`; as it is where they are the same.
    pub fn convert(self, value: f64, other: Unit) -> f64 {
        if self == other {
            value
        } else {
            value * self.millimetres() / other.millimetres()
        }
    }
}

/// What a unit may be called, and its size.
pub(super) type UnitTable = [(&'static str, f64)];

/// In millimetres.
pub(super) const LENGTHS: &UnitTable = &[("mm", 1.0), ("cm", 10.0), ("m", 1000.0), ("in", 25.4)];
/// In square millimetres.
pub(super) const AREAS: &UnitTable = &[
    ("mm2", 1.0),
    ("cm2", 100.0),
    ("m2", 1e6),
    ("in2", 25.4 * 25.4),
];
/// In cubic millimetres.
pub(super) const VOLUMES: &UnitTable = &[
    ("mm3", 1.0),
    ("cm3", 1e3),
    ("m3", 1e9),
    ("in3", 25.4 * 25.4 * 25.4),
];
/// In radians.
pub(super) const ANGLES: &UnitTable = &[("deg", PI / 180.0), ("rad", 1.0), ("turn", 2.0 * PI)];
/// In newtons.
pub(super) const FORCES: &UnitTable = &[("N", 1.0), ("mN", 1e-3), ("kN", 1e3)];
/// In pascals.
pub(super) const PRESSURES: &UnitTable = &[("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)];
/// In kilograms per cubic metre.
pub(super) const MASS_DENSITIES: &UnitTable = &[("kg/m3", 1.0), ("g/cm3", 1e3)];
/// In metres per second squared.
pub(super) const ACCELERATIONS: &UnitTable = &[("m/s2", 1.0)];
/// In ones.
pub(super) const FRACTIONS: &UnitTable = &[("%", 0.01)];

/// `text` as a number and what stands after it, without the space around either. Nothing if it
/// does not begin with a number.
pub(super) fn split_number(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit())
            .count()
    };
    let mut end = usize::from(text.starts_with(['+', '-']));
    end += digits(end);
    if bytes.get(end) == Some(&b'.') {
        end += 1;
        end += digits(end);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits((end + 1 + sign).min(bytes.len()));
        end += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    let number = text[..end].parse().ok()?;
    Some((number, text[end..].trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_told_from_their_units() {
        assert_eq!(split_number("2.5mm"), Some((2.5, "mm")));
        assert_eq!(split_number(" -1e3 in "), Some((-1000.0, "in")));
        assert_eq!(split_number("3em"), Some((3.0, "em")));
        assert_eq!(split_number(".5"), Some((0.5, "")));
        assert_eq!(split_number("2.e-2%"), Some((0.02, "%")));
        assert_eq!(split_number("1e"), Some((1.0, "e")));
        for none in ["", "mm", "-", ".", "nan", "inf", "é1"] {
            assert_eq!(split_number(none), None, "{none}");
        }
    }

    #[test]
    fn a_unit_converts_to_itself_exactly() {
        assert_eq!(Unit::Inch.convert(0.1, Unit::Inch), 0.1);
        assert_eq!(Unit::Inch.convert(6.5, Unit::Millimetre), 165.1);
        assert_eq!(Unit::Metre.convert(2.0, Unit::Centimetre), 200.0);
    }
}
