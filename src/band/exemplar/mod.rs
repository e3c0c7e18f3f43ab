//! The first step: an exemplar is put into the axes of a band, cut into pieces, and every pair of
//! pieces is compared (Zhou 2014, sections 3.2 to 3.4, 3.6.1 and 5). Which pieces a pattern takes
//! is decided in `solve`.

pub mod bar;
mod cap;
pub mod descriptor;
pub mod ends;
pub mod error;
mod mend;
mod mirror;
pub mod normalize;
pub mod piece;
pub mod seam;
pub mod slicing;
