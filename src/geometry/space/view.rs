//! How space is seen from a side: the drawing plane of a parallel projection.

use super::Point3;
use crate::Point;

/// A parallel view. What is drawn has its own drawing plane, y down: seen from above (+z) it is the plane of regions, so that
/// what was extruded comes back as it was drawn; from a side +z is up; from below left and right change places.
///
/// ```
/// use fretwork_geometry::{Point, Point3, View};
/// let front = View::from(Point3::new(0.0, -2.0, 0.0)).unwrap();
/// assert_eq!(front.flat(Point3::new(1.0, 7.0, 3.0)), Point::new(1.0, -3.0));
/// assert_eq!(front.nearness(Point3::new(1.0, 7.0, 3.0)), -7.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    right: Point3,
    up: Point3,
    toward: Point3,
}

impl View {
    /// The view of somebody who stands in the direction `from`; none of a vector without a length.
    pub fn from(from: Point3) -> Option<View> {
        let toward = from.unit()?;
        let z = Point3::new(0.0, 0.0, 1.0);
        let up = z - toward * toward.z;
        // Of a view along z no direction but y is up.
        let up = if up.length() > 1e-9 {
            up.unit()?
        } else {
            Point3::new(0.0, 1.0, 0.0)
        };
        let right = up.cross(toward).unit()?;
        Some(View { right, up, toward })
    }

    /// Where a point is drawn.
    #[inline]
    pub fn flat(&self, p: Point3) -> Point {
        // Adding 0 leaves no negative zero.
        Point::new(self.right.dot(p) + 0.0, 0.0 - self.up.dot(p))
    }

    /// How near a point is to the viewer: its distance from the origin along the view.
    #[inline]
    pub fn nearness(&self, p: Point3) -> f64 {
        self.toward.dot(p)
    }

    /// The direction to the viewer, of length one.
    #[inline]
    pub fn toward(&self) -> Point3 {
        self.toward
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_seen_upright() {
        let p = Point3::new(1.0, 2.0, 3.0);
        let seen = |from: [f64; 3]| View::from(from.into()).unwrap().flat(p);
        assert_eq!(seen([0.0, 0.0, 5.0]), Point::new(1.0, -2.0));
        assert_eq!(seen([0.0, 0.0, -1.0]), Point::new(-1.0, -2.0));
        assert_eq!(seen([0.0, 1.0, 0.0]), Point::new(-1.0, -3.0));
        assert_eq!(seen([3.0, 0.0, 0.0]), Point::new(2.0, -3.0));
        assert!(View::from(Point3::ORIGIN).is_none());
        let slanted = View::from(Point3::new(1.0, -2.0, 0.5)).unwrap();
        let square = slanted.flat(p).dot(slanted.flat(p)) + slanted.nearness(p).powi(2);
        assert!((square - p.dot(p)).abs() < 1e-12);
    }
}
