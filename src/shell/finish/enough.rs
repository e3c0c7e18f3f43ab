//! A pattern made as wide as asked, and no more than that: strands that are hardly there first, by voxels, then what is narrower than asked
//! where its wall will end. Nothing that is wide enough is touched, so that a pattern of wide features stays as it is
//! (S4), and one that has been widened does so too.

use fretwork_geometry::Mesh;

use super::feature::{stamped, widened};
use super::pinhole::without_pinholes;
use super::width::narrow;
use crate::connect::{SurfaceGraph, join_through_faces};

/// Strands of fewer voxels than this may have no wall at all: they are widened by voxels first.
const STRAND: f64 = 2.0;
/// Features of more voxels than this are made by voxels alone: beside so many, what the smooth border takes away is little, and discs of
/// that size take long.
const WIDEST: f64 = 8.0;
/// Rounds of widening strands and joining them.
const ROUNDS: usize = 3;
/// How much wider than asked narrow places are made, in pitches, one round after the other: a voxel counts where its middle
/// is, so that some need more than others.
const BEYOND: [f64; 8] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0];
/// So much less than asked, in pitches, is not widened again: widths are seldom measured more exactly.
const MEASURED: f64 = 0.05;

/// The solid voxels with those that features lack which are narrower than `width`, a length, those of gaps that are too
/// narrow, and those by which voxels that touch in an edge or a corner are joined through faces. `rim` are the voxels in which the
/// surface ends.
pub fn wide_enough(
    of: (&Mesh, &SurfaceGraph),
    (solid, rim): (&[bool], &[bool]),
    width: f64,
) -> Vec<bool> {
    let (_, graph) = of;
    let pitches = width / graph.pitch();
    let is_wide = pitches > WIDEST;
    let strand = if is_wide {
        pitches
    } else {
        pitches.min(STRAND)
    };
    let mut solid = solid.to_vec();
    // What joins may be narrow again.
    for _ in 0..ROUNDS {
        solid = without_pinholes(graph, &widened(graph, (&solid, rim), strand));
        let joints = join_through_faces(graph, &solid);
        for voxel in joints.iter().flatten() {
            solid[*voxel as usize] = true;
        }
        if joints.is_empty() {
            break;
        }
    }
    let least = width - MEASURED * graph.pitch();
    for beyond in BEYOND {
        let places = match least > 0.0 && !is_wide {
            true => narrow(of, (&solid, rim), (width, least)),
            false => Vec::new(),
        };
        if places.is_empty() {
            break;
        }
        let radius = (width + beyond * graph.pitch()) / 2.0;
        let wide = stamped(graph.surface, &solid, &places, radius);
        solid = without_pinholes(graph, &wide);
    }
    solid
}
