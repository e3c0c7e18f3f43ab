//! fretwork is a compiler: a spec in YAML goes in, files that can be fabricated come out, and
//! everything between is a pure function of what is above it.
//!
//! The rooms, in the order in which data flows through them:
//!
//! | room | what it does | what it may use |
//! | --- | --- | --- |
//! | [`diagnostic`] | what is wrong, where, and how it is shown | |
//! | [`geometry`] | the kernel: points, curves, polygons, planar maps, drawings, fields, seeds | |
//! | [`store`] | the action cache and its blobs | |
//! | [`script`] | embedded Starlark: expressions, values, budgets | geometry, diagnostic |
//! | [`spec`] | YAML text → typed nodes; schema and reference | diagnostic |
//! | [`graph`] | nodes → a named, typed, acyclic graph | spec, diagnostic |
//! | [`source`] | foreign bytes → geometry, a file per format | geometry, diagnostic |
//! | [`arrangement`] | element textures | geometry, script, spec, diagnostic |
//! | [`band`] | patterns along curves, panels | geometry, spec, diagnostic |
//! | [`facade`] | layered facades | geometry, spec, diagnostic |
//! | [`solid`] | extruded, turned and combined solids | geometry, spec, diagnostic |
//! | [`fabricate`] | geometry → bytes, a file per format | geometry, diagnostic |
//! | [`build`] | queries, firewalls, evaluation, scheduling: the only room that knows salsa | all above |
//! | [`cli`] | one file per command; the only printing and reading of the disk | build |
//!
//! A build reads a spec and its includes, evaluates expressions behind a firewall of positions,
//! resolves names, plans jobs (a node, or an arrangement on a region) and evaluates each from memory,
//! from the store, or by its stage. Values compare by the digest of their canonical bytes, so one that
//! comes out the same stops the rebuild there, in this process and in the next.

pub mod arrangement;
pub mod band;
pub mod build;
pub mod cli;
pub mod diagnostic;
pub mod fabricate;
pub mod facade;
pub mod geometry;
pub mod graph;
pub mod script;
pub mod solid;
pub mod source;
pub mod spec;
pub mod store;
