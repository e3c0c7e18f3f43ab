//! Facades in space: scenes of shapes for viewers, and solids with a back for makers of models. The cells
//! are given; files are written elsewhere.

mod bend;
mod divide;
mod drawn;
mod error;
mod moulding;
mod relief;
mod ridge;
mod run;
mod scene;
mod slab;
pub mod style;
mod terrace;
#[cfg(test)]
mod tests;

pub use bend::BendError;
pub use drawn::drawn;
pub use error::FormError;
pub use relief::relief;
pub use scene::scene;
