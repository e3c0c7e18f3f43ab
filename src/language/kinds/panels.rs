//! `panels`: patterns that fill a rectangle, with a given number of pieces and holes.

use super::bands::Synthesis;
use crate::Ref;
use crate::define::record;
use crate::scalar::PositiveLength;
use crate::types::wants;

record! {
    /// A pattern that fills a rectangle, made of pieces of an exemplar, with a given number of connected components and holes: a cutout.
    pub struct Panel {
        /// The ornament, at its own size.
        exemplar: Ref<wants::VectorExemplar>,
        /// The panel's extent along x.
        width: PositiveLength,
        /// The panel's extent along y.
        height: PositiveLength,
    }
    /// What is shared with bands.
    + synthesis: Synthesis
}
