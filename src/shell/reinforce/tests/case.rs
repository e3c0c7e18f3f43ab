//! A pattern with its frame and forces, for tests of the model.

use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Point3, Seed};

use super::super::discretize::Detail;
use super::super::forces::Forces;
use super::super::frame::{Frame, Measure};
use super::super::model::{Model, Parts};
use super::super::profile::Profile;
use super::elements::PLASTIC;
use crate::connect::{AbstractGraph, Pieces, SurfaceGraph, Touch, sample};

/// Standing on what lies below a height, under its own weight.
pub(super) fn standing<'a>(height: f64) -> Profile<'a> {
    Profile {
        material: PLASTIC,
        metres: 1e-3,
        gravity: Point3::new(0.0, 0.0, -9.81),
        supports: vec![Box::new(move |p| p.z < height)],
        loads: Vec::new(),
        max_stress: None,
    }
}

/// The frame, forces and graph of a pattern of pitch 1 mm, 2 mm thick.
pub(super) struct Case {
    pub abstracted: AbstractGraph,
    pub frame: Frame,
    pub forces: Forces,
    pub solid: Vec<bool>,
}

pub(super) fn case(
    surface: &VoxelSurface,
    solid: &[bool],
    samples: usize,
    profile: &Profile,
) -> Case {
    let graph = SurfaceGraph::new(surface);
    let all = Pieces::of(&graph, Touch::Corner, |_| true);
    let samples = sample(&graph, solid, samples, Seed::root(0));
    let abstracted = AbstractGraph::new(&graph, solid, samples);
    let measure = Measure {
        pitch: 1e-3,
        thickness: 2e-3,
        bridge: 4e-3,
    };
    let frame = Frame::new(&graph, &abstracted, &measure);
    let forces = Forces::new(&graph, &all, &abstracted, profile, (solid, 2e-3)).unwrap();
    let solid = abstracted.edges.iter().map(|edge| edge.is_solid).collect();
    Case {
        abstracted,
        frame,
        forces,
        solid,
    }
}

impl Case {
    /// The same pattern with another thickness.
    pub fn thicken(&mut self, surface: &VoxelSurface, thickness: f64) {
        let measure = Measure {
            pitch: 1e-3,
            thickness,
            bridge: 4e-3,
        };
        self.frame = Frame::new(&SurfaceGraph::new(surface), &self.abstracted, &measure);
    }

    pub fn scores(&self, profile: &Profile, detail: Detail) -> Vec<f64> {
        let parts = Parts::new(&self.frame, &self.forces, profile, &self.solid, detail);
        Model::new(parts).unwrap().scores(&self.solid).unwrap()
    }
}
