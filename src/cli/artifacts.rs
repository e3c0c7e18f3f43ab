//! Artifacts on disk: what changed, written in one step each.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::disk::{digest_of, is_abandoned, write_atomically};
use fretwork_diagnostic::Diagnostic;
use fretwork_engine::{Artifact, Compiler};
use fretwork_language::kinds::artifacts::Format;

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
pub enum Unwritten {
    /// Its bytes cannot be had.
    Lost(Diagnostic),
    /// The system refuses to write it.
    Refused(PathBuf, io::Error),
}

/// Brings the file of `artifact` below `out` up to date, or with `locked` only compares it.
///
/// # Errors
/// When the bytes cannot be had or the file cannot be written; the old file is as it was.
pub fn update(
    compiler: &Compiler,
    artifact: &Artifact,
    out: &Path,
    locked: bool,
) -> Result<Written, Unwritten> {
    let path = out.join(&artifact.path);
    let written = |status, bytes| Written {
        path: artifact.path.clone(),
        status,
        bytes,
        blake3: artifact.digest.hex(),
    };
    let found = digest_of(&path);
    if found == Some(artifact.digest) {
        return Ok(written(
            Status::Unchanged,
            fs::metadata(&path).map_or(0, |m| m.len()),
        ));
    }
    let bytes = compiler.bytes(artifact).map_err(Unwritten::Lost)?;
    if locked {
        let status = if found.is_some() {
            Status::Different
        } else {
            Status::Missing
        };
        return Ok(written(status, bytes.len() as u64));
    }
    write_atomically(&path, &bytes).map_err(|e| Unwritten::Refused(path, e))?;
    Ok(written(Status::Written, bytes.len() as u64))
}

/// One error for each reason why files were not written: a full disk is one mishap, however many
/// artifacts it keeps from being written.
pub fn report(unwritten: Vec<Unwritten>) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    let mut refused: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for one in unwritten {
        match one {
            Unwritten::Lost(diagnostic) => diagnostics.push(diagnostic),
            Unwritten::Refused(path, error) => {
                refused.entry(error.to_string()).or_default().push(path)
            }
        }
    }
    for (reason, paths) in refused {
        let others = match paths.len() {
            1 => String::new(),
            2 => " and another artifact".to_string(),
            n => format!(" and {} other artifacts", n - 1),
        };
        let message = format!("cannot write `{}`{others}: {reason}", paths[0].display());
        diagnostics
            .push(Diagnostic::error(message).help("files of an earlier build are as they were"));
    }
    diagnostics
}

/// What [`prune`] looks at.
pub struct Pruning<'a> {
    /// The output folders of the specs that were built.
    pub folders: BTreeSet<PathBuf>,
    /// The output folders of other specs, which may lie below those.
    pub others: BTreeSet<PathBuf>,
    /// The artifacts of this build.
    pub keep: &'a BTreeSet<PathBuf>,
}

/// Removes stale artifacts: files in the folders that have the extension of a format and are not
/// artifacts of this build, files that a killed build left half written, and folders that this
/// leaves empty. Anything else is not ours. Gives the paths of the removed files.
///
/// # Errors
/// When a folder cannot be read or a file not be removed.
pub fn prune(pruning: &Pruning<'_>) -> io::Result<Vec<PathBuf>> {
    let mut removed = Vec::new();
    for folder in &pruning.folders {
        prune_folder(folder, pruning, &mut removed)?;
    }
    Ok(removed)
}

fn prune_folder(
    folder: &Path,
    pruning: &Pruning<'_>,
    removed: &mut Vec<PathBuf>,
) -> io::Result<()> {
    let entries = match fs::read_dir(folder) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries?,
    };
    let mut paths = entries
        .map(|e| e.map(|e| e.path()))
        .collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    for path in paths {
        if path.is_dir() && !path.is_symlink() {
            if !pruning.others.contains(&path) {
                prune_folder(&path, pruning, removed)?;
            }
        } else if !pruning.keep.contains(&path)
            && (Format::of(&path.to_string_lossy()).is_some() || is_abandoned(&path))
        {
            fs::remove_file(&path)?;
            removed.push(path);
        }
    }
    if fs::read_dir(folder)?.next().is_none() {
        fs::remove_dir(folder)?;
    }
    Ok(())
}
