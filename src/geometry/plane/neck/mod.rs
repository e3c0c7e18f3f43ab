//! The narrowest places of an area and of what is between its parts.
//!
//! A neck joins two places of an outline that face each other. Where two outlines are nearest to each other, one of them has
//! a corner or they run in parallel, so necks are sought from corners, and from the middles of edges whose corners face
//! nothing. From each such place one looks at the edges in a rectangle around what may face it (`search`); the rectangle shrinks as
//! narrower necks are found. Two kinds of what is found do not count: a neck with another part of the outline in between, and
//! the tip of something that tapers off, which gets as narrow as one likes. `outline` holds the edges.

mod outline;
mod search;

use crate::Polygon;
pub use outline::Neck;
use outline::{Outline, Side};

/// The narrowest neck inside `polygons`: where they would fall apart, or lose a bridge, if they were made thinner from all
/// sides. Sharp tips are no necks. None when nothing faces itself.
pub fn narrowest_neck(polygons: &[Polygon]) -> Option<Neck> {
    Outline::new(polygons).narrowest(Side::Inside)
}

/// The narrowest gap beside `polygons`, between two of them or two parts of one.
pub fn narrowest_gap(polygons: &[Polygon]) -> Option<Neck> {
    Outline::new(polygons).narrowest(Side::Outside)
}

/// Necks inside `polygons` and gaps beside them below this width: one place of each, or several side by side.
pub fn below(polygons: &[Polygon], width: f64) -> Vec<Neck> {
    Outline::new(polygons).below(width)
}

#[cfg(test)]
mod tests;
