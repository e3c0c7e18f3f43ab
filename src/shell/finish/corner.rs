//! Where the corner of a cube of a net belongs.
//!
//! Each place where the border crosses an edge of a cube gives a plane: the bound that is greatest there, to the
//! first order. The corner is where the planes of its cube meet (Ju and others, Dual Contouring of Hermite Data,
//! 2002); where they are one plane, or nearly, a small pull keeps it near the mean of the crossings. A
//! sharp edge may pass beside the cube: the corner may leave it by half a side.

use fretwork_geometry::Point3;

use super::wall::Wall;

/// The pull towards the mean, beside that of one plane. A sharp edge is missed by so much of the way to it; less lets
/// corners of plain places wander.
const PULL: f64 = 0.01;
/// How far from the middle of its cube a corner may be along each axis, in sides.
const REACH: f64 = 1.0;
/// A crossing with a bound this far from zero, in spacings, was made by a point that was taken in.
const FAR: f64 = 1.0;
/// Planes that lean from one another by more than what has this cosine make a sharp corner: half a right angle.
const SHARP: f64 = 0.7;

/// What is tangent to the border where it crosses an edge of the lattice.
#[derive(Clone, Copy)]
pub struct Plane {
    /// A point of it.
    pub at: Point3,
    /// Its unit normal, outward.
    pub normal: Point3,
    /// The bound that it belongs to.
    pub bound: u8,
    /// The triangle of the surface that is nearest.
    pub triangle: u32,
}

impl Plane {
    /// The plane at a crossing; nothing where no bound is near zero.
    pub fn of(wall: &Wall<'_>, (at, near): (Point3, &mut u32), spacing: f64) -> Option<Plane> {
        let bounds = (0u8..).zip(wall.bounds(at, near));
        let (bound, (value, slope)) = bounds.max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
        let steep = slope.length();
        let normal = slope.unit()?;
        let off = value / steep;
        (off.abs() <= FAR * spacing).then_some(Plane {
            at: at - normal * off,
            normal,
            bound,
            triangle: *near,
        })
    }
}

/// Where a corner of a net is, and may be.
#[derive(Clone, Copy)]
pub struct Corner {
    /// The mean of the places where the border crosses its cube.
    pub plain: Point3,
    /// The middle of its cube.
    pub middle: Point3,
    /// Where its planes meet.
    pub sharp: Point3,
    /// The bounds that its planes belong to, a bit each; none where the border is no zero of them.
    pub bounds: u8,
    /// Whether its planes lean from one another.
    pub is_sharp: bool,
    /// A triangle of the surface that is near to it.
    pub triangle: u32,
}

impl Corner {
    /// The corner of a cube with these crossings and their planes.
    pub fn new(crossings: &[Point3], planes: &[Option<Plane>], middle: Point3, side: f64) -> Self {
        let sum = crossings.iter().fold(Point3::ORIGIN, |sum, at| sum + *at);
        let plain = sum * (1.0 / crossings.len() as f64);
        let held = Corner {
            plain,
            middle,
            sharp: plain,
            bounds: 0,
            is_sharp: false,
            triangle: 0,
        };
        let known: Option<Vec<Plane>> = planes.iter().copied().collect();
        let Some(known) = known else { return held };
        let meet = meeting(&known, plain);
        let is_sharp = known
            .iter()
            .any(|p| known.iter().any(|q| p.normal.dot(q.normal) < SHARP));
        Corner {
            sharp: held.within(meet, side).unwrap_or(plain),
            bounds: known.iter().fold(0, |all, plane| all | 1 << plane.bound),
            is_sharp,
            triangle: known.first().map_or(0, |plane| plane.triangle),
            ..held
        }
    }

    /// `at`, where the corner may be there.
    pub fn within(&self, at: Point3, side: f64) -> Option<Point3> {
        let away: [f64; 3] = (at - self.middle).into();
        let is_near = away.iter().all(|part| part.abs() <= REACH * side);
        is_near.then_some(at)
    }
}

/// Where planes meet, nearest to `mean`: the least squares of the distances, solved as three equations.
fn meeting(planes: &[Plane], mean: Point3) -> Point3 {
    let mut rows = [[0.0; 4]; 3];
    for plane in planes {
        let n: [f64; 3] = plane.normal.into();
        let d = plane.normal.dot(plane.at - mean);
        for (row, part) in rows.iter_mut().zip(n) {
            for (entry, other) in row.iter_mut().zip([n[0], n[1], n[2], d]) {
                *entry += part * other;
            }
        }
    }
    let pull = PULL * planes.len() as f64;
    (0..3).for_each(|k| rows[k][k] += pull);
    let column = |k: usize| Point3::new(rows[0][k], rows[1][k], rows[2][k]);
    let [a, b, c, d] = [0, 1, 2, 3].map(column);
    let whole = a.dot(b.cross(c));
    let parts = [d.dot(b.cross(c)), a.dot(d.cross(c)), a.dot(b.cross(d))];
    mean + Point3::from(parts) * (1.0 / whole)
}
