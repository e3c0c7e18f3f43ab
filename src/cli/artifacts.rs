//! Artifacts on disk: what changed, written as a set.

use std::collections::BTreeMap;
use std::io;
use std::path::PathBuf;

use serde::Serialize;

use super::output::{FileFound, Inputs, Output};
use super::record::{self, Record, split};
use super::session::Session;
use fretwork_diagnostic::{Code, Diagnostic};
use fretwork_engine::Artifact;
use fretwork_store::Lasting;

/// What became of an artifact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Its file is new or has new bytes.
    Written,
    /// Its file had these bytes already.
    Unchanged,
    /// Its file has other bytes, and nothing was to be written.
    Different,
    /// It has no file, and nothing was to be written.
    Missing,
}

/// An artifact's file.
#[derive(Clone, Debug, Serialize)]
pub struct Written {
    /// Path below the output folder.
    pub path: String,
    /// What became of it.
    pub status: Status,
    /// Its size.
    pub bytes: u64,
    /// The BLAKE3 digest of its bytes.
    pub blake3: String,
}

/// Why the file of an artifact was not brought up to date. The old file is as it was.
#[derive(Debug)]
enum Unwritten {
    /// That has a message of its own.
    Told(Diagnostic),
    /// The system refuses, or a file of somebody else is in the way.
    Refused(PathBuf, String),
}

/// Artifacts, the folder that they belong to, and what has become of them so far.
pub struct Update<'a> {
    session: &'a Session,
    artifacts: &'a [Artifact],
    output: &'a mut Output,
    written: Vec<Written>,
    unwritten: Vec<Unwritten>,
}

/// A file that was written beside its place.
struct Staged<'a> {
    artifact: &'a Artifact,
    temporary: String,
    bytes: u64,
}

/// The reason that is given for a file that is not in the record.
const FOREIGN: &str = "a file is there that no build has written";

impl<'a> Update<'a> {
    /// An update of the files of `artifacts` below `output`.
    pub fn new(session: &'a Session, artifacts: &'a [Artifact], output: &'a mut Output) -> Self {
        Update {
            session,
            artifacts,
            output,
            written: Vec::new(),
            unwritten: Vec::new(),
        }
    }

    /// Says of each file whether it is what its artifact is. Writes nothing.
    pub fn compare(mut self) -> (Vec<Written>, Vec<Diagnostic>) {
        for (artifact, found) in self.look() {
            let status = match found {
                None => Status::Missing,
                Some(found) if found.digest == artifact.digest => Status::Unchanged,
                Some(_) => Status::Different,
            };
            let bytes = found.map_or(0, |found| found.bytes);
            self.written.push(written(artifact, status, bytes));
        }
        self.ended("read")
    }

    /// Brings the files up to date: all of them are written beside their places first, so that a full
    /// disk leaves the set of an earlier build. With `overwrite`, files that no build has written are replaced
    /// too.
    pub fn write(mut self, overwrite: bool) -> (Vec<Written>, Vec<Diagnostic>) {
        let mut changed = Vec::new();
        let mut is_settled = true;
        let record = self.record();
        for (artifact, found) in self.look() {
            match found {
                Some(found) if found.digest == artifact.digest => {
                    is_settled &= record.is_settled(&artifact.path, &artifact.spec, found.digest);
                    self.written
                        .push(written(artifact, Status::Unchanged, found.bytes));
                }
                found => changed.push((artifact, found)),
            }
        }
        if !(changed.is_empty() && is_settled) {
            self.write_set(changed, overwrite);
        }
        self.ended("write")
    }

    fn ended(self, verb: &str) -> (Vec<Written>, Vec<Diagnostic>) {
        let places: BTreeMap<&str, usize> = self
            .artifacts
            .iter()
            .enumerate()
            .map(|(n, artifact)| (&*artifact.path, n))
            .collect();
        let mut written = self.written;
        written.sort_by_key(|one| places.get(&*one.path).copied());
        (written, report(self.unwritten, verb))
    }

    fn record(&mut self) -> Record {
        self.output
            .root(false)
            .ok()
            .and_then(|root| Record::load(root, record::NAME))
            .unwrap_or_default()
    }

    /// What is there of each artifact.
    fn look(&mut self) -> Vec<(&'a Artifact, Option<FileFound>)> {
        let mut all = Vec::new();
        for artifact in self.artifacts {
            match self.output.find(&artifact.path) {
                Ok(found) => all.push((artifact, found)),
                Err(error) => self.refuse(artifact, error.to_string()),
            }
        }
        all
    }

    fn refuse(&mut self, artifact: &Artifact, reason: String) {
        let path = self.output.path(&artifact.path);
        self.unwritten.push(Unwritten::Refused(path, reason));
    }

