//! Lattices of the plane: the moves after which a tiled arrangement is the same again.

use fretwork_geometry::{Bounds, Point};

/// The moves k1 v1 + k2 v2 for all whole numbers k1 and k2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// The periods v1 and v2.
    pub periods: [Point; 2],
    /// What the coordinates of a point with regard to the periods are the products with.
    dual: [Point; 2],
}

/// A step of a reduction makes the square of a period shorter by this part of it at least, or it is the last one.
const SHORTER: f64 = 1e-9;

/// The number of a tile along both periods.
pub type TileNumber = [i64; 2];

impl Lattice {
    /// The lattice with these periods. None when they are parallel or not finite.
    pub fn of(periods: [Point; 2]) -> Option<Lattice> {
        let area = periods[0].cross(periods[1]);
        let size = periods[0].length() * periods[1].length();
        if !(area.is_finite() && size.is_finite() && area.abs() > 1e-9 * size) {
            return None;
        }
        let [v, w] = periods;
        let dual = [
            Point::new(w.y / area, -w.x / area),
            Point::new(-v.y / area, v.x / area),
        ];
        Some(Lattice { periods, dual })
    }

    /// The coordinates of `p` with regard to the periods.
    pub fn coordinates(&self, p: Point) -> [f64; 2] {
        self.dual.map(|d| d.dot(p))
    }

    /// The point with these coordinates.
    pub fn point(&self, [u, v]: [f64; 2]) -> Point {
        self.periods[0] * u + self.periods[1] * v
    }

    /// The move to a tile.
    pub fn at(&self, [i, j]: TileNumber) -> Point {
        self.point([i as f64, j as f64])
    }

    /// The tile that `p` lies in, of those that begin at `origin`.
    pub fn tile(&self, p: Point, origin: Point) -> TileNumber {
        self.coordinates(p - origin).map(|v| libm::floor(v) as i64)
    }

    /// The area of a tile.
    pub fn area(&self) -> f64 {
        self.periods[0].cross(self.periods[1]).abs()
    }

    /// The length of the longer diagonal of a tile.
    pub fn diagonal(&self) -> f64 {
        let [v, w] = self.periods;
        (v + w).length().max((v - w).length())
    }

    /// How far the coordinates of points can differ that are `distance` apart.
    pub fn spread(&self, distance: f64) -> [f64; 2] {
        self.dual.map(|d| d.length() * distance)
    }

    /// The box of the tiles with numbers from `from` to `to`, which begin at `origin`.
    pub fn bounds(&self, from: TileNumber, to: TileNumber, origin: Point) -> Bounds {
        let [low, high] = [from, [to[0] + 1, to[1] + 1]].map(|k| k.map(|n| n as f64));
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        Bounds::of(corners.map(|c| origin + self.point(c)))
    }

    /// The same moves from shorter periods, by Lagrange's reduction. It ends where a step makes nothing shorter: between
    /// equilateral triangles a period may be turned to either side for ever, by rounding too.
    pub fn reduced(self) -> Lattice {
        let [mut v, mut w] = self.periods;
        loop {
            if w.dot(w) < v.dot(v) {
                (v, w) = (w, v);
            }
            let shorter = w - v * libm::round(w.dot(v) / v.dot(v));
            if shorter.dot(shorter) >= (1.0 - SHORTER) * w.dot(w) {
                break;
            }
            w = shorter;
        }
        let w = if v.cross(w) < 0.0 { -w } else { w };
        Lattice::of([v, w]).unwrap_or(self)
    }
}

/// The tiles around a window: the least and the greatest numbers of those of which something that lies in `hull` for tile
/// (0, 0) may reach into it. Nothing reaches anywhere.
pub(crate) fn around(lattice: &Lattice, hull: &Bounds, window: &Bounds) -> [TileNumber; 2] {
    if hull.is_empty() || window.is_empty() {
        return [[0, 0], [-1, -1]];
    }
    let corners = |b: &Bounds| {
        let corners = [
            b.min,
            Point::new(b.max.x, b.min.y),
            b.max,
            Point::new(b.min.x, b.max.y),
        ];
        corners.map(|p| lattice.coordinates(p))
    };
    let range = |corners: [[f64; 2]; 4], axis: usize| {
        let of_axis = corners.map(|c| c[axis]);
        let least = of_axis.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = of_axis.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (least, greatest)
    };
    let (own, wanted) = (corners(hull), corners(window));
    let numbers = |axis: usize| {
        let (of_hull, of_window) = (range(own, axis), range(wanted, axis));
        let (first, last) = (of_window.0 - of_hull.1, of_window.1 - of_hull.0);
        (libm::floor(first) as i64, libm::ceil(last) as i64)
    };
    let (along, across) = (numbers(0), numbers(1));
    [[along.0, across.0], [along.1, across.1]]
}

/// The tiles from one to another, by rows.
pub(crate) fn tiles([from, to]: [TileNumber; 2]) -> impl Iterator<Item = TileNumber> {
    (from[1]..=to[1]).flat_map(move |j| (from[0]..=to[0]).map(move |i| [i, j]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_reaches_into_no_window() {
        let lattice = Lattice::of([Point::new(3.0, 1.0), Point::new(-1.0, 2.0)]).expect("periods");
        let window = Bounds::of([Point::ORIGIN, Point::new(9.0, 9.0)]);
        assert_eq!(tiles(around(&lattice, &Bounds::EMPTY, &window)).count(), 0);
        assert_eq!(tiles(around(&lattice, &window, &Bounds::EMPTY)).count(), 0);
        assert!(tiles(around(&lattice, &window, &window)).count() > 20);
    }
}
