//! GeoTIFF and BigTIFF: one band of the first full-size image, where it lies, and in which coordinate
//! system. Blocks are decoded when a sample of them is asked for.
//!
//! ```text
//! file        the image that is meant, its compression, its plain tags
//! keys        GeoKeys (GeoTIFF 1.1, chapter 7) → coordinate system
//! blocks      strips and tiles → samples
//! ```

mod blocks;
mod file;
mod keys;
#[cfg(test)]
mod tests;

pub use blocks::Blocks;
pub use file::{GeoTiff, GeoTiffError, open, world_file};
