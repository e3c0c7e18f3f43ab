//! The border of a room as curves: what it cuts off of a face is closed by it, so that the face is not taken for the face
//! around all cells.

use std::collections::BTreeMap;

use crate::tiled::zone::inside;
use fretwork_geometry::{Bounds, CurveLabels, Curves, EdgeId, FaceId, PlanarMap, Point};

/// What is as near to a side as this part of the room lies on it.
const NEAR: f64 = 1e-9;

/// The sides of the box `room` as far as they lie in the box `hull` of all curves of the whole; nothing where all of these
/// lie in the room. Beyond the hull there is only the outermost face, so what reaches it there belongs to it.
pub(crate) fn sides(room: &Bounds, hull: Option<&Bounds>) -> Curves {
    let corners = [
        room.min,
        Point::new(room.max.x, room.min.y),
        room.max,
        Point::new(room.min.x, room.max.y),
    ];
    let mut sides = Curves::new();
    for (i, from) in corners.into_iter().enumerate() {
        let to = corners[(i + 1) % 4];
        let side = match hull {
            Some(hull) if hull.is_empty() => None,
            Some(hull) => inside(from, to, hull),
            None => Some([from, to]),
        };
        if let Some(side) = side {
            sides.push(side, CurveLabels::default());
        }
    }
    sides
}

/// The bounded face of `map`, which has the sides of the room, that comes to all of these, where there is one: it may be a part
/// of the outermost face of the whole.
pub(crate) fn face_on_all_sides(map: &PlanarMap, room: &Bounds) -> Option<FaceId> {
    let sides = on_sides(map, room);
    let mut touched: BTreeMap<FaceId, [bool; 4]> = BTreeMap::new();
    for &(side, e) in &sides {
        for face in [map.left(e), map.right(e)] {
            touched.entry(face).or_default()[side] = true;
        }
    }
    touched.remove(&FaceId::UNBOUNDED);
    // Sides that lie beyond all curves are not there.
    let mut there = [false; 4];
    sides.iter().for_each(|(side, _)| there[*side] = true);
    let found = touched.into_iter().find(|(_, sides)| *sides == there)?;
    Some(found.0)
}

/// The sides of the room without those parts along which the face `open` lies.
pub(crate) fn sides_without(map: &PlanarMap, room: &Bounds, open: FaceId) -> Curves {
    let mut left = Curves::new();
    for (_, e) in on_sides(map, room) {
        if map.left(e) != open && map.right(e) != open {
            left.push(map.points(e), CurveLabels::default());
        }
    }
    left
}

/// The edges of a map that run along the sides of a room, with the number of the side.
fn on_sides(map: &PlanarMap, room: &Bounds) -> Vec<(usize, EdgeId)> {
    let side = |e: EdgeId| Some((runs_along(map.points(e), room)?, e));
    map.edges().filter_map(side).collect()
}

/// The number of the side of a room along which a polyline runs, counted from the lower one to the right.
pub(crate) fn runs_along(points: impl IntoIterator<Item = Point>, room: &Bounds) -> Option<usize> {
    let box_of = Bounds::of(points);
    let near = |v: f64, w: f64| (v - w).abs() <= NEAR * room.longer_side();
    let runs = [
        near(box_of.min.y, room.min.y) && near(box_of.max.y, room.min.y),
        near(box_of.min.x, room.max.x) && near(box_of.max.x, room.max.x),
        near(box_of.min.y, room.max.y) && near(box_of.max.y, room.max.y),
        near(box_of.min.x, room.min.x) && near(box_of.max.x, room.min.x),
    ];
    runs.iter().position(|runs| *runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_end_where_all_curves_do() {
        let bounds = |low: f64, high: f64| Bounds {
            min: Point::new(low, low),
            max: Point::new(high, high),
        };
        assert_eq!(sides(&bounds(0.0, 4.0), None).len(), 4);
        assert!(sides(&bounds(0.0, 4.0), Some(&bounds(1.0, 3.0))).is_empty());
        let cut = sides(&bounds(0.0, 4.0), Some(&bounds(1.0, 9.0)));
        // The right side and the upper one, from 1 to 4.
        assert_eq!(cut.len(), 2);
        assert_eq!(cut.bounds().min, Point::new(1.0, 1.0));
        assert_eq!(cut.bounds().max, Point::new(4.0, 4.0));
    }
}
