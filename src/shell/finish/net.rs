//! The border of a body as a mesh: the dual of the lattice's cubes, known as a surface net (Gibson,
//! Constrained Elastic Surface Nets, 1998).
//!
//! Each cube that the border passes gets one corner, the mean of the places where the border crosses
//! the cube's edges; where two bounds of the wall meet in the cube it is moved to where both are zero,
//! so that edges stay sharp. Each crossed edge gets a quadrilateral over the four cubes around it. A
//! well-composed body has one piece of border in a cube, so that the mesh is a closed 2-manifold.

use rayon::prelude::*;

use fretwork_geometry::mesh::doubled_normal;
use fretwork_geometry::{Mesh, Point3};

use super::compose::Body;
use super::samples::Samples;
use super::untangle::{Corner, untangle};
use super::wall::Wall;

/// Where the value of a point that was taken in lies below zero, in spacings.
const TAKEN: f64 = 0.1;
/// The cosine of the angle by which a move may turn a triangle: a little more than the half of a sharp
/// edge.
const LEAST_TURN: f64 = 0.3;
/// Rounds of putting corners back.
const ROUNDS: usize = 4;
/// Steps of Newton's method to where bounds meet.
const STEPS: usize = 3;
/// How near to the zero of a bound counts as there, in spacings.
const NEAR: f64 = 0.1;
/// How near to a point of the lattice a crossing may be, in spacings.
const LEAST_PART: f64 = 0.01;

/// An edge of the lattice that the border crosses.
struct Crossing {
    /// The cubes around it, counter-clockwise seen from outside.
    cubes: [usize; 4],
    at: Point3,
    /// The bound that is crossed, if it is known.
    bound: Option<u8>,
}

/// The border of a well-composed body of samples, facing outward.
pub fn net(wall: &Wall<'_>, body: &Body, samples: &Samples) -> Mesh {
    let crossings = crossings(body, samples);
    let mut touched: Vec<(usize, u32)> = crossings
        .iter()
        .enumerate()
        .flat_map(|(number, crossing)| crossing.cubes.map(|cube| (cube, number as u32)))
        .collect();
    touched.par_sort_unstable();
    let groups: Vec<&[(usize, u32)]> = touched.chunk_by(|a, b| a.0 == b.0).collect();
    let cubes: Vec<usize> = groups.iter().map(|group| group[0].0).collect();
    let (plain, mut positions): (Vec<Point3>, Vec<Point3>) = groups
        .par_iter()
        .map(|group| {
            let of_cube = group.iter().map(|(_, n)| &crossings[*n as usize]);
            let sum = of_cube.clone().fold(Point3::ORIGIN, |sum, c| sum + c.at);
            let mean = sum * (1.0 / group.len() as f64);
            let bounds = of_cube
                .filter_map(|c| c.bound)
                .fold(0, |all, bound| all | 1 << bound);
            (mean, sharpened(wall, samples, (group[0].0, bounds), mean))
        })
        .unzip();
    let corner = |cube: usize| cubes.partition_point(|c| *c < cube) as u32;
    let triangles: Vec<[u32; 3]> = crossings
        .par_iter()
        .flat_map_iter(|crossing| split(crossing.cubes.map(corner), &plain))
        .collect();
    unfold(&triangles, &plain, &mut positions);
    let mut mesh = Mesh {
        positions,
        triangles,
    };
    let middle = |cube: &usize| {
        samples
            .lattice
            .center(samples.place(*cube).map(|n| n as u16))
    };
    let corners = plain.into_iter().zip(cubes.iter().map(middle));
    let corners: Vec<Corner> = corners
        .map(|(plain, middle)| Corner { plain, middle })
        .collect();
    untangle(&mut mesh, &corners, samples.lattice.pitch);
    mesh
}

