//! Mouldings: what runs along the cells of a facade with one cross-section.

use serde::{Deserialize, Serialize};

use super::FacadeCell;
use crate::mesh::triangulate;
use crate::plane::flatten::distance_to_segment;
use crate::{Point, Polygon, Ring};

/// How far a cross-section may be off, as a part of its height. Its corners are repeated at every bend of the
/// facade: an arc of more of them is not seen, but takes most of the time.
const TOLERANCE: f64 = 1e-3;

/// A cross-section that runs along cells, or around one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moulding {
    /// Its polygons: x is out of the facade, y up, both from 0. The inside lies on the left of the rings.
    pub profile: Vec<Polygon>,
    /// The greatest y.
    pub height: f64,
    /// Where it runs.
    pub run: Run,
}

/// Where a moulding runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Run {
    /// Along the cells beside one another.
    Row,
    /// Along the cells above one another.
    Column,
    /// Around a cell, with the upper side of the cross-section at the cell's border.
    Frame,
}

impl Moulding {
    /// How much larger than its cross-section it is in a cell.
    pub fn scale(&self, cell: &FacadeCell) -> f64 {
        match self.run {
            Run::Row => cell.height / self.height,
            Run::Column => cell.width / self.height,
            Run::Frame => 1.0,
        }
    }

    /// Whether it leaves an opening in a cell of this width and height that it goes around.
    pub fn leaves_opening(&self, sides: [f64; 2]) -> bool {
        sides.iter().all(|side| 2.0 * self.height < *side)
    }

    /// A moulding whose cross-section is an area of the drawing plane (y down): its left side lies on the facade.
    /// Nothing if the area is empty.
    pub fn of(area: &[Polygon], run: Run) -> Option<Moulding> {
        let corners = || area.iter().flat_map(Polygon::rings).flatten();
        let least = |values: &mut dyn Iterator<Item = f64>| values.reduce(f64::min);
        let left = least(&mut corners().map(|p| p.x))?;
        let top = least(&mut corners().map(|p| p.y))?;
        let bottom = -least(&mut corners().map(|p| -p.y))?;
        // A mirror turns rings over.
        let upright = |ring: &Ring| -> Ring {
            let points = ring.iter().rev();
            points
                .map(|p| Point::new(p.x - left, bottom - p.y))
                .collect()
        };
        let height = bottom - top;
        let profile = area.iter().map(|polygon| {
            let upright = Polygon {
                outer: upright(&polygon.outer),
                holes: polygon.holes.iter().map(upright).collect(),
            };
            coarser(&upright, TOLERANCE * height).unwrap_or(upright)
        });
        Some(Moulding {
            profile: profile.collect(),
            height,
            run,
        })
    }
}

/// A polygon of fewer corners that is nowhere farther than `tolerance` off; nothing where it would meet itself.
fn coarser(polygon: &Polygon, tolerance: f64) -> Option<Polygon> {
    let thinned = |ring: &Ring| -> Ring {
        let far = |at: usize| ring[0].distance(ring[at]);
        let farthest = (0..ring.len()).max_by(|a, b| far(*a).total_cmp(&far(*b)));
        let middle = farthest.unwrap_or(0);
        let mut kept = vec![ring[0]];
        keep(&ring[..=middle], tolerance, &mut kept);
        let back: Ring = ring[middle..].iter().chain(&ring[..1]).copied().collect();
        keep(&back, tolerance, &mut kept);
        kept.pop();
        kept
    };
    let polygon = Polygon {
        outer: thinned(&polygon.outer),
        holes: polygon.holes.iter().map(thinned).collect(),
    };
    let is_sound = polygon.rings().all(|ring| ring.len() > 2) && triangulate(&polygon).is_ok();
    is_sound.then_some(polygon)
}

/// Adds the points of a line but its first, without those that are near the line through the others
/// (Douglas and Peucker 1973).
fn keep(line: &[Point], tolerance: f64, kept: &mut Ring) {
    let (Some(first), Some(last)) = (line.first(), line.last()) else {
        return;
    };
    let off = |at: &usize| distance_to_segment(line[*at], *first, *last);
    let inner = 1..line.len().saturating_sub(1);
    match inner.max_by(|a, b| off(a).total_cmp(&off(b))) {
        Some(at) if off(&at) > tolerance => {
            keep(&line[..=at], tolerance, kept);
            keep(&line[at..], tolerance, kept);
        }
        _ => kept.push(*last),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn arcs_of_a_cross_section_get_coarser_and_its_corners_stay() {
        let turn = |i: u32| Point::unit(f64::from(i) / 1000.0 * std::f64::consts::TAU);
        let disc = Polygon {
            outer: (0..1000)
                .map(|i| Point::new(3.0, 8.0) + turn(i) * 5.0)
                .collect(),
            holes: Vec::new(),
        };
        let moulding = Moulding::of(&[disc], Run::Row).unwrap();
        let corners = moulding.profile[0].outer.len();
        assert!((20..100).contains(&corners), "{corners}");
        assert!((moulding.height - 10.0).abs() < 1e-9);
        let area = moulding.profile[0].area();
        assert!(
            (area / (25.0 * std::f64::consts::PI) - 1.0).abs() < 5e-3,
            "{area}"
        );
        let square = [[1.0, 1.0], [3.0, 1.0], [3.0, 5.0], [2.0, 5.0], [1.0, 5.0]];
        let square = Polygon {
            outer: square.map(Point::from).to_vec(),
            holes: Vec::new(),
        };
        let moulding = Moulding::of(&[square], Run::Row).unwrap();
        let expected = [[0.0, 0.0], [2.0, 0.0], [2.0, 4.0], [0.0, 4.0]].map(Point::from);
        let profile = &moulding.profile[0];
        assert!(expected.iter().all(|corner| profile.outer.contains(corner)));
        assert_eq!((profile.outer.len(), profile.area()), (4, 8.0));
        assert_eq!(Moulding::of(&[], Run::Row), None);
    }
}
