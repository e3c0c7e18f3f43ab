//! Artifacts in other formats than their files have, for those who look at them: a drawing of a DXF, a scene of an STL,
//! measures of either. They are remembered as artifacts are, and no build makes them.

use std::sync::Arc;

use super::compile::Compiler;
use super::database::{Db, SourceFile};
use super::evaluate::{Subject, action_key, inputs, run, stored};
use super::gather;
use super::job::Job;
use super::report::Artifact;
use super::settings::Settings;
use super::value::Handle;
use fretwork_action::{Action, Data, ReadLog, Value};
use fretwork_language::kinds::artifacts::Format;
use fretwork_store::Digest;

/// An artifact in some format.
#[derive(Clone, Debug)]
pub struct View {
    /// The digest of the bytes.
    pub digest: Digest,
    /// The bytes of a file in that format.
    pub bytes: Arc<[u8]>,
}

impl Compiler {
    /// What an artifact shows in another format; none where it has no such form.
    pub fn view(&self, artifact: &Artifact, format: Format) -> Option<View> {
        let db = &self.database;
        let job = &artifact.job;
        let (root, settings) = (job.root, job.settings.clone());
        let handle = viewed(db, root, settings, Subject::of(job), format)?;
        let bytes = bytes(db, job, format, &handle)?;
        Some(View {
            digest: handle.digest,
            bytes,
        })
    }
}

#[salsa::tracked(returns(clone))]
fn viewed(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    subject: Subject,
    format: Format,
) -> Option<Handle> {
    db.budget().stop().check();
    let job = subject.job(root, settings);
    let definition = job.definition(db)?;
    let mut inputs = inputs(db, &job, &definition)?;
    // A view is no file, and names no origin.
    inputs.retain(|(name, _)| name != "origin");
    let extension = Format::EXTENSIONS[format as usize];
    for (name, digest) in &mut inputs {
        if name == "format" {
            *digest = Digest::of(extension.as_bytes());
        }
    }
    let key = action_key(db, &definition, inputs.iter());
    if let Some((handle, ..)) = stored(db, &key) {
        return Some(handle);
    }
    run(db, &action(db, &job, format)?, &key, inputs).value
}

/// The action of an artifact in a format.
fn action(db: &dyn Db, job: &Job, format: Format) -> Option<Action> {
    let definition = job.definition(db)?;
    let action = gather::action(db, job, &definition)?;
    Some(Action {
        format: Some(format),
        origin: None,
        ..action
    })
}

/// The bytes behind a handle, computed again if the store has lost them.
fn bytes(db: &dyn Db, job: &Job, format: Format, handle: &Handle) -> Option<Arc<[u8]>> {
    let value = match handle.get() {
        Some(value) => value.clone(),
        None => {
            let provided = job.definition(db)?.node.provides();
            let blob = db.store().and_then(|store| store.blob(&handle.digest));
            let stored = blob.and_then(|bytes| Data::decode(bytes, provided));
            let data = match stored {
                Some(data) => data,
                None => {
                    fretwork_stage::run(&action(db, job, format)?, &ReadLog::default())
                        .ok()?
                        .0
                }
            };
            handle.fill(Value::Data(data)).clone()
        }
    };
    match value {
        Value::Data(Data::File(bytes)) => Some(bytes),
        _ => None,
    }
}