/// Puts corners back whose move has turned a triangle over, until there is none.
fn unfold(triangles: &[[u32; 3]], plain: &[Point3], positions: &mut [Point3]) {
    for _ in 0..ROUNDS {
        let normal = |of: &[Point3], t: &[u32; 3]| doubled_normal(t.map(|c| of[c as usize]));
        let is_folded = |t: &&[u32; 3]| {
            let (before, after) = (normal(plain, t), normal(positions, t));
            before.dot(after) < LEAST_TURN * before.length() * after.length()
        };
        let folded: Vec<[u32; 3]> = triangles.par_iter().filter(is_folded).copied().collect();
        let mut is_moved = false;
        for corner in folded.into_iter().flatten() {
            is_moved |= positions[corner as usize] != plain[corner as usize];
            positions[corner as usize] = plain[corner as usize];
        }
        if !is_moved {
            break;
        }
    }
}

/// The corner of a cube that several bounds cross, moved to where they are zero together. It stays in the
/// cube, and where it is if there is no such place.
fn sharpened(
    wall: &Wall<'_>,
    samples: &Samples,
    (cube, crossed): (usize, u8),
    mean: Point3,
) -> Point3 {
    if crossed.count_ones() < 2 {
        return mean;
    }
    let low = samples.place(cube);
    let mut p = mean;
    for _ in 0..STEPS {
        let mut step = Point3::ORIGIN;
        for (number, (value, slope)) in wall.bounds(p).into_iter().enumerate() {
            let steep = slope.dot(slope);
            if crossed >> number & 1 == 1 && steep > 1e-6 && value.is_finite() {
                step = step - slope * (value / steep);
            }
        }
        let [x, y, z] = samples.lattice.place(p + step);
        let [x, y, z] = [(x, low[0]), (y, low[1]), (z, low[2])]
            .map(|(at, low)| at.clamp(low as f64, low as f64 + 1.0));
        p = samples.lattice.point([x, y, z]);
    }
    let off = |p: Point3| {
        let crossed = (0..)
            .zip(wall.bounds(p))
            .filter(|(number, _)| crossed >> number & 1 == 1);
        crossed.fold(0.0, |most: f64, (_, (value, _))| most.max(value.abs()))
    };
    if off(p) <= NEAR * samples.lattice.pitch {
        p
    } else {
        mean
    }
}

/// A quadrilateral as two triangles, along its shorter diagonal.
fn split([a, b, c, d]: [u32; 4], positions: &[Point3]) -> [[u32; 3]; 2] {
    let length = |p: u32, q: u32| positions[p as usize].distance(positions[q as usize]);
    if length(a, c) <= length(b, d) {
        [[a, b, c], [a, c, d]]
    } else {
        [[b, c, d], [b, d, a]]
    }
}

fn crossings(body: &Body, samples: &Samples) -> Vec<Crossing> {
    let inside: Vec<usize> = body.inside().collect();
    let steps = body.steps();
    inside
        .par_iter()
        .flat_map_iter(|&index| {
            let out = move |axis: usize| {
                let (up, down) = (index + steps[axis], index - steps[axis]);
                [(up, true), (down, false)].map(|(other, up)| (axis, other, up))
            };
            (0..3)
                .flat_map(out)
                .filter(|(_, other, _)| !body.holds(*other))
                .map(move |(axis, other, up)| crossing(samples, steps, (index, other, axis, up)))
        })
        .collect()
}

/// The crossing between a point inside and its neighbour outside, up or down an axis.
fn crossing(
    samples: &Samples,
    steps: [usize; 3],
    (inside, outside, axis, up): (usize, usize, usize, bool),
) -> Crossing {
    let spacing = samples.lattice.pitch;
    let low = match samples.value(inside) {
        value if value < 0.0 => value.max(-spacing),
        _ => -TAKEN * spacing,
    };
    let high = samples.value(outside).min(spacing);
    // A corner on a point of the lattice would be shared by triangles without area.
    let part = (low / (low - high)).clamp(LEAST_PART, 1.0 - LEAST_PART);
    let place = |index: usize| {
        samples
            .lattice
            .point(samples.place(index).map(|n| n as f64))
    };
    let base = inside.min(outside);
    let (b, c) = (steps[(axis + 1) % 3], steps[(axis + 2) % 3]);
    let mut cubes = [base - b - c, base - c, base, base - b];
    if !up {
        cubes.reverse();
    }
    Crossing {
        cubes,
        at: place(inside).lerp(place(outside), part),
        bound: samples.bound(outside),
    }
}
