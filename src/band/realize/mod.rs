//! The geometry of a sequence.

pub mod assemble;
pub mod retry;
pub mod shape;
pub mod warp;
