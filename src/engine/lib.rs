//! From specs to artifacts: the queries, what they remember, and the order in which they run. The
//! only room that knows salsa.
//!
//! `program` parses and merges files; `scope` evaluates parameters; `definition` gives typed nodes
//! behind a firewall of positions; `job` says what a value needs; `evaluate` gets it from memory,
//! from the store or from its stage, which is given an action that `gather` puts together; `compile`
//! does that for whole specs. `tiled` says which arrangements are drawn once and copied.

mod actions;
mod cache;
mod checking;
mod compared;
mod compile;
mod content;
mod database;
mod definition;
mod engine_line;
mod evaluate;
mod explain;
mod gather;
#[cfg(test)]
mod incremental_tests;
mod inspect;
mod job;
mod labels;
mod lettering;
mod local;
mod map_system;
mod modules;
mod once;
mod origin;
mod output;
mod overtaken;
mod params;
mod part_read;
mod program;
mod report;
mod ruler;
mod schedule;
mod scope;
mod settable;
mod settings;
mod shell_step;
mod sources;
mod support;
mod target;
mod target_paths;
mod threads;
mod tiled;
mod value;
mod view;
mod window_digest;
mod windows;
mod world;
mod written;

pub use actions::WrittenAction;
pub use cache::{Cache, Versions};
pub use compile::{Compiler, Progress, Request, output_folder};
pub use explain::{Explanation, InputChange};
pub use fretwork_action::{
    EngineChoice, FILE_LIMIT, HELD_LIMIT, Parts, ReadError, Window, is_read_by_parts,
};
pub use fretwork_difference as difference;
pub use fretwork_geometry::budget::Stop;
pub use fretwork_geometry::progress::Steps;
pub use fretwork_stage::compared::Compared;
pub use fretwork_stage::{Origin, functions_reference, read_origin};
pub use inspect::InspectRequest;
pub use job::Job;
pub use report::{Artifact, NodeReport, NodeStatus, ParamReport, Report, TraceSpan};
pub use settable::Settable;
pub use settings::Settings;
pub use sources::DatabaseSources;
pub use threads::threads;
pub use view::View;
pub use windows::{Cutting, MAX_LEVEL, TileRange, TileSpan};
pub use world::{MemoryWorld, Opened, World};
