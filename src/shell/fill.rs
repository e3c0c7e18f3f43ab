//! A closed body filled with voxels.

use fretwork_geometry::mesh::doubled_normal;
use fretwork_geometry::voxel::{Lattice, Voxel, Voxels};
use fretwork_geometry::{Mesh, Point3, budget};
use rayon::prelude::*;
use std::ops::Range;

use crate::weights::weights;

/// Rays leave the middles of columns by this part of a pitch, along x and y, so that they pass between
/// the corners and edges of bodies that are made on a lattice themselves.
const NUDGE: [f64; 2] = [1.37e-5, 0.91e-5];
/// The most columns and voxels.
const MOST: f64 = 4e8;
/// Parts of a mesh that lie in one another no deeper than this, in pitches, touch: rounding leaves as much.
const TOUCH: f64 = 1e-9;
/// Bytes for each place where a column enters or leaves the body, while they are sorted.
const COLUMN: usize = 64;

/// Why a body is not filled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FillError {
    /// The voxels are larger than the body, or fall between its walls.
    #[error("no voxel of {pitch} has its middle in the body: choose smaller ones")]
    Empty {
        /// The side of a voxel.
        pitch: f64,
    },
    /// There would be too many.
    #[error("{count:.2e} voxels of {pitch} would be too many: choose larger ones")]
    TooMany {
        /// How many the box of the body holds.
        count: f64,
        /// The side of a voxel.
        pitch: f64,
    },
}

/// The voxels of side `pitch` whose middles lie in a closed mesh that faces outward. Where it overlaps
/// itself it is filled once. The lattice lies evenly about the body's box: a box whose sides are
/// multiples of the pitch is filled exactly. O(n + k log k) for n triangles that k columns pass.
///
/// # Errors
/// When there is no voxel, or too many.
pub fn fill(mesh: &Mesh, pitch: f64) -> Result<Voxels, FillError> {
    let bounds = mesh.bounds();
    let size = bounds.size();
    let counts = [size.x, size.y, size.z].map(|side| (side / pitch - 1e-9).ceil().max(1.0));
    let count = counts.iter().product::<f64>();
    let is_numbered = counts.iter().all(|n| *n < f64::from(u16::MAX));
    if !is_numbered || count.is_nan() || count > MOST {
        return Err(FillError::TooMany { count, pitch });
    }
    let lattice = Lattice {
        origin: bounds.center() - Point3::from(counts.map(|n| n * pitch / 2.0)),
        pitch,
    };
    let size = counts.map(|n| n as usize);
    let crossings = crossings(mesh, &lattice, size);
    let columns: Vec<&[(usize, f64, i32)]> = crossings.chunk_by(|a, b| a.0 == b.0).collect();
    let all = columns.iter().map(|column| voxels_of(column, size)).sum();
    budget::make("voxels of a body", all, size_of::<Voxel>());
    let cells: Vec<Voxel> = columns
        .par_iter()
        .flat_map_iter(|column| filled(column, size, 0))
        .collect();
    if cells.is_empty() {
        return Err(FillError::Empty { pitch });
    }
    Ok(Voxels { lattice, cells })
}

/// How many voxels of a filled body lie in several parts of it at once, and the middle of the first; nothing where none does.
/// Costs as much as filling it.
pub fn overlap(mesh: &Mesh, voxels: &Voxels) -> Option<(usize, Point3)> {
    let size = [0, 1, 2].map(|axis| extent(voxels, axis));
    let crossings = crossings(mesh, &voxels.lattice, size);
    let columns = crossings.chunk_by(|a, b| a.0 == b.0);
    let cells: Vec<Voxel> = columns.flat_map(|column| filled(column, size, 1)).collect();
    let first = cells.first()?;
    Some((cells.len(), voxels.lattice.center(*first)))
}

/// How many voxels there may be along an axis, from the first of the lattice.
fn extent(voxels: &Voxels, axis: usize) -> usize {
    let ends = voxels.cells.iter().map(|c| usize::from(c[axis]) + 1);
    ends.max().unwrap_or(0)
}

