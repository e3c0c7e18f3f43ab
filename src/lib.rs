//! fretwork is a compiler: a spec in YAML goes in, files that can be fabricated come out, and
//! everything between is a pure function of what is above it.

pub mod arrangement;
pub mod build;
pub mod cli;
pub mod diagnostic;
pub mod fabricate;
pub mod geometry;
pub mod graph;
pub mod script;
pub mod source;
pub mod spec;
pub mod store;
