//! One step of the loop on the full model of a pattern, and the same equations put together from triplets, which it spares:
//! what benchmarks measure beside one another.

use nalgebra_sparse::{CooMatrix, CscMatrix};

use super::discretize::Detail;
use super::forces::Forces;
use super::frame::{Frame, Measure};
use super::model::{Model, Parts};
use super::profile::ReinforceError;
use super::round::Settings;
use super::system::FIXED;
use crate::connect::{AbstractGraph, Pieces, SurfaceGraph, Touch, sample};

/// The model of a pattern as the loop keeps it from one step to the next.
pub struct Kept {
    model: Model,
    parts: Parts,
    solid: Vec<bool>,
}

impl Kept {
    /// The full model of the solid voxels under the profile of the settings.
    ///
    /// # Errors
    /// When nothing is asked of the pattern's strength, or the profile does not fit it.
    pub fn new(
        graph: &SurfaceGraph,
        solid: &[bool],
        settings: &Settings,
    ) -> Result<Kept, ReinforceError> {
        let mechanism = || ReinforceError::Mechanism {
            place: graph.center(0),
        };
        let profile = settings.profile.ok_or_else(mechanism)?;
        let samples = sample(graph, solid, settings.samples, settings.seed);
        let abstracted = AbstractGraph::new(graph, solid, samples);
        let thickness = settings.thickness * profile.metres;
        let measure = Measure {
            pitch: graph.pitch() * profile.metres,
            thickness,
            bridge: (2.0 * settings.feature_radius + graph.pitch()) * profile.metres,
        };
        let frame = Frame::new(graph, &abstracted, &measure);
        let surface = Pieces::of(graph, Touch::Corner, |_| true);
        let pattern = (solid, thickness);
        let forces = Forces::new(graph, &surface, &abstracted, profile, pattern)?;
        let solid: Vec<bool> = abstracted.edges.iter().map(|edge| edge.is_solid).collect();
        let parts = || Parts::new(&frame, &forces, profile, &solid, Detail::Full);
        Ok(Kept {
            model: Model::new(parts()).map_err(|_| mechanism())?,
            parts: parts(),
            solid,
        })
    }

    /// How many unknowns the model has.
    pub fn unknowns(&self) -> usize {
        self.parts.unknowns()
    }

    /// A step: the equations filled again, factored and solved, the stress of every edge, Pa. None where the pattern is a
    /// mechanism.
    pub fn step(&mut self) -> Vec<f64> {
        self.model.scores(&self.solid).unwrap_or_default()
    }

    /// The whole matrix from triplets, as it is assembled where nothing is kept from one step to the next. How many entries it
    /// has.
    pub fn assemble(&self) -> usize {
        let mut triplets = CooMatrix::new(self.unknowns(), self.unknowns());
        for member in self.parts.stay.iter().chain(&self.parts.change) {
            let moving = member.unknowns.iter().enumerate();
            let moving = moving.filter(|(_, unknown)| **unknown != FIXED);
            for (j, column) in moving.clone() {
                for (i, row) in moving.clone() {
                    let value = member.stiffness[(i, j)];
                    triplets.push(*row as usize, *column as usize, value);
                }
            }
        }
        CscMatrix::from(&triplets).nnz()
    }
}
