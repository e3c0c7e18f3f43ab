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

/// What relative lengths are taken of, in user units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// The size of the viewport; NaN where it is not known.
    pub viewport: Point,
    /// The height of the letters of the element.
    pub font_size: f64,
    /// That of the root element.
    pub root_font_size: f64,
    /// Whether a physical length keeps its size in the result.
    pub is_physical: bool,
}

/// The height of the letters where nothing says otherwise, in user units.
pub const FONT_SIZE: f64 = 16.0;
/// CSS fixes 96 user units to the inch.
pub const USER_PER_MM: f64 = 96.0 / 25.4;

impl Basis {
    /// With a viewport of this size and letters of the usual height.
    pub fn of(viewport: Point) -> Basis {
        Basis {
            viewport,
            font_size: FONT_SIZE,
            root_font_size: FONT_SIZE,
            is_physical: true,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Unit {
    /// Millimetres per unit.
    Physical(f64),
    User,
    /// So many font sizes.
    Font(f64),
    RootFont,
    Percent,
}

const UNITS: [(&str, Unit); 13] = [
    ("mm", Unit::Physical(1.0)),
    ("cm", Unit::Physical(10.0)),
    ("in", Unit::Physical(25.4)),
    ("pt", Unit::Physical(25.4 / 72.0)),
    ("pc", Unit::Physical(25.4 / 6.0)),
    ("q", Unit::Physical(0.25)),
    ("px", Unit::User),
    ("rem", Unit::RootFont),
    ("em", Unit::Font(1.0)),
    // What browsers take where a font does not say it.
    ("ex", Unit::Font(0.5)),
    ("ch", Unit::Font(0.5)),
    ("%", Unit::Percent),
    ("", Unit::User),
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
    /// In user units; NaN for a percentage of an unknown viewport.
    pub fn user(self, axis: Axis, basis: &Basis) -> f64 {
        let whole = match self.unit {
            Unit::Physical(mm) => mm * USER_PER_MM,
            Unit::User => 1.0,
            Unit::Font(sizes) => sizes * basis.font_size,
            Unit::RootFont => basis.root_font_size,
            Unit::Percent => {
                let viewport = basis.viewport;
                let whole = match axis {
                    Axis::X => viewport.x,
                    Axis::Y => viewport.y,
                    Axis::Diagonal => viewport.length() / std::f64::consts::SQRT_2,
                };
                whole / 100.0
            }
        };
        self.number * whole
    }

    /// In user units as a size of letters, of which a percentage is taken too.
    pub fn font_size(self, basis: &Basis) -> f64 {
        let of_letters = Basis {
            viewport: Point::new(basis.font_size, basis.font_size),
            ..*basis
        };
        self.user(Axis::X, &of_letters)
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
        let basis = Basis {
            font_size: 10.0,
            ..Basis::of(Point::new(200.0, 100.0))
        };
        let user = |text: &str| text.parse::<Length>().unwrap().user(Axis::X, &basis);
        assert_eq!(user("1in"), 96.0);
        assert!((user("25.4mm") - 96.0).abs() < 1e-12);
        assert!((user("2.54cm") - 96.0).abs() < 1e-12);
        assert!((user("72pt") - 96.0).abs() < 1e-12 && (user("6pc") - 96.0).abs() < 1e-12);
        assert!((user("101.6Q") - 96.0).abs() < 1e-12);
        assert_eq!(user(" 3PX "), 3.0);
        assert_eq!(
            (user("1e2"), user("1e2em"), user("50%"), user("-.5")),
            (100.0, 1000.0, 100.0, -0.5)
        );
        assert_eq!((user("2ex"), user("2rem"), user("1ch")), (10.0, 32.0, 5.0));
        let letters = |text: &str| text.parse::<Length>().unwrap().font_size(&basis);
        assert_eq!(
            (letters("150%"), letters("2em"), letters("1rem")),
            (15.0, 20.0, 16.0)
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
