//! Points of the plane, boxes around them, affine maps of them.

use std::ops::{Add, Mul, Neg, Sub};

use serde::{Deserialize, Serialize};

/// A point, or a vector, of the drawing plane (y points down in pictures, as in SVG).
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Point {
    /// To the right.
    pub x: f64,
    /// Downward in pictures.
    pub y: f64,
}

impl Point {
    /// (0, 0).
    pub const ORIGIN: Point = Point { x: 0.0, y: 0.0 };

    /// The point (x, y).
    #[inline]
    pub const fn new(x: f64, y: f64) -> Point {
        Point { x, y }
    }

    /// The unit vector at `angle` radians from +x toward +y.
    #[inline]
    pub fn unit(angle: f64) -> Point {
        Point::new(libm::cos(angle), libm::sin(angle))
    }

    /// The scalar product.
    #[inline]
    pub fn dot(self, other: Point) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// The z component of the vector product: positive where `other` is to the left of `self`,
    /// left being (-y, x).
    #[inline]
    pub fn cross(self, other: Point) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// The vector turned a quarter to its left, (-y, x).
    #[inline]
    pub fn left(self) -> Point {
        Point::new(-self.y, self.x)
    }

    /// The euclidean length.
    #[inline]
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The euclidean distance to `other`.
    #[inline]
    pub fn distance(self, other: Point) -> f64 {
        (other - self).length()
    }

    /// The point at `t` between `self` (0) and `other` (1).
    #[inline]
    pub fn lerp(self, other: Point, t: f64) -> Point {
        self + (other - self) * t
    }

    /// Whether both coordinates are finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl Add for Point {
    type Output = Point;
    #[inline]
    fn add(self, o: Point) -> Point {
        Point::new(self.x + o.x, self.y + o.y)
    }
}

impl Sub for Point {
    type Output = Point;
    #[inline]
    fn sub(self, o: Point) -> Point {
        Point::new(self.x - o.x, self.y - o.y)
    }
}

impl Mul<f64> for Point {
    type Output = Point;
    #[inline]
    fn mul(self, k: f64) -> Point {
        Point::new(self.x * k, self.y * k)
    }
}

impl Neg for Point {
    type Output = Point;
    #[inline]
    fn neg(self) -> Point {
        Point::new(-self.x, -self.y)
    }
}

impl From<[f64; 2]> for Point {
    #[inline]
    fn from([x, y]: [f64; 2]) -> Point {
        Point::new(x, y)
    }
}

impl From<Point> for [f64; 2] {
    #[inline]
    fn from(p: Point) -> [f64; 2] {
        [p.x, p.y]
    }
}

/// An axis-parallel box. Empty when `min` is not below `max`, as [`Bounds::EMPTY`] is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// The corner of least coordinates.
    pub min: Point,
    /// The corner of greatest coordinates.
    pub max: Point,
}

impl Bounds {
    /// The box of no points.
    pub const EMPTY: Bounds = Bounds {
        min: Point::new(f64::INFINITY, f64::INFINITY),
        max: Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The box of `points`.
    #[inline]
    pub fn of(points: impl IntoIterator<Item = Point>) -> Bounds {
        points.into_iter().fold(Bounds::EMPTY, Bounds::with)
    }

    /// The box grown to hold `p`.
    #[inline]
    pub fn with(self, p: Point) -> Bounds {
        Bounds {
            min: Point::new(self.min.x.min(p.x), self.min.y.min(p.y)),
            max: Point::new(self.max.x.max(p.x), self.max.y.max(p.y)),
        }
    }

    /// The box that holds both.
    #[inline]
    pub fn union(self, other: Bounds) -> Bounds {
        if other.is_empty() {
            self
        } else {
            self.with(other.min).with(other.max)
        }
    }

    /// Whether it holds no point.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y)
    }

    /// Extent along x; 0 when empty.
    #[inline]
    pub fn width(&self) -> f64 {
        (self.max.x - self.min.x).max(0.0)
    }

    /// Extent along y; 0 when empty.
    #[inline]
    pub fn height(&self) -> f64 {
        (self.max.y - self.min.y).max(0.0)
    }

