//! Areas to be cut out of a sheet, with a proven number of components and holes, and what they
//! lie on. How they come about is known to the rooms that make them.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{Imprint, Point, Point3, Polygon, Ribbon, Ring, polygon, topology};

/// What the coordinates of a [`Cutout`]'s polygons mean.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Carrier {
    /// The drawing plane (y down).
    Plane,
    /// The strip along an open curve: x is the arc length u, y is v, across the curve.
    Strip(Arc<Ribbon>),
    /// The strip along a closed curve, laid as a ring about the origin: u runs clockwise from +x, v outward.
    Ring {
        /// The strip.
        ribbon: Arc<Ribbon>,
        /// The distance of v = 0 from the origin.
        radius: f64,
    },
    /// A surface, which the pattern is pressed into: x and y are those of the drawing that was laid on it, y up.
    Surface(Arc<Imprint>),
}

/// How a drawing lies on a surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wrapping {
    /// How many copies go around.
    pub copies: usize,
    /// A length on the surface by what it was in the drawing: least, mean and greatest.
    pub stretch: [f64; 3],
    /// The area on the surface.
    pub area: f64,
    /// Components and holes of all copies as they lay in the plane.
    pub flat: topology::Topology,
}

/// What a pattern was made of.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Synthesis {
    /// How many pieces the exemplar was cut into.
    pub pieces_in: usize,
    /// How many pieces the pattern has.
    pub pieces_out: usize,
    /// Their numbers in order.
    pub pieces: Vec<usize>,
    /// The sum of the costs of their seams.
    pub seam_cost: f64,
}

/// The figures of a cutout beside its counts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// The length of the curve, or the extent along x.
    pub length: f64,
    /// The area of the polygons as they are cut flat.
    pub area: f64,
    /// The width of the narrowest neck; none where there is no neck.
    pub min_width: Option<f64>,
    /// How it was put together from pieces, where it was.
    pub synthesis: Option<Synthesis>,
    /// How it lies on a surface, where it was laid on one.
    pub wrapping: Option<Wrapping>,
}

/// On which side of what a cutout lies on its thickness goes.
///
/// The outer side of the drawing plane is above it; that of the strip along a curve is told by
/// [`Ribbon::outward`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// Half of it on each side.
    Center,
    /// On the inner side.
    Inside,
    /// On the outer side.
    Outside,
}

/// Polygons with holes whose numbers of components and holes are proven.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cutout {
    /// Simple polygons that do not touch, in the coordinates of the carrier.
    pub polygons: Vec<Polygon>,
    /// How many connected components they have.
    pub components: usize,
    /// How many holes, without those round which a closed curve runs.
    pub holes: usize,
    /// How many components run round a closed curve: each has one hole more.
    pub around: usize,
    /// What the polygons lie on.
    pub carrier: Carrier,
    /// The strip of a closed curve cut open at u = 0, as it is developed: x is u, y is v. Empty for others.
    pub developed: Vec<Polygon>,
    /// It is cut flat as the developed strip even where its curve is planar.
    pub is_strip: bool,
    /// Where its thickness goes when it is made solid.
    pub side: Side,
    /// Figures.
    pub measures: Measures,
}

