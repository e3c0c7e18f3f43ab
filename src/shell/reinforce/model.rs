//! The mechanical model of a pattern (Dumas 2015, 5.2.1): how much each edge of its abstract graph is strained
//! when the profile's forces pull at it. Which edges are to be added is decided in `select`.

use fretwork_geometry::budget;
use nalgebra::{DMatrix, DVector, SMatrix};
use rayon::prelude::*;

use super::discretize::{Detail, Numbering, brick, rigid_motions, wedge_volume};
use super::element::{Element, Vector, principal_sum};
use super::forces::Forces;
use super::frame::{Beam, Frame, Pad};
use super::profile::Profile;
use super::system::{FIXED, Loose, Member, System};
use crate::analyse::Material;

/// The stiffness of an empty edge as a part of a solid one's. Small enough that what hangs by empty edges
/// only counts as loose, large enough that the system can be factored.
const EMPTY: f64 = 1e-4;

/// Steps of the budget for each unknown when the equations are solved.
const STEPS: u64 = 400;

/// What a beam's displacements say of its stress.
struct Gauge {
    unknowns: Vec<u32>,
    stress: DMatrix<f64>,
    /// Its weight when it is solid, by unknown.
    weight: DVector<f64>,
    /// The width of the pattern over that of its shape.
    factor: f64,
}

/// The model of a pattern whose edges may become solid.
pub(super) struct Model {
    system: Option<System>,
    gauges: Vec<Gauge>,
    /// The load that does not hang on which edges are solid.
    steady: DVector<f64>,
    /// The pad of every unknown.
    pads: Vec<u32>,
}

/// What a model is put together from.
pub(super) struct Parts {
    /// The members whose stiffness stays.
    pub stay: Vec<Member>,
    /// The beams, by edge.
    pub change: Vec<Member>,
    gauges: Vec<Gauge>,
    steady: DVector<f64>,
    pads: Vec<u32>,
}

impl Parts {
    /// The parts of a body under a profile whose edges are solid or not.
    pub fn new(
        frame: &Frame,
        forces: &Forces,
        profile: &Profile,
        solid: &[bool],
        detail: Detail,
    ) -> Parts {
        let material = match detail {
            Detail::Full => profile.material,
            // Between rigid ends a beam cannot become thinner as it is pulled: with its own ratio it would be half
            // as stiff again as it is, and the stress across it would count.
            Detail::Rigid => Material {
                poisson_ratio: 0.0,
                ..profile.material
            },
        };
        let numbering = Numbering::new(frame, &forces.held, detail);
        let bricks = frame
            .beams
            .par_iter()
            .map(|beam| brick(frame, beam, &material));
        let bricks: Vec<Element> = bricks.collect();
        let gravity = Vector::new(profile.gravity.x, profile.gravity.y, profile.gravity.z);
        let pull = gravity * density(frame, forces, &bricks, solid);
        let beams = frame.beams.par_iter().zip(bricks);
        let beams = beams.map(|(beam, brick)| gauge(frame, beam, brick, &numbering, pull));
        let (change, gauges) = beams.unzip();
        Parts {
            stay: match detail {
                Detail::Full => numbering.wedges(frame, &material),
                Detail::Rigid => Vec::new(),
            },
            change,
            gauges,
            steady: numbering.steady(frame, &forces.loads, pull),
            pads: numbering.pads,
        }
    }

    /// How many unknowns they have.
    pub fn unknowns(&self) -> usize {
        self.pads.len()
    }
}

impl Model {
    /// The model of these parts.
    ///
    /// # Errors
    /// When the equations are too many for memory.
    pub fn new(parts: Parts) -> Result<Model, Loose> {
        let count = parts.unknowns();
        Ok(Model {
            system: match count {
                0 => None,
                _ => Some(System::new(count, &parts.stay, &parts.change)?),
            },
            gauges: parts.gauges,
            steady: parts.steady,
            pads: parts.pads,
        })
    }

    /// The score of every edge: the sum of the sizes of the principal stresses that a solid beam would have
    /// there, Pa (Dumas 2015, 5.2.1). The strain of empty edges counts as if they were solid, which ranks
    /// them as their own small stresses would.
    ///
    /// # Errors
    /// With the pad that moves most, when the body can move.
    pub fn scores(&mut self, solid: &[bool]) -> Result<Vec<f64>, usize> {
        let Some(system) = &mut self.system else {
            return Ok(vec![0.0; solid.len()]);
        };
        budget::spend(
            "unknowns of a pattern's model",
            STEPS * self.pads.len() as u64,
        );
        let part = |solid: &bool| if *solid { 1.0 } else { EMPTY };
        let factors = self
            .gauges
            .iter()
            .zip(solid)
            .map(|(g, solid)| g.factor * part(solid));
        let factors: Vec<f64> = factors.collect();
        system.refill(&factors);
        let mut load = self.steady.clone();
        for (gauge, factor) in self.gauges.iter().zip(&factors) {
            for (unknown, weight) in gauge.unknowns.iter().zip(&gauge.weight) {
                if *unknown != FIXED {
                    load[*unknown as usize] += weight * factor;
                }
            }
        }
        let moved = system
            .solve(&load)
            .map_err(|loose| self.pads[loose.unknown] as usize)?;
        Ok(self
            .gauges
            .par_iter()
            .map(|gauge| gauge.score(&moved))
            .collect())
    }
}

impl Gauge {
    fn score(&self, moved: &DVector<f64>) -> f64 {
        let of = |u: &u32| if *u == FIXED { 0.0 } else { moved[*u as usize] };
        let local = DVector::from_iterator(self.unknowns.len(), self.unknowns.iter().map(of));
        let stress = &self.stress * local;
        principal_sum(&SMatrix::<f64, 6, 1>::from_column_slice(stress.as_slice()))
    }
}

/// A beam as a member, and what its displacements say.
fn gauge(
    frame: &Frame,
    beam: &Beam,
    brick: Element,
    numbering: &Numbering,
    pull: Vector,
) -> (Member, Gauge) {
    let weight = brick.volumes.iter().flat_map(|v| (pull * *v).data.0[0]);
    let weight = DVector::from_iterator(24, weight);
    let (stiffness, stress, weight) = match numbering.detail {
        Detail::Full => (brick.stiffness, brick.stress, weight),
        Detail::Rigid => {
            let motion = rigid_motions(frame, beam);
            let turned = motion.transpose();
            let stiffness = &turned * brick.stiffness * &motion;
            (stiffness, brick.stress * &motion, turned * weight)
        }
    };
    let unknowns = numbering.beam(frame, beam);
    let member = Member {
        unknowns: unknowns.clone(),
        stiffness,
    };
    let gauge = Gauge {
        unknowns,
        stress,
        weight,
        factor: beam.factor,
    };
    (member, gauge)
}

/// The density at which the pads and the solid beams weigh as much as the solid voxels.
fn density(frame: &Frame, forces: &Forces, bricks: &[Element], solid: &[bool]) -> f64 {
    let wedges = frame.pads.iter().flat_map(Pad::wedges);
    let pads: f64 = wedges.map(|wedge| wedge_volume(frame, &wedge)).sum();
    let volumes = frame
        .beams
        .iter()
        .zip(bricks)
        .zip(solid)
        .filter(|(_, solid)| **solid);
    let volumes = volumes.map(|((beam, brick), _)| beam.factor * brick.volumes.iter().sum::<f64>());
    forces.mass / (pads + volumes.sum::<f64>())
}
