//! Gaps of a pattern that are too narrow to be made: no disc of about two voxels across fits into them.
//!
//! The smooth border of a pattern passes over such a gap, but for places where it does not quite: they
//! would be holes that end inside of the wall. The voxels of such gaps are solid, so that what is said of the pattern is
//! true of the body.

use rayon::prelude::*;

use fretwork_geometry::Point3;

use super::coverage::Coverage;
use crate::connect::SurfaceGraph;

/// How far a place of a gap must be from the smooth border for the gap to go on through it, in pitches. The middle of four
/// empty voxels in a square is 0.79, that of two side by side along a diagonal 0.41, that of a single row 0.24.
const DEEP: f64 = 0.4;
/// How far from the middle of a voxel such a place is looked for, in pitches, away from the border.
const STEP: f64 = 0.5;
/// Rounds, at most: what is filled may leave a narrow gap beside it.
const ROUNDS: usize = 6;

/// The solid voxels with those of gaps that are too narrow. All around a place where a gap is wide is left.
pub fn without_pinholes(graph: &SurfaceGraph, solid: &[bool]) -> Vec<bool> {
    let mut solid = solid.to_vec();
    let pitch = graph.pitch();
    for _ in 0..ROUNDS {
        let coverage = Coverage::new(graph.surface, &solid);
        let is_wide = |v: usize| {
            let normal = Point3::from(graph.surface.normals[v].map(f64::from));
            let center = graph.center(v as u32);
            let (here, slope) = coverage.outside(center, normal);
            let beside = center + slope.unit().unwrap_or_default() * (STEP * pitch);
            !solid[v] && here.max(coverage.outside(beside, normal).0) >= DEEP * pitch
        };
        let wide: Vec<bool> = (0..solid.len()).into_par_iter().map(is_wide).collect();
        let is_narrow = |v: &usize| {
            let mut beside = graph.neighbours(*v as u32).iter();
            !solid[*v] && !wide[*v] && !beside.any(|w| wide[*w as usize])
        };
        let narrow: Vec<usize> = (0..solid.len()).into_par_iter().filter(is_narrow).collect();
        if narrow.is_empty() {
            break;
        }
        narrow.into_iter().for_each(|v| solid[v] = true);
    }
    solid
}
