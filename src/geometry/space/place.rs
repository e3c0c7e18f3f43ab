//! Affine maps of space, and boxes in it.

use serde::{Deserialize, Serialize};

use super::Point3;

/// An affine map of space, p ↦ x·p.x + y·p.y + z·p.z + origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Affine3 {
    /// The image of the x axis.
    pub x: Point3,
    /// The image of the y axis.
    pub y: Point3,
    /// The image of the z axis.
    pub z: Point3,
    /// The image of the origin.
    pub origin: Point3,
}

impl Affine3 {
    /// p ↦ p.
    pub const IDENTITY: Affine3 = Affine3 {
        x: Point3::new(1.0, 0.0, 0.0),
        y: Point3::new(0.0, 1.0, 0.0),
        z: Point3::new(0.0, 0.0, 1.0),
        origin: Point3::ORIGIN,
    };

    /// p ↦ p + by.
    #[inline]
    pub const fn translation(by: Point3) -> Affine3 {
        Affine3 {
            origin: by,
            ..Affine3::IDENTITY
        }
    }

    /// Scaling about the origin by a factor for each axis.
    #[inline]
    pub fn scale(by: Point3) -> Affine3 {
        let axis = |x, y, z| Point3::new(x, y, z);
        Affine3 {
            x: axis(by.x, 0.0, 0.0),
            y: axis(0.0, by.y, 0.0),
            z: axis(0.0, 0.0, by.z),
            origin: Point3::ORIGIN,
        }
    }

    /// Rotation by `angle` radians about the unit vector `axis` through the origin, counter-clockwise seen against it.
    #[inline]
    pub fn rotation(axis: Point3, angle: f64) -> Affine3 {
        let turned = |p: Point3| p.turned(axis, angle);
        let id = Affine3::IDENTITY;
        Affine3 {
            x: turned(id.x),
            y: turned(id.y),
            z: turned(id.z),
            origin: Point3::ORIGIN,
        }
    }

    /// The map that does this one first and `next` after it.
    #[inline]
    pub fn then(&self, next: &Affine3) -> Affine3 {
        let axis = |p| next.apply_vector(p);
        Affine3 {
            x: axis(self.x),
            y: axis(self.y),
            z: axis(self.z),
            origin: next.apply(self.origin),
        }
    }

    /// The image of the point `p`.
    #[inline]
    pub fn apply(&self, p: Point3) -> Point3 {
        self.apply_vector(p) + self.origin
    }

    /// The image of the vector `v`, which is not moved.
    #[inline]
    pub fn apply_vector(&self, v: Point3) -> Point3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// The factor by which volumes grow; negative where the map mirrors.
    #[inline]
    pub fn determinant(&self) -> f64 {
        self.x.dot(self.y.cross(self.z))
    }

    /// Whether the axes stay square to one another, so that the map is a scaling, a turn and a move.
    #[inline]
    pub fn is_square(&self) -> bool {
        let square = |a: Point3, b: Point3| a.dot(b).abs() <= 1e-9 * a.length() * b.length();
        square(self.x, self.y) && square(self.y, self.z) && square(self.z, self.x)
    }

    /// Whether all coefficients are finite.
    #[inline]
    pub fn is_finite(&self) -> bool {
        [self.x, self.y, self.z, self.origin]
            .iter()
            .all(|p| p.is_finite())
    }
}

/// An axis-parallel box. Empty when `min` is not below `max`, as [`Bounds3::EMPTY`] is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds3 {
    /// The corner of least coordinates.
    pub min: Point3,
    /// The corner of greatest coordinates.
    pub max: Point3,
}

impl Bounds3 {
    /// The box of no points.
    pub const EMPTY: Bounds3 = Bounds3 {
        min: Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        max: Point3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The box of `points`.
    #[inline]
    pub fn of(points: impl IntoIterator<Item = Point3>) -> Bounds3 {
        points.into_iter().fold(Bounds3::EMPTY, Bounds3::with)
    }

    /// The box grown to hold `p`.
    #[inline]
    pub fn with(self, p: Point3) -> Bounds3 {
        let (a, b) = (self.min, self.max);
        Bounds3 {
            min: Point3::new(a.x.min(p.x), a.y.min(p.y), a.z.min(p.z)),
            max: Point3::new(b.x.max(p.x), b.y.max(p.y), b.z.max(p.z)),
        }
    }

    /// The box that holds both.
    #[inline]
    pub fn union(self, other: Bounds3) -> Bounds3 {
        if other.is_empty() {
            self
        } else {
            self.with(other.min).with(other.max)
        }
    }

    /// Whether it holds no point.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// The extents along the axes; 0 when empty.
    #[inline]
    pub fn size(&self) -> Point3 {
        if self.is_empty() {
            Point3::ORIGIN
        } else {
            self.max - self.min
        }
    }

    /// The middle.
    #[inline]
    pub fn center(&self) -> Point3 {
        if self.is_empty() {
            Point3::ORIGIN
        } else {
            self.min.lerp(self.max, 0.5)
        }
    }

    /// The longest of the extents.
    #[inline]
    pub fn longest_side(&self) -> f64 {
        let size = self.size();
        size.x.max(size.y).max(size.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_compose_in_reading_order() {
        let up = Point3::new(0.0, 0.0, 1.0);
        let turn = Affine3::rotation(up, std::f64::consts::FRAC_PI_2);
        let map = turn.then(&Affine3::translation(Point3::new(5.0, 0.0, 0.0)));
        assert!(
            map.apply(Point3::new(1.0, 0.0, 2.0))
                .distance(Point3::new(5.0, 1.0, 2.0))
                < 1e-15
        );
        assert!(map.is_square() && (map.determinant() - 1.0).abs() < 1e-15);
        let sheared = Affine3::scale(Point3::new(1.0, 2.0, 1.0)).then(&Affine3::rotation(up, 0.5));
        assert!(sheared.is_square());
        assert!(
            !turn
                .then(&Affine3::rotation(up, 0.5))
                .then(&Affine3::scale(Point3::new(1.0, 2.0, 1.0)))
                .is_square()
        );
    }

    #[test]
    fn boxes_of_nothing_are_empty() {
        assert!(Bounds3::of([]).is_empty());
        assert_eq!(
            (Bounds3::EMPTY.size(), Bounds3::EMPTY.longest_side()),
            (Point3::ORIGIN, 0.0)
        );
        let b = Bounds3::of([Point3::ORIGIN])
            .union(Bounds3::EMPTY)
            .with(Point3::new(1.0, 2.0, -3.0));
        assert_eq!(
            (b.longest_side(), b.center()),
            (3.0, Point3::new(0.5, 1.0, -1.5))
        );
    }
}
