//! Patterns on surfaces: what the steps of their synthesis hand to one another, and what comes out.

use serde::{Deserialize, Serialize};

use crate::voxel::VoxelSurface;
use crate::{Mesh, Point3};

/// What a step on the way to a shell gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Step {
    /// The voxels of the surface.
    Voxels(VoxelSurface),
    /// A first pattern on them, which nothing holds together yet.
    Pattern {
        /// The pattern.
        pattern: Pattern,
        /// Where the exemplar's up points in each voxel, a vector of its tangent plane; none where one
        /// direction says it for all.
        directions: Option<Vec<[f32; 3]>>,
    },
    /// The pattern in one piece.
    Structure(Structure),
}

impl Step {
    /// The voxels, if it is they.
    pub fn voxels(&self) -> Option<&VoxelSurface> {
        match self {
            Step::Voxels(surface) => Some(surface),
            Step::Pattern { .. } | Step::Structure(_) => None,
        }
    }

    /// The first pattern with its directions, if it is that.
    pub fn pattern(&self) -> Option<(&Pattern, Option<&Vec<[f32; 3]>>)> {
        match self {
            Step::Pattern {
                pattern,
                directions,
            } => Some((pattern, directions.as_ref())),
            Step::Voxels(_) | Step::Structure(_) => None,
        }
    }

    /// The pattern in one piece, if it is that.
    pub fn structure(&self) -> Option<&Structure> {
        match self {
            Step::Structure(structure) => Some(structure),
            Step::Voxels(_) | Step::Pattern { .. } => None,
        }
    }
}

/// A pattern on the voxels of a surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pattern {
    /// For each level of resolution, the finest first, the label of each voxel: which plane of the
    /// exemplar it reads, and how that is laid.
    pub labels: Vec<Vec<u32>>,
    /// Which voxels of the finest level are solid.
    pub solid: Vec<bool>,
    /// Their colours.
    pub colors: Vec<[u8; 3]>,
}

impl Pattern {
    /// The part of the voxels that is solid, from 0 to 1.
    pub fn solid_fraction(&self) -> f64 {
        solid_fraction(&self.solid)
    }
}

/// The part of some voxels that is solid, from 0 to 1.
pub fn solid_fraction(solid: &[bool]) -> f64 {
    solid.iter().filter(|solid| **solid).count() as f64 / solid.len().max(1) as f64
}

/// How many bridges were added, by what asked for them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bridges {
    /// To make one piece.
    pub connection: usize,
    /// Where the stress was too large.
    pub stress: usize,
    /// Where the way round was too long.
    pub geodesic: usize,
}

/// A pattern that holds together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// Which voxels are solid.
    pub solid: Vec<bool>,
    /// Rounds of analysis and repair.
    pub iterations: usize,
    /// Whether every criterion held at the end, rather than the rounds running out.
    pub is_done: bool,
    /// What was added.
    pub bridges: Bridges,
    /// The part of the voxels that was solid before.
    pub fraction_before: f64,
}

/// A pattern on a surface as a body, with what was found out about it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shell {
    /// The closed mesh.
    pub mesh: Mesh,
    /// For each corner of the mesh the stress there, |σ1| + |σ2| + |σ3| in Pa; empty where nothing was
    /// analysed.
    pub stress: Vec<f32>,
    /// For each corner of the mesh why it is solid.
    pub reasons: Vec<Reason>,
    /// Its figures.
    pub measures: ShellMeasures,
}

/// Why a part of a shell is solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Reason {
    /// The first pattern has it so.
    Pattern,
    /// A bridge, or the pattern made again about one.
    Bridge,
    /// A feature would be too thin without it.
    Feature,
}

/// The figures of a shell; lengths in the spec's unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShellMeasures {
    /// Voxels of the surface.
    pub voxels: usize,
    /// Those that are solid.
    pub solid_voxels: usize,
    /// The side of a voxel.
    pub voxel: f64,
    /// Pieces of the body.
    pub components: usize,
    /// Rounds of analysis and repair.
    pub iterations: usize,
    /// Whether every criterion held at the end.
    pub is_done: bool,
    /// Bridges by what asked for them.
    pub bridges: Bridges,
    /// The part of the exemplar's pixels that is solid.
    pub exemplar_fraction: f64,
    /// The solid part of the voxels before bridges were added, and after all.
    pub fraction: [f64; 2],
    /// The least width of what is solid, on the surface.
    pub min_feature: f64,
    /// Where that is; nowhere where all is much wider than was asked.
    pub min_feature_at: Option<Point3>,
    /// What the analysis of the body says, if there was one.
    pub strength: Option<Strength>,
}

/// A body that was analysed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AnalysedBody {
    /// What the analysis says.
    pub strength: Strength,
    /// The body, with edges as short as what differs along them.
    pub mesh: Mesh,
    /// |σ1| + |σ2| + |σ3| at each corner of the mesh, in Pa.
    pub stress: Vec<f32>,
}

/// What an analysis of a body says. Values have five significant digits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Strength {
    /// Cubes that were analysed.
    pub elements: usize,
    /// |σ1| + |σ2| + |σ3| in Pa.
    pub stress: Statistics,
    /// The stress of von Mises in Pa.
    pub von_mises: Statistics,
    /// The largest displacement, as a length.
    pub max_displacement: f64,
    /// Where it is.
    pub displacement_at: Point3,
    /// The mass in kg.
    pub mass: f64,
    /// The yield strength over the 99th percentile and over the maximum of von Mises; none where nothing strains the
    /// body.
    pub safety_factor: Option<[f64; 2]>,
    /// Where the stress of von Mises is greatest; nowhere where nothing strains the body.
    pub weakest_at: Option<Point3>,
    /// What is left of the forces, as a part of them.
    pub residual: f64,
    /// Iterations of the solver.
    pub iterations: usize,
    /// What is worst of the directions of gravity that were tried; none where one direction was asked for.
    pub worst_gravity: Option<WorstGravity>,
}

/// The worst of several directions of gravity: each value is that of the direction under which it is worst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WorstGravity {
    /// The direction under which the 99th percentile of the stress is greatest.
    pub direction: [f64; 3],
    /// That percentile, in Pa.
    pub p99: f64,
    /// The least safety factors, by the 99th percentile and by the maximum of von Mises; none where no direction strains
    /// the body.
    pub safety_factor: Option<[f64; 2]>,
    /// Where the body is weakest under any of them.
    pub weakest_at: Option<Point3>,
    /// The largest displacement, as a length.
    pub max_displacement: f64,
}

/// The distribution of values over elements of one size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// The mean.
    pub mean: f64,
    /// The median.
    pub median: f64,
    /// The 99th percentile.
    pub p99: f64,
    /// The greatest.
    pub max: f64,
}
