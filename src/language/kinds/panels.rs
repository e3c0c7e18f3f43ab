//! `panels`: patterns that fill a rectangle, with a given number of pieces and holes.

use super::bands::Synthesis;
use super::side::Side;
use crate::Ref;
use crate::macros::record;
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
        /// On which side of the drawing plane the thickness goes when the panel becomes a solid: with `outside` the panel lies on the plane, with `inside` below it.
        side: Side = "outside",
    }
    /// What is shared with bands.
    + synthesis: Synthesis
}
