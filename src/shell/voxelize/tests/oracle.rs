//! A slow oracle: every voxel of the box is tried against every triangle, by the distance between the
//! triangle and the cube that clipping one by the other tells.

use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Mesh, mesh};

/// Clips the triangle by the six half spaces of the cube grown by `margin`; whether anything is left.
fn meets(triangle: &[[f64; 3]; 3], corner: [f64; 3], margin: f64) -> bool {
    let mut polygon = triangle.to_vec();
    for axis in 0..3 {
        for (sign, plane) in [
            (1.0, corner[axis] - margin),
            (-1.0, corner[axis] + 1.0 + margin),
        ] {
            let height = |p: &[f64; 3]| sign * (p[axis] - plane);
            let mut kept = Vec::new();
            for i in 0..polygon.len() {
                let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                if height(&a) >= 0.0 {
                    kept.push(a);
                }
                if (height(&a) < 0.0) != (height(&b) < 0.0) {
                    let t = height(&a) / (height(&a) - height(&b));
                    kept.push([0, 1, 2].map(|i| a[i] + t * (b[i] - a[i])));
                }
            }
            polygon = kept;
        }
    }
    !polygon.is_empty()
}

/// How far a triangle may be from a voxel that is taken all the same, in pitches. Axes across sides that are
/// nearly along the lattice tell a gap less sharply than others.
const NEAR: f64 = 0.01;

/// That `surface` has every voxel that `mesh` meets and none that it does not, but for what is nearly
/// touched.
pub fn check(mesh: &Mesh, surface: &VoxelSurface) {
    let lattice = &surface.voxels.lattice;
    let triangles: Vec<[[f64; 3]; 3]> = mesh
        .triangles
        .iter()
        .filter(|t| mesh::doubled_normal(mesh.corners(**t)).length() > 0.0)
        .map(|t| mesh.corners(*t).map(|p| lattice.place(p)))
        .collect();
    let top = lattice.place(mesh.bounds().max).map(|c| c as u16 + 2);
    let mut met = 0;
    for x in 0..top[0] {
        for y in 0..top[1] {
            for z in 0..top[2] {
                let corner = [x, y, z].map(f64::from);
                let found = surface.voxels.find([x, y, z]).is_some();
                met += usize::from(found);
                let any = |margin| triangles.iter().any(|t| meets(t, corner, margin));
                assert!(found || !any(0.0), "{x} {y} {z} is missing");
                assert!(!found || any(NEAR), "{x} {y} {z} is too much");
            }
        }
    }
    assert_eq!(met, surface.voxels.len(), "voxels beyond the box");
}
