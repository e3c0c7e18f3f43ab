//! Bands and panels: patterns along curves, put together from pieces of an exemplar so that they
//! have exactly the number of components and holes that was asked for (Zhou, Jiang, Lefebvre 2014).
//!
//! Where the paper leaves room, the rules are those of the language's page on bands. Reading the
//! exemplar's file, and making solids of the result, are done elsewhere.

#[expect(clippy::module_inception, reason = "a band is what this room makes")]
mod band;
mod exemplar;
mod panel;
mod realize;
pub mod sample;
mod solve;

pub use band::band;
pub use exemplar::normalize::Exemplar;
pub use exemplar::slicing::Slicing;
pub use panel::panel;
pub use solve::pattern::{Parts, Recipe, Room};
pub use solve::search::Sequence;
