//! Why a facade has no form.

use super::bend::BendError;
use super::terrace::TerraceError;
use fretwork_geometry::mesh::{MeshError, TriangulationError};
use fretwork_geometry::polygon::AreaError;

/// Why a facade has no form.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormError {
    /// The facade cannot be laid along its curve.
    #[error(transparent)]
    Bend(#[from] BendError),
    /// The visible areas of its cells cannot be computed.
    #[error(transparent)]
    Area(#[from] AreaError),
    /// The cells form no solid.
    #[error("the cells form no solid: {0}")]
    Terrace(#[from] TerraceError),
    /// The mesh of a shape is not closed.
    #[error(
        "the mesh of shape `{shape}` is no solid: {error}; bodies that touch need corners of their own in its file"
    )]
    Mesh {
        /// The name of the shape.
        shape: String,
        /// What is wrong with the mesh.
        error: MeshError,
    },
    /// The cross-section of a moulding cannot be filled.
    #[error("the profile of shape `{shape}` cannot be filled: {error}")]
    Profile {
        /// The name of the shape.
        shape: String,
        /// What is wrong with it.
        error: TriangulationError,
    },
    /// A moulding leaves no opening in the cell that it goes around.
    #[error(
        "the profile of shape `{shape}` is {height} high: around a cell of {} x {} it leaves no opening",
        cell[0],
        cell[1]
    )]
    Frame {
        /// The name of the shape.
        shape: String,
        /// The height of the profile.
        height: f64,
        /// The width and height of the cell.
        cell: [f64; 2],
    },
    /// No cell with a shape is visible.
    #[error("no cell of the facade holds a shape")]
    Empty,
    /// There are more rectangles than can be held.
    #[error(
        "the facade has {0} rectangles between the sides of its cells, more than {MOST_RECTANGLES}"
    )]
    TooFine(usize),
}

/// The most rectangles between the sides of cells. They are all held in memory, with a face of the
/// planar map for each.
pub const MOST_RECTANGLES: usize = 4_000_000;