/// How much of itself each voxel of a filled body stands for; what lies in several parts of it counts once. Costs as much as filling it three times.
pub fn fill_weights(mesh: &Mesh, voxels: &Voxels) -> Vec<f32> {
    let lattice = voxels.lattice;
    let size = [0, 1, 2].map(|axis| extent(voxels, axis));
    // The axes in an order that ends with each of them.
    let turned = |axis: usize| [(axis + 1) % 3, (axis + 2) % 3, axis];
    let along: Vec<Vec<(usize, f64, i32)>> = (0..3)
        .map(|axis| {
            let turn = |p: Point3| {
                let p: [f64; 3] = p.into();
                Point3::from(turned(axis).map(|k| p[k]))
            };
            let mesh = Mesh {
                positions: mesh.positions.iter().map(|p| turn(*p)).collect(),
                triangles: mesh.triangles.clone(),
            };
            let lattice = Lattice {
                origin: turn(lattice.origin),
                pitch: lattice.pitch,
            };
            crossings(&mesh, &lattice, turned(axis).map(|k| size[k]))
        })
        .collect();
    let all: usize = along.iter().map(Vec::len).sum();
    let along: Vec<Vec<(usize, f64, i32)>> = along.into_iter().map(outermost).collect();
    let volume = match along.iter().map(Vec::len).sum::<usize>() == all {
        true => mesh.volume() / lattice.pitch.powi(3),
        false => along.iter().map(|c| length(c)).sum::<f64>() / 3.0,
    };
    let border = |voxel: usize, axis: usize, up: bool| {
        let cell = voxels.cells[voxel].map(usize::from);
        let [x, y, z] = turned(axis);
        let (column, middle) = (cell[x] * size[y] + cell[y], cell[z] as f64 + 0.5);
        let above = along[axis].partition_point(|c| (c.0, c.1) < (column, middle));
        let nearest = if up {
            Some(above)
        } else {
            above.checked_sub(1)
        };
        let found = nearest.and_then(|n| along[axis].get(n));
        let distance = found
            .filter(|crossing| crossing.0 == column)
            .map(|crossing| (crossing.1 - middle).abs());
        distance.filter(|distance| *distance <= 1.0).unwrap_or(0.5)
    };
    weights(voxels, volume, &border)
}

/// Of where columns pass a mesh those places where they enter and leave all of it: the side of a part that lies inside of another
/// bounds nothing.
fn outermost(mut crossings: Vec<(usize, f64, i32)>) -> Vec<(usize, f64, i32)> {
    let (mut column, mut depth) = (usize::MAX, 0);
    crossings.retain(|(number, _, turn)| {
        if *number != column {
            (column, depth) = (*number, 0);
        }
        let was_inside = depth > 0;
        depth += turn;
        was_inside != (depth > 0)
    });
    crossings
}

/// How long all columns are inside together, in pitches, from where they enter and leave.
fn length(crossings: &[(usize, f64, i32)]) -> f64 {
    let signed = crossings.iter().map(|(_, at, turn)| -f64::from(*turn) * at);
    signed.sum()
}

/// Where columns along z enter and leave a mesh, in the order of columns and heights.
fn crossings(mesh: &Mesh, lattice: &Lattice, size: [usize; 3]) -> Vec<(usize, f64, i32)> {
    let doubled = |t: &[u32; 3]| doubled_normal(mesh.corners(*t)).z.abs();
    let shadows =
        mesh.triangles.iter().map(doubled).sum::<f64>() / (2.0 * lattice.pitch * lattice.pitch);
    budget::make("columns of a body", shadows as usize, COLUMN);
    let mut crossings: Vec<(usize, f64, i32)> = mesh
        .triangles
        .par_iter()
        .flat_map_iter(|triangle| passed(mesh.corners(*triangle), lattice, size))
        .collect();
    crossings
        .par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    crossings
}

/// The columns that pass through a triangle: their numbers, at what height in pitches, and whether they
/// enter (1) or leave (-1) there.
fn passed(corners: [Point3; 3], lattice: &Lattice, size: [usize; 3]) -> Vec<(usize, f64, i32)> {
    let normal = doubled_normal(corners);
    let [a, b, c] = corners.map(|p| lattice.place(p));
    let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if normal.z == 0.0 || twice == 0.0 {
        return Vec::new();
    }
    let range = |axis: usize| {
        let low = a[axis].min(b[axis]).min(c[axis]) - 0.5 - NUDGE[axis];
        let high = a[axis].max(b[axis]).max(c[axis]) - 0.5 - NUDGE[axis];
        let end = size[axis] as f64 - 1.0;
        (low.ceil().max(0.0) as usize, high.floor().min(end))
    };
    let ((x0, x1), (y0, y1)) = (range(0), range(1));
    let mut found = Vec::new();
    for x in (x0..).take_while(|x| *x as f64 <= x1) {
        for y in (y0..).take_while(|y| *y as f64 <= y1) {
            let p = [x as f64 + 0.5 + NUDGE[0], y as f64 + 0.5 + NUDGE[1]];
            let part = |q: [f64; 3], r: [f64; 3]| {
                ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / twice
            };
            let shares = [part(b, c), part(c, a), part(a, b)];
            if shares.iter().all(|share| *share >= 0.0) {
                let height = shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2];
                let turn = if normal.z < 0.0 { 1 } else { -1 };
                found.push((x * size[1] + y, height, turn));
            }
        }
    }
    found
}

