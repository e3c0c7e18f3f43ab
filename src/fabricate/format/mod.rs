//! Sheets and models as the bytes of files, a file per format.

pub mod dxf;
pub mod dxf_color;
pub mod geojson;
pub mod glb;
mod path_data;
pub mod stl;
pub mod svg;
pub mod threemf;
mod xml;
mod zip;
