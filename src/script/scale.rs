//! What an evaluation takes from the region that it was started with.

use fretwork_geometry::{Point, Region, Snap};

/// What the evaluation takes from the region that it was started with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Of planar maps.
    pub resolution: f64,
    /// How positions of cells are rounded where they are hashed.
    pub snap: Snap,
}

impl Scale {
    /// Of `region`, where points nearer than `resolution` are one.
    pub fn of(region: &Region, resolution: f64) -> Scale {
        Scale {
            resolution,
            snap: Snap::of(region),
        }
    }

    /// The same with positions rounded to `step`, where there is one.
    pub fn in_steps(self, step: Option<f64>) -> Scale {
        Scale {
            snap: self.snap.in_steps(step),
            ..self
        }
    }

    /// Of the unit square: for what has no region.
    pub fn unit() -> Scale {
        let square = Region::rectangle(Point::ORIGIN, Point::new(1.0, 1.0));
        Scale::of(&square, fretwork_geometry::planar_map::resolution(1.0))
    }
}