/// The rows of a column in which it is inside of more parts of a mesh than `parts`.
fn rows(
    column: &[(usize, f64, i32)],
    size: [usize; 3],
    parts: i32,
) -> impl Iterator<Item = Range<usize>> {
    let row = move |height: f64| (height - 0.5).ceil().clamp(0.0, size[2] as f64) as usize;
    let mut depth = 0;
    column.windows(2).filter_map(move |pair| {
        depth += pair[0].2;
        (depth > parts && pair[1].1 - pair[0].1 > TOUCH).then(|| row(pair[0].1)..row(pair[1].1))
    })
}

/// How many voxels a column has.
fn voxels_of(column: &[(usize, f64, i32)], size: [usize; 3]) -> usize {
    rows(column, size, 0).map(|rows| rows.len()).sum()
}

/// The voxels of a column that are inside of more parts of a mesh than `parts`.
fn filled(column: &[(usize, f64, i32)], size: [usize; 3], parts: i32) -> Vec<Voxel> {
    let (x, y) = (column[0].0 / size[1], column[0].0 % size[1]);
    let cell = |z: usize| [x as u16, y as u16, z as u16];
    rows(column, size, parts).flatten().map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point;
    use fretwork_geometry::mesh::revolve;

    /// A ring with a square section from (3, 0) to (7, 4).
    fn ring() -> Mesh {
        let section = [[3.0, 0.0], [7.0, 0.0], [7.0, 4.0], [3.0, 4.0]];
        revolve(&section.map(Point::from), true, 48)
            .unwrap()
            .welded()
    }

    #[test]
    fn a_voxel_is_filled_when_its_middle_is_inside() {
        let mesh = ring();
        let voxels = fill(&mesh, 0.5).unwrap();
        assert!(voxels.cells.is_sorted_by(|a, b| a < b));
        let inside = |p: Point3| {
            // The outline is a polygon of 48 sides.
            let angle = std::f64::consts::PI / 48.0;
            let turn = libm::atan2(p.y, p.x).rem_euclid(2.0 * angle) - angle;
            let apothem = (p.x * p.x + p.y * p.y).sqrt() * libm::cos(turn) / libm::cos(angle);
            (3.0..=7.0).contains(&apothem)
        };
        for x in 0..28u16 {
            for y in 0..28u16 {
                for z in 0..8u16 {
                    let middle = voxels.lattice.center([x, y, z]);
                    let is_filled = voxels.find([x, y, z]).is_some();
                    assert_eq!(is_filled, inside(middle), "{middle:?}");
                }
            }
        }
    }

    #[test]
    fn overlapping_bodies_are_filled_once() {
        let mut both = ring();
        both.append(&ring());
        assert_eq!(
            fill(&both, 0.5).unwrap().cells,
            fill(&ring(), 0.5).unwrap().cells
        );
    }

    /// Two bodies that overlap weigh as much as their union, whether one of them lies inside of the other or not.
    #[test]
    fn overlapping_bodies_weigh_once() {
        let alone = fill(&ring(), 0.5).unwrap();
        assert_eq!(overlap(&ring(), &alone), None);
        // A ring of half the height, deep inside of the first one's height.
        let mut inside = ring();
        let lower = ring()
            .positions
            .into_iter()
            .map(|p| Point3::new(p.x, p.y, 1.0 + 0.5 * p.z));
        inside.append(&Mesh {
            positions: lower.collect(),
            triangles: ring().triangles,
        });
        let mut raised = ring();
        let above = ring()
            .positions
            .into_iter()
            .map(|p| p + Point3::new(0.0, 0.0, 2.0));
        raised.append(&Mesh {
            positions: above.collect(),
            triangles: ring().triangles,
        });
        let mut beside = ring();
        let over = ring()
            .positions
            .into_iter()
            .map(|p| p + Point3::new(0.0, 0.0, 4.0));
        beside.append(&Mesh {
            positions: over.collect(),
            triangles: ring().triangles,
        });
        assert_eq!(overlap(&beside, &fill(&beside, 0.5).unwrap()), None);
        let volume = |mesh: &Mesh| {
            let voxels = fill(mesh, 0.5).unwrap();
            let weights = fill_weights(mesh, &voxels);
            let all: f64 = weights.iter().map(|w| f64::from(*w)).sum();
            (all * 0.125, overlap(mesh, &voxels).is_some())
        };
        let (plain, _) = volume(&ring());
        let (raised, is_told) = volume(&raised);
        assert!(
            is_told && (raised / plain - 1.5).abs() < 0.01,
            "{raised} {plain}"
        );
        let (within, is_told) = volume(&inside);
        assert!(
            is_told && (within / plain - 1.0).abs() < 0.01,
            "{within} {plain}"
        );
    }

    #[test]
    fn too_coarse_and_too_fine_are_refused() {
        assert!(matches!(fill(&ring(), 40.0), Err(FillError::Empty { .. })));
        assert!(matches!(
            fill(&ring(), 1e-4),
            Err(FillError::TooMany { .. })
        ));
    }
}
