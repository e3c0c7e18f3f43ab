//! Reinforcement: which bridges make a pattern one piece, strong enough, and without long ways round
//! (Dumas 2015, 5.2), and the loop that lets the synthesizer take them up. The graph that all of it works
//! on is made in `connect`; the analysis of the finished body is `analyse`.
//!
//! | step | what it gives |
//! | --- | --- |
//! | `profile` | material, supports, loads, limits |
//! | `ring`, `frame` | a pad for each sample, a beam for each edge |
//! | `element` | stiffness and stresses of wedges and bricks |
//! | `discretize` | pads and beams as members of a system |
//! | `forces` | what holds the pads and what pulls at them |
//! | `system` | the equations, filled again in place |
//! | `model` | the score of each edge |
//! | `select`, `geodesic` | the edges to add |
//! | `round` | the voxels to force after one look at the pattern |
//! | `structure` | rounds until nothing is missing, and one piece in any case |
//! | `measure` | a step of the loop by itself, for benchmarks |

mod discretize;
mod element;
mod forces;
mod frame;
mod geodesic;
mod measure;
mod model;
mod profile;
mod ring;
mod round;
mod select;
mod structure;
mod system;
#[cfg(test)]
mod tests;

pub use measure::Kept;
pub use profile::{Load, Profile, ReinforceError, Zone};
pub use round::{Bridges, Round, Settings, round};
pub use structure::{Structure, structure};
