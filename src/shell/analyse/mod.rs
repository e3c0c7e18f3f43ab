//! The analysis of a body of voxels as linear elasticity: every voxel is a trilinear hexahedron, and nothing
//! is simplified. How a body comes to be, and what its stresses are compared with, is not known here.
//!
//! | step | what it gives |
//! | --- | --- |
//! | `case`, `material`, `units` | what is asked, and the units in which it is solved |
//! | `mesh`, `element`, `operator` | nodes and elements, and the stiffness matrix times a vector |
//! | `parts`, `mechanism` | what can move without strain, named before anything is solved |
//! | `patches`, `rigid`, `galerkin`, `coarse` | the coarse space: rigid motions of patches, with its factor |
//! | `preconditioner`, `conjugate_gradients` | displacements, and how good they are |
//! | `number`, `together` | four load cases side by side, at hardly more than the price of two |
//! | `stress`, `statistics`, `analysis` | stresses, their statistics, the safety factor |
//! | `sweep` | gravity from all sides |
//!
//! The matrix is never put together: a product goes through the elements. A shell of 700,000 voxels
//! has 2.5 million unknowns, and takes some twenty iterations. Results are the same for any number of
//! threads; on another processor their last digits may differ, as the factor of the coarse matrix picks
//! its instructions at run time.
//!
//! ```
//! use fretwork_geometry::voxel::{Lattice, Voxels};
//! use fretwork_geometry::Point3;
//! use fretwork_shell::analyse::{Body, Case, Material, Zone, analyse};
//!
//! // A bar of 2 × 2 × 10 mm that stands on its end.
//! let lattice = Lattice { origin: Point3::ORIGIN, pitch: 1.0 };
//! let cell = |i: u16| [i % 2, i / 2 % 2, i / 4];
//! let voxels = Voxels::new(lattice, (0..40).map(cell).collect());
//! let body = Body { voxels: &voxels, metres_per_unit: 1e-3 };
//! let material = Material {
//!     youngs_modulus: 2.3e9,
//!     poisson_ratio: 0.35,
//!     density: 1040.0,
//!     yield_strength: Some(40e6),
//!     across_layers: None,
//! };
//! let bounds = body.bounds();
//! let supports = |p: Point3| Zone::Lowest(0.0).contains(p, &bounds);
//! let fall = Case { gravity: [0.0, 0.0, -9.81], loads: Vec::new() };
//! let found = analyse(&body, &material, &supports, &[fall])?;
//! assert!(found[0].summary.residual <= 1e-6);
//! assert!(found[0].summary.safety.is_some_and(|safety| safety.least > 1e5));
//! # Ok::<(), fretwork_shell::analyse::AnalysisError>(())
//! ```

mod analysis;
mod block;
mod case;
mod coarse;
mod conjugate_gradients;
mod element;
mod error;
mod galerkin;
mod material;
mod mechanism;
mod memory;
mod mesh;
mod model;
mod number;
mod operator;
mod parts;
mod patches;
mod preconditioner;
mod rigid;
mod statistics;
mod stress;
mod sweep;
#[cfg(test)]
mod tests;
mod together;
mod units;
mod vector;

pub use analysis::{Analysis, Safety, Summary};
pub use case::{Body, Case, Load, Places, Zone};
pub use error::{AnalysisError, Hold, LoosePart};
pub use material::{AcrossLayers, Material};
pub use memory::MemoryLimit;
pub use model::{Model, analyse};
pub use statistics::Statistics;
pub use stress::{Stress, principal_stresses, stress_sum, von_mises};
pub use sweep::Sweep;
