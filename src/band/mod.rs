//! Bands and panels: patterns along curves, put together from pieces of an exemplar so that they
//! have exactly the number of components and holes that was asked for (Zhou, Jiang, Lefebvre 2014).
//!
//! Where the paper leaves room, the rules are those of the language's page on bands. Reading the
//! exemplar's file, and making solids of the result, are done elsewhere.

pub mod cycle;
pub mod descriptor;
pub mod exemplar;
#[cfg(test)]
mod oracle;
pub mod piece;
#[cfg(test)]
mod sample;
pub mod scale;
pub mod seam;
pub mod slicing;
pub mod solver;
pub mod states;
pub mod table;
