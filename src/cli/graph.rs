//! `fretwork graph`: the nodes of a spec and what needs what.

use super::arguments::{Graph, GraphFormat};
use super::session::{CacheAt, Session};
use super::terminal::{self, Failure};
use crate::build::Settings;
use crate::diagnostic::Diagnostic;
use crate::graph;

/// Prints the graph.
pub fn run(arguments: &Graph) -> Result<(), Failure> {
    let (session, spec) = Session::of_one(&arguments.spec, CacheAt::Nowhere)?;
    let format = match arguments.format {
        GraphFormat::Dot => graph::GraphFormat::Dot,
        GraphFormat::Mermaid => graph::GraphFormat::Mermaid,
        GraphFormat::Json => graph::GraphFormat::Json,
    };
    let settings = Settings::default();
    let diagnostics = session.compiler.check(&spec, &settings);
    session.print(&diagnostics);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    terminal::print(&session.compiler.graph(&spec, &settings, format))
}
