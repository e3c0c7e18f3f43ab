//! The mean normal of what lies in a voxel.

use fretwork_geometry::voxel::Lattice;
use fretwork_geometry::{Mesh, Point3, mesh};
use rayon::prelude::*;

use super::clip::area_within;
use super::cover::{Piece, placed};

/// Below this length of the mean of unit normals, sides in a voxel face apart. Three faces of a cube that meet in a
/// corner leave 0.58, an edge of 40 degrees 0.34.
const APART: f64 = 0.35;

/// Below this length a mean normal is rounding.
const VANISHING: f64 = 1e-6;

/// For each run of pieces, all of one voxel, the mean of the normals by area, and whether sides in it
/// face apart.
pub(super) fn means(
    mesh: &Mesh,
    lattice: &Lattice,
    runs: &[&[Piece]],
) -> (Vec<[f32; 3]>, Vec<bool>) {
    runs.par_iter()
        .with_min_len(256)
        .map(|run| mean(mesh, lattice, run))
        .unzip()
}

fn mean(mesh: &Mesh, lattice: &Lattice, run: &[Piece]) -> ([f32; 3], bool) {
    let corner = run[0].voxel().map(f64::from);
    let (mut sum, mut total) = (Point3::ORIGIN, 0.0);
    let (mut largest, mut most) = (Point3::ORIGIN, -1.0);
    // Of what only touches the cube there is no area: then every triangle counts alike.
    let mut touching = Point3::ORIGIN;
    for piece in run {
        let corners = placed(mesh, lattice, piece.triangle);
        let normal = mesh::doubled_normal(corners.map(Point3::from));
        let normal = normal.unit().unwrap_or(Point3::ORIGIN);
        let area = area_within(corners, corner);
        sum = sum + normal * area;
        total += area;
        touching = touching + normal;
        if area > most {
            (largest, most) = (normal, area);
        }
    }
    if total < VANISHING {
        let normal = touching.unit().filter(|_| touching.length() > VANISHING);
        return (rounded(normal.unwrap_or(largest)), false);
    }
    let length = sum.length() / total;
    let normal = sum.unit().filter(|_| length > VANISHING);
    (rounded(normal.unwrap_or(largest)), length < APART)
}

fn rounded(n: Point3) -> [f32; 3] {
    [n.x, n.y, n.z].map(|c| c as f32)
}
