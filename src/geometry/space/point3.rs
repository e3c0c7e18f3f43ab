//! Points of space.

use std::ops::{Add, Mul, Neg, Sub};

use serde::{Deserialize, Serialize};

use crate::Point;

/// A point, or a vector, of world space (right-handed, z up).
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(from = "[f64; 3]", into = "[f64; 3]")]
pub struct Point3 {
    /// To the right.
    pub x: f64,
    /// Away, in a view from above upward.
    pub y: f64,
    /// Up.
    pub z: f64,
}

impl Point3 {
    /// (0, 0, 0).
    pub const ORIGIN: Point3 = Point3::new(0.0, 0.0, 0.0);

    /// The point (x, y, z).
    #[inline]
    pub const fn new(x: f64, y: f64, z: f64) -> Point3 {
        Point3 { x, y, z }
    }

    /// The point of the plane z = 0 below `p`, of which no coordinate is mirrored.
    #[inline]
    pub fn flat(p: Point) -> Point3 {
        Point3::new(p.x, p.y, 0.0)
    }

    /// The scalar product.
    #[inline]
    pub fn dot(self, o: Point3) -> f64 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// The vector product.
    #[inline]
    pub fn cross(self, o: Point3) -> Point3 {
        Point3::new(
            self.y * o.z - self.z * o.y,
            self.z * o.x - self.x * o.z,
            self.x * o.y - self.y * o.x,
        )
    }

    /// The euclidean length.
    #[inline]
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The euclidean distance to `o`.
    #[inline]
    pub fn distance(self, o: Point3) -> f64 {
        (o - self).length()
    }

    /// The vector of length one in this direction; none of a vector without a length.
    #[inline]
    pub fn unit(self) -> Option<Point3> {
        let length = self.length();
        (length > 0.0 && length.is_finite()).then(|| self * (1.0 / length))
    }

    /// The point at `t` between `self` (0) and `o` (1).
    #[inline]
    pub fn lerp(self, o: Point3, t: f64) -> Point3 {
        self + (o - self) * t
    }

    /// This vector turned by `angle` radians about the unit vector `axis`, counter-clockwise seen against it.
    #[inline]
    pub fn turned(self, axis: Point3, angle: f64) -> Point3 {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        self * c + axis.cross(self) * s + axis * (axis.dot(self) * (1.0 - c))
    }

    /// Whether all coordinates are finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }
}

impl Add for Point3 {
    type Output = Point3;
    #[inline]
    fn add(self, o: Point3) -> Point3 {
        Point3::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl Sub for Point3 {
    type Output = Point3;
    #[inline]
    fn sub(self, o: Point3) -> Point3 {
        Point3::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Mul<f64> for Point3 {
    type Output = Point3;
    #[inline]
    fn mul(self, k: f64) -> Point3 {
        Point3::new(self.x * k, self.y * k, self.z * k)
    }
}

impl Neg for Point3 {
    type Output = Point3;
    #[inline]
    fn neg(self) -> Point3 {
        Point3::new(-self.x, -self.y, -self.z)
    }
}

impl From<[f64; 3]> for Point3 {
    #[inline]
    fn from([x, y, z]: [f64; 3]) -> Point3 {
        Point3::new(x, y, z)
    }
}

impl From<Point3> for [f64; 3] {
    #[inline]
    fn from(p: Point3) -> [f64; 3] {
        [p.x, p.y, p.z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_is_counter_clockwise_about_the_axis() {
        let x = Point3::new(1.0, 0.0, 0.0);
        let y = x.turned(Point3::new(0.0, 0.0, 1.0), std::f64::consts::FRAC_PI_2);
        assert!(y.distance(Point3::new(0.0, 1.0, 0.0)) < 1e-15);
        assert_eq!(
            x.cross(Point3::new(0.0, 1.0, 0.0)),
            Point3::new(0.0, 0.0, 1.0)
        );
        assert_eq!(Point3::ORIGIN.unit(), None);
    }
}
