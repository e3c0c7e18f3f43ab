//! The edges of an area, as they are traced and counted.

use fretwork_geometry::{Point, Polygon};

/// The edges of all rings, those of length 0 too.
pub fn edges(area: &[Polygon]) -> impl Iterator<Item = [Point; 2]> {
    area.iter().flat_map(Polygon::rings).flat_map(|ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| [*a, *b])
    })
}
