//! The last step: a wall of the asked thickness where the pattern is, as one closed mesh a body and
//! as voxels to be analysed.
//!
//! The wall is a function of space (`wall`), bounded by the surface's distance and by the pattern's
//! smooth border (`coverage`). It is sampled on a lattice (`samples`), made well-composed
//! (`compose`), and its border is meshed (`net`) and kept from passing through itself (`untangle`). The same samples are the voxels of the analysis, weighted by
//! the part of them that the wall fills.

mod compose;
mod corner;
mod coverage;
mod enough;
mod feature;
mod net;
mod pinhole;
mod reason;
mod rejoin;
mod relax;
mod rim;
mod samples;
mod slivers;
#[cfg(test)]
mod tests;
mod thin;
mod untangle;
mod wall;
mod width;

use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::voxel::{Lattice, VoxelSurface, Voxels};
use fretwork_geometry::{Mesh, Point3, budget};

use compose::Body;
use coverage::Coverage;
use samples::Samples;
use wall::Wall;

use crate::weights::weights;

pub use enough::wide_enough;
pub use feature::widened;
pub use reason::reasons;
pub use rejoin::rejoined;
pub use rim::rim;
pub use wall::{Thickness, crowding};
pub use width::{Narrow, least_width, narrow};

/// How many samples a wall has across it, at least: so many that three are inside wherever it lies, as bending wants.
const ACROSS: f64 = 3.05;
/// A piece of fewer samples than this part of the largest is dust, which is left out.
const DUST: f64 = 1e-3;
/// A closed void of a smaller volume than this many cubes of the lattice is filled.
const BUBBLE: f64 = 8.0;
/// The most bytes that a wall may need.
const MOST_BYTES: f64 = 2e9;
/// The bytes that a sample needs while a wall is finished, with the mesh.
const BYTES: usize = 64;
/// What a budget is told of.
const SAMPLES: &str = "samples of a wall";
/// Steps of the budget for a sample: the nearest place on the surface is looked for.
const STEPS: f64 = 200.0;

/// A pattern as a body.
pub struct Finished {
    /// The closed mesh, facing outward.
    pub mesh: Mesh,
    /// The same body as cubes, one about each sample inside.
    pub voxels: Voxels,
    /// How much of itself each of them stands for.
    pub weights: Vec<f32>,
    /// How many pieces it has, and a place in each but the largest.
    pub pieces: usize,
    /// A place in each piece but the largest.
    pub loose: Vec<Point3>,
    /// The piece of each voxel, where there are several.
    pub piece_of: Vec<u32>,
    /// How many samples were taken in so that nothing hangs by an edge or a corner.
    pub filled: usize,
}

/// Why a wall cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FinishError {
    /// Nothing of the pattern is solid, or it is finer than the lattice.
    #[error("nothing of the pattern is solid")]
    Empty,
    /// The lattice would be too large.
    #[error(
        "the wall would need a lattice of {points} points and about {} MB: it is too thin for its size, or its voxels are too small",
        bytes / 1_000_000
    )]
    TooLarge {
        /// The points of the lattice along the three axes.
        points: u64,
        /// The estimate of the memory.
        bytes: u64,
    },
}

