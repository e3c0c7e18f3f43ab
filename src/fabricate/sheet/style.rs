//! How the things of a sheet look, and what a machine does with them.

use std::str::FromStr;

/// What a machine does with a layer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Cuts through.
    Cut,
    /// Marks the surface.
    Engrave,
    /// Nothing in particular.
    #[default]
    Draw,
}

/// How the items of a layer look.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Style {
    /// Their lines, if they have any.
    pub stroke: Option<Pen>,
    /// The inside of areas and of closed lines, if it is filled.
    pub fill: Option<Color>,
}

/// A line's look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// In millimetres in the file.
    pub width: f64,
    /// Its colour.
    pub color: Color,
}

/// An opaque sRGB colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Color(pub [u8; 3]);

impl Style {
    /// Black lines of this width in millimetres, nothing filled.
    pub fn outline(width: f64) -> Style {
        Style {
            stroke: Some(Pen {
                width,
                color: Color::default(),
            }),
            fill: None,
        }
    }

    /// Filled, without lines.
    pub fn filled(color: Color) -> Style {
        Style {
            stroke: None,
            fill: Some(color),
        }
    }
}

impl FromStr for Color {
    type Err = String;

    /// A CSS colour, `#c9a27a` or `tan`; an error that says so for anything else, and for one that
    /// is not opaque.
    fn from_str(text: &str) -> Result<Color, String> {
        match text.parse::<svgtypes::Color>() {
            Ok(c) if c.alpha == 255 => Ok(Color([c.red, c.green, c.blue])),
            Ok(_) => Err(format!("`{text}` is not opaque")),
            Err(_) => Err(format!(
                "`{text}` is not a colour such as `#c9a27a` or `tan`"
            )),
        }
    }
}

impl std::fmt::Display for Color {
    /// `#rrggbb`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_css_colours() {
        assert_eq!("tan".parse::<Color>().unwrap().to_string(), "#d2b48c");
        assert_eq!("#c9a".parse(), Ok(Color([0xcc, 0x99, 0xaa])));
        assert!("#c9a27a80".parse::<Color>().is_err() && "blurple".parse::<Color>().is_err());
    }
}
