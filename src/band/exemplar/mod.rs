//! The exemplar, its pieces, and how they fit.

pub mod descriptor;
pub mod normalize;
pub mod piece;
pub mod seam;
pub mod slicing;
