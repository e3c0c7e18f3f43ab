//! The widest place of a polygon.

use super::{Polygon, centroid};
use crate::{Point, budget};

/// The place is found to this part of the size of the polygon.
const PRECISION: f64 = 1e-3;
/// Steps for a side that a square is compared with.
const SIDE: u64 = 2;

/// The centre of the largest circle inside a polygon, to a thousandth of its size, and its radius; none of a polygon without
/// an area.
///
/// Squares that may hold a better place than the best one known are divided (Garcia-Castellanos and Lombardo, Poles of
/// inaccessibility, 2007; the queue of squares as in Mapbox's polylabel, 2016). O(n) a square for n sides, for some
/// tens of squares.
///
/// ```
/// use fretwork_geometry::{Point, Region, polygon};
/// let bar = Region::rectangle(Point::new(0.0, 0.0), Point::new(9.0, 2.0));
/// let (at, radius) = polygon::widest_place(&bar.area[0]).unwrap();
/// assert!(radius > 0.99 && (at.y - 1.0).abs() < 0.01);
/// ```
pub fn widest_place(polygon: &Polygon) -> Option<(Point, f64)> {
    let bounds = polygon.bounds();
    let (width, height) = (bounds.width(), bounds.height());
    let precision = PRECISION * bounds.longer_side();
    let half = 0.5 * width.min(height);
    if !(half > 0.0 && precision > 0.0) {
        return None;
    }
    let square = |at: Point, half: f64| {
        let room = room(polygon, at);
        (room + half * std::f64::consts::SQRT_2, at, half, room)
    };
    let mut best = square(centroid(std::slice::from_ref(polygon)), 0.0);
    let mut waiting = Vec::new();
    let (columns, rows) = ((width / half / 2.0).ceil(), (height / half / 2.0).ceil());
    for i in 0..columns as u32 {
        for j in 0..rows as u32 {
            let step = Point::new(f64::from(2 * i + 1), f64::from(2 * j + 1)) * half;
            waiting.push(square(bounds.min + step, half));
        }
    }
    // The square that may hold the best place is last.
    waiting.sort_by(|a, b| a.0.total_cmp(&b.0));
    while let Some(next) = waiting.pop() {
        if next.3 > best.3 {
            best = next;
        }
        if next.0 <= best.3 + precision {
            break;
        }
        let half = 0.5 * next.2;
        for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]] {
            let part = square(next.1 + Point::new(x, y) * half, half);
            if part.0 > best.3 + precision {
                let at = waiting.partition_point(|other| other.0 < part.0);
                waiting.insert(at, part);
            }
        }
    }
    (best.3 > 0.0).then_some((best.1, best.3))
}

/// The distance from `p` to the border, negative outside.
fn room(polygon: &Polygon, p: Point) -> f64 {
    let mut nearest = f64::INFINITY;
    for ring in polygon.rings() {
        budget::spend("sides of areas", SIDE * ring.len() as u64);
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let along = *b - *a;
            let square = along.dot(along);
            let t = if square > 0.0 {
                ((p - *a).dot(along) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            nearest = nearest.min(p.distance(a.lerp(*b, t)));
        }
    }
    if polygon.contains(p) {
        nearest
    } else {
        -nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    #[test]
    fn no_place_of_a_fine_grid_is_wider() {
        for case in 0..12 {
            let seed = Seed::root(case);
            let corner = |i: u32| {
                let angle = std::f64::consts::TAU * f64::from(i) / 14.0;
                Point::unit(angle) * seed.range(u64::from(i), 1.0, 6.0)
            };
            let hole = [[0.2, 0.2], [0.1, -0.3], [-0.3, 0.0]].map(Point::from);
            let star = Polygon {
                outer: (0..14).map(corner).collect(),
                holes: vec![hole.to_vec()],
            };
            let (at, radius) = widest_place(&star).unwrap();
            assert!((room(&star, at) - radius).abs() < 1e-12);
            for (i, j) in (-60..=60).flat_map(|i| (-60..=60).map(move |j| (i, j))) {
                let p = Point::new(f64::from(i), f64::from(j)) * 0.1;
                assert!(room(&star, p) < radius + 0.0125, "case {case} {p:?}");
            }
        }
        let flat = Polygon {
            outer: vec![Point::ORIGIN, Point::new(1.0, 0.0), Point::new(2.0, 0.0)],
            holes: Vec::new(),
        };
        assert_eq!(widest_place(&flat), None);
    }
}
