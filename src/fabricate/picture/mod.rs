//! Pictures of sheets, fields and solids, as PNG.

pub mod chunk;
pub mod field_picture;
pub mod sheet_picture;
pub mod solid;
