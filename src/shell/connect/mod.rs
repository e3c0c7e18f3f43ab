//! What the pattern hangs together by: the graph of the surface's voxels, the abstract graph of the
//! pattern, and bridges made of voxels. Which bridges are worth making is decided in `reinforce`;
//! how the pattern takes them up, by whoever synthesizes it.
//!
//! | step | what it gives | source |
//! | --- | --- | --- |
//! | `surface_graph` | voxels that touch, once for a surface | Dumas 2015, 5.1 |
//! | `pieces` | components of voxels, through corners or through faces | S6 |
//! | `sample` | about a thousand solid voxels spread evenly | 5.1, Poisson disks |
//! | `forest` | shortest paths from the samples | Algorithm 5, lines 1 and 3 |
//! | `abstract_graph` | solid and empty edges between samples, with their voxels | Algorithm 5 |
//! | `bridge` | paths made as wide as a feature | 5.2 |
//! | `join` | the fewest voxels that make loose pieces one | S6 |

mod abstract_graph;
mod bridge;
mod forest;
mod join;
mod pieces;
mod sample;
mod surface_graph;
#[cfg(test)]
pub(crate) mod tests;

pub use abstract_graph::{AbstractEdge, AbstractGraph};
pub use bridge::widen;
pub use forest::{Forest, NOBODY};
pub use join::{join_groups, join_through_corners, join_through_faces};
pub use pieces::{NO_PIECE, Pieces, specks};
pub use sample::{sample, sample_at};
pub use surface_graph::{SurfaceGraph, Touch, UNIT};
