//! The sequence of pieces.

pub mod a_star;
pub mod autocorrelation;
pub mod beam;
pub mod closed;
pub mod cost_to_go;
pub mod feasible;
pub mod least_squares_offsets;
#[cfg(test)]
pub mod oracle;
pub mod partial_sequence;
pub mod pattern;
pub mod quantize;
pub mod search;
pub mod states;
pub mod unsolvable;
