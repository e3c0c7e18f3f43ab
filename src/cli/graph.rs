//! `fretwork graph`: the nodes of a spec and what needs what.

use super::arguments::{Graph, GraphFormat};
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use fretwork_diagnostic::Diagnostic;

/// Prints the graph.
pub fn run(arguments: &Graph) -> Result<(), Failure> {
    let (session, spec) = Session::of_one(&arguments.spec, CacheAt::Nowhere)?;
    let format = match arguments.format {
        GraphFormat::Dot => fretwork_graph::GraphFormat::Dot,
        GraphFormat::Mermaid => fretwork_graph::GraphFormat::Mermaid,
        GraphFormat::Json => fretwork_graph::GraphFormat::Json,
    };
    let settings = settings(&arguments.sets);
    let diagnostics = session.compiler.check(&spec, &settings);
    session.print(&diagnostics);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    terminal::print(&session.compiler.graph(&spec, &settings, format))
}
