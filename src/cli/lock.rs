//! `fretwork.lock`: the digest of every artifact, to be committed. It says what a build must give,
//! also where no artifact is committed.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::terminal::Failure;
use fretwork_diagnostic::{Code, Diagnostic};
use fretwork_engine::{Artifact, output_folder};
use fretwork_store::{Digest, Folder, Lasting};

/// Its name beside the root marker.
pub const NAME: &str = "fretwork.lock";

/// The version of its format.
const VERSION: u32 = 1;

/// The digests of the artifacts of a project.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lock {
    version: u32,
    /// For each spec the digest of each of its artifacts, by the path below the spec's folder.
    specs: BTreeMap<String, BTreeMap<String, Digest>>,
}

impl Lock {
    /// The lock of the project at `root`; none where there is none.
    ///
    /// # Errors
    /// When it cannot be read, or is none.
    pub fn load(root: &Path) -> Result<Option<Lock>, Failure> {
        let failed = |e: String| Failure::usage(format!("cannot read `{NAME}`: {e}"));
        let bytes = match Folder::open(root).and_then(|root| root.read(NAME)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            bytes => bytes.map_err(|e| failed(e.to_string()))?,
        };
        let lock: Lock = serde_json::from_slice(&bytes).map_err(|e| failed(e.to_string()))?;
        if lock.version != VERSION {
            return Err(failed(format!("version {} is not known", lock.version)));
        }
        Ok(Some(lock))
    }

    /// Puts the digests of `artifacts`, all those of `specs`, into the lock of the project at `root`. What it says of
    /// other specs stays, or goes with `is_all`.
    ///
    /// # Errors
    /// When it cannot be read or written.
    pub fn renew(
        root: &Path,
        specs: &[String],
        artifacts: &[Artifact],
        is_all: bool,
    ) -> Result<(), Failure> {
        let known = Lock::load(root)?;
        let mut lock = known.clone().filter(|_| !is_all).unwrap_or(Lock {
            version: VERSION,
            specs: BTreeMap::new(),
        });
        for spec in specs {
            lock.specs.insert(spec.clone(), BTreeMap::new());
        }
        for artifact in artifacts {
            let files = lock.specs.entry(artifact.spec.clone()).or_default();
            files.insert(name(artifact).to_string(), artifact.digest);
        }
        lock.specs.retain(|_, files| !files.is_empty());
        if known.as_ref() == Some(&lock) {
            return Ok(());
        }
        let failed = |e: io::Error| Failure::usage(format!("cannot write `{NAME}`: {e}"));
        let text = serde_json::to_string_pretty(&lock).map_err(|e| failed(e.into()))? + "\n";
        let root = Folder::open(root).map_err(failed)?;
        root.write(NAME, &[text.as_bytes()], Lasting::OnDisk)
            .map_err(failed)
    }

    /// The errors for `artifacts` that are not what the lock holds, and, where they are `complete`, for
    /// what it holds of `specs` beyond them.
    pub fn compare(
        &self,
        artifacts: &[Artifact],
        specs: &[String],
        complete: Complete,
    ) -> Vec<Diagnostic> {
        let mut errors = Vec::new();
        let mut given = BTreeSet::new();
        for artifact in artifacts {
            let name = name(artifact);
            given.insert((&*artifact.spec, name));
            let held = self
                .specs
                .get(&artifact.spec)
                .and_then(|files| files.get(name));
            let message = match held {
                Some(digest) if *digest == artifact.digest => continue,
                Some(_) => format!("`{}` is not what `{NAME}` holds", artifact.path),
                None => format!("`{}` is not in `{NAME}`", artifact.path),
            };
            errors.push(Diagnostic::error(message).about(Code::Output));
        }
        for (spec, files) in &self.specs {
            let is_asked_for = match complete {
                Complete::Project => true,
                Complete::Specs => specs.contains(spec),
                Complete::Nothing => false,
            };
            for name in files
                .keys()
                .filter(|name| is_asked_for && !given.contains(&(&**spec, &***name)))
            {
                let message = format!("`{NAME}` holds `{name}` of `{spec}`, which no spec gives");
                errors.push(Diagnostic::error(message).about(Code::Output));
            }
        }
        let help = "if the change is meant, run `fretwork build --lock` and commit the file";
        errors.into_iter().map(|error| error.help(help)).collect()
    }
}

/// Of what a build gives all artifacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Complete {
    /// Of all specs that there are.
    Project,
    /// Of the specs that were named.
    Specs,
    /// Of none: some were chosen.
    Nothing,
}

/// The path of an artifact below its spec's folder, wherever it was built to.
fn name(artifact: &Artifact) -> &str {
    let path = artifact.path.strip_prefix(&output_folder(&artifact.spec));
    path.and_then(|path| path.strip_prefix('/'))
        .unwrap_or(&artifact.path)
}
