//! Why each part of a finished body is solid.

use fretwork_geometry::index::KdTree;
use fretwork_geometry::shell::Reason;
use fretwork_geometry::voxel::{Voxel, VoxelSurface};
use fretwork_geometry::{Mesh, Point3};

/// For each corner of the mesh why the solid voxel nearest to it is solid: in the first pattern, in the
/// structure, or only at the end.
pub fn reasons(
    surface: &VoxelSurface,
    mesh: &Mesh,
    [first, held, all]: [&[bool]; 3],
) -> Vec<Reason> {
    let middle = |cell: &Voxel| -> [f64; 3] { surface.voxels.lattice.center(*cell).into() };
    let cells = surface
        .voxels
        .cells
        .iter()
        .zip(all)
        .zip(first.iter().zip(held));
    let (middles, reasons): (Vec<[f64; 3]>, Vec<Reason>) = cells
        .filter(|((_, solid), _)| **solid)
        .map(|((cell, _), (first, held))| {
            let reason = match (first, held) {
                (true, _) => Reason::Pattern,
                (false, true) => Reason::Bridge,
                (false, false) => Reason::Feature,
            };
            (middle(cell), reason)
        })
        .unzip();
    let tree = KdTree::new(middles);
    let nearest = |p: &Point3| tree.nearest((*p).into());
    let reason = |p: &Point3| nearest(p).map_or(Reason::Pattern, |number| reasons[number]);
    mesh.positions.iter().map(reason).collect()
}
