//! `curves`: lines in the plane and in space.

use crate::macros::{kinds, record};
use crate::placement::SpacePlace;
use crate::scalar::{Angle, FilePath, Fraction, PositiveLength, Text};
use crate::types::wants;
use crate::value::{List, NonEmpty, SpacePoint};
use crate::{Ref, Tree};

kinds! {
    /// Lines in the plane and in space, by arc length, open or closed, each with a frame that turns smoothly along it. They
    /// live in world space: y points up.
    pub enum Curve {
        /// A circle in the xy plane, counter-clockwise from +x; `at` is its centre.
        circle: Circle(Circle),
        /// A part of a circle in the xy plane, counter-clockwise; `at` is the circle's centre.
        arc: Arc(Arc),
        /// A path of a drawing, mirrored into world space: it looks the same seen from above.
        svg: Svg(SvgCurve),
        /// Straight pieces from point to point.
        polyline: Polyline(Polyline),
        /// A smooth curve (a centripetal Catmull-Rom spline) through points.
        spline: Spline(Spline),
        /// A smooth curve through points of a surface, that keeps to the surface.
        on_surface: OnSurface(OnSurface),
    }
}

record! {
    /// A circle in the xy plane; `at` is its centre.
    pub struct Circle {
        /// Its radius.
        radius: PositiveLength,
    }
    /// Where it stands.
    + placement: SpacePlace
}

record! {
    /// A part of a circle in the xy plane; `at` is the circle's centre.
    pub struct Arc {
        /// The circle's radius.
        radius: PositiveLength,
        /// The angle where it begins, from +x toward +y.
        from: Angle,
        /// The angle where it ends; below `from` it runs clockwise.
        to: Angle,
    }
    /// Where it stands.
    + placement: SpacePlace
}

record! {
    /// A path of an SVG file, mirrored into world space: it looks the same seen from above.
    pub struct SvgCurve {
        /// The drawing.
        file: FilePath,
        /// The path, by its label or id. Without it the drawing must hold one path.
        id: Option<Text>,
        /// How far a polyline may be from the curve that it stands for. Without it, a hundred-thousandth of the drawing's longer side, and 0.01 mm at most: of the object, in a map of its paper if it has a `scale`, and any length if not.
        tolerance: Option<PositiveLength>,
    }
    /// Where it stands.
    + placement: SpacePlace
}

record! {
    /// Straight pieces from point to point.
    pub struct Polyline {
        /// The points, at least two: `[x, y]` or `[x, y, z]`.
        points: NonEmpty<SpacePoint>,
        /// The last point is joined to the first.
        closed: bool = false,
    }
}

record! {
    /// A smooth curve (a centripetal Catmull-Rom spline) through points.
    pub struct Spline {
        /// The points, at least two: `[x, y]` or `[x, y, z]`.
        points: NonEmpty<SpacePoint>,
        /// The last point is joined to the first.
        closed: bool = false,
        /// How far the frame is turned about the curve, linear between these places.
        twist: List<Twist> = Tree::list([]),
    }
}

record! {
    /// A turn of a curve's frame.
    pub struct Twist {
        /// The place: a part of the curve's length.
        at: Fraction,
        /// The turn there.
        angle: Angle,
    }
}

record! {
    /// A smooth curve on a surface.
    pub struct OnSurface {
        /// The surface.
        surface: Ref<wants::Surface>,
        /// Points that it runs through, at least two, each moved to the nearest point of the surface.
        points: NonEmpty<SpacePoint>,
        /// The last point is joined to the first.
        closed: bool = false,
    }
}
