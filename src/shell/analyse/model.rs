//! A body, its material and its supports, set up once for many load cases.

use fretwork_geometry::{Point3, budget};

use super::analysis::Analysis;
use super::case::{Body, Case, Load, Places};
use super::conjugate_gradients::{Quality, solve};
use super::element::Quad;
use super::error::{AnalysisError, LoosePart};
use super::material::Material;
use super::mechanism::loose_parts;
use super::memory::MemoryLimit;
use super::mesh::{Mesh, Node, corners};
use super::preconditioner::Preconditioner;
use super::units::Units;
use super::vector::norm;

/// Steps of the budget for each voxel while a body is set up: ten iterations.
const SETUP_STEPS: u64 = 1000;

/// A body that is ready for load cases.
pub struct Model {
    pub(super) units: Units,
    pub(super) inverse: Preconditioner,
    pub(super) limit: MemoryLimit,
}

/// Forces at the nodes in units of the element.
pub(super) type Forces = Vec<Quad<f64>>;

/// How a body moves under forces.
pub(super) struct Response {
    /// The displacement of each node under forces of the length one.
    pub(super) displacement: Vec<Quad<f64>>,
    /// How good that is.
    pub(super) quality: Quality,
    /// The length of the forces.
    pub(super) scale: f64,
}

impl Model {
    /// Sets up a body that is held at the nodes for which `supports` is true. The setup takes about as
    /// long as ten iterations.
    ///
    /// # Errors
    /// When the body or the material cannot be, nothing is held, parts can move without strain, or the
    /// analysis would not fit below `limit`.
    pub fn new(
        body: &Body,
        material: &Material,
        supports: Places,
        limit: MemoryLimit,
    ) -> Result<Model, AnalysisError> {
        Model::weighted((body, &[]), material, supports, limit)
    }

