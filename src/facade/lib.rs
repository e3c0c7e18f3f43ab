//! Layered facades: words of patterns, aligned, sized and multiplied into a grid of shapes.
//!
//! The method is that of M. Ilčík and others, "Layer-Based Procedural Design of Façades" (Computer
//! Graphics Forum 34(2), 2015). A facade comes in as [`Facade`], goes through one file per step, an
//! axis at a time, and leaves as a [`FacadeLayout`](fretwork_geometry::FacadeLayout):
//!
//! | step | file |
//! | --- | --- |
//! | text → trees, checks | `pattern`, `prepare` |
//! | trees → words (3.2, 3.3) | `word` |
//! | words → candidates (5.1) | `candidate`, `choice`, `grid` |
//! | candidates → alignments (5.2) | `row`, `assembly`, `network`, `outlook`, `column`, `label`, `search`, `ties`, `narrow`, `constrained` |
//! | alignments → sizes (5.3) | `balance`, `sizing` |
//! | the choice among all, the growing tolerance | `selection`, `comparison`, `axis` |
//! | two axes → shapes | `layout`, `style` |
//!
//! What stands in the cells comes from outside as a [`Facade`](fretwork_geometry::Facade) of `geometry`; `form` makes
//! scenes and solids of it.

mod assembly;
mod axis;
mod balance;
mod budget;
mod candidate;
mod choice;
mod column;
mod comparison;
mod constrained;
mod form;
mod grid;
mod input;
mod label;
mod layout;
mod narrow;
mod network;
mod outlook;
pub mod pattern;
mod prepare;
mod problem;
mod row;
mod search;
mod selection;
mod sizing;
mod style;
#[cfg(test)]
mod tests;
mod ties;
mod word;

pub use candidate::Range;
pub use form::{BendError, FormError, relief, scene};
pub use input::{Facade, Layer, PatternText, Symbol};
pub use layout::{check, lay_out};
pub use prepare::mistakes as pattern_mistakes;
pub use problem::{Part, PatternPart, Problem};
pub use style::shape;
