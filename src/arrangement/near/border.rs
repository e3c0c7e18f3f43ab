//! The border of a room as curves: what it cuts off of a face is closed by it, so that the face is not taken for the face
//! around all cells.

use std::collections::BTreeMap;

use crate::near::locality::CellSize;
use crate::tiled::zone::inside;
use fretwork_geometry::{Bounds, CurveLabels, Curves, EdgeId, FaceId, PlanarMap, Point};

/// What is as near to a side as this part of the room lies on it.
const NEAR: f64 = 1e-9;
/// Squares of rooms that are looked at, at most.
const MOST: usize = 1 << 22;

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

/// The sides of the room without those parts where the outermost face of the whole goes on beyond them, where a face of `map`,
/// which has the sides, can be told to be a part of it: it comes to all sides of the room, which is deeper than any cell is
/// large, and no square of the room is as empty as where cells of a partition have nothing drawn for them. There, a ring of
/// others may close a face of any size.
///
/// None where there is no such face.
pub(crate) fn outermost(
    map: &PlanarMap,
    curves: &Curves,
    room: &Bounds,
    cell: CellSize,
) -> Option<Curves> {
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
    let (open, _) = touched.into_iter().find(|(_, sides)| *sides == there)?;
    let size = room.width().min(room.height());
    if there == [false; 4] || size < 2.0 * cell.most || has_void(curves, room, cell.void) {
        return None;
    }
    let mut left = Curves::new();
    for (_, e) in sides {
        if map.left(e) != open && map.right(e) != open {
            left.push(map.points(e), CurveLabels::default());
        }
    }
    Some(left)
}

/// The edges of a map that run along the sides of a room, with the number of the side.
fn on_sides(map: &PlanarMap, room: &Bounds) -> Vec<(usize, EdgeId)> {
    let side = |e: EdgeId| {
        let box_of = Bounds::of(map.points(e));
        let near = |v: f64, w: f64| (v - w).abs() <= NEAR * room.longer_side();
        let runs = [
            near(box_of.min.y, room.min.y) && near(box_of.max.y, room.min.y),
            near(box_of.min.x, room.max.x) && near(box_of.max.x, room.max.x),
            near(box_of.min.y, room.max.y) && near(box_of.max.y, room.max.y),
            near(box_of.min.x, room.min.x) && near(box_of.max.x, room.min.x),
        ];
        runs.iter().position(|runs| *runs)
    };
    let edges = map.edges();
    edges
        .filter_map(|e| side(e).map(|side| (side, e)))
        .collect()
}

/// Whether some square of this side in a room has no curve in it, as far as points of curves tell.
fn has_void(curves: &Curves, room: &Bounds, side: f64) -> bool {
    let step = side / 2.0;
    let count = |length: f64| (length / step).floor().max(0.0) as usize;
    let (columns, rows) = (count(room.width()), count(room.height()));
    if columns < 2 || rows < 2 || columns.saturating_mul(rows) > MOST {
        return true;
    }
    let mut has_curve = vec![false; columns * rows];
    let mut mark = |p: Point| {
        let at = p - room.min;
        let (i, j) = ((at.x / step).floor(), (at.y / step).floor());
        if i >= 0.0 && j >= 0.0 && (i as usize) < columns && (j as usize) < rows {
            has_curve[j as usize * columns + i as usize] = true;
        }
    };
    for ends in curves.iter().flat_map(|curve| curve.points.windows(2)) {
        if let Some([from, to]) = inside(ends[0], ends[1], room) {
            let parts = (from.distance(to) / step).ceil().max(1.0) as usize;
            (0..=parts).for_each(|n| mark(from.lerp(to, n as f64 / parts as f64)));
        }
    }
    let is_empty = |i: usize, j: usize| {
        let at = |i: usize, j: usize| has_curve[j * columns + i];
        !(at(i, j) || at(i + 1, j) || at(i, j + 1) || at(i + 1, j + 1))
    };
    (0..rows - 1).any(|j| (0..columns - 1).any(|i| is_empty(i, j)))
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
