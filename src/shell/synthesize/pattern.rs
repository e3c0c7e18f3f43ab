//! What is asked of a synthesis, and what it gives.

use fretwork_geometry::Seed;

pub use fretwork_geometry::shell::Pattern;

/// How a texture lies on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Of everything random.
    pub seed: Seed,
    /// The part of the voxels whose labels are shuffled on each level, from 0 to 1: how far the texture departs
    /// from the order of its exemplar.
    pub jitter: f64,
    /// Where the exemplar's up points, as far as the surface allows: a unit vector.
    pub up: [f32; 3],
    /// Where it points in each voxel of the finest level instead: vectors in the tangent plane, of
    /// length 1 or shorter where it matters less.
    pub orientation: Option<Vec<[f32; 3]>>,
    /// Whether those vectors have no sign, as principal directions of stress have none.
    pub is_axial: bool,
    /// Voxels that must be solid from the first pass on; empty, or one for each voxel of the finest level.
    pub keep: Vec<bool>,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            seed: Seed::root(0),
            jitter: 0.1,
            up: [0.0, 0.0, 1.0],
            orientation: None,
            is_axial: false,
            keep: Vec::new(),
        }
    }
}