/// The wall about a welded `mesh` where the voxels of its `surface` are solid.
///
/// # Errors
/// When there is nothing, or too much.
pub fn finish(
    mesh: &Mesh,
    surface: &VoxelSurface,
    solid: &[bool],
    thickness: Thickness,
) -> Result<Finished, FinishError> {
    let spacing = surface
        .voxels
        .lattice
        .pitch
        .min(thickness.thickness / ACROSS);
    check_size(surface, thickness, spacing)?;
    let coverage = Coverage::new(surface, solid);
    let wall = Wall::new(mesh, &coverage, thickness);
    let samples = Samples::of(&wall, surface, solid, spacing, thickness.reach());
    let mut body = Body::of(&samples);
    let mut pieces = body.pieces();
    let Some(largest) = pieces.first().map(Vec::len) else {
        return Err(FinishError::Empty);
    };
    let is_dust = |piece: &Vec<usize>| (piece.len() as f64) < DUST * largest as f64;
    pieces
        .iter()
        .filter(|piece| is_dust(piece))
        .for_each(|piece| body.remove(piece));
    pieces.retain(|piece| !is_dust(piece));
    let cells = body
        .inside()
        .map(|index| samples.place(index).map(|n| n as u16))
        .collect();
    let half = Point3::new(0.5, 0.5, 0.5) * spacing;
    let lattice = Lattice {
        origin: samples.lattice.origin - half,
        pitch: spacing,
    };
    let piece_of = piece_of(&body, &pieces);
    let loose = pieces[1..].iter().map(|piece| {
        samples
            .lattice
            .point(samples.place(piece[0]).map(|n| n as f64))
    });
    let mesh = without_bubbles(net::net(&wall, &body, &samples), spacing);
    let voxels = Voxels { lattice, cells };
    let weights = weights(
        &voxels,
        mesh.volume() / spacing.powi(3),
        &|voxel, axis, up| samples.border(voxels.cells[voxel].map(usize::from), axis, up),
    );
    budget::release(SAMPLES);
    Ok(Finished {
        mesh,
        loose: loose.collect(),
        voxels,
        weights,
        pieces: pieces.len(),
        filled: body.filled,
        piece_of,
    })
}

/// The mesh without closed voids in it that are dust.
fn without_bubbles(mut mesh: Mesh, spacing: f64) -> Mesh {
    let mut corners = UnionFind::new(mesh.positions.len());
    for [a, b, c] in &mesh.triangles {
        corners.unite(*a, *b);
        corners.unite(*b, *c);
    }
    let part_of = corners.labels();
    let origin = mesh.bounds().center();
    let mut six = vec![0.0; corners.count()];
    for triangle in &mesh.triangles {
        let [a, b, c] = mesh.corners(*triangle).map(|p| p - origin);
        six[part_of[triangle[0] as usize] as usize] += a.dot(b.cross(c));
    }
    let is_bubble = |part: u32| {
        let volume = six[part as usize] / 6.0;
        volume <= 0.0 && volume > -BUBBLE * spacing.powi(3)
    };
    let kept = |triangle: &[u32; 3]| !is_bubble(part_of[triangle[0] as usize]);
    mesh.triangles.retain(kept);
    net::compact(mesh)
}

/// The number of each inner point's piece in their order; nothing where there is one piece.
fn piece_of(body: &Body, pieces: &[Vec<usize>]) -> Vec<u32> {
    if pieces.len() < 2 {
        return Vec::new();
    }
    let points: Vec<usize> = body.inside().collect();
    let mut piece_of = vec![0; points.len()];
    for (number, piece) in (0u32..).zip(pieces) {
        for point in piece {
            let at = points
                .binary_search(point)
                .expect("the points of a piece are inside");
            piece_of[at] = number;
        }
    }
    piece_of
}

/// Refuses a lattice that would not fit into memory, or whose points cannot be numbered, before it is made. The
/// band about the surface holds samples, the whole box a bit for each point.
fn check_size(
    surface: &VoxelSurface,
    thickness: Thickness,
    spacing: f64,
) -> Result<(), FinishError> {
    let pitch = surface.voxels.lattice.pitch;
    let layers = 2.0 * (thickness.reach() + pitch) / spacing + 5.0;
    let band = surface.voxels.len() as f64 * (pitch / spacing) * (pitch / spacing) * layers;
    let far = |axis: usize| {
        surface
            .voxels
            .cells
            .iter()
            .map(|c| c[axis])
            .max()
            .unwrap_or(0)
    };
    let sides = [0, 1, 2].map(|axis| f64::from(far(axis)) * pitch / spacing + 2.0 * layers);
    let box_points = sides.iter().product::<f64>();
    let bytes = band * BYTES as f64 + box_points / 8.0;
    if bytes > MOST_BYTES * budget::factor() || sides.iter().any(|side| *side > f64::from(u16::MAX))
    {
        return Err(FinishError::TooLarge {
            points: box_points as u64,
            bytes: bytes as u64,
        });
    }
    budget::hold(SAMPLES, 1, bytes as usize);
    budget::spend(SAMPLES, (STEPS * band) as u64);
    Ok(())
}
