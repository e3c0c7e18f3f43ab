//! The entries of each section, a file per section: plain structs with their docs, defaults and
//! limits. How they are computed is the business of the rooms that take them.

pub mod analyses;
pub mod arrangements;
pub mod artifacts;
pub mod bands;
pub mod curves;
pub mod exemplars;
pub mod facades;
pub mod fields;
pub mod force_profiles;
pub mod layers;
pub mod look;
pub mod panels;
pub mod partitions;
pub mod patterns;
pub mod regions;
pub mod shells;
pub mod side;
pub mod solids;
pub mod surfaces;
pub mod symbols;
pub mod texts;
pub mod wraps;
