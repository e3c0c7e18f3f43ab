//! Corners of a net spread evenly over the border that they lie on, so that its triangles are neither narrow nor folded.
//!
//! Each is moved towards the mean of its neighbours and then back to the zero of its bounds: in the plain to that of one
//! bound, on a sharp edge to that of two, along which it moves towards the neighbours on the same edge.

use rayon::prelude::*;

use fretwork_geometry::Point3;
use fretwork_geometry::index::Rows;
use fretwork_geometry::mesh::doubled_normal;

use super::corner::Corner;
use super::wall::Wall;

/// Rounds in which all corners move at once.
const ROUNDS: usize = 2;
/// The part of the way to the mean of its neighbours that a corner moves in a round. All of it lets corners swing.
const PART: f64 = 0.6;
/// Steps of Newton's method to where bounds meet before the last one, at most: from where a corner is first, and from
/// where it was moved to.
const FIRST_STEPS: usize = 2;
const STEPS: usize = 1;
/// Triangles at one corner are folded where the cosine of the angle between them is less than this: at a sharp edge it is about
/// zero.
const FOLDED: f64 = -0.5;
/// The parts of the way back that folded corners go, before they are spread and after it, one round after the other.
const FIRST_BACK: [f64; 2] = [0.5, 1.0];
const LAST_BACK: [f64; 5] = [0.5, 1.0, 1.0, 1.0, 1.0];
/// From how near to the zero of a bound a last step leads to it, in spacings.
const NEAR: f64 = 0.05;

/// The triangles of each corner.
struct Around<'a> {
    triangles: &'a [[u32; 3]],
    rows: Rows,
}

impl Around<'_> {
    fn new(corners: usize, triangles: &[[u32; 3]]) -> Around<'_> {
        let rows = Rows::fill(corners, |filler| {
            for (number, triangle) in (0u32..).zip(triangles) {
                let put = |corner: &u32| filler.put(*corner as usize, number);
                triangle.iter().for_each(put);
            }
        });
        Around { triangles, rows }
    }

    fn triangles_of(&self, corner: usize) -> impl Iterator<Item = [u32; 3]> {
        let numbers = self.rows.row(corner).iter();
        numbers.map(|number| self.triangles[*number as usize])
    }
}

/// The corners where they lie evenly, `spacing` being the side of a cube.
pub fn relaxed(
    wall: &Wall<'_>,
    corners: &[Corner],
    triangles: &[[u32; 3]],
    spacing: f64,
) -> Vec<Point3> {
    let around = Around::new(corners.len(), triangles);
    let settle =
        |corner: &Corner, at: Point3, steps: usize| settled(wall, corner, (at, steps), spacing);
    let mut positions: Vec<Point3> = corners
        .par_iter()
        .map(|corner| settle(corner, corner.sharp, FIRST_STEPS).unwrap_or(corner.sharp))
        .collect();
    unfold(corners, &around, &mut positions, &FIRST_BACK);
    for _ in 0..ROUNDS {
        let moved = |(number, corner): (usize, &Corner)| {
            let here = positions[number];
            let others = around
                .triangles_of(number)
                .flatten()
                .filter(|c| *c as usize != number);
            target(corners, &positions, (corner, others))
                .and_then(|mean| settle(corner, here.lerp(mean, PART), STEPS))
                .unwrap_or(here)
        };
        positions = corners.par_iter().enumerate().map(moved).collect();
    }
    unfold(corners, &around, &mut positions, &LAST_BACK);
    positions
}

/// Puts the corners of triangles that face opposite ways at a corner back, round by round, to where a net has them by itself: there
/// no two do.
fn unfold(corners: &[Corner], around: &Around<'_>, positions: &mut [Point3], back: &[f64]) {
    for part in back {
        let all = (0..corners.len()).into_par_iter();
        let of_corner = |corner: &usize| around.triangles_of(*corner);
        let at = |t: [u32; 3]| t.map(|corner| positions[corner as usize]);
        let folded: Vec<usize> = all
            .filter(|corner| are_folded(of_corner(corner).map(at)))
            .collect();
        let mut moved: Vec<u32> = folded.iter().flat_map(of_corner).flatten().collect();
        moved.sort_unstable();
        moved.dedup();
        for corner in moved {
            let corner = corner as usize;
            positions[corner] = positions[corner].lerp(corners[corner].plain, *part);
        }
    }
}

/// Whether two triangles of a corner face opposite ways.
pub fn are_folded(triangles: impl Iterator<Item = [Point3; 3]>) -> bool {
    let normals: Vec<Point3> = triangles.filter_map(|t| doubled_normal(t).unit()).collect();
    let is_turned = |n: &Point3| normals.iter().any(|m| n.dot(*m) < FOLDED);
    normals.iter().any(is_turned)
}

/// The mean of the neighbours that a corner moves towards. One on a sharp edge of the surface itself stays.
fn target(
    corners: &[Corner],
    positions: &[Point3],
    (corner, beside): (&Corner, impl Iterator<Item = u32>),
) -> Option<Point3> {
    if corner.bounds == 0 || (corner.is_sharp && corner.bounds.count_ones() < 2) {
        return None;
    }
    let counts = |other: &u32| {
        let other = &corners[*other as usize];
        !corner.is_sharp || (other.is_sharp && (other.bounds & corner.bounds).count_ones() > 1)
    };
    let mean_of = beside.filter(counts);
    let (sum, count) = mean_of.fold((Point3::ORIGIN, 0u32), |(sum, count), other| {
        (sum + positions[other as usize], count + 1)
    });
    (count > 1).then(|| sum * (1.0 / f64::from(count)))
}

/// The place near `at` where the bounds of a corner are zero and no other one is passed; nothing where there is none
/// that it may be at.
fn settled(
    wall: &Wall<'_>,
    corner: &Corner,
    (at, steps): (Point3, usize),
    spacing: f64,
) -> Option<Point3> {
    if corner.bounds == 0 {
        return None;
    }
    let (mut p, mut near) = (at, corner.triangle);
    let is_bound = |number: usize, value: f64| {
        value.is_finite() && (corner.bounds >> number & 1 == 1 || value > 0.0)
    };
    for _ in 0..=steps {
        let (mut step, mut off) = (Point3::ORIGIN, 0.0f64);
        for (number, (value, slope)) in wall.bounds(p, &mut near).into_iter().enumerate() {
            if !is_bound(number, value) {
                continue;
            }
            off = off.max(value.abs());
            let steep = slope.dot(slope);
            if steep > 1e-6 {
                step = step - slope * (value / steep);
            }
        }
        p = p + step;
        if step.length() > spacing {
            return None;
        }
        // From so near a step leads as near as another look would tell.
        if off <= NEAR * spacing {
            return corner.within(p, spacing);
        }
    }
    None
}
