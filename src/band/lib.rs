//! Bands and panels: patterns along curves, put together from pieces of an exemplar so that they
//! have exactly the number of components and holes that was asked for (S. Zhou, C. Jiang, S.
//! Lefebvre, *Topology-Constrained Synthesis of Vector Patterns*, ACM Transactions on Graphics
//! 33(6), 2014).
//!
//! The way of one band, from its spec to its cutout:
//!
//! 1. [`band()`] takes the spec with its exemplar's area and its curve.
//! 2. `exemplar` puts the area into the axes of a band, cuts it and compares every pair of pieces;
//!    bars and caps for its ends are pieces too.
//! 3. `solve` finds the cheapest sequence of pieces with the length and the counts asked for.
//! 4. `realize` joins the outlines of these pieces along the curve, and counts the result again.
//! 5. [`band()`] measures the cutout; `diagnose` puts into words what went wrong.
//!
//! A [`panel()`] takes this way twice. Reading the exemplar's file, and making solids of the result,
//! are done in other rooms.
//!
#![doc = include_str!("SEMANTICS.md")]

mod band;
mod diagnose;
mod exemplar;
mod panel;
mod parameters;
mod realize;
mod solve;

#[cfg(test)]
#[path = "../../tests/support/random_exemplar.rs"]
mod random_exemplar;

pub use band::{Areas, Fault, band};
pub use exemplar::ends::{Ends, EndsError};
pub use exemplar::error::{ExemplarError, ExemplarWarning, SlicingError};
pub use exemplar::normalize::Exemplar;
pub use exemplar::slicing::Cutting;
pub use panel::panel;
pub use parameters::{Parameters, Room};
pub use solve::pattern::Parts;
pub use solve::task::Sequence;
pub use solve::unsolvable::Unsolvable;
