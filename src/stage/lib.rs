//! The one dispatch from a node to the room that makes its value. Each file here hands the fields
//! and inputs of an [`Action`] to a room and wraps up what it gives. A stage is a function of its
//! action: the same action gives the same value in any process.
//!
//! | section | stage |
//! | --- | --- |
//! | regions, curves, surfaces, fields, exemplars | the room `primitive` |
//! | partitions, arrangements, faces as regions | [`arrangement`] |
//! | which engine draws an arrangement | [`tiling`] |
//! | bands, panels | [`band`] |
//! | facades, with their symbols, patterns and layers | [`facade`], [`description`] |
//! | shells | [`shell`] |
//! | solids | [`solid`] |
//! | sections and slices as regions | [`section`] |
//! | projections as arrangements | [`projection`] |
//! | drawings laid on surfaces | [`wrap`] |
//! | analyses | [`analysis`] |
//! | artifacts | [`artifact`], and what two states of one are compared by: [`compared`] |

pub mod analysis;
pub mod arrangement;
pub mod artifact;
pub mod band;
mod code;
pub mod compared;
mod date_line;
pub mod description;
mod expect;
pub mod facade;
mod force_profile;
mod ground;
mod host;
mod model;
mod page;
mod preview;
pub mod projection;
pub mod section;
mod sheet;
pub mod shell;
mod shell_body;
mod shell_pattern;
mod shell_remarks;
mod shell_step;
mod shown;
pub mod solid;
mod strength;
mod stress;
pub mod tiling;
mod verdict;
pub mod wrap;

pub use fretwork_arrangement::functions_reference;
pub use fretwork_fabricate::origin::{Origin, read as read_origin};
pub use page::slack;

use fretwork_action::{Action, Data, ReadLog, StageResult, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_language::kinds::arrangements::Arrangement;
use fretwork_language::kinds::curves::Curve;
use fretwork_language::kinds::exemplars::Exemplar;
use fretwork_language::kinds::regions::Region;
use fretwork_language::{Node, Section};
use fretwork_primitive::{curve, exemplar, field, pixels, region, surface, text};

/// Makes the value of an action. Notes the files that turn up meanwhile in `log`.
///
/// # Errors
/// What is wrong with the node, and warnings about it.
pub fn run(action: &Action, log: &ReadLog) -> StageResult {
    let result = action.within_budget(|| {
        let made = dispatch(action, log)?;
        match faults(action) {
            faults if faults.is_empty() => Ok(made),
            faults => Err(faults),
        }
    });
    let coded = |diagnostics| code::coded(&action.definition, diagnostics);
    match result {
        Ok((data, warnings)) => Ok((data, coded(warnings))),
        Err(errors) => Err(coded(errors)),
    }
}

/// What of an arrangement lies in the window of its action, drawn without the whole. None where that would take as much as
/// drawing the whole.
///
/// # Errors
/// Those of [`run`].
pub fn near(action: &Action, log: &ReadLog) -> Option<StageResult> {
    let result = action.within_budget(|| {
        let made = arrangement::near(action, log)?;
        match faults(action) {
            faults if faults.is_empty() => Ok(made),
            faults => Err(faults),
        }
    });
    let coded = |diagnostics| code::coded(&action.definition, diagnostics);
    match result {
        Ok(curves) => curves.map(|curves| Ok((Data::Curves(curves), Vec::new()))),
        Err(errors) => Some(Err(coded(errors))),
    }
}

fn dispatch(action: &Action, log: &ReadLog) -> StageResult {
    match &action.definition.node {
        Node::Region(Region::Faces(kind)) => arrangement::faces(action, kind),
        Node::Region(Region::Section(kind)) => section::section(action, kind),
        Node::Region(Region::Slices(kind)) => section::slices(action, kind),
        Node::Region(kind) => region::region(action, kind, log),
        Node::Exemplar(Exemplar::Vector(kind)) => exemplar::vector(action, kind),
        Node::Exemplar(Exemplar::Image(kind)) => pixels::picture(action, kind),
        Node::Exemplar(Exemplar::Rasterize(kind)) => pixels::rasterize(action, kind),
        Node::Curve(kind) => curve::curve(action, kind),
        Node::Surface(kind) => surface::surface(action, kind, log),
        Node::Arrangement(Arrangement::Connect(kind)) => arrangement::connect(action, kind),
        Node::Arrangement(Arrangement::Wrap(kind)) => wrap::wrap(action, kind),
        Node::Arrangement(Arrangement::Text(kind)) => text::lines(action, kind),
        Node::Arrangement(Arrangement::Projection(kind)) => projection::projection(action, kind),
        Node::Arrangement(Arrangement::Registration(kind)) => {
            arrangement::registration(action, kind)
        }
        Node::Partition(_) | Node::Arrangement(_) => arrangement::applied(action, log),
        Node::Band(kind) => band::band(action, kind),
        Node::Panel(kind) => band::panel(action, kind),
        Node::Facade(kind) => facade::facade(action, kind, log),
        Node::Shell(kind) => shell::shell(action, kind),
        Node::Solid(kind) => solid::solid(action, kind),
        Node::Analysis(kind) => analysis::analysis(action, kind),
        Node::Artifact(kind) => artifact::artifact(action, kind),
        _ => Err(vec![unsupported(action)]),
    }
}

/// Puts the function of an action together that is applied elsewhere, so that what is wrong with it
/// is told by the node that has it; and warnings. Parts of other nodes are read where they are used.
///
/// # Errors
/// What is wrong with the node.
pub fn prepare(action: &Action, log: &ReadLog) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let result = action.within_budget(|| match &action.definition.node {
        Node::Field(_) => field::prepare(action, log),
        Node::Partition(_) | Node::Arrangement(_) => {
            arrangement::function(action, log).map(|_| Vec::new())
        }
        _ => Ok(Vec::new()),
    });
    let coded = |diagnostics| code::coded(&action.definition, diagnostics);
    result.map(coded).map_err(coded)
}

