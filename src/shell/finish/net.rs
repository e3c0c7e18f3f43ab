//! The border of a body as a mesh: the dual of the lattice's cubes, known as a surface net (Gibson,
//! Constrained Elastic Surface Nets, 1998).
//!
//! Each cube that the border passes gets one corner, where the planes meet that touch the border where it crosses the
//! cube's edges (`corner`), so that edges stay sharp. Each crossed edge gets a quadrilateral over the four cubes around it. A
//! well-composed body has one piece of border in a cube, so that the mesh is a closed 2-manifold. Its corners are
//! then spread evenly (`relax`), kept from passing through one another (`untangle`), and its narrow
//! triangles are taken out (`slivers`).

use rayon::prelude::*;

use fretwork_geometry::mesh::Surface;
use fretwork_geometry::{Mesh, Point3};

use super::compose::Body;
use super::corner::{Corner, Plane};
use super::relax::relaxed;
use super::samples::Samples;
use super::slivers::{FIXED, Mended, sine, without_slivers};
use super::untangle::{DEPTH, untangle};
use super::wall::Wall;

/// Where the value of a point that was taken in lies below zero, in spacings.
const TAKEN: f64 = 0.1;
/// How near to a point of the lattice a crossing may be, in spacings.
const LEAST_PART: f64 = 0.01;
/// Crossings that are looked at one after the other: the surface is searched from where the last one was.
const CHUNK: usize = 512;
/// Rounds of taking narrow triangles out, each without those that made the mesh pass through itself.
const ROUNDS: usize = 6;

/// An edge of the lattice that the border crosses.
struct Crossing {
    /// The cubes around it, counter-clockwise seen from outside.
    cubes: [usize; 4],
    at: Point3,
}

/// The border of a well-composed body of samples, facing outward; some corners may be of no triangle.
pub fn net(wall: &Wall<'_>, body: &Body, samples: &Samples) -> Mesh {
    let spacing = samples.lattice.pitch;
    let crossings = crossings(body, samples);
    let (cubes, corners) = corners(wall, samples, &crossings);
    let number = |cube: usize| cubes.partition_point(|c| *c < cube) as u32;
    let quads: Vec<[u32; 4]> = crossings
        .par_iter()
        .map(|crossing| crossing.cubes.map(number))
        .collect();
    drop(crossings);
    let halves = |positions: &[Point3]| -> Vec<[u32; 3]> {
        quads
            .par_iter()
            .flat_map_iter(|quad| split(*quad, positions))
            .collect()
    };
    let plain: Vec<Point3> = corners.iter().map(|corner| corner.plain).collect();
    let positions = relaxed(wall, &corners, &halves(&plain), spacing);
    let mut mesh = Mesh {
        triangles: halves(&positions),
        positions,
    };
    let left = untangle(&mut mesh, &corners, spacing);
    smooth(mesh, &corners, (spacing, &left))
}

/// The cubes that the border passes, ascending, and their corners.
fn corners(
    wall: &Wall<'_>,
    samples: &Samples,
    crossings: &[Crossing],
) -> (Vec<usize>, Vec<Corner>) {
    let spacing = samples.lattice.pitch;
    let of_chunk = |chunk: &[Crossing]| -> Vec<Option<Plane>> {
        let mut near = 0;
        let at = |crossing: &Crossing| Plane::of(wall, (crossing.at, &mut near), spacing);
        chunk.iter().map(at).collect()
    };
    let planes: Vec<Option<Plane>> = crossings
        .par_chunks(CHUNK)
        .flat_map_iter(of_chunk)
        .collect();
    let mut touched: Vec<(usize, u32)> = crossings
        .iter()
        .enumerate()
        .flat_map(|(number, crossing)| crossing.cubes.map(|cube| (cube, number as u32)))
        .collect();
    touched.par_sort_unstable();
    let groups: Vec<&[(usize, u32)]> = touched.chunk_by(|a, b| a.0 == b.0).collect();
    let corner = |group: &&[(usize, u32)]| {
        let of_cube = || group.iter().map(|(_, number)| *number as usize);
        let places: Vec<Point3> = of_cube().map(|n| crossings[n].at).collect();
        let planes: Vec<Option<Plane>> = of_cube().map(|n| planes[n]).collect();
        let cube = samples.place(group[0].0).map(|n| n as u16);
        Corner::new(&places, &planes, samples.lattice.center(cube), spacing)
    };
    let corners = groups.par_iter().map(corner).collect();
    (groups.iter().map(|group| group[0].0).collect(), corners)
}

/// The mesh without its narrow triangles, as far as it passes through itself in no more than the pairs that are `left`
/// without that.
fn smooth(mesh: Mesh, corners: &[Corner], (spacing, left): (f64, &[[u32; 2]])) -> Mesh {
    let rank = |corner: &Corner| match corner.is_sharp {
        true => corner.bounds.count_ones().max(2) as u8,
        false => 1,
    };
    let mut ranks: Vec<u8> = corners.iter().map(rank).collect();
    for _ in 0..ROUNDS {
        let Mended {
            mesh: smooth,
            changed,
            of,
        } = without_slivers(mesh.clone(), &ranks);
        let is_changed = |t: usize| changed.binary_search(&(t as u32)).is_ok();
        let is_old = |t: &u32| of.binary_search(t).is_ok_and(|t| !is_changed(t));
        let old = left.iter().filter(|pair| pair.iter().all(is_old));
        let tangled = Surface::new(&smooth).overlaps_of(&changed, DEPTH * spacing);
        if tangled.len() + old.count() <= left.len() {
            return smooth;
        }
        let of_pair = tangled.into_iter().flatten();
        of_pair
            .flat_map(|t| smooth.triangles[t as usize])
            .for_each(|corner| ranks[corner as usize] = FIXED);
    }
    mesh
}

/// A mesh without the corners that no triangle has.
pub fn compact(mut mesh: Mesh) -> Mesh {
    let mut numbers = vec![0u32; mesh.positions.len()];
    let of_triangles = mesh.triangles.iter().flatten();
    of_triangles.for_each(|corner| numbers[*corner as usize] = 1);
    let mut old = 0;
    mesh.positions.retain(|_| {
        old += 1;
        numbers[old - 1] == 1
    });
    let mut next = 0;
    for number in &mut numbers {
        next += *number;
        *number = next.saturating_sub(1);
    }
    let corners = mesh.triangles.par_iter_mut().flatten();
    corners.for_each(|corner| *corner = numbers[*corner as usize]);
    mesh
}

/// A quadrilateral as two triangles: those of the two pairs whose narrowest is the less narrow.
fn split([a, b, c, d]: [u32; 4], positions: &[Point3]) -> [[u32; 3]; 2] {
    let pairs = [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]];
    let worst = |pair: &[[u32; 3]; 2]| {
        let narrow = pair.map(|t| sine(t.map(|corner| positions[corner as usize])));
        narrow[0].min(narrow[1])
    };
    if worst(&pairs[0]) >= worst(&pairs[1]) {
        pairs[0]
    } else {
        pairs[1]
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
    }
}
