//! Where an open surface ends.

use fretwork_geometry::mesh::{doubled_normal, open_sides};
use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Mesh, Point3};

/// How far apart the places of a border are that are looked up, in pitches.
const SAMPLE: f64 = 0.2;

/// The voxels in which an open surface ends.
pub fn rim(mesh: &Mesh, surface: &VoxelSurface) -> Vec<bool> {
    let lattice = &surface.voxels.lattice;
    let mut rim = vec![false; surface.voxels.len()];
    for place in border(mesh, SAMPLE * lattice.pitch) {
        let at = lattice.place(place.at);
        if at.iter().all(|c| (0.0..f64::from(u16::MAX)).contains(c))
            && let Some(v) = surface.voxels.find(at.map(|c| c as u16))
        {
            rim[v] = true;
        }
    }
    rim
}

/// A place of the border of a surface.
pub struct Place {
    /// Where it is.
    pub at: Point3,
    /// The unit vector along the surface, away from its border.
    pub inward: Point3,
    /// The unit normal of the surface.
    pub normal: Point3,
}

/// Places along the border of a surface, no farther than `step` from one another, and none in a corner of it. O(n log n) for n triangles.
pub fn border(mesh: &Mesh, step: f64) -> Vec<Place> {
    let mut open = open_sides(&mesh.triangles);
    open.sort_unstable();
    let mut places = Vec::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = *triangle;
        let sides = [[a, b], [b, c], [c, a]];
        for [from, to] in sides
            .into_iter()
            .filter(|side| open.binary_search(side).is_ok())
        {
            let [p, q] = [from, to].map(|corner| mesh.positions[corner as usize]);
            let normal = doubled_normal(mesh.corners(*triangle)).unit();
            let inward = normal.and_then(|normal| normal.cross(q - p).unit());
            let (Some(normal), Some(inward)) = (normal, inward) else {
                continue;
            };
            let count = (p.distance(q) / step).ceil().max(1.0);
            places.extend((0..count as u64).map(|n| Place {
                at: p.lerp(q, (n as f64 + 0.5) / count),
                inward,
                normal,
            }));
        }
    }
    places
}
