//! Surfaces unrolled: for every triangle its place in the drawing, and its place in a plane in which a way around the
//! surface is a ring. `turned`, `swept` and `patch` make charts; `flatten` finds the one of a patch.

mod flatten;
mod patch;
mod swept;
mod turned;

use fretwork_geometry::{Bounds, Form, OnMesh, Point, Point3, SurfaceMesh, polyline};

use crate::WrapError;

/// A triangle of the surface in a chart.
#[derive(Clone, Copy, Debug)]
pub struct Flap {
    /// The numbers of its corners in the mesh.
    pub corners: [u32; 3],
    /// Where they are in the drawing, x to the right and y up.
    pub drawn: [Point; 3],
    /// Where they are in the plane of counting, counter-clockwise.
    pub plan: [Point; 3],
    /// Lengths on the surface by those in the drawing.
    pub stretch: Stretch,
}

/// Lengths on the surface by those in the drawing.
#[derive(Clone, Copy, Debug)]
pub enum Stretch {
    /// The same all over a triangle: least, mean, greatest.
    Even([f64; 3]),
    /// Those around, at each corner of a triangle, between which they change evenly; lengths across are kept.
    Around([f64; 3]),
}

impl Flap {
    /// Lengths at some places of the triangle by those in the drawing: least, mean, greatest. Lengths around are `fit` times
    /// what they are in the chart.
    pub fn stretched(&self, places: [&OnMesh; 3], fit: f64) -> [f64; 3] {
        let around = match self.stretch {
            Stretch::Even(stretch) => return stretch,
            Stretch::Around(around) => around,
        };
        let at = |place: &OnMesh| {
            let own = |corner: u32| self.corners.iter().position(|own| *own == corner);
            let parts = place.of.iter().zip(place.weights);
            let parts = parts.filter(|(_, weight)| *weight > 0.0);
            parts
                .map(|(corner, weight)| own(*corner).map(|i| around[i] * weight))
                .sum::<Option<f64>>()
        };
        let is_even = around.iter().all(|one| *one == around[0]);
        let found = if is_even {
            around
        } else {
            places.map(|p| at(p).unwrap_or(around[0]))
        };
        let found = found.map(|one| one * fit);
        let least = found.iter().copied().fold(1.0, f64::min);
        let most = found.iter().copied().fold(1.0, f64::max);
        [least, (found.iter().sum::<f64>() / 3.0).sqrt(), most]
    }
}

/// How the drawing comes back to its beginning on the way around.
#[derive(Clone, Copy, Debug)]
pub enum Deck {
    /// It does not.
    Open,
    /// By so much to the right.
    Step(f64),
    /// By so much of a turn, counter-clockwise about this place.
    Turn(Point, f64),
}

/// What of the drawing's plane the surface covers.
#[derive(Clone, Copy, Debug)]
pub enum Room {
    /// From here to there along x, everything where it is none; and along y.
    Strip(Option<[f64; 2]>, [f64; 2]),
    /// The distances from the apex of a cone, with whether the apex is above.
    Sector(Point, [f64; 2], bool),
    /// What the flaps cover.
    Flaps,
}

/// A surface unrolled, with the place that the middle of the drawing comes to in its origin.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The triangles that are in it.
    pub flaps: Vec<Flap>,
    /// The numbers of those that are not.
    pub others: Vec<u32>,
    /// The way around.
    pub deck: Deck,
    /// Its extent.
    pub room: Room,
    /// How many times as long the way around would be on a true circle: the flat pieces of a mesh are a little short of it.
    pub slack: f64,
}

impl Chart {
    /// How far it is around at the height of the origin; none where nothing goes around.
    pub fn around(&self) -> Option<f64> {
        match self.deck {
            Deck::Open => None,
            Deck::Step(step) => Some(step.abs()),
            Deck::Turn(center, turn) => Some(center.length() * turn.abs()),
        }
    }
}

/// What has to be known of a drawing before the surface is unrolled for it.
#[derive(Clone, Copy, Debug)]
pub struct Demand {
    /// The place for its middle.
    pub at: Option<Point3>,
    /// How far it reaches from its middle.
    pub reach: f64,
    /// The box of what is laid once, with its middle in the origin.
    pub extent: Bounds,
    /// Copies are laid on the way around.
    pub is_around: bool,
    /// Copies meet on the way around, so that a step must lead on.
    pub in_rows: bool,
}

/// The surface unrolled around a place.
///
/// # Errors
/// A surface that is broken or cannot be unrolled there, and no place where one is needed.
pub fn chart(surface: &SurfaceMesh, demand: &Demand) -> Result<Chart, WrapError> {
    surface.validate().map_err(|_| WrapError::Broken)?;
    match &surface.form {
        Form::Turned(form) => turned::chart(form, demand),
        Form::Swept(form) => swept::chart(form, demand),
        Form::Free => patch::chart(&surface.mesh, demand),
    }
}

/// The place on a ring about the origin for a part of the way around and a height above the lowest.
fn ring(part: f64, height: f64, radius: f64) -> Point {
    Point::unit(-std::f64::consts::TAU * part) * (radius + height)
}

/// The point of a polyline nearest to `p`: how far along it that is.
fn along(points: &[Point], closed: bool, p: Point) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    let mut length = 0.0;
    let last = if closed {
        points.len()
    } else {
        points.len() - 1
    };
    for i in 0..last {
        let (a, b) = (points[i], points[(i + 1) % points.len()]);
        let way = b - a;
        let t = ((p - a).dot(way) / way.dot(way)).clamp(0.0, 1.0);
        let distance = a.lerp(b, t).distance(p);
        if distance < best.0 {
            best = (distance, length + t * way.length());
        }
        length += way.length();
    }
    best.1
}

/// Where a polyline crosses itself on pieces that are covered from `low` to `high`, which may go round a closed one.
fn crossing(points: &[Point], closed: bool, [low, high]: [f64; 2]) -> Option<Point> {
    let s = lengths(points, closed);
    let whole = s[s.len() - 1];
    let is_covered = |piece: usize| {
        let meets = |by: f64| s[piece] + by < high && s[piece + 1] + by > low;
        meets(0.0) || closed && (meets(whole) || meets(-whole))
    };
    polyline::crossing(points, closed, is_covered)
}

/// How far along a polyline its points are; where it is closed, with the way back to the first.
fn lengths(points: &[Point], closed: bool) -> Vec<f64> {
    let mut lengths = vec![0.0];
    let last = if closed {
        points.len()
    } else {
        points.len() - 1
    };
    for i in 0..last {
        lengths.push(lengths[i] + points[i].distance(points[(i + 1) % points.len()]));
    }
    lengths
}
