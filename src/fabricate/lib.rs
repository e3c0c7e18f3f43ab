//! Geometry to bytes: the files that machines and people take. A [`Sheet`] holds what is drawn; it
//! is prepared (kerf, clipping, no line twice, short ways) by functions from sheets to sheets, and
//! written by one module per format. Lengths in files are millimetres.

mod clip;
mod decimal;
mod deduplicate;
pub mod dxf;
pub mod glb;
pub mod kerf;
mod lines;
mod optimize;
pub mod png;
pub mod render;
pub mod shades;
mod sheet;
mod slabs;
mod solid;
pub mod stl;
pub mod svg;
pub mod threemf;
mod tour;
mod written;
mod zip;

pub use clip::clip;
pub use decimal::STEPS_PER_MM;
pub use deduplicate::deduplicate;
pub use optimize::optimize;
pub use sheet::{Color, Item, Layer, Pen, Role, Sheet, Style};
pub use solid::check as check_model;
pub use written::written;
