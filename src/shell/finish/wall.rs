//! The wall that a pattern becomes: a function of space that is negative inside of it.
//!
//! The wall of thickness t about a surface holds the points whose nearest place on the surface is
//! covered by the pattern and not farther than t / 2 from them. Three bounds meet in it: the distance
//! to the surface, the border of the pattern, and the border of the surface, where it has one. Each is
//! a distance near its own zero, and the wall's function is the greatest of them, so that the wall has
//! flat sides and a flat rim.

use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::mesh::nearest::{Foot, Nearest};
use fretwork_geometry::mesh::{Bounds3, doubled_normal};
use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Mesh, Point3, Side};
use rayon::prelude::*;

use super::coverage::Coverage;

/// How many bounds a wall has.
pub const BOUNDS: usize = 3;

/// How many places of a surface are looked at for walls that run into one another.
const PLACES: usize = 3000;
/// The cosine of the angle from which on a place of the surface faces the other way: at an edge of the surface it faces aside.
const ACROSS: f64 = -0.3;
/// The part of the way to a side of the wall that nothing else of the surface may be nearer than.
const ROOM: f64 = 0.8;

/// The end of a surface that is farther away than the wall is thick, and by so many pitches, bounds nothing.
const IDLE: f64 = 4.0;

/// How thick a wall is, and where it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thickness {
    /// Its thickness, as a length.
    pub thickness: f64,
    /// On which side of the surface it lies.
    pub side: Side,
}

impl Thickness {
    /// How far the middle of the wall is in front of the surface.
    pub fn offset(&self) -> f64 {
        match self.side {
            Side::Center => 0.0,
            Side::Inside => -self.thickness / 2.0,
            Side::Outside => self.thickness / 2.0,
        }
    }

    /// How far the wall reaches from the surface.
    pub fn reach(&self) -> f64 {
        self.offset().abs() + self.thickness / 2.0
    }
}

/// On which part of a surface a wall of this thickness runs into another one, and a place of those: where what is as far in front
/// of the surface or behind it as the wall reaches is much nearer to another place of it. Some thousand places are looked at; nothing
/// where there is none.
pub fn crowding(
    mesh: &Mesh,
    surface: &VoxelSurface,
    thickness: Thickness,
) -> Option<(f64, Point3)> {
    let nearest = Nearest::new(mesh);
    let (half, offset) = (thickness.thickness / 2.0, thickness.offset());
    let step = surface.voxels.len().div_ceil(PLACES).max(1);
    let places: Vec<usize> = (0..surface.voxels.len()).step_by(step).collect();
    let is_crowded = |v: &usize| {
        let normal = Point3::from(surface.normals[*v].map(f64::from)).unit();
        let foot = nearest.foot(surface.voxels.lattice.center(surface.voxels.cells[*v]));
        let (Some(normal), Some(foot)) = (normal, foot) else {
            return false;
        };
        [offset + half, offset - half].into_iter().any(|height| {
            let there = nearest.foot(foot.at + normal * height);
            there.is_some_and(|there| {
                let other = doubled_normal(mesh.corners(mesh.triangles[there.triangle as usize]));
                let is_across = other.dot(normal) < ACROSS * other.length();
                is_across && there.distance < ROOM * height.abs()
            })
        })
    };
    let crowded: Vec<usize> = places.par_iter().copied().filter(is_crowded).collect();
    let first = *crowded.first()?;
    let at = surface.voxels.lattice.center(surface.voxels.cells[first]);
    Some((crowded.len() as f64 / places.len() as f64, at))
}

/// The wall of a pattern.
pub struct Wall<'a> {
    mesh: &'a Mesh,
    nearest: Nearest<'a>,
    normals: Normals,
    border: Option<BoxTree<3>>,
    segments: Vec<[Point3; 2]>,
    coverage: &'a Coverage<'a>,
    thickness: Thickness,
}

