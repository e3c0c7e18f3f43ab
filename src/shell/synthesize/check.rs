//! What cannot be synthesized.

use fretwork_geometry::Pixels;

use super::{Options, Pattern};
use crate::voxelize::Level;

/// How many voxels a neighbourhood is wide.
const WINDOW: f64 = 5.0;

/// Why there is no texture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SynthesizeError {
    /// There are no voxels.
    #[error("there are no voxels to put a texture on")]
    NoVoxels,
    /// The exemplar has no pixels, or not as many colours as solid flags.
    #[error(
        "the exemplar has {colors} colours and {solid} solid or empty pixels in rows of {width}"
    )]
    NoPicture {
        /// How many colours.
        colors: usize,
        /// How many flags.
        solid: usize,
        /// Columns.
        width: usize,
    },
    /// The size of a pixel is not a positive length.
    #[error("{pixel_size} is no size of a pixel: it must be a positive length")]
    PixelSize {
        /// What was asked for.
        pixel_size: f64,
    },
    /// No pixel is empty.
    #[error("all pixels of the exemplar are solid: there is no pattern to make")]
    AllSolid,
    /// No pixel is solid.
    #[error("all pixels of the exemplar are empty: nothing would remain of the surface")]
    AllEmpty,
    /// The exemplar is smaller than the neighbourhoods in which voxels are compared.
    #[error(
        "the exemplar is {width:.2} × {height:.2} voxels large, each {voxel:.4} long, and must be at least 5 × 5: raise the \
         resolution or the size of its pixels, or make the surface as small as it should be"
    )]
    TooSmall {
        /// Its width in voxels.
        width: f64,
        /// Its height in voxels.
        height: f64,
        /// The side of a voxel.
        voxel: f64,
    },
    /// The jitter is not a part.
    #[error("a jitter of {jitter} is not between 0 and 1")]
    Jitter {
        /// What was asked for.
        jitter: f64,
    },
    /// A direction is not finite.
    #[error("a direction of the texture is not finite")]
    Direction,
    /// Something that is given for each voxel is given for another number of them.
    #[error("{what} is given for {given} voxels, but there are {voxels}")]
    Count {
        /// What it is.
        what: &'static str,
        /// For how many it is given.
        given: usize,
        /// How many there are.
        voxels: usize,
    },
}

/// Whether a synthesis is possible.
pub(super) fn check(
    pyramid: &[Level],
    exemplar: &Pixels,
    options: &Options,
) -> Result<(), SynthesizeError> {
    let Some(finest) = pyramid.first().filter(|l| !l.surface.voxels.is_empty()) else {
        return Err(SynthesizeError::NoVoxels);
    };
    check_exemplar(exemplar, finest.surface.voxels.lattice.pitch)?;
    check_options(options, finest.surface.voxels.len())
}

fn check_exemplar(exemplar: &Pixels, pitch: f64) -> Result<(), SynthesizeError> {
    let (colors, solid) = (exemplar.rgb.len(), exemplar.solid.len());
    let width = exemplar.width;
    if width == 0 || colors == 0 || colors != solid || !colors.is_multiple_of(width) {
        return Err(SynthesizeError::NoPicture {
            colors,
            solid,
            width,
        });
    }
    let pixel_size = exemplar.pixel_size;
    if !(pixel_size.is_finite() && pixel_size > 0.0) {
        return Err(SynthesizeError::PixelSize { pixel_size });
    }
    if !exemplar.solid.contains(&false) {
        return Err(SynthesizeError::AllSolid);
    }
    if !exemplar.solid.contains(&true) {
        return Err(SynthesizeError::AllEmpty);
    }
    let [width, height] = [width, exemplar.height()].map(|n| n as f64 * pixel_size / pitch);
    if width.min(height) < WINDOW {
        return Err(SynthesizeError::TooSmall {
            width,
            height,
            voxel: pitch,
        });
    }
    Ok(())
}

fn check_options(options: &Options, voxels: usize) -> Result<(), SynthesizeError> {
    let jitter = options.jitter;
    if !(0.0..=1.0).contains(&jitter) {
        return Err(SynthesizeError::Jitter { jitter });
    }
    let directions = options.orientation.iter().flatten().chain([&options.up]);
    if directions.flatten().any(|c| !c.is_finite()) {
        return Err(SynthesizeError::Direction);
    }
    if let Some(given) = &options.orientation {
        count("an orientation", given.len(), voxels)?;
    }
    match options.keep.len() {
        0 => Ok(()),
        given => count("what is kept solid", given, voxels),
    }
}

/// Whether a pattern and what is forced in it are of a surface.
pub(super) fn check_pattern(
    pyramid: &[Level],
    pattern: &Pattern,
    forced: &[bool],
) -> Result<(), SynthesizeError> {
    let voxels = pyramid[0].surface.voxels.len();
    count("what is forced", forced.len(), voxels)?;
    count("a pattern", pattern.solid.len(), voxels)?;
    count("a pattern's colour", pattern.colors.len(), voxels)?;
    if pattern.labels.len() != pyramid.len() {
        let given = pattern.labels.len();
        return count("a pattern's level", given, pyramid.len());
    }
    let mut pairs = pattern.labels.iter().zip(pyramid);
    pairs.try_for_each(|(labels, level)| count("a label", labels.len(), level.surface.voxels.len()))
}

fn count(what: &'static str, given: usize, voxels: usize) -> Result<(), SynthesizeError> {
    if given == voxels {
        return Ok(());
    }
    Err(SynthesizeError::Count {
        what,
        given,
        voxels,
    })
}
