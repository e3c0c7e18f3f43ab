//! Shells: a pixel pattern over any mesh, reinforced until it is one piece and strong enough
//! (Dumas, Lu, Lefebvre, Wu, Dick: By-Example Synthesis of Structurally Sound Patterns, 2015).
//!
//! | step | what it gives |
//! | --- | --- |
//! | `voxelize` | the voxels of a surface, with normals, in a pyramid of resolutions |
//! | `synthesize` | a solid or empty pixel of the exemplar for each voxel |
//! | `connect` | the abstract graph of the pattern, and the bridges that make it one piece |
//! | `reinforce` | bridges where the stress or the way round is too large |
//! | `fill` | the voxels of a closed body |
//! | `weights` | how much of itself each voxel of a body stands for |
//! | `orient` | the direction of the principal stress on a surface |
//! | `finish` | features of the least width, and a closed mesh of the asked thickness |
//! | `analyse` | the stresses of any body of voxels under loads |
//!
#![doc = include_str!("SEMANTICS.md")]

pub mod analyse;
pub mod connect;
pub mod fill;
pub mod finish;
pub mod orient;
pub mod reinforce;
pub mod synthesize;
pub mod voxelize;
pub mod weights;
