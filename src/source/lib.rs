//! Foreign bytes to geometry, a module per format. Files are opened elsewhere: what comes in here
//! is their text or bytes, and a name for diagnostics.

pub mod font;
pub mod geo;
pub mod image;
pub mod mesh;
pub mod svg;
mod woff;

pub use woff::WoffError;