    fn refuse_all<'b>(&mut self, all: impl IntoIterator<Item = &'b Artifact>, error: &io::Error) {
        all.into_iter()
            .for_each(|artifact| self.refuse(artifact, error.to_string()));
    }

    /// Writes the artifacts that changed, and the record before and after them: a build that is killed leaves
    /// no file that the record does not know.
    fn write_set(&mut self, changed: Vec<(&'a Artifact, Option<FileFound>)>, overwrite: bool) {
        let held = self.output.root(true).map(|root| root.hold());
        let _held = match held {
            Ok(held) => held,
            Err(error) => {
                self.refuse_all(changed.into_iter().map(|(artifact, _)| artifact), &error);
                return;
            }
        };
        let before = self.record();
        let mut record = before.clone();
        let changed = self.without_foreign(changed, &record, overwrite);
        for artifact in &changed {
            record.announce(&artifact.path, &artifact.spec, artifact.digest);
        }
        if let Err(error) = self.store(&record, &before) {
            self.refuse_all(changed, &error);
            return;
        }
        let announced = record.clone();
        self.write_files(changed);
        let digests: BTreeMap<&str, &Artifact> = self
            .artifacts
            .iter()
            .map(|artifact| (&*artifact.path, artifact))
            .collect();
        for done in &self.written {
            if let Some(artifact) = digests.get(&*done.path) {
                record.settle(&artifact.path, &artifact.spec, artifact.digest);
            }
        }
        // Without it the record knows more digests of a file than it needs to.
        let _ = self.store(&record, &announced);
    }

    fn store(&mut self, record: &Record, known: &Record) -> io::Result<()> {
        if record == known {
            return Ok(());
        }
        record.store(self.output.root(true)?, record::NAME)
    }

    /// The artifacts whose places are free, or hold what a build has written and none reads.
    fn without_foreign(
        &mut self,
        changed: Vec<(&'a Artifact, Option<FileFound>)>,
        record: &Record,
        overwrite: bool,
    ) -> Vec<&'a Artifact> {
        let mut inputs = None;
        let mut free = Vec::new();
        for (artifact, found) in changed {
            if found.is_none() {
                free.push(artifact);
                continue;
            }
            let inputs = inputs.get_or_insert_with(|| Inputs::of(self.session));
            if inputs.has(&self.output.path(&artifact.path)) {
                let message = format!(
                    "`{}` would overwrite a file that this build reads",
                    artifact.path
                );
                let help =
                    "give the artifact another name, or build into another folder with `--out`";
                let diagnostic = Diagnostic::error(message).about(Code::Output).help(help);
                self.unwritten.push(Unwritten::Told(diagnostic));
            } else if !overwrite && !record.has(&artifact.path) {
                self.refuse(artifact, FOREIGN.to_string());
            } else {
                free.push(artifact);
            }
        }
        free
    }

    /// Writes all files beside their places, then gives them their names. When one cannot be written,
    /// none gets its name.
    fn write_files(&mut self, changed: Vec<&'a Artifact>) {
        let mut staged = Vec::new();
        for &artifact in &changed {
            let bytes = match self.session.compiler.bytes(artifact) {
                Ok(bytes) => bytes,
                Err(diagnostic) => {
                    self.unwritten.push(Unwritten::Told(diagnostic));
                    continue;
                }
            };
            match self.stage(artifact, &bytes) {
                Ok(temporary) => staged.push(Staged {
                    artifact,
                    temporary,
                    bytes: bytes.len() as u64,
                }),
                Err(error) => {
                    staged.iter().for_each(|one| self.unstage(one));
                    self.refuse_all(changed, &error);
                    return;
                }
            }
        }
        for one in staged {
            match self.commit(&one) {
                Ok(()) => self
                    .written
                    .push(written(one.artifact, Status::Written, one.bytes)),
                Err(error) => self.refuse(one.artifact, error.to_string()),
            }
        }
    }

    fn stage(&mut self, artifact: &Artifact, bytes: &[u8]) -> io::Result<String> {
        let folder = self.output.folder(split(&artifact.path).0, true)?;
        folder.stage(&[bytes], Lasting::OnDisk)
    }

    fn unstage(&mut self, staged: &Staged<'_>) {
        if let Ok(folder) = self.output.folder(split(&staged.artifact.path).0, false) {
            // What stays has a name that the next prune knows.
            let _ = folder.remove_file(&staged.temporary);
        }
    }

    fn commit(&mut self, staged: &Staged<'_>) -> io::Result<()> {
        let (below, name) = split(&staged.artifact.path);
        self.output
            .folder(below, false)?
            .commit(&staged.temporary, name)
    }
}

fn written(artifact: &Artifact, status: Status, bytes: u64) -> Written {
    Written {
        path: artifact.path.clone(),
        status,
        bytes,
        blake3: artifact.digest.hex(),
    }
}

/// One error for each reason why files were not written: a full disk is one mishap, however many
/// artifacts it keeps from being written.
fn report(unwritten: Vec<Unwritten>, verb: &str) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    let mut refused: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for one in unwritten {
        match one {
            Unwritten::Told(diagnostic) => diagnostics.push(diagnostic),
            Unwritten::Refused(path, reason) => refused.entry(reason).or_default().push(path),
        }
    }
    for (reason, mut paths) in refused {
        paths.sort();
        let others = match paths.len() {
            1 => String::new(),
            2 => " and another artifact".to_string(),
            n => format!(" and {} other artifacts", n - 1),
        };
        let message = format!("cannot {verb} `{}`{others}: {reason}", paths[0].display());
        let help = if reason == FOREIGN {
            "move it away, or replace it with `--overwrite`"
        } else {
            "files of an earlier build are as they were"
        };
        diagnostics.push(Diagnostic::error(message).about(Code::Output).help(help));
    }
    diagnostics
}
