//! Facades in space: scenes of shapes for viewers, and solids with a back for model makers. Which cells
//! there are is known already; files are written elsewhere.

mod bend;
mod relief;
mod ridge;
mod scene;
mod slab;
mod terrace;
#[cfg(test)]
mod tests;

pub use bend::BendError;
pub use relief::relief;
pub use scene::scene;

use fretwork_geometry::mesh::MeshError;
use fretwork_geometry::polygon::AreaError;
use fretwork_geometry::{Facade, SpaceCurve};

use bend::Bend;
use terrace::TerraceError;

/// Why a facade has no form.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormError {
    /// It cannot be laid along its curve.
    #[error(transparent)]
    Bend(#[from] BendError),
    /// The areas of its cells cannot be computed.
    #[error(transparent)]
    Area(#[from] AreaError),
    /// Its cells do not form a solid.
    #[error("the cells form no solid: {0}")]
    Terrace(#[from] TerraceError),
    /// A mesh is not closed.
    #[error("the mesh of shape `{shape}` is no solid: {error}")]
    Mesh {
        /// The shape.
        shape: String,
        /// What is wrong with it.
        error: MeshError,
    },
    /// Nothing is seen.
    #[error("no cell of the facade holds a shape")]
    Empty,
    /// More rectangles than can be held.
    #[error(
        "the facade has {0} rectangles between the sides of its cells, more than {MOST_RECTANGLES}"
    )]
    TooFine(usize),
}

/// More rectangles than this are refused.
const MOST_RECTANGLES: usize = 4_000_000;

/// Along the facade's curve, or as `flat` says.
fn bend(facade: &Facade, flat: Bend) -> Result<Bend, BendError> {
    let along = |curve: &SpaceCurve| Bend::along(curve, facade.layout.width);
    facade.wrap.as_ref().map_or(Ok(flat), along)
}