    /// Sets up a body each of whose voxels stands for a part of itself: stiffness and mass are multiplied by its weight, which
    /// is positive; without weights they are whole.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn weighted(
        (body, weights): (&Body, &[f32]),
        material: &Material,
        supports: Places,
        limit: MemoryLimit,
    ) -> Result<Model, AnalysisError> {
        let cells = &body.voxels.cells;
        if cells.is_empty() {
            return Err(AnalysisError::Empty);
        }
        let units = Units::new(body, material)?;
        limit.check_voxels(cells.len())?;
        let mut mesh = Mesh::new(cells, |node| supports(units.node_place(node)));
        if !weights.is_empty() {
            mesh.weigh(weights);
        }
        limit.check_factor(cells.len(), mesh.nodes.len(), 0)?;
        if mesh.clamped.is_empty() {
            return Err(AnalysisError::NothingSupported);
        }
        let loose = loose_parts(&mesh).into_iter().map(|part| LoosePart {
            at: units.lattice.point(part.at),
            hold: part.hold,
            voxels: part.voxels,
        });
        let loose: Vec<LoosePart> = loose.collect();
        if !loose.is_empty() {
            return Err(AnalysisError::Loose(loose));
        }
        budget::spend("rounds of an analysis", SETUP_STEPS * cells.len() as u64);
        let mut inverse = Preconditioner::new(mesh, material.poisson_ratio, limit)?;
        inverse.mesh.forget_neighbors();
        Ok(Model {
            units,
            inverse,
            limit,
        })
    }

    /// Analyses one load case.
    ///
    /// # Errors
    /// When a load misses the body, a number is not finite, or the equations cannot be solved.
    pub fn analyse(&self, case: &Case) -> Result<Analysis, AnalysisError> {
        let response = self.solve(&|| self.forces(case))?;
        Ok(self.analysis(&response))
    }

    /// The analysis of a response.
    pub(super) fn analysis(&self, response: &Response) -> Analysis {
        let solution = (&response.displacement[..], &response.quality);
        Analysis::new(&self.inverse.mesh, &self.units, solution, response.scale)
    }

    /// The forces of a load case.
    ///
    /// # Errors
    /// When a load misses the body, or a number is not finite.
    pub(super) fn forces(&self, case: &Case) -> Result<Forces, AnalysisError> {
        let mut forces = self.weight(case.gravity)?;
        self.add_loads(&case.loads, &mut forces)?;
        Ok(forces)
    }

    /// The weight of the body, an eighth of each voxel's at each of its corners. `gravity` is in m/s².
    pub(super) fn weight(&self, gravity: [f64; 3]) -> Result<Forces, AnalysisError> {
        check_finite("gravity", gravity)?;
        let mesh = &self.inverse.mesh;
        let corner = self.units.voxel_mass() / 8.0 / self.units.newtons();
        let force = gravity.map(|g| g * corner);
        let mut forces: Forces = vec![[0.0; 4]; mesh.nodes.len()];
        for (element, weight) in mesh.elements.iter().zip(&mesh.weights) {
            for node in corners(element)
                .into_iter()
                .filter(|n| !mesh.is_clamped[*n])
            {
                for (sum, force) in forces[node].iter_mut().zip(force) {
                    *sum += force * f64::from(*weight);
                }
            }
        }
        Ok(forces)
    }

    /// Shares each load among the nodes that it catches.
    pub(super) fn add_loads(&self, loads: &[Load], to: &mut Forces) -> Result<(), AnalysisError> {
        let mesh = &self.inverse.mesh;
        for (number, load) in loads.iter().enumerate() {
            check_finite("a force", load.force)?;
            let catches = |node: &usize| (load.at)(self.units.node_place(mesh.nodes[*node]));
            let caught: Vec<usize> = (0..mesh.nodes.len()).filter(catches).collect();
            if caught.is_empty() {
                return Err(AnalysisError::LoadMisses { load: number });
            }
            let share = 1.0 / (caught.len() as f64 * self.units.newtons());
            for node in caught.into_iter().filter(|node| !mesh.is_clamped[*node]) {
                for (sum, force) in to[node].iter_mut().zip(load.force) {
                    *sum += force * share;
                }
            }
        }
        Ok(())
    }

    /// The displacements under forces, divided by the length of the forces, and that length. Numbers of
    /// about one fit the single precision of the smoother, however weak the forces are.
    ///
    /// # Errors
    /// Those of `forces`, which are asked for several times, and equations that cannot be solved.
    pub(super) fn solve(
        &self,
        forces: &dyn Fn() -> Result<Forces, AnalysisError>,
    ) -> Result<Response, AnalysisError> {
        let scale = norm(&forces()?);
        if scale == 0.0 {
            return Ok(Response {
                displacement: vec![[0.0; 4]; self.inverse.mesh.nodes.len()],
                quality: Quality::default(),
                scale,
            });
        }
        let scaled = || {
            let mut forces = forces()?;
            forces.iter_mut().flatten().for_each(|x| *x /= scale);
            Ok(forces)
        };
        let solution = solve::<f64, 4>(&self.inverse, &scaled)?;
        let quality = solution.qualities[0];
        converged(&quality)?;
        Ok(Response {
            displacement: solution.displacement,
            quality,
            scale,
        })
    }

    /// The numbers of the loads that do nothing: their force is zero, or all nodes that they catch are held.
    pub fn idle_loads(&self, loads: &[Load]) -> Vec<usize> {
        let mesh = &self.inverse.mesh;
        let acts = |load: &Load| {
            let is_moved = |(node, is_clamped): (&Node, &bool)| {
                !is_clamped && (load.at)(self.units.node_place(*node))
            };
            load.force != [0.0; 3] && mesh.nodes.iter().zip(&mesh.is_clamped).any(is_moved)
        };
        (0..loads.len()).filter(|n| !acts(&loads[*n])).collect()
    }

    /// How many voxels there are.
    pub fn voxel_count(&self) -> usize {
        self.inverse.mesh.elements.len()
    }

    /// How many unknowns there are.
    pub fn unknown_count(&self) -> usize {
        3 * (self.inverse.mesh.nodes.len() - self.inverse.mesh.clamped.len())
    }

    /// The nodes that are held, in units of the lattice.
    pub fn supported_nodes(&self) -> impl Iterator<Item = Point3> + '_ {
        let mesh = &self.inverse.mesh;
        let nodes = mesh.clamped.iter().map(|node| mesh.nodes[*node as usize]);
        nodes.map(|node| self.units.node_place(node))
    }
}

/// Sets up a body and analyses some load cases, within the usual memory.
///
/// # Errors
/// As [`Model::new`] and [`Model::analyse`].
pub fn analyse(
    body: &Body,
    material: &Material,
    supports: Places,
    cases: &[Case],
) -> Result<Vec<Analysis>, AnalysisError> {
    let model = Model::new(body, material, supports, MemoryLimit::default())?;
    model.analyse_all(cases)
}

/// An error for a solution that is not good enough.
pub(super) fn converged(quality: &Quality) -> Result<(), AnalysisError> {
    match quality.is_good() {
        true => Ok(()),
        false => Err(AnalysisError::NotConverged {
            iterations: quality.iterations,
            residual: quality.residual,
            energy_error: quality.energy_error,
        }),
    }
}

fn check_finite(what: &'static str, vector: [f64; 3]) -> Result<(), AnalysisError> {
    match vector.into_iter().find(|x| x.is_nan() || x.abs() > 1e30) {
        Some(value) => Err(AnalysisError::Value { what, value }),
        None => Ok(()),
    }
}
