//! From the units of a body to those of its elements, where Young's modulus and a voxel's side are one.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::Lattice;

use super::case::Body;
use super::error::AnalysisError;
use super::material::Material;
use super::mesh::Node;

/// What the units of an element are worth.
#[derive(Clone, Copy)]
pub(super) struct Units {
    pub(super) material: Material,
    pub(super) lattice: Lattice,
    /// The side of a voxel in metres: the unit of length.
    pub(super) voxel: f64,
    /// The longest side of the body in metres.
    pub(super) longest_side: f64,
}

impl Units {
    /// The units of a body.
    ///
    /// # Errors
    /// Names a constant that cannot be.
    pub(super) fn new(body: &Body, material: &Material) -> Result<Units, AnalysisError> {
        material.check()?;
        let lattice = body.voxels.lattice;
        let voxel = lattice.pitch * body.metres_per_unit;
        if !(1e-9..1e6).contains(&voxel) {
            let what = "the side of a voxel in metres";
            return Err(AnalysisError::Value { what, value: voxel });
        }
        Ok(Units {
            material: *material,
            lattice,
            voxel,
            longest_side: body.bounds().longest_side() * body.metres_per_unit,
        })
    }

    /// The unit of force in newtons.
    pub(super) fn newtons(&self) -> f64 {
        self.material.youngs_modulus * self.voxel * self.voxel
    }

    /// The unit of work in joules.
    pub(super) fn joules(&self) -> f64 {
        self.newtons() * self.voxel
    }

    /// The mass of a voxel in kilograms.
    pub(super) fn voxel_mass(&self) -> f64 {
        self.material.density * self.voxel * self.voxel * self.voxel
    }

    /// The place of a node, in units of the lattice.
    pub(super) fn node_place(&self, node: Node) -> Point3 {
        self.lattice.point(node.map(f64::from))
    }
}
