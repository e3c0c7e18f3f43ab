//! The texture of a shell: for each voxel of a surface a place on an exemplar, so that all together look like it
//! (Dumas, Lu, Lefebvre, Wu, Dick 2015, section 4; S2 to S5). Coarse levels are made first; each hands
//! its labels down, where some are shuffled and all are improved. What the texture is for, and which
//! voxels a structure needs, is not known here.
//!
//! | file | what |
//! | --- | --- |
//! | `pattern`, `synthesizer` | what is asked and given, and the way from coarse to fine |
//! | `label` | labels, and where they put a voxel on the exemplar |
//! | `distance`, `picture`, `stack` | the exemplar as each level sees it |
//! | `neighbors` | which voxels are compared |
//! | `energy` | what labels cost |
//! | `candidates`, `optimize` | how they become better |
//! | `orientation` | where up is |
//! | `check` | what cannot be synthesized |
//! | `region` | what a local synthesis may change |

mod candidates;
mod check;
mod distance;
mod energy;
mod label;
mod neighbors;
mod optimize;
mod orientation;
mod pattern;
mod picture;
mod region;
mod stack;
mod synthesizer;
#[cfg(test)]
mod tests;

use fretwork_geometry::Pixels;

use crate::voxelize::Level;

pub use check::SynthesizeError;
pub use distance::feature_radius;
pub use pattern::{Options, Pattern};
pub use synthesizer::Synthesizer;

/// A first synthesis: [`Synthesizer::synthesize`] of a synthesizer that is used once.
///
/// # Errors
/// Those of [`Synthesizer::new`].
pub fn synthesize(
    pyramid: &[Level],
    exemplar: &Pixels,
    options: &Options,
) -> Result<Pattern, SynthesizeError> {
    Ok(Synthesizer::new(pyramid, exemplar, options)?.synthesize())
}

/// A local synthesis: [`Synthesizer::resynthesize`] of a synthesizer that is used once. Where there are several
/// to come, keep the synthesizer: it remembers neighbours and the exemplar.
///
/// # Errors
/// Those of [`Synthesizer::new`], and patterns or `forced` of another surface.
pub fn resynthesize(
    pyramid: &[Level],
    exemplar: &Pixels,
    options: &Options,
    pattern: &Pattern,
    forced: &[bool],
) -> Result<Pattern, SynthesizeError> {
    Synthesizer::new(pyramid, exemplar, options)?.resynthesize(pattern, forced)
}
