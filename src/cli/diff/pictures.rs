//! The pictures of a comparison, written below a folder. A record of their own says which files there are ours: nothing else
//! is replaced, and a picture of what no longer differs goes.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use super::change::Change;
use super::comparison::Comparison;
use crate::output::Output;
use crate::place::Place;
use crate::record::{Record, split};
use crate::terminal::{self, Failure};
use fretwork_engine::difference::picture;
use fretwork_store::{Digest, Lasting};

/// The name of the record.
const RECORD: &str = ".fretwork-diffs";

/// Writes the pictures of what differs below `out`; `is_whole` if nothing was left out of the specs that were compared.
///
/// # Errors
/// When a file cannot be written, or stands in the way.
pub fn write(comparison: &mut Comparison, out: &Path, is_whole: bool) -> Result<(), Failure> {
    let failed = |e: io::Error| refused(out, &e);
    let place = Place::of(&comparison.root, out).map_err(failed)?;
    let mut output = Output::new(place);
    let root = output.root(false).ok();
    let known = root.and_then(|root| Record::load(root, RECORD));
    let known = known.unwrap_or_default();
    let mut record = known.clone();
    for change in &mut comparison.artifacts {
        draw(change, &mut output, &mut record)?;
    }
    if is_whole {
        prune(comparison, &mut output, &mut record).map_err(failed)?;
    }
    if record != known {
        let root = output.root(true).map_err(failed)?;
        record.store(root, RECORD).map_err(failed)?;
    }
    Ok(())
}

fn refused(path: &Path, error: &io::Error) -> Failure {
    Failure::usage(format!("cannot write `{}`: {error}", path.display()))
}

/// Writes the pictures of one artifact if it differs, and notes their paths.
fn draw(change: &mut Change, output: &mut Output, record: &mut Record) -> Result<(), Failure> {
    let Some(overlay) = change.overlay.as_ref() else {
        return Ok(());
    };
    let files = match picture::files(overlay) {
        Ok(files) => files,
        Err(error) => {
            let path = &change.path;
            terminal::note(&format!("no picture of {path}: {}", error.message));
            return Ok(());
        }
    };
    for (extension, bytes) in files {
        let path = format!("{}.diff.{extension}", change.path);
        let full = output.path(&path);
        put(output, record, (&path, &change.spec), &bytes).map_err(|e| refused(&full, &e))?;
        change.pictures.push(path);
    }
    Ok(())
}

/// Removes the pictures of what no longer differs, as they were written.
fn prune(comparison: &Comparison, output: &mut Output, record: &mut Record) -> io::Result<()> {
    let pictures = comparison.artifacts.iter().flat_map(|one| &one.pictures);
    let keep: BTreeSet<&str> = pictures.map(String::as_str).collect();
    let is_compared = |spec: &str| comparison.specs.iter().any(|known| known == spec);
    for (path, entry) in record.stale(is_compared, &keep) {
        let found = output.find(&path)?;
        if found.is_some_and(|found| entry.digests.contains(&found.digest)) {
            output.remove(&path)?;
        }
        record.forget(&path);
    }
    Ok(())
}

/// Writes a file that is new or ours. The record knows it before it is there.
fn put(
    output: &mut Output,
    record: &mut Record,
    (path, spec): (&str, &str),
    bytes: &[u8],
) -> io::Result<()> {
    let digest = Digest::of(bytes);
    match output.find(path)? {
        Some(found) if found.digest == digest && record.has(path) => return Ok(()),
        Some(_) if !record.has(path) => {
            return Err(io::Error::other("a file is there that no diff has written"));
        }
        _ => {}
    }
    record.announce(path, spec, digest);
    record.store(output.root(true)?, RECORD)?;
    let (below, name) = split(path);
    let folder = output.folder(below, true)?;
    folder.write(name, &[bytes], Lasting::UntilPowerFails)?;
    record.settle(path, spec, digest);
    Ok(())
}
