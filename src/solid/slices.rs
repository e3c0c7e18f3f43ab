//! A body in slices for models of stacked sheets: one section a sheet, side by side in the plane, numbered, with holes for pins.
//! What is engraved on the sheets is drawn elsewhere.

use std::sync::Arc;

use fretwork_geometry::drawing::Join;
use fretwork_geometry::mesh::{SectionError, sections};
use fretwork_geometry::polygon::{AreaError, intersect, offset, subtract};
use fretwork_geometry::{
    Affine, Bounds, CurveLabels, LabelSet, Mesh, Point, Polygon, Region, Ring, View, budget,
};

/// More slices than this are refused.
const MOST: f64 = 5000.0;
/// Bytes for a slice beside its points.
const SLICE: usize = 1000;
/// Corners of a hole for a pin.
const CORNERS: u32 = 48;

/// How a body is sliced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slicing {
    /// The view against which slices lie; the first is the farthest from the viewer.
    pub view: View,
    /// How thick a sheet is.
    pub every: f64,
    /// Between slices side by side.
    pub gap: f64,
    /// How many slices stand in a row; about as many as rows where it is not said.
    pub columns: Option<usize>,
    /// The diameter of the holes for pins; none where it is 0.
    pub pins: f64,
}

/// Why a body has no slices.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SliceError {
    /// More slices than anybody stacks.
    #[error(
        "there would be {count} slices, more than {MOST}; sheets of {least} or thicker give fewer"
    )]
    TooMany {
        /// How many.
        count: f64,
        /// The thickness that is the least.
        least: f64,
    },
    /// The holes for pins have no place in common.
    #[error(
        "no place for pins lies inside of all slices: slice {slice} has none in common with those before it where a hole {diameter} wide keeps {} of the sheet around it", 0.5 * .diameter
    )]
    NoPins {
        /// The first slice that has none.
        slice: usize,
        /// The diameter of the holes.
        diameter: f64,
    },
    /// A section could not be made.
    #[error(transparent)]
    Section(#[from] SectionError),
    /// An area could not be computed.
    #[error(transparent)]
    Area(#[from] AreaError),
}

/// The slices of a closed mesh as one region, in rows from the upper left: slice n, the nth from below, is the section in the
/// middle of the nth sheet (in the middle of what there is in it, for the last), labelled `n` on its inside; a point named `n`
/// stands where the origin of the body comes to. The sum of areas times thicknesses is the volume but for what the midpoint
/// rule leaves out. A slice that is empty keeps its place and number.
///
/// Two pins go through all slices where all have material for them, a radius around each, as far apart as can be.
///
/// # Errors
/// [`SliceError`].
pub fn slices(mesh: &Mesh, slicing: &Slicing) -> Result<Region, SliceError> {
    let (levels, heights) = levels(mesh, slicing)?;
    let mut areas = sections(mesh, &slicing.view, &levels)?;
    if slicing.pins > 0.0 {
        let holes = pins(&areas, slicing.pins)?;
        for area in areas.iter_mut().filter(|area| !area.is_empty()) {
            *area = subtract(area, &holes)?;
        }
    }
    let bounds = Bounds::of(mesh.positions.iter().map(|p| slicing.view.flat(*p)));
    let columns = slicing.columns.unwrap_or_else(|| {
        let across = heights as f64 * (bounds.height() + slicing.gap);
        let columns = (across / (bounds.width() + slicing.gap)).sqrt().round();
        columns.max(1.0) as usize
    });
    let mut whole = Region::of_area(Vec::new());
    for (area, n) in areas.into_iter().zip(0..) {
        let step = Point::new(bounds.width() + slicing.gap, bounds.height() + slicing.gap);
        let corner = Point::new((n % columns) as f64 * step.x, (n / columns) as f64 * step.y);
        put(&mut whole, n + 1, &area, corner - bounds.min);
    }
    Ok(whole)
}

/// The levels of the sections, and how many there are.
fn levels(mesh: &Mesh, slicing: &Slicing) -> Result<(Vec<f64>, usize), SliceError> {
    let nearness = mesh.positions.iter().map(|p| slicing.view.nearness(*p));
    let (low, high) = nearness.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    // What is thinner than this part of a sheet at the end is an error of rounding.
    let count = ((high - low) / slicing.every - 1e-6).ceil().max(1.0);
    if count > MOST {
        let least = (high - low) / MOST;
        return Err(SliceError::TooMany { count, least });
    }
    let count = count as usize;
    budget::make("slices", count, SLICE);
    let level = |i: usize| {
        let begin = low + slicing.every * i as f64;
        0.5 * (begin + (begin + slicing.every).min(high))
    };
    Ok(((0..count).map(level).collect(), count))
}

/// Adds slice `number`, moved by `by`.
fn put(whole: &mut Region, number: usize, area: &[Polygon], by: Point) {
    let name: Arc<str> = number.to_string().into();
    let moved = Region::of_area(area.to_vec()).transformed(&Affine::translation(by));
    let labels = CurveLabels {
        left: LabelSet::one(&name),
        ..CurveLabels::default()
    };
    for curve in moved.contour.iter() {
        whole.contour.push(curve.points.iter().copied(), labels);
    }
    whole.contour.name_point(name, by);
    whole.area.extend(moved.area);
}

/// The holes for two pins in all slices.
fn pins(areas: &[Vec<Polygon>], diameter: f64) -> Result<Vec<Polygon>, SliceError> {
    let mut common: Option<Vec<Polygon>> = None;
    for (area, n) in areas.iter().zip(1..) {
        if area.is_empty() {
            continue;
        }
        let inner = offset(area, -diameter, Join::Miter(4.0), 1e-3 * diameter)?;
        let left = match common {
            None => inner,
            Some(common) => intersect(&common, &inner)?,
        };
        if left.is_empty() {
            return Err(SliceError::NoPins { slice: n, diameter });
        }
        common = Some(left);
    }
    let corners: Vec<Point> = common
        .iter()
        .flatten()
        .flat_map(Polygon::rings)
        .flatten()
        .copied()
        .collect();
    let Some(&any) = corners.first() else {
        return Ok(Vec::new());
    };
    let one = farthest(&corners, any);
    let other = farthest(&corners, one);
    let apart = one.distance(other) > 2.0 * diameter;
    let places = if apart { vec![one, other] } else { vec![one] };
    Ok(places.into_iter().map(|at| disc(at, diameter)).collect())
}

fn farthest(corners: &[Point], from: Point) -> Point {
    let farther = |best: Point, p: &Point| {
        if p.distance(from) > best.distance(from) {
            *p
        } else {
            best
        }
    };
    corners.iter().fold(from, farther)
}

fn disc(center: Point, diameter: f64) -> Polygon {
    let corner = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(CORNERS);
        center + Point::unit(angle) * (0.5 * diameter)
    };
    let outer: Ring = (0..CORNERS).map(corner).collect();
    Polygon {
        outer,
        holes: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point3;

    fn slicing(every: f64, pins: f64) -> Slicing {
        Slicing {
            view: View::from(Point3::new(0.0, 0.0, 1.0)).unwrap(),
            every,
            gap: 5.0,
            columns: None,
            pins,
        }
    }

    fn area(region: &Region) -> f64 {
        region.area.iter().map(Polygon::area).sum()
    }

    #[test]
    fn slices_of_a_ball_have_its_volume_and_places_of_their_own() {
        let ball = crate::ball(20.0, 96).unwrap();
        let sliced = slices(&ball, &slicing(0.5, 0.0)).unwrap();
        assert_eq!(sliced.area.len(), 80);
        assert!((area(&sliced) * 0.5 / ball.volume() - 1.0).abs() < 2e-3);
        for (n, polygon) in (1..).zip(&sliced.area) {
            let origin = sliced.contour.point_named(&n.to_string()).unwrap();
            assert!(polygon.bounds().center().distance(origin) < 1e-9);
        }
        let first = sliced.contour.get(0).labels.left;
        assert!(first.contains("1"));
    }

    #[test]
    fn pins_go_through_all_slices_or_are_refused() {
        let bar = crate::cuboid(Point3::new(40.0, 20.0, 9.0)).unwrap();
        let sliced = slices(&bar, &slicing(3.0, 3.0)).unwrap();
        assert!(sliced.area.iter().all(|slice| slice.holes.len() == 2));
        let hole = area(&slices(&bar, &slicing(3.0, 0.0)).unwrap()) - area(&sliced);
        assert!((hole / 6.0 - std::f64::consts::PI * 2.25).abs() < 0.05);
        let ball = crate::ball(20.0, 48).unwrap();
        let refused = slices(&ball, &slicing(2.0, 12.0));
        let wanted = SliceError::NoPins {
            slice: 1,
            diameter: 12.0,
        };
        assert_eq!(refused, Err(wanted));
    }

    #[test]
    fn the_last_sheet_is_cut_in_the_middle_of_what_there_is() {
        let bar = crate::cuboid(Point3::new(4.0, 4.0, 10.0)).unwrap();
        assert_eq!(slices(&bar, &slicing(3.0, 0.0)).unwrap().area.len(), 4);
        assert_eq!(slices(&bar, &slicing(2.0, 0.0)).unwrap().area.len(), 5);
        assert_eq!(slices(&bar, &slicing(99.0, 0.0)).unwrap().area.len(), 1);
        assert!(matches!(
            slices(&bar, &slicing(1e-3, 0.0)),
            Err(SliceError::TooMany { .. })
        ));
    }
}
