//! Sheets and models as the bytes of files, a file per format.

pub mod dxf;
pub mod glb;
pub mod stl;
pub mod svg;
pub mod threemf;
mod zip;
