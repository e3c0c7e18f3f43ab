//! What a body must hold: its material, where it stands, what pulls at it. How that is written in a spec,
//! and the full analysis, are not known here.

use fretwork_geometry::Point3;

use crate::analyse::Material;

/// A part of space: whether a point, in the surface's own units, lies in it.
pub type Zone<'a> = Box<dyn Fn(Point3) -> bool + Send + Sync + 'a>;

/// A force on a part of the surface.
pub struct Load<'a> {
    /// Where it acts: it is shared among the voxels whose middles are caught.
    pub zone: Zone<'a>,
    /// The force, N.
    pub force: Point3,
}

/// A case of load with what must hold under it.
pub struct Profile<'a> {
    /// What the body is made of.
    pub material: Material,
    /// Metres in a unit of the surface's lengths: 0.001 where they are millimetres.
    pub metres: f64,
    /// The acceleration that pulls at every element, m/s².
    pub gravity: Point3,
    /// Where the body is held: voxels whose middles one of them catches do not move.
    pub supports: Vec<Zone<'a>>,
    /// The other forces.
    pub loads: Vec<Load<'a>>,
    /// The largest |σ1| + |σ2| + |σ3| that the edges of the pattern may bear, Pa; without it nothing is
    /// added for the sake of the stress.
    pub max_stress: Option<f64>,
}

/// Why the stresses of a pattern cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReinforceError {
    /// A constant that no material has.
    #[error("{name} of the material is {value}, which no material has")]
    Material {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A length or a force that is not a number, or not positive where it must be.
    #[error("{name} is {value}, which is not possible")]
    Number {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A part of the surface that no support holds.
    #[error("no support catches the part of the surface near ({:.3}, {:.3}, {:.3})", place.x, place.y, place.z)]
    NotSupported {
        /// The middle of one of its voxels.
        place: Point3,
    },
    /// A load that catches nothing.
    #[error("load {} lies outside the surface: it catches no voxel", load + 1)]
    LoadOutside {
        /// Its number, from 0.
        load: usize,
    },
    /// A system that has no single solution although all parts are held.
    #[error("the pattern can move near ({:.3}, {:.3}, {:.3}): the stresses cannot be computed", place.x, place.y, place.z)]
    Mechanism {
        /// The middle of a voxel there.
        place: Point3,
    },
}

impl Profile<'_> {
    /// Refuses constants that no material has, and numbers that are none.
    ///
    /// # Errors
    /// The first of them.
    pub fn check(&self) -> Result<(), ReinforceError> {
        let Material {
            youngs_modulus,
            poisson_ratio,
            density,
            ..
        } = self.material;
        let constants = [
            ("Young's modulus", youngs_modulus, youngs_modulus > 0.0),
            (
                "Poisson's ratio",
                poisson_ratio,
                (0.0..0.499).contains(&poisson_ratio),
            ),
            ("the density", density, density >= 0.0),
        ];
        for (name, value, is_possible) in constants {
            if !is_possible || !value.is_finite() {
                return Err(ReinforceError::Material { name, value });
            }
        }
        let limit = self.max_stress.unwrap_or(1.0);
        let forces = self.loads.iter().map(|load| load.force);
        let forces = forces.map(|force| ("the size of a load", force.length(), true));
        let numbers = [
            ("the scale of lengths", self.metres, self.metres > 0.0),
            ("the largest stress", limit, limit > 0.0),
            ("gravity", self.gravity.length(), true),
        ];
        for (name, value, is_possible) in numbers.into_iter().chain(forces) {
            if !is_possible || !value.is_finite() {
                return Err(ReinforceError::Number { name, value });
            }
        }
        Ok(())
    }

    /// Whether a support catches a point.
    pub fn holds(&self, point: Point3) -> bool {
        self.supports.iter().any(|zone| zone(point))
    }
}