    /// The middle.
    #[inline]
    pub fn center(&self) -> Point {
        self.min.lerp(self.max, 0.5)
    }

    /// The longer of width and height.
    #[inline]
    pub fn longer_side(&self) -> f64 {
        self.width().max(self.height())
    }

    /// The box moved outward by `margin` on each side.
    #[inline]
    pub fn grown(&self, margin: f64) -> Bounds {
        let m = Point::new(margin, margin);
        Bounds {
            min: self.min - m,
            max: self.max + m,
        }
    }

    /// Whether `p` lies in the closed box.
    #[inline]
    pub fn contains(&self, p: Point) -> bool {
        self.min.x <= p.x && p.x <= self.max.x && self.min.y <= p.y && p.y <= self.max.y
    }

    /// Whether the closed boxes share a point.
    #[inline]
    pub fn intersects(&self, o: &Bounds) -> bool {
        self.min.x <= o.max.x
            && o.min.x <= self.max.x
            && self.min.y <= o.max.y
            && o.min.y <= self.max.y
    }
}

/// An affine map, p ↦ (a·x + c·y + e, b·x + d·y + f), the order of SVG's `matrix`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Affine(pub [f64; 6]);

impl Affine {
    /// p ↦ p.
    pub const IDENTITY: Affine = Affine([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);

    /// p ↦ p + by.
    #[inline]
    pub fn translation(by: Point) -> Affine {
        Affine([1.0, 0.0, 0.0, 1.0, by.x, by.y])
    }

    /// Scaling about the origin.
    #[inline]
    pub fn scale(x: f64, y: f64) -> Affine {
        Affine([x, 0.0, 0.0, y, 0.0, 0.0])
    }

    /// Rotation about the origin by `angle` radians from +x toward +y.
    #[inline]
    pub fn rotation(angle: f64) -> Affine {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        Affine([c, s, -s, c, 0.0, 0.0])
    }

    /// This map, done about `center` instead of the origin.
    #[inline]
    pub fn about(self, center: Point) -> Affine {
        Affine::translation(-center)
            .then(self)
            .then(Affine::translation(center))
    }

    /// The map that does this one first and `next` after it.
    #[inline]
    pub fn then(self, next: Affine) -> Affine {
        let ([a, b, c, d, e, f], [na, nb, nc, nd, ne, nf]) = (self.0, next.0);
        Affine([
            na * a + nc * b,
            nb * a + nd * b,
            na * c + nc * d,
            nb * c + nd * d,
            na * e + nc * f + ne,
            nb * e + nd * f + nf,
        ])
    }

    /// The image of `p`.
    #[inline]
    pub fn apply(&self, p: Point) -> Point {
        let [a, b, c, d, e, f] = self.0;
        Point::new(a * p.x + c * p.y + e, b * p.x + d * p.y + f)
    }

    /// The factor by which areas grow; negative where the map mirrors.
    #[inline]
    pub fn determinant(&self) -> f64 {
        let [a, b, c, d, ..] = self.0;
        a * d - b * c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn affine_maps_compose_in_reading_order() {
        let turn_then_move = Affine::rotation(std::f64::consts::FRAC_PI_2)
            .then(Affine::translation(Point::new(5.0, 0.0)));
        let p = turn_then_move.apply(Point::new(1.0, 0.0));
        assert!(p.distance(Point::new(5.0, 1.0)) < 1e-15);
        let about = Affine::scale(2.0, 2.0).about(Point::new(1.0, 1.0));
        assert_eq!(about.apply(Point::new(1.0, 1.0)), Point::new(1.0, 1.0));
        assert_eq!(about.apply(Point::new(2.0, 1.0)), Point::new(3.0, 1.0));
    }

    #[test]
    fn bounds_of_nothing_are_empty() {
        assert!(Bounds::of([]).is_empty());
        assert_eq!(Bounds::EMPTY.width(), 0.0);
        assert_eq!(
            Bounds::of([Point::ORIGIN]).union(Bounds::EMPTY),
            Bounds::of([Point::ORIGIN])
        );
    }
}