impl<'a> Wall<'a> {
    /// The wall about a welded mesh where `coverage` says so.
    pub fn new(mesh: &'a Mesh, coverage: &'a Coverage<'a>, thickness: Thickness) -> Wall<'a> {
        let normals = Normals::of(mesh);
        let segments: Vec<[Point3; 2]> = normals
            .border
            .iter()
            .map(|edge| edge.map(|corner| mesh.positions[corner as usize]))
            .collect();
        let boxes = |segment: &[Point3; 2]| -> Extent<3> { Bounds3::of(*segment).into() };
        let boxes: Vec<Extent<3>> = segments.iter().map(boxes).collect();
        Wall {
            mesh,
            nearest: Nearest::new(mesh),
            border: (!boxes.is_empty()).then(|| BoxTree::new(&boxes)),
            normals,
            segments,
            coverage,
            thickness,
        }
    }

    /// The value at `p`, a length: negative inside. Farther than `far` outside of the wall's thickness only that counts.
    /// `near` is a triangle that may be near, as of a neighbour, and becomes the one that is nearest.
    pub fn value(&self, p: Point3, near: &mut u32, far: f64) -> f64 {
        let Some(foot) = self.nearest.foot_from(p, *near) else {
            return f64::INFINITY;
        };
        *near = foot.triangle;
        let apart = foot.distance - self.thickness.reach();
        if apart > far {
            return apart;
        }
        let values = self.bounds_at(p, foot).map(|(value, _)| value);
        values.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The three bounds at `p` with their gradients: the thickness, the border of the pattern, the
    /// border of the surface. A point is inside where all are negative. `near` is as for the value.
    pub fn bounds(&self, p: Point3, near: &mut u32) -> [(f64, Point3); BOUNDS] {
        let Some(foot) = self.nearest.foot_from(p, *near) else {
            return [(f64::INFINITY, Point3::ORIGIN); BOUNDS];
        };
        *near = foot.triangle;
        self.bounds_at(p, foot)
    }

    fn bounds_at(&self, p: Point3, foot: Foot) -> [(f64, Point3); BOUNDS] {
        let triangle = self.mesh.triangles[foot.triangle as usize];
        let corners = self.mesh.corners(triangle);
        let flat = doubled_normal(corners).unit().unwrap_or(Point3::ORIGIN);
        let away = p - foot.at;
        let mut out = away.unit().unwrap_or(flat);
        let (mut height, mut beyond) = (foot.distance, (f64::NEG_INFINITY, Point3::ORIGIN));
        if let Some(border) = &self.border {
            let (distance, at) = self.border_distance(border, foot.at);
            if distance <= 1e-9 * (1.0 + foot.distance) {
                let rise = away.dot(flat);
                let along = away - flat * rise;
                height = rise.abs();
                out = if rise < 0.0 { -flat } else { flat };
                beyond = (along.length(), along.unit().unwrap_or_default());
            } else {
                beyond = (-distance, (at - foot.at).unit().unwrap_or_default());
            }
        }
        let offset = self.thickness.offset();
        // Without an offset both sides are alike, and the side of a foot need not be known.
        let is_behind = offset != 0.0 && out.dot(self.normals.at(&foot, triangle, corners)) < 0.0;
        let front = if is_behind { -1.0 } else { 1.0 };
        let rise = front * height - offset;
        let outward = out * front;
        let across = rise.abs() - self.thickness.thickness / 2.0;
        let outward = if rise < 0.0 { -outward } else { outward };
        let (outside, slope) = self.coverage.outside(foot.at, flat);
        let slope = slope - flat * slope.dot(flat);
        [(across, outward), (outside, slope), beyond]
    }

    /// The distance of the border, and its nearest place; where it is so far that it bounds nothing, how far it is at
    /// least, and no place of it.
    fn border_distance(&self, border: &BoxTree<3>, p: Point3) -> (f64, Point3) {
        let here = Extent::from([p.x, p.y, p.z]);
        let far = self.thickness.thickness + IDLE * self.coverage.pitch();
        let mut best = (far, p);
        border.nearest_first(
            |extent, _| Some(extent.distance(&here)),
            far,
            |number| {
                let [a, b] = self.segments[number as usize];
                let along = b - a;
                let t = (p - a).dot(along) / along.dot(along).max(f64::MIN_POSITIVE);
                let at = a.lerp(b, t.clamp(0.0, 1.0));
                if p.distance(at) < best.0 {
                    best = (p.distance(at), at);
                }
                best.0
            },
        );
        best
    }
}

/// The normals by which the sides of a mesh are told apart: of an edge the sum of its triangles', of a
/// corner their sum by angle (Bærentzen and Aanæs, Signed Distance Computation Using the Angle Weighted
/// Pseudonormal, 2005).
struct Normals {
    /// For each triangle those of the sides from its corners 0 to 1, 1 to 2, 2 to 0.
    sides: Vec<[Point3; 3]>,
    corners: Vec<Point3>,
    /// The edges of one triangle only.
    border: Vec<[u32; 2]>,
}

impl Normals {
    fn of(mesh: &Mesh) -> Normals {
        let flat = |t: &[u32; 3]| doubled_normal(mesh.corners(*t)).unit();
        let flats: Vec<Point3> = mesh
            .triangles
            .iter()
            .map(|t| flat(t).unwrap_or_default())
            .collect();
        let mut edges: Vec<([u32; 2], u32, usize)> = Vec::with_capacity(3 * flats.len());
        let mut corners = vec![Point3::ORIGIN; mesh.positions.len()];
        for (number, triangle) in mesh.triangles.iter().enumerate() {
            let points = mesh.corners(*triangle);
            for side in 0..3 {
                let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
                edges.push(([a.min(b), a.max(b)], number as u32, side));
                let (next, back) = (
                    points[(side + 1) % 3] - points[side],
                    points[(side + 2) % 3] - points[side],
                );
                let angle = libm::atan2(next.cross(back).length(), next.dot(back));
                corners[a as usize] = corners[a as usize] + flats[number] * angle;
            }
        }
        edges.sort_unstable();
        let mut sides = vec![[Point3::ORIGIN; 3]; flats.len()];
        let mut border = Vec::new();
        for group in edges.chunk_by(|a, b| a.0 == b.0) {
            let sum = group
                .iter()
                .fold(Point3::ORIGIN, |sum, e| sum + flats[e.1 as usize]);
            for (_, triangle, side) in group {
                sides[*triangle as usize][*side] = sum;
            }
            if let [(edge, ..)] = group {
                border.push(*edge);
            }
        }
        Normals {
            sides,
            corners,
            border,
        }
    }

    /// The normal at a place of a triangle.
    fn at(&self, foot: &Foot, triangle: [u32; 3], corners: [Point3; 3]) -> Point3 {
        let [a, b, c] = corners;
        let twice = doubled_normal(corners);
        let weight = |p: Point3, q: Point3| (p - foot.at).cross(q - foot.at).dot(twice);
        let whole = twice.dot(twice);
        let weights = [weight(b, c), weight(c, a), weight(a, b)];
        let is_zero: [bool; 3] = weights.map(|w| w <= 1e-9 * whole);
        match is_zero {
            [false, true, true] => self.corners[triangle[0] as usize],
            [true, false, true] => self.corners[triangle[1] as usize],
            [true, true, false] => self.corners[triangle[2] as usize],
            [true, false, false] => self.sides[foot.triangle as usize][1],
            [false, true, false] => self.sides[foot.triangle as usize][2],
            [false, false, true] => self.sides[foot.triangle as usize][0],
            _ => twice,
        }
    }
}
