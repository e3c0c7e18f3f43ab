//! The second step: the cheapest sequence of pieces that has the asked length and topology (Zhou
//! 2014, section 3.6). Which pieces there are is known from `exemplar`; the outlines of the
//! sequence are made in `realize`.
//!
//! | file | what is in it |
//! | --- | --- |
//! | `task` | what is asked of a sequence, and what comes back |
//! | `states` | the graph: last piece and topology descriptor |
//! | `quantize` | lengths, costs and offsets in whole numbers |
//! | `cost_to_go` | the dynamic program: the least cost from every state to the end |
//! | `search` | one table and how a sequence is read from it |
//! | `strategy` | which searches are made, in which order |
//! | `a_star`, `beam` | searches forward along a table, with exact lengths and offsets |
//! | `closed` | loops |
//! | `autocorrelation` | how much a sequence repeats itself |
//! | `alignment` | where the pieces of a sequence stand across the curve |
//! | `feasible`, `unsolvable` | what could be had instead |
//! | `pattern` | exemplar and solver together |

mod a_star;
pub mod alignment;
mod autocorrelation;
mod beam;
mod cell_layout;
mod closed;
mod cost_to_go;
mod feasible;
mod least_squares_offsets;
#[cfg(test)]
mod oracle;
mod packed_cost;
mod partial_sequence;
pub mod pattern;
mod quantize;
mod quantized;
mod search;
mod solver;
mod states;
mod strategy;
pub mod task;
#[cfg(test)]
mod tests;
pub mod unsolvable;
