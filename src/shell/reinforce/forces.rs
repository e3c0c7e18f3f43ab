//! What holds the pads of a body and what pulls at them. How they deform is not known here.

use fretwork_geometry::Point3;
use fretwork_geometry::numeric::UnionFind;

use super::element::Vector;
use super::profile::{Profile, ReinforceError};
use crate::connect::{AbstractGraph, NOBODY, Pieces, SurfaceGraph};

/// The supports and loads of a body, pad by pad.
#[derive(Clone, Debug)]
pub(super) struct Forces {
    /// Which pads do not move.
    pub held: Vec<bool>,
    /// The force on each pad besides gravity, N.
    pub loads: Vec<Vector>,
    /// The mass of the solid voxels, kg.
    pub mass: f64,
}

impl Forces {
    /// The forces of `profile` on the pads of `abstracted`.
    ///
    /// A zone smaller than the distance of two samples may catch voxels and no sample: it then holds the
    /// samples whose trees it touches, so that a small foot is not overlooked.
    ///
    /// # Errors
    /// When a load catches no voxel, or a part of the surface is held nowhere.
    pub fn new(
        graph: &SurfaceGraph,
        surface: &Pieces,
        abstracted: &AbstractGraph,
        profile: &Profile,
        (solid, thickness): (&[bool], f64),
    ) -> Result<Forces, ReinforceError> {
        let square = graph.pitch() * graph.pitch() * profile.metres * profile.metres;
        let area: f64 = (0u32..)
            .zip(solid)
            .filter(|(_, s)| **s)
            .map(|(v, _)| graph.area(v))
            .sum();
        Ok(Forces {
            held: held(graph, surface, abstracted, profile)?,
            loads: loads(graph, abstracted, profile)?,
            mass: area * square * thickness * profile.material.density,
        })
    }
}

/// Which pads a support holds.
fn held(
    graph: &SurfaceGraph,
    surface: &Pieces,
    abstracted: &AbstractGraph,
    profile: &Profile,
) -> Result<Vec<bool>, ReinforceError> {
    let samples = &abstracted.samples;
    let mut held: Vec<bool> = samples
        .iter()
        .map(|v| profile.holds(graph.center(*v)))
        .collect();
    let piece = |v: u32| surface.of[v as usize] as usize;
    let mut is_held = vec![false; surface.len()];
    for (v, held) in samples.iter().zip(&held) {
        is_held[piece(*v)] |= held;
    }
    for v in 0..graph.len() as u32 {
        let owner = abstracted.owners[v as usize];
        if !is_held[piece(v)] && owner != NOBODY && profile.holds(graph.center(v)) {
            held[owner as usize] = true;
        }
    }
    let mut sets = UnionFind::new(samples.len());
    for edge in &abstracted.edges {
        sets.unite(edge.ends[0], edge.ends[1]);
    }
    let mut is_held = vec![false; samples.len()];
    for (pad, held) in (0u32..).zip(&held) {
        is_held[sets.find(pad) as usize] |= held;
    }
    let loose = sets.roots().find(|root| !is_held[*root as usize]);
    match loose.map(|root| graph.center(samples[root as usize])) {
        Some(place) => Err(ReinforceError::NotSupported { place }),
        None => Ok(held),
    }
}

/// The forces on the pads: each load shared evenly among the voxels that it catches,
/// solid or not, and given to the samples whose trees these belong to.
fn loads(
    graph: &SurfaceGraph,
    abstracted: &AbstractGraph,
    profile: &Profile,
) -> Result<Vec<Vector>, ReinforceError> {
    let mut loads = vec![Vector::zeros(); abstracted.samples.len()];
    for (number, load) in profile.loads.iter().enumerate() {
        let owner = |v: u32| abstracted.owners[v as usize];
        let voxels = (0..graph.len() as u32).filter(|v| owner(*v) != NOBODY);
        let caught: Vec<u32> = voxels.filter(|v| (load.zone)(graph.center(*v))).collect();
        if caught.is_empty() {
            return Err(ReinforceError::LoadOutside { load: number });
        }
        let Point3 { x, y, z } = load.force;
        let share = Vector::new(x, y, z) / caught.len() as f64;
        caught
            .iter()
            .for_each(|v| loads[owner(*v) as usize] += share);
    }
    Ok(loads)
}