impl Cutout {
    /// A cutout of the drawing plane, on which its thickness stands; none when `polygons` are not simple.
    pub fn planar(polygons: Vec<Polygon>) -> Result<Cutout, topology::TopologyError> {
        let counts = topology::count(&polygons)?;
        let bounds = polygons
            .iter()
            .fold(crate::Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let area = polygons.iter().map(Polygon::area).sum();
        Ok(Cutout {
            polygons,
            components: counts.components,
            holes: counts.holes,
            around: 0,
            carrier: Carrier::Plane,
            developed: Vec::new(),
            is_strip: false,
            side: Side::Outside,
            measures: Measures {
                length: bounds.width(),
                area,
                ..Measures::default()
            },
        })
    }

    /// Whether it is cut flat as it lies in space: in the drawing plane, or along a planar curve in that one's plane.
    pub fn is_in_place(&self) -> bool {
        match &self.carrier {
            Carrier::Plane => true,
            Carrier::Strip(ribbon) | Carrier::Ring { ribbon, .. } => {
                ribbon.plane().is_some() && !self.is_strip
            }
            Carrier::Surface(_) => false,
        }
    }

    /// Where `p`, in the coordinates of the carrier, lies along and across the curve; of a plane its own coordinates.
    pub fn along_and_across(&self, p: Point) -> (f64, f64) {
        match &self.carrier {
            Carrier::Plane | Carrier::Strip(_) | Carrier::Surface(_) => (p.x, p.y),
            Carrier::Ring { ribbon, radius } => unroll(p, *radius, ribbon.curve().length()),
        }
    }

    /// Where `p`, in the coordinates of the carrier, lies in space, `w` out of the surface that it is on. The drawing plane
    /// is mirrored: what is drawn looks the same from above. What is pressed into a surface has its places there, and here
    /// that of the drawing.
    pub fn place(&self, p: Point, w: f64) -> Point3 {
        let (u, v) = self.along_and_across(p);
        match &self.carrier {
            Carrier::Plane => Point3::new(u, -v, w),
            Carrier::Surface(_) => Point3::new(u, v, w),
            Carrier::Strip(ribbon) | Carrier::Ring { ribbon, .. } => ribbon.place(u, v, w),
        }
    }

    /// Between which distances a body of this thickness lies, as the `w` of [`Cutout::place`], if the
    /// thickness goes to `side`.
    ///
    /// ```
    /// use fretwork_geometry::{Cutout, Side};
    /// let cutout = Cutout::planar(Vec::new()).unwrap();
    /// assert_eq!(cutout.thickness_between(3.0, Side::Center), [-1.5, 1.5]);
    /// assert_eq!(cutout.thickness_between(3.0, Side::Inside), [-3.0, 0.0]);
    /// ```
    pub fn thickness_between(&self, thickness: f64, side: Side) -> [f64; 2] {
        let outward = match &self.carrier {
            Carrier::Plane | Carrier::Surface(_) => 1.0,
            Carrier::Strip(ribbon) | Carrier::Ring { ribbon, .. } => ribbon.outward(),
        };
        match side {
            Side::Center => [-0.5 * thickness, 0.5 * thickness],
            Side::Outside if outward > 0.0 => [0.0, thickness],
            Side::Inside if outward < 0.0 => [0.0, thickness],
            Side::Outside | Side::Inside => [-thickness, 0.0],
        }
    }

    /// The polygons as they are cut flat, in the drawing plane (y down): bent in place along a planar curve (in the
    /// curve's own plane, from above), else the developed strip.
    pub fn flat(&self) -> Vec<Polygon> {
        let ribbon = match &self.carrier {
            Carrier::Plane => return self.polygons.clone(),
            Carrier::Surface(_) => return mapped(&self.polygons, |p| Point::new(p.x, -p.y)),
            Carrier::Strip(ribbon) | Carrier::Ring { ribbon, .. } => ribbon,
        };
        let Some(normal) = ribbon.plane().filter(|_| !self.is_strip) else {
            let developed = if self.developed.is_empty() {
                &self.polygons
            } else {
                &self.developed
            };
            return mapped(developed, |p| Point::new(p.x, -p.y));
        };
        let (x, y) = plane_axes(normal);
        mapped(&self.polygons, |p| {
            let at = self.place(p, 0.0);
            Point::new(at.dot(x), -at.dot(y))
        })
    }
}

/// The place of the ring coordinates that stands for (u, v) along a closed curve of this length.
pub fn roll(u: f64, v: f64, radius: f64, length: f64) -> Point {
    Point::unit(-std::f64::consts::TAU * (u / length)) * (radius + v)
}

/// The (u, v) of a place of the ring.
fn unroll(p: Point, radius: f64, length: f64) -> (f64, f64) {
    let turn = libm::atan2(-p.y, p.x) / std::f64::consts::TAU;
    (
        length * if turn < 0.0 { turn + 1.0 } else { turn },
        p.length() - radius,
    )
}

/// The axes of the plane with this normal: x and y themselves where it points up or down.
fn plane_axes(normal: Point3) -> (Point3, Point3) {
    let x = Point3::new(1.0, 0.0, 0.0);
    let side = x - normal * normal.x;
    let x = if normal.x.abs() > 0.9 {
        None
    } else {
        side.unit()
    };
    let x = x.unwrap_or(Point3::new(0.0, 1.0, 0.0));
    let x = (x - normal * normal.dot(x)).unit().unwrap_or(x);
    (x, normal.cross(x))
}

/// The polygons moved point by point, in the one order and sense that equal areas have.
pub fn mapped(polygons: &[Polygon], map: impl Fn(Point) -> Point) -> Vec<Polygon> {
    let ring = |r: &Ring| -> Ring { r.iter().map(|&p| map(p)).collect() };
    let moved = |p: &Polygon| Polygon {
        outer: ring(&p.outer),
        holes: p.holes.iter().map(ring).collect(),
    };
    polygon::canonical(polygons.iter().map(moved).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Across, SpaceCurve};

    #[test]
    fn rolling_up_can_be_undone() {
        for (u, v) in [(0.0, 0.0), (3.0, 1.0), (9.9, -2.0)] {
            let (u2, v2) = unroll(roll(u, v, 5.0, 10.0), 5.0, 10.0);
            assert!((u - u2).abs() < 1e-12 && (v - v2).abs() < 1e-12);
        }
    }

    #[test]
    fn a_strip_in_the_plane_is_drawn_as_seen_from_above() {
        let line = SpaceCurve::new([Point3::ORIGIN, Point3::new(0.0, 10.0, 0.0)], false).unwrap();
        let ribbon = Arc::new(Ribbon::new(line, Across::Plane, false).unwrap());
        let square = [[0., 0.], [4., 0.], [4., 1.], [0., 1.]]
            .map(Point::from)
            .to_vec();
        let polygons = vec![Polygon {
            outer: square,
            holes: vec![],
        }];
        let cutout = Cutout {
            carrier: Carrier::Strip(ribbon),
            ..Cutout::planar(polygons).unwrap()
        };
        // Up in the drawing is -y, left of the curve is -x.
        let flat = cutout.flat();
        assert_eq!(flat[0].bounds().min, Point::new(-1.0, -4.0));
        assert!(flat[0].area() > 0.0 && cutout.is_in_place());
        let strip = Cutout {
            is_strip: true,
            ..cutout
        };
        assert_eq!(strip.flat()[0].bounds().max, Point::new(4.0, 0.0));
        assert!(!strip.is_in_place());
    }

    #[test]
    fn only_simple_polygons_are_cutouts() {
        let eight = [[0., 0.], [2., 2.], [2., 0.], [0., 2.]]
            .map(Point::from)
            .to_vec();
        assert!(
            Cutout::planar(vec![Polygon {
                outer: eight,
                holes: vec![]
            }])
            .is_err()
        );
    }
}
