//! Artifacts on disk: what changed, written in one step each.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::disk::{digest_of, write_atomically};
use crate::build::{Artifact, Compiler};
use crate::diagnostic::Diagnostic;

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

/// Brings the file of `artifact` below `out` up to date, or with `locked` only compares it.
///
/// # Errors
/// A diagnostic when the bytes cannot be had or the file cannot be written; the old file is as it
/// was.
pub fn update(compiler: &Compiler, artifact: &Artifact, out: &Path, locked: bool) -> Result<Written, Diagnostic> {
    let path = out.join(&artifact.path);
    let written = |status, bytes| Written { path: artifact.path.clone(), status, bytes, blake3: artifact.digest.hex() };
    if digest_of(&path) == Some(artifact.digest) {
        return Ok(written(Status::Unchanged, fs::metadata(&path).map_or(0, |m| m.len())));
    }
    let bytes = compiler.bytes(artifact)?;
    if locked {
        return Ok(written(Status::Different, bytes.len() as u64));
    }
    write_atomically(&path, &bytes)
        .map_err(|e| Diagnostic::error(format!("cannot write `{}`: {e}", path.display())))?;
    Ok(written(Status::Written, bytes.len() as u64))
}

/// Removes the files below the output folders of `specs` (paths below `out`) that are not in
/// `keep`, and folders that this leaves empty. Gives the paths of the removed files.
///
/// # Errors
/// When a folder cannot be read or a file not be removed.
pub fn prune(out: &Path, specs: &[String], keep: &BTreeSet<PathBuf>) -> io::Result<Vec<PathBuf>> {
    let mut removed = Vec::new();
    for spec in specs {
        prune_folder(&out.join(spec), keep, &mut removed)?;
    }
    Ok(removed)
}

fn prune_folder(folder: &Path, keep: &BTreeSet<PathBuf>, removed: &mut Vec<PathBuf>) -> io::Result<()> {
    let entries = match fs::read_dir(folder) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries?,
    };
    let mut paths = entries.map(|e| e.map(|e| e.path())).collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    for path in paths {
        if path.is_dir() && !path.is_symlink() {
            prune_folder(&path, keep, removed)?;
        } else if !keep.contains(&path) {
            fs::remove_file(&path)?;
            removed.push(path);
        }
    }
    if fs::read_dir(folder)?.next().is_none() {
        fs::remove_dir(folder)?;
    }
    Ok(())
}
