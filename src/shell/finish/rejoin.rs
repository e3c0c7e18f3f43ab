//! A body that fell into pieces although its voxels hang together, joined again on the surface (S6): the smooth
//! border of the pattern may pass over what is a single voxel wide, on its own or beside a rim.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::{Voxel, VoxelSurface, Voxels};

use super::Finished;
use super::wall::Thickness;
use crate::connect::{NO_PIECE, SurfaceGraph, Touch, join_groups, widen};

/// The solid voxels with the shortest bridges between the pieces of the body that was made of them, `radius` pitches
/// wide on each side. Nothing where no way along the surface leads from one piece to another.
pub fn rejoined(
    graph: &SurfaceGraph,
    surface: &VoxelSurface,
    solid: &[bool],
    (finished, thickness): (&Finished, Thickness),
    radius: f64,
) -> Option<Vec<bool>> {
    if finished.pieces < 2 {
        return None;
    }
    let lattice = &surface.voxels.lattice;
    let reach = (lattice.pitch / finished.voxels.lattice.pitch).ceil() as i32;
    let group = |v: usize| {
        if !solid[v] {
            return NO_PIECE;
        }
        let normal = Point3::from(surface.normals[v].map(f64::from));
        let at = lattice.center(surface.voxels.cells[v]) + normal * thickness.offset();
        let nearest = nearest(&finished.voxels, at, reach);
        nearest.map_or(NO_PIECE, |voxel| finished.piece_of[voxel])
    };
    let mut groups: Vec<u32> = (0..solid.len()).map(group).collect();
    for (piece, at) in (1u32..).zip(&finished.loose) {
        if !groups.contains(&piece)
            && let Some(v) = nearest_solid(surface, solid, *at)
        {
            groups[v] = piece;
        }
    }
    let paths = join_groups(graph, &groups, Touch::Corner);
    if paths.is_empty() {
        return None;
    }
    // Also voxels side by side may have been parted: all of a path is widened.
    let bridges = widen(graph, &vec![false; solid.len()], &paths, radius);
    Some((0..solid.len()).map(|v| solid[v] || bridges[v]).collect())
}

/// The solid voxel nearest to a place: that of a piece that is so small that each voxel is nearer to another one.
fn nearest_solid(surface: &VoxelSurface, solid: &[bool], at: Point3) -> Option<usize> {
    let distance = |v: &usize| {
        let center = surface.voxels.lattice.center(surface.voxels.cells[*v]);
        center.distance(at)
    };
    let all = (0..solid.len()).filter(|v| solid[*v]);
    all.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The number of the voxel that is nearest to a place, of those at most `reach` voxels away along each axis; the
/// layers about the place are looked at one after the other.
fn nearest(voxels: &Voxels, at: Point3, reach: i32) -> Option<usize> {
    let place = voxels.lattice.place(at);
    let middle = place.map(|c| c.floor() as i32);
    (0..=reach).find_map(|layer| {
        let range = || -layer..=layer;
        let shifts =
            range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
        let on_layer = shifts.filter(|shift| shift.iter().any(|s| s.abs() == layer));
        let found = on_layer.filter_map(|shift| {
            let cell = [0, 1, 2].map(|axis| u16::try_from(middle[axis] + shift[axis]).ok());
            let cell: Voxel = [cell[0]?, cell[1]?, cell[2]?];
            let off = |axis: usize| f64::from(cell[axis]) + 0.5 - place[axis];
            let square: f64 = (0..3).map(|axis| off(axis) * off(axis)).sum();
            Some((square, voxels.find(cell)?))
        });
        found
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .map(|(_, voxel)| voxel)
    })
}
