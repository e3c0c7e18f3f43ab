//! GeoTIFF and BigTIFF: one band of the first full-size image, where it lies, and in which coordinate
//! system. Blocks are decoded when a sample of them is asked for.
//!
//! ```text
//! file        the image that is meant, its plain tags
//! keys        GeoKeys (GeoTIFF 1.1, chapter 7) → coordinate system
//! parameters  the same of systems that have no code
//! blocks      strips and tiles → samples
//! shelf       the blocks that were decoded lately, as many as there is room for
//! packing     how samples lie in a block, and how it is compressed
//! words       what is wrong with a file, in words
//! ```

mod blocks;
mod file;
mod keys;
mod packing;
mod parameters;
mod shelf;
#[cfg(test)]
mod tests;
mod words;

pub use blocks::Blocks;
pub use file::{GeoTiff, GeoTiffError, Source, open, world_file};
