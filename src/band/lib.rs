//! Bands and panels: patterns along curves, put together from pieces of an exemplar so that they
//! have exactly the number of components and holes that was asked for (Zhou, Jiang, Lefebvre 2014).
//!
//! Where the paper leaves room, the rules are those of the language's page on bands. Reading the
//! exemplar's file, and making solids of the result, are done elsewhere.

mod assemble;
#[expect(clippy::module_inception, reason = "a band is what this room makes")]
mod band;
mod beam;
mod best_first;
mod cycle;
mod descriptor;
mod draw;
mod exemplar;
mod explain;
mod offsets;
#[cfg(test)]
mod oracle;
mod panel;
mod piece;
mod reach;
mod recipe;
pub mod sample;
mod scale;
mod seam;
mod shape;
mod slicing;
mod solver;
mod states;
mod stitch;
mod table;
mod variety;
mod walk;

pub use band::band;
pub use exemplar::Exemplar;
pub use panel::panel;
pub use recipe::{Parts, Recipe, Room};
pub use slicing::Slicing;
pub use solver::Sequence;
