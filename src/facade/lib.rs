//! Layered facades: words of patterns, aligned, sized and multiplied into a grid of shapes.
//!
//! The method is that of M. Ilčík and others, "Layer-Based Procedural Design of Façades" (Computer
//! Graphics Forum 34(2), 2015). A facade comes in as a [`Description`], goes through one folder a
//! step, an axis at a time, and leaves as a [`FacadeLayout`](fretwork_geometry::FacadeLayout):
//!
//! | step | folder |
//! | --- | --- |
//! | texts → trees → words, checks (3.2, 3.3) | `pattern` |
//! | words → candidates (5.1) | `candidate` |
//! | candidates → alignments (5.2) | `align` |
//! | alignments → sizes (5.3) | `size` |
//! | the choice among all, the growing tolerance | `select` |
//! | two axes → shapes | `layout` |
//!
//! What stands in the cells comes from outside as a [`Facade`](fretwork_geometry::Facade) of
//! `geometry`; `form` makes scenes and solids of it.
//!
//! # The way of one facade
//!
//! 1. [`lay_out`] parses the patterns of all layers and reports every mistake in them.
//! 2. For each axis, names become numbers, and sizes become multiples of their common divisor.
//! 3. At the first tolerance, 1 % of the canvas, the words of each pattern are listed that may fit.
//! 4. One word a layer makes a candidate, if their counters agree and their lengths fit together.
//! 5. A candidate's words become the rows of a network. The shortest path through it is the alignment
//!    with the least error.
//! 6. The candidates with the least error of all are sized: least squares keep their symbols near the
//!    preferred sizes. The one with the least change wins.
//! 7. If no candidate can be aligned and sized, the tolerance grows by half, and step 3 follows.
//! 8. The borders and letters of both axes are multiplied, layer by layer, into cells.
//! 9. The caller puts shapes into the cells ([`shape`]) and fills them.
//! 10. [`scene`] or [`relief`] make a model of it, or the elevation is drawn elsewhere.
#![doc = include_str!("SEMANTICS.md")]

mod align;
mod axis;
mod budget;
mod candidate;
mod description;
mod form;
mod layout;
pub mod pattern;
mod problem;
mod select;
mod size;
#[cfg(test)]
mod tests;

pub use axis::Axis;
pub use description::{Description, Layer, PatternText, Range, Symbol};
pub use form::style::{idle_shapes, shape};
pub use form::{BendError, FormError, drawn, relief, scene};
pub use layout::{check, lay_out};
pub use pattern::prepare::mistakes as pattern_mistakes;
pub use problem::{Part, PatternPart, Problem};
