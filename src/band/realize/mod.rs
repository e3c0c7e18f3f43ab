//! The third step: the outlines of a sequence (Zhou 2014, section 4). Pieces are put in place and
//! warped until they meet, outlines are turned at the seams, linked to polygons, and counted again.
//! Where that fails or leaves thin places, the solver is asked for another sequence.

mod assemble;
pub mod bed;
mod placed;
pub mod retry;
pub mod shape;
mod turn;
mod warp;
