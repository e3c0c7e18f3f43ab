//! What can be wrong with an exemplar. The words for the user are put together in `diagnose`.

use fretwork_geometry::polygon::AreaError;
use fretwork_geometry::{Point, TopologyError};

/// Why a drawing is no exemplar.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ExemplarError {
    /// Its overlapping parts cannot be united.
    #[error("the exemplar cannot be used: {0}")]
    Area(#[from] AreaError),
    /// It covers nothing, or its coordinates are not numbers.
    #[error("the exemplar has no area")]
    Empty,
    /// Its outline touches itself, and joining the parts does not help.
    #[error("the exemplar cannot be cut into pieces: its outline touches itself{}", near(.0))]
    Touching(Option<Point>),
    /// Its contours are still not simple after the repair.
    #[error("the exemplar cannot be cut into pieces: {0}")]
    NotSimple(TopologyError),
}

/// Why an exemplar cannot be cut as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SlicingError {
    /// Its topology has too many events.
    #[error("the exemplar falls into {pieces} pieces, more than {most}")]
    TooManyPieces {
        /// How many pieces it would fall into.
        pieces: usize,
        /// How many there may be.
        most: usize,
    },
    /// Uniform slicing was asked for too many lines.
    #[error("`uniform: {lines}` asks for more than {most} pieces")]
    TooManyLines {
        /// How many lines were asked for.
        lines: usize,
        /// How many pieces there may be.
        most: usize,
    },
}

/// What the user should know although the exemplar can be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExemplarWarning {
    /// The outline crosses itself, near this point if it is known.
    Crossing(Option<Point>),
    /// Parts touch or nearly touch, and were joined.
    Joined(Option<Point>),
    /// No event lies between its ends: it is cut at this many places with equal distances.
    Unchanging(usize),
    /// Every cut would pass a neck thinner than this `min_portal`.
    NoWideCut(f64),
}

/// The words for a place, with a blank before them; empty where the place is not known.
pub fn near(place: &Option<Point>) -> String {
    place.map_or(String::new(), |p| format!(" near ({:.3}, {:.3})", p.x, p.y))
}
