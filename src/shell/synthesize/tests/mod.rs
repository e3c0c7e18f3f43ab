//! Textures on small surfaces, judged by number; `look` draws them.

mod exemplars;
mod field;
mod laws;
mod local;
mod look;
mod peers;
mod quality;
mod refusals;

use fretwork_geometry::{Mesh, Pixels};

use super::{Options, Pattern, Synthesizer};
use crate::voxelize::tests::shapes;
use crate::voxelize::{Level, pyramid, voxelize};

/// The pyramid of a mesh of voxels of side one.
fn levels(mesh: &Mesh) -> Vec<Level> {
    pyramid(voxelize(mesh, 1.0).unwrap())
}

fn made(levels: &[Level], exemplar: &Pixels, options: &Options) -> Pattern {
    Synthesizer::new(levels, exemplar, options)
        .unwrap()
        .synthesize()
}

fn sphere() -> Vec<Level> {
    levels(&shapes::sphere(30.0, 64))
}
