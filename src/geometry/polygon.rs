//! Polygons with holes, in floating point: the areas of regions, drawings and cutouts.

use serde::{Deserialize, Serialize};

use super::{Bounds, Point};

/// A closed polyline; the edge from the last point to the first is implied.
pub type Ring = Vec<Point>;

/// An outer ring, counter-clockwise (+x toward +y), and its holes, clockwise. Rings do not cross.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Polygon {
    /// The outer ring.
    pub outer: Ring,
    /// The holes.
    pub holes: Vec<Ring>,
}

impl Polygon {
    /// The rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// The area without the holes.
    pub fn area(&self) -> f64 {
        self.rings().map(|ring| signed_area(ring)).sum()
    }

    /// Whether `p` lies inside, by the even-odd rule; on the border either answer is given.
    pub fn contains(&self, p: Point) -> bool {
        let crosses =
            |a: Point, b: Point| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        let crossings = |ring: &Ring| (0..ring.len()).filter(|&i| crosses(ring[i], ring[(i + 1) % ring.len()])).count();
        self.rings().map(crossings).sum::<usize>() % 2 == 1
    }

    /// The box of the outer ring.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.outer.iter().copied())
    }
}

/// The area that `ring` goes round, positive where it runs from +x toward +y.
pub fn signed_area(ring: &[Point]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    // Measured from the first point, which keeps the digits of a small ring far from (0, 0).
    ring.windows(2).map(|w| (w[0] - origin).cross(w[1] - origin)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_taken_from_the_area() {
        let square = |a: f64, b: f64| vec![Point::new(a, a), Point::new(b, a), Point::new(b, b), Point::new(a, b)];
        let mut hole = square(1.0, 2.0);
        hole.reverse();
        assert_eq!(Polygon { outer: square(0.0, 4.0), holes: vec![hole] }.area(), 15.0);
    }
}
