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
//! | [`language`] | YAML text → typed nodes; schema and reference | diagnostic |
//! | [`graph`] | nodes → a named, typed, acyclic graph | language, diagnostic |
//! | [`source`] | foreign bytes → geometry, a file per format | geometry, diagnostic |
//! | [`arrangement`] | element textures | geometry, script, language, diagnostic |
//! | [`band`] | patterns along curves, panels | geometry, language, diagnostic |
//! | [`facade`] | layered facades | geometry, language, diagnostic |
//! | [`solid`] | extruded, turned and combined solids | geometry, language, diagnostic |
//! | [`fabricate`] | geometry → bytes, a file per format | geometry, diagnostic |
//! | [`engine`] | queries, firewalls, evaluation, scheduling: the only room that knows salsa | all above |
//! | [`cli`] | one file per command; the only printing and reading of the disk | engine |
//!
//! A build reads a spec and its includes, evaluates expressions behind a firewall of positions,
//! resolves names, plans jobs (a node, or an arrangement on a region) and evaluates each from memory,
//! from the store, or by its stage. Values compare by the digest of their canonical bytes, so one that
//! comes out the same stops the rebuild there, in this process and in the next.

pub use fretwork_arrangement as arrangement;
pub use fretwork_band as band;
pub use fretwork_cli as cli;
pub use fretwork_diagnostic as diagnostic;
pub use fretwork_engine as engine;
pub use fretwork_fabricate as fabricate;
pub use fretwork_facade as facade;
pub use fretwork_geometry as geometry;
pub use fretwork_graph as graph;
pub use fretwork_language as language;
pub use fretwork_script as script;
pub use fretwork_solid as solid;
pub use fretwork_source as source;
pub use fretwork_store as store;

/// The versions of the rooms, which are digests of their source.
pub const VERSIONS: engine::Versions =
    engine::Versions(include!(concat!(env!("OUT_DIR"), "/versions.rs")));
