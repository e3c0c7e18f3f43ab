//! Where things are seen.

use fretwork_geometry::{Bounds, Model, Point, Point3};

/// The part of the picture's sides that stays free, on both sides together.
const MARGIN: f64 = 0.08;

/// An orthographic camera.
pub struct Camera {
    /// To the right in the picture.
    pub right: Point3,
    /// Upward in the picture.
    pub up: Point3,
    /// Toward the viewer.
    pub toward: Point3,
    /// The height of the picture in pixels.
    pub height: u32,
    /// Pixels to a unit.
    scale: f64,
    /// The place in the middle of the picture, along `right` and `up`.
    middle: Point,
    /// The middle of the picture in pixels.
    half: Point,
}

impl Camera {
    /// A camera that sees all of `model` from `toward`, a unit vector, in a picture of this width.
    /// The picture is no more than twice as high as wide, and no less than a quarter. Up is z, or y
    /// where z is seen from its end.
    pub fn new(model: &Model, toward: Point3, width: u32) -> Camera {
        let z = Point3::new(0.0, 0.0, 1.0);
        let above = if toward.cross(z).length() > 1e-6 {
            z
        } else {
            Point3::new(0.0, 1.0, 0.0)
        };
        let right = above
            .cross(toward)
            .unit()
            .unwrap_or(Point3::new(1.0, 0.0, 0.0));
        let up = toward.cross(right);
        let mut seen = Bounds::EMPTY;
        for part in &model.parts {
            let positions = model.bodies[part.body as usize].mesh.positions.iter();
            let places = positions.map(|p| part.place.apply(*p));
            seen = places.fold(seen, |seen, p| {
                seen.with(Point::new(p.dot(right), p.dot(up)))
            });
        }
        let inner = f64::from(width) * (1.0 - MARGIN);
        let margin = f64::from(width) * MARGIN;
        let widest = seen.longer_side().max(f64::MIN_POSITIVE);
        let across = if seen.width() > 0.0 {
            inner / seen.width()
        } else {
            f64::INFINITY
        };
        let height = (seen.height() * across.min(1e12 / widest) + margin)
            .clamp(f64::from(width) / 4.0, f64::from(width) * 2.0)
            .round()
            .max(1.0);
        let along = if seen.height() > 0.0 {
            (height - margin).max(0.5) / seen.height()
        } else {
            f64::INFINITY
        };
        let scale = across.min(along).min(1e12 / widest);
        Camera {
            right,
            up,
            toward,
            height: height as u32,
            scale,
            middle: seen.center(),
            half: Point::new(f64::from(width) / 2.0, height / 2.0),
        }
    }

    /// A direction in the frame of the camera: to the right, up, toward the viewer.
    pub fn turn(&self, direction: Point3) -> Point3 {
        Point3::new(
            direction.dot(self.right),
            direction.dot(self.up),
            direction.dot(self.toward),
        )
    }

    /// The place of `p` in the picture, in pixels from the upper left corner, and how near it is,
    /// in pixels too.
    pub fn project(&self, p: Point3) -> Point3 {
        let (x, y) = (
            p.dot(self.right) - self.middle.x,
            p.dot(self.up) - self.middle.y,
        );
        Point3::new(
            self.half.x + x * self.scale,
            self.half.y - y * self.scale,
            p.dot(self.toward) * self.scale,
        )
    }
}
