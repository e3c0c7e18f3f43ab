//! The one dispatch from a node to the room that makes its value. Each function here fetches the
//! inputs, calls the room, and returns.

mod arrangement;
mod artifact;
mod band;
mod body;
mod curve;
mod elevation;
mod exemplar;
mod facade;
mod field;
mod host;
mod look;
mod placement;
mod region;
mod solid;
mod surface;

use std::collections::BTreeMap;
use std::sync::Arc;

use super::database::Db;
use super::definition::Definition;
pub use host::ReadLog;

pub use super::evaluate::StageResult;
use super::evaluate::value;
use super::job::Job;
use super::value::{Data, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Drawing, Region};
use fretwork_graph::NodeId;
use fretwork_language::kinds::arrangements::Arrangement;
use fretwork_language::kinds::exemplars::Exemplar;
use fretwork_language::{Node, Ref, Wanted};
use fretwork_store::Digest;

/// The files that a stage found and read by itself, through a script or a drawing.
#[derive(Debug, Default)]
pub struct Reads(BTreeMap<Arc<str>, Option<Digest>>);

impl Reads {
    /// Notes what scripts have read.
    fn note(&mut self, log: &ReadLog) {
        self.0.extend(log.entries());
    }

    /// The paths that were read, and the digests of their bytes; none where that failed.
    pub fn paths(&self) -> impl Iterator<Item = (&Arc<str>, Option<Digest>)> {
        self.0.iter().map(|(path, digest)| (path, *digest))
    }

    /// Those that were read, with the digests of their bytes.
    pub fn known(&self) -> impl Iterator<Item = (&str, Digest)> {
        self.paths()
            .filter_map(|(path, digest)| Some((&**path, digest?)))
    }

    /// The paths in order, with the digests of their bytes.
    pub fn into_pairs(self) -> Vec<(String, Digest)> {
        self.0
            .into_iter()
            .filter_map(|(path, digest)| Some((path.to_string(), digest?)))
            .collect()
    }
}

/// What a stage works with.
pub struct Stage<'a> {
    /// The database.
    pub db: &'a dyn Db,
    /// The job.
    pub job: &'a Job,
    /// The definition of its node.
    pub definition: &'a Definition,
}

/// What is wrong with the texts in other languages that a node holds or names: scripts, formulas. Needs
/// no values.
pub fn check(db: &dyn Db, job: &Job, definition: &Definition) -> Vec<Diagnostic> {
    match &definition.node {
        Node::Arrangement(kind) => arrangement::check(
            &Stage {
                db,
                job,
                definition,
            },
            kind,
        ),
        Node::Field(kind) => field::check(
            &Stage {
                db,
                job,
                definition,
            },
            kind,
        ),
        _ => Vec::new(),
    }
}

/// Makes the value of `job`, all of whose inputs have values.
pub fn run(db: &dyn Db, job: &Job, definition: &Definition, reads: &mut Reads) -> StageResult {
    let stage = Stage {
        db,
        job,
        definition,
    };
    match &definition.node {
        Node::Region(kind) => region::region(&stage, kind),
        Node::Exemplar(Exemplar::Vector(kind)) => exemplar::vector(&stage, kind),
        Node::Curve(kind) => curve::curve(&stage, kind),
        Node::Band(kind) => band::band(&stage, kind),
        Node::Panel(kind) => band::panel(&stage, kind),
        Node::Field(kind) => field::field(&stage, kind),
        Node::Arrangement(Arrangement::Connect(kind)) => arrangement::connect(&stage, kind),
        Node::Partition(_) | Node::Arrangement(_) => arrangement::arrangement(&stage, reads),
        // Facades read these themselves: they have no value but what they say.
        Node::Symbol(_) | Node::Pattern(_) | Node::Layer(_) => Ok((Value::Definition, Vec::new())),
        Node::Facade(kind) => facade::facade(&stage, kind, reads),
        Node::Surface(kind) => surface::surface(&stage, kind, reads),
        Node::Solid(kind) => solid::solid(&stage, kind),
        Node::Artifact(kind) => artifact::artifact(&stage, kind),
        _ => Err(vec![stage.unsupported(&format!(
            "`{}` of `{}`",
            definition.node.kind_name(),
            definition.id.section.name()
        ))]),
    }
}

impl Stage<'_> {
    /// The error for what cannot be evaluated yet.
    pub fn unsupported(&self, what: &str) -> Diagnostic {
        Diagnostic::error(format!("{what} is not supported yet"))
            .at(self.definition.span(), "needed here")
    }

    /// The value of an input, without a region.
    pub fn input<T: Wanted>(&self, reference: &Ref<T>) -> Value {
        self.value_of(self.definition.target(reference))
    }

    /// The value of the node `id`, without a region.
    pub fn value_of(&self, id: &NodeId) -> Value {
        self.value_on(id, None)
    }

    /// The value of the node `id`, on a region if one is given.
    pub fn value_on(&self, id: &NodeId, region: Option<&NodeId>) -> Value {
        value(self.db, &self.job.of(id, region))
            .expect("a stage runs only when all its inputs have values")
    }

    /// The region that `reference` means.
    pub fn region<T: Wanted>(&self, reference: &Ref<T>) -> Arc<Region> {
        match self.input(reference) {
            Value::Data(Data::Region(region)) => region,
            other => unreachable!("the graph checks types, and {other:?} is no region"),
        }
    }

    /// The vector exemplar that `reference` means.
    pub fn drawing<T: Wanted>(&self, reference: &Ref<T>) -> Arc<Drawing> {
        match self.input(reference) {
            Value::Data(Data::Drawing(drawing)) => drawing,
            other => unreachable!("the graph checks types, and {other:?} is no vector exemplar"),
        }
    }

    /// The bytes of a file that the node names.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn file(&self, name: &Arc<str>) -> Result<(Arc<str>, Arc<[u8]>), Vec<Diagnostic>> {
        let path = &self.definition.files[name];
        match self.db.file(path).content(self.db) {
            Ok(content) => Ok((path.clone(), content.bytes.clone())),
            Err(error) => Err(vec![super::program::unreadable(
                self.db,
                name,
                path,
                error,
                self.definition.span(),
            )]),
        }
    }
}
