//! The voxels of a surface (S1; Dumas et al. 2015, section 3): those whose closed cubes the surface
//! meets, one layer of them, and the pyramid of coarser layers above. Which of them are solid is not
//! known here.
//!
//! ```
//! use fretwork_geometry::{Mesh, Point3};
//! use fretwork_shell::voxelize::{pyramid, voxelize};
//! let corners = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
//! let mesh = Mesh { positions: corners.map(Point3::from).to_vec(), triangles: vec![[0, 1, 2]] };
//! let surface = voxelize(&mesh, 0.25)?;
//! assert!(surface.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]));
//! assert!(pyramid(surface).len() > 1);
//! # Ok::<(), fretwork_shell::voxelize::VoxelizeError>(())
//! ```

mod clip;
mod cover;
mod error;
mod estimate;
mod lattice;
mod normal;
mod pyramid;
#[cfg(test)]
pub(crate) mod tests;

use fretwork_geometry::voxel::{Voxel, VoxelSurface, Voxels};
use fretwork_geometry::{Mesh, budget};

pub use error::VoxelizeError;
pub use estimate::{Estimate, MAX_BYTES, estimate};
pub use pyramid::{Level, pyramid};

use cover::Piece;

/// Steps of the budget for a voxel.
const STEPS: u64 = 60;

/// The voxels of a surface, and what was odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Voxelization {
    /// The voxels.
    pub surface: VoxelSurface,
    /// Numbers of the voxels that hold sides of the surface which face apart: a sheet thinner than a
    /// voxel, or a sharp edge. Ascending.
    pub thin: Vec<u32>,
    /// How many triangles without area were passed over.
    pub skipped: usize,
}

/// The voxels of side `pitch` whose closed cubes `mesh` meets (26-separating), with the mean normal, by
/// area, of what lies in each. The mesh may be open or closed, of one body or several. For a given
/// number of voxels along the longest side of its box, `pitch` is that side over the number. The
/// lattice leaves an empty voxel on each side of the box and is symmetric about its middle.
///
/// O(n + k log k) for n triangles that meet k cubes; the same for any number of threads.
///
/// # Errors
/// A mesh that is empty, not finite or without area, a pitch that is none, more voxels than can be
/// numbered or stored (before they are made), a body that is thinner than a voxel nearly everywhere.
pub fn voxelize(mesh: &Mesh, pitch: f64) -> Result<VoxelSurface, VoxelizeError> {
    let Voxelization { surface, thin, .. } = voxelize_in_detail(mesh, pitch)?;
    if 2 * thin.len() > surface.voxels.len() {
        let first = surface.voxels.cells[thin[0] as usize];
        return Err(VoxelizeError::TooThin {
            thin: thin.len(),
            voxels: surface.voxels.len(),
            near: surface.voxels.lattice.center(first),
        });
    }
    Ok(surface)
}

/// As [`voxelize`], and which voxels are too coarse for what they hold; a thin body is no error.
///
/// # Errors
/// Those of [`voxelize`] but for thin bodies.
pub fn voxelize_in_detail(mesh: &Mesh, pitch: f64) -> Result<Voxelization, VoxelizeError> {
    mesh.validate()?;
    if !(pitch.is_finite() && pitch > 0.0) {
        return Err(VoxelizeError::Pitch { pitch });
    }
    let lattice = lattice::around(&mesh.bounds(), pitch)?;
    let needed = estimate(mesh, pitch);
    let limit = (MAX_BYTES as f64 * budget::factor()) as u64;
    if needed.bytes > limit {
        return Err(VoxelizeError::TooLarge {
            estimate: needed,
            limit,
        });
    }
    budget::hold("voxels of a surface", 1, needed.bytes as usize);
    budget::spend("voxels of a surface", STEPS * needed.voxels);
    let (pieces, skipped) = cover::pieces(mesh, &lattice);
    if pieces.is_empty() {
        let triangles = mesh.triangles.len();
        return Err(VoxelizeError::NoArea { triangles });
    }
    let runs: Vec<&[Piece]> = pieces.chunk_by(|a, b| a.cell == b.cell).collect();
    let (normals, is_thin) = normal::means(mesh, &lattice, &runs);
    let cells: Vec<Voxel> = runs.iter().map(|run| run[0].voxel()).collect();
    let thin = (0u32..)
        .zip(is_thin)
        .filter_map(|(number, is_thin)| is_thin.then_some(number));
    Ok(Voxelization {
        thin: thin.collect(),
        surface: VoxelSurface {
            voxels: Voxels { lattice, cells },
            normals,
        },
        skipped,
    })
}