/// What was found to be wrong with the files of the fields that an action has read, in order and each once.
fn faults(action: &Action) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for value in action.values.values() {
        if let Value::Deferred(inner) = value {
            found.extend(field::fault(inner));
            found.extend(faults(inner));
        }
    }
    found.dedup();
    found
}

/// What is wrong with the texts in other languages that a node holds or names: scripts, formulas, drawings. The
/// action needs no values for it.
pub fn check(action: &Action) -> Vec<Diagnostic> {
    let check = || match &action.definition.node {
        Node::Arrangement(kind) => arrangement::check(action, kind),
        Node::Field(kind) => field::check(action, kind),
        Node::Exemplar(Exemplar::Vector(kind)) => errors(exemplar::vector(action, kind)),
        Node::Region(kind @ Region::Svg(_)) => {
            errors(region::region(action, kind, &ReadLog::default()))
        }
        Node::Curve(kind @ Curve::Svg(_)) => errors(curve::curve(action, kind)),
        _ => Vec::new(),
    };
    action
        .within_budget(|| Ok(check()))
        .unwrap_or_else(|errors| errors)
}

/// What is wrong with a node; warnings are told where it is needed.
fn errors(result: StageResult) -> Vec<Diagnostic> {
    result.err().unwrap_or_default()
}

/// The source that makes the value of a node: a room, or a file of this one.
pub fn source_of(node: &Node) -> &'static str {
    match node {
        Node::Region(Region::Faces(_)) => return "stage/arrangement",
        Node::Region(Region::Section(_) | Region::Slices(_)) => return "stage/section",
        Node::Arrangement(Arrangement::Projection(_)) => return "stage/projection",
        Node::Arrangement(Arrangement::Wrap(_)) => return "stage/wrap",
        Node::Arrangement(Arrangement::Text(_)) => return "primitive",
        _ => {}
    }
    match node.section() {
        Section::Partitions | Section::Arrangements => "stage/arrangement",
        Section::Bands | Section::Panels => "stage/band",
        Section::Facades => "stage/facade",
        Section::Shells => "stage/shell",
        Section::Solids => "stage/solid",
        Section::Analyses => "stage/analysis",
        Section::Artifacts => "stage/artifact",
        _ => "primitive",
    }
}

fn unsupported(action: &Action) -> Diagnostic {
    let definition = &action.definition;
    let (kind, section) = (definition.node.kind_name(), definition.id.section.name());
    action.unsupported(&format!("`{kind}` of `{section}`"))
}
