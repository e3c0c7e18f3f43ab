//! Areas that are cut out of a sheet in one piece or several.

use serde::{Deserialize, Serialize};

use super::{Bounds, Polygon};

/// Polygons with holes that do not overlap, each a piece of its own. How many pieces and holes there
/// are is counted on these polygons, not taken from how they were made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cutout {
    /// The pieces. Two that touch in a point only are two pieces.
    pub polygons: Vec<Polygon>,
}

impl Cutout {
    /// How many pieces there are.
    pub fn component_count(&self) -> usize {
        self.polygons.len()
    }

    /// How many holes the pieces have.
    pub fn hole_count(&self) -> usize {
        self.polygons.iter().map(|polygon| polygon.holes.len()).sum()
    }

    /// The area of all pieces without their holes.
    pub fn area(&self) -> f64 {
        self.polygons.iter().map(Polygon::area).sum()
    }

    /// The box of all pieces.
    pub fn bounds(&self) -> Bounds {
        self.polygons.iter().fold(Bounds::EMPTY, |bounds, polygon| bounds.union(polygon.bounds()))
    }
}
