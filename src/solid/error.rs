//! Why there is no solid.

use fretwork_geometry::mesh::{RevolveError, TriangulationError};
use fretwork_geometry::{MeshError, Point3, counted};

/// Why a solid cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// The area cannot be divided into triangles.
    #[error(transparent)]
    Triangulation(#[from] TriangulationError),
    /// What came in or out is no closed mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Nothing is left.
    #[error("nothing is left of the solid")]
    Nothing,
    /// The components and handles of a body are not those of its cutout.
    #[error("the body has {} and {}, its cutout {} and {}", counted(.found.0, "component", "components"), counted(.found.1, "handle", "handles"), .wanted.0, .wanted.1)]
    Handles {
        /// Components and handles of the body.
        found: (usize, usize),
        /// What they were to be.
        wanted: (usize, usize),
    },
    /// A size that is not above zero, or not finite.
    #[error("a size cannot be {0}")]
    Size(f64),
    /// The profile cannot be turned.
    #[error(transparent)]
    Revolve(#[from] RevolveError),
    /// A cutout that does not lie on the surface.
    #[error("the cutout lies off the surface: near ({:.3}, {:.3}, {:.3}) it is {away:.3} from it", .at.x, .at.y, .at.z)]
    OffSurface {
        /// The farthest place.
        at: Point3,
        /// How far it is.
        away: f64,
    },
    /// A surface that is bent more sharply than it is to be thick.
    #[error("the surface is bent too sharply for the thickness near ({:.3}, {:.3}, {:.3})", .at.x, .at.y, .at.z)]
    Bend {
        /// Where.
        at: Point3,
        /// A thickness that would do, if one is known.
        most: Option<f64>,
    },
    /// Openings that meet.
    #[error("the surface has openings that meet at ({:.3}, {:.3}, {:.3})", .at.x, .at.y, .at.z)]
    Rim {
        /// Where.
        at: Point3,
    },
    /// An opening that is not flat.
    #[error("the surface is open and its opening is not flat near ({:.3}, {:.3}, {:.3})", .at.x, .at.y, .at.z)]
    NotFlat {
        /// Where.
        at: Point3,
    },
    /// The cutout was wrapped on another surface.
    #[error("the cutout lies on another surface than this one")]
    OtherSurface,
    /// Rims of a surface that has none.
    #[error("the surface has no open rim for a frame")]
    NoRim,
    /// What is engraved reaches through the surface.
    #[error("a depth of {depth} reaches through the surface, which becomes {thickness} thick, by {:.3}", depth + away - thickness)]
    Through {
        /// How deep it is engraved.
        depth: f64,
        /// How thick the surface becomes.
        thickness: f64,
        /// How far the cutout lies off the surface.
        away: f64,
    },
    /// The operands cannot be combined.
    #[error("the solids cannot be combined: {0}")]
    Combination(String),
}

impl SolidError {
    /// What would help, if something is known.
    pub fn help(&self) -> Option<String> {
        match self {
            SolidError::OffSurface { .. } => Some(
                "`wrap` lays a drawing on the surface; a band follows one where its curve is `on_surface`"
                    .into(),
            ),
            SolidError::Bend { most: Some(most), .. } => Some(format!(
                "a thickness of {most:.3} would do, or another `side` of the surface"
            )),
            SolidError::Through {
                thickness, away, ..
            } if away < thickness => Some(format!(
                "a depth below {:.3} leaves a floor; without `depth` it is cut through",
                thickness - away
            )),
            SolidError::NotFlat { .. } | SolidError::Rim { .. } => Some(
                "only flat openings are closed; `carve` makes an open surface thick, and so does a `thickness` in `assemble`"
                    .into(),
            ),
            _ => None,
        }
    }
}
