//! How a surface is carved: what of it is kept, how thick it becomes, and how deep the rest is taken away.

use fretwork_geometry::Side;

use super::SolidError;

/// What of a surface is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Keep {
    /// What the pattern leaves.
    Ground,
    /// The pattern, and rims of the surface that are so wide.
    Pattern {
        /// How wide; no rims where it is 0.
        frame: f64,
    },
}

/// How a surface is carved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carving {
    /// What is kept.
    pub keep: Keep,
    /// How thick the surface becomes.
    pub thickness: f64,
    /// On which side of it the thickness goes.
    pub side: Side,
    /// How deep the rest is taken away from the outer face. None where it is cut through.
    pub depth: Option<f64>,
}

/// What is wrong, and with which of the cutouts if it is about one.
#[derive(Debug)]
pub struct AtCutout {
    /// The number of the cutout.
    pub cutout: Option<usize>,
    /// What is wrong.
    pub error: SolidError,
}

impl From<SolidError> for AtCutout {
    fn from(error: SolidError) -> AtCutout {
        AtCutout {
            cutout: None,
            error,
        }
    }
}

/// An error where what is taken away to a depth reaches through a surface; it may lie so far off it.
pub(crate) fn reaching(depth: f64, thickness: f64, away: f64) -> Result<(), SolidError> {
    if depth + away < thickness {
        return Ok(());
    }
    Err(SolidError::Through {
        depth,
        thickness,
        away,
    })
}

/// What goes through something that is pressed goes farther by this part of the thickness.
pub(crate) const THROUGH: f64 = 0.01;
