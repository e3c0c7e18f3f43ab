//! Why there is no solid.

use fretwork_geometry::mesh::TriangulationError;
use fretwork_geometry::{MeshError, Point3};

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
    #[error("the body has {} components and {} handles, its cutout {} and {}", .found.0, .found.1, .wanted.0, .wanted.1)]
    Handles {
        /// Components and handles of the body.
        found: (usize, usize),
        /// What they were to be.
        wanted: (usize, usize),
    },
    /// A size that is not above zero, or not finite.
    #[error("a size cannot be {0}")]
    Size(f64),
    /// A full turn of fewer than three pieces.
    #[error("a full turn of {0} pieces has no volume: it needs at least 3")]
    Segments(u32),
    /// The profile has fewer than two distinct points.
    #[error("a profile needs at least two distinct points")]
    ShortProfile,
    /// The profile goes to the other side of the axis.
    #[error("the profile leaves the right side of the axis: its radius is {0}")]
    NegativeRadius(f64),
    /// The profile touches the axis between its ends.
    #[error("the profile touches the axis at height {0}, between its ends")]
    TouchesAxis(f64),
    /// More triangles than a mesh may have.
    #[error("{0} triangles are too many")]
    TooMany(u64),
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
    /// The operands cannot be combined.
    #[error("the solids cannot be combined: {0}")]
    Combination(String),
}
