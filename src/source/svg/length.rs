//! Lengths with units.

use std::str::FromStr;

use fretwork_geometry::Point;

/// A number and its unit, as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length {
    number: f64,
    unit: Unit,
}

/// What a percentage is taken of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// The viewport's width.
    X,
    /// The viewport's height.
    Y,
    /// The root of the mean square of both.
    Diagonal,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Unit {
    /// Millimetres per unit.
    Physical(f64),
    /// User units per unit.
    User(f64),
    Percent,
}

/// The height of the letters where nothing says otherwise, in user units.
const FONT_SIZE: f64 = 16.0;
/// CSS fixes 96 user units to the inch.
const USER_PER_MM: f64 = 96.0 / 25.4;

const UNITS: [(&str, Unit); 12] = [
    ("mm", Unit::Physical(1.0)),
    ("cm", Unit::Physical(10.0)),
    ("in", Unit::Physical(25.4)),
    ("pt", Unit::Physical(25.4 / 72.0)),
    ("pc", Unit::Physical(25.4 / 6.0)),
    ("q", Unit::Physical(0.25)),
    ("px", Unit::User(1.0)),
    ("rem", Unit::User(FONT_SIZE)),
    ("em", Unit::User(FONT_SIZE)),
    ("ex", Unit::User(FONT_SIZE / 2.0)),
    ("%", Unit::Percent),
    ("", Unit::User(1.0)),
];

impl FromStr for Length {
    type Err = ();

    fn from_str(text: &str) -> Result<Length, ()> {
        let text = text.trim();
        let ends = |unit: &str| {
            let at = text.len().checked_sub(unit.len())?;
            text.get(at..)?
                .eq_ignore_ascii_case(unit)
                .then_some(&text[..at])
        };
        let (number, unit) = UNITS
            .iter()
            .find_map(|(name, unit)| Some((ends(name)?, *unit)))
            .ok_or(())?;
        let svgtypes::Number(number) = number.parse().map_err(|_| ())?;
        Ok(Length { number, unit })
    }
}

impl Length {
    /// In user units, for a viewport of this size; NaN for a percentage of an unknown viewport.
    pub fn user(self, axis: Axis, viewport: Point) -> f64 {
        match self.unit {
            Unit::Physical(mm) => self.number * mm * USER_PER_MM,
            Unit::User(units) => self.number * units,
            Unit::Percent => {
                let whole = match axis {
                    Axis::X => viewport.x,
                    Axis::Y => viewport.y,
                    Axis::Diagonal => viewport.length() / std::f64::consts::SQRT_2,
                };
                self.number / 100.0 * whole
            }
        }
    }

    /// In millimetres, when the unit is a physical one (px is not).
    pub fn millimetres(self) -> Option<f64> {
        match self.unit {
            Unit::Physical(mm) => Some(self.number * mm),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_what_css_says() {
        let user = |text: &str| {
            text.parse::<Length>()
                .unwrap()
                .user(Axis::X, Point::new(200.0, 100.0))
        };
        assert_eq!(user("1in"), 96.0);
        assert_eq!(user("25.4mm"), 96.0);
        assert_eq!(user("2.54cm"), 96.0);
        assert!((user("72pt") - 96.0).abs() < 1e-12 && (user("6pc") - 96.0).abs() < 1e-12);
        assert!((user("101.6Q") - 96.0).abs() < 1e-12);
        assert_eq!(user(" 3PX "), 3.0);
        assert_eq!(
            (user("1e2"), user("1e2em"), user("50%"), user("-.5")),
            (100.0, 1600.0, 100.0, -0.5)
        );
        assert_eq!("2in".parse::<Length>().unwrap().millimetres(), Some(50.8));
        assert_eq!("2px".parse::<Length>().unwrap().millimetres(), None);
        for bad in [
            "", "mm", "1 2", "inf", "nan", "1e999", "1furlong", "0x10", "ü%",
        ] {
            assert!(bad.parse::<Length>().is_err(), "{bad}");
        }
    }
}
