//! Files that builds have written and that no spec names any more.

use std::collections::BTreeSet;
use std::io;

use super::output::{Inputs, Output};
use super::record::{self, Entry, Record, split};
use super::session::Session;
use super::terminal;
use fretwork_diagnostic::{Code, Diagnostic};
use fretwork_engine::{Artifact, output_folder};
use fretwork_language::kinds::artifacts::Format;
use fretwork_store::Digest;

/// What a build says about the files that there should be.
pub struct Stale<'a> {
    /// The session; its specs are those that were built.
    pub session: &'a Session,
    /// Whether those are all specs of the project.
    pub is_all: bool,
    /// Whether the output folder is that of one spec alone.
    pub is_own_folder: bool,
    /// The artifacts of the build.
    pub artifacts: &'a [Artifact],
}

impl Stale<'_> {
    /// Removes stale files that are as a build has written them, files that a killed build left half
    /// written, and folders that this leaves empty. Whatever else lies there is not ours.
    ///
    /// # Errors
    /// When a folder cannot be read, is behind a link, or a file cannot be removed.
    pub fn prune(&self, output: &mut Output) -> Result<(), Diagnostic> {
        let failed = |e: io::Error| {
            Diagnostic::error(format!("cannot remove stale artifacts: {e}")).about(Code::Output)
        };
        let Some(known) = output
            .root(false)
            .ok()
            .and_then(|root| Record::load(root, record::NAME))
        else {
            return Ok(());
        };
        let mut record = known.clone();
        let inputs = Inputs::of(self.session);
        for (path, entry) in self.stale(&known).map_err(failed)? {
            let full = output.path(&path);
            let why_kept = match output.find(&path).map_err(failed)? {
                None => None,
                Some(_) if inputs.has(&full) => Some("this build reads it"),
                Some(found) if !is_ours(&entry, found.digest) => {
                    Some("it is no longer what a build has written")
                }
                Some(_) => {
                    output.remove(&path).map_err(failed)?;
                    terminal::note(&format!("removed {}", full.display()));
                    None
                }
            };
            match why_kept {
                Some(why) => terminal::note(&format!("kept {}: {why}", full.display())),
                None => record.forget(&path),
            }
        }
        self.remove_abandoned(output).map_err(failed)?;
        if record != known {
            output
                .root(true)
                .and_then(|root| record.store(root, record::NAME))
                .map_err(failed)?;
        }
        Ok(())
    }

    /// The errors for files that are there and that no spec gives. Where there is no record, each file of
    /// a format in the folder of a spec is taken for an artifact.
    pub fn orphans(&self, output: &mut Output) -> Result<Vec<Diagnostic>, Diagnostic> {
        let failed = |e: io::Error| {
            Diagnostic::error(format!("cannot look for artifacts: {e}")).about(Code::Output)
        };
        let paths = match output.root(false) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(failed(error)),
            Ok(root) => match Record::load(root, record::NAME) {
                Some(record) => {
                    let stale = self.stale(&record).map_err(failed)?;
                    stale.into_iter().map(|(path, _)| path).collect()
                }
                None => self.unrecorded(output).map_err(failed)?,
            },
        };
        let mut errors = Vec::new();
        for path in paths {
            if output.find(&path).map_err(failed)?.is_some() {
                let message = format!("`{}` belongs to no artifact", output.path(&path).display());
                let help = "remove it, or let `fretwork build --prune` do that";
                errors.push(Diagnostic::error(message).about(Code::Output).help(help));
            }
        }
        Ok(errors)
    }

    /// The files of the record that the built specs, and specs that there no longer are, do not name.
    fn stale(&self, record: &Record) -> io::Result<Vec<(String, Entry)>> {
        let specs = self.session.world.specs()?;
        let is_gone = |spec: &str| self.is_all && specs.iter().all(|known| known != spec);
        let is_built = |spec: &str| self.session.specs.iter().any(|built| built == spec);
        let mut stale = record.stale(|spec| is_built(spec) || is_gone(spec), &self.kept());
        stale.retain(|(path, _)| !self.is_part(path));
        Ok(stale)
    }

    /// Whether a file shows a window or a tile of an artifact: `a/b/3/0/7.svg` of `a/b.svg`.
    fn is_part(&self, path: &str) -> bool {
        let is_part_of = |artifact: &Artifact| {
            let (stem, ending) = artifact.path.rsplit_once('.')?;
            let name = path.strip_prefix(stem)?.strip_prefix('/')?;
            let name = name.strip_suffix(ending)?.strip_suffix('.')?;
            let is_number = |c: char| c.is_ascii_digit() || "._-/".contains(c);
            (Format::of(&artifact.path)?.is_planar() && name.chars().all(is_number)).then_some(())
        };
        self.artifacts.iter().any(|one| is_part_of(one).is_some())
    }

    fn kept(&self) -> BTreeSet<&str> {
        self.artifacts
            .iter()
            .map(|artifact| &*artifact.path)
            .collect()
    }

    /// The files of a format in the folders of the built specs, without those of other specs.
    fn unrecorded(&self, output: &mut Output) -> io::Result<Vec<String>> {
        if self.is_own_folder {
            return Ok(Vec::new());
        }
        let all = self.session.world.specs()?;
        let others: Vec<String> = (all.iter().filter(|spec| !self.session.specs.contains(spec)))
            .map(|spec| output_folder(spec) + "/")
            .collect();
        let kept = self.kept();
        let mut found = BTreeSet::new();
        for spec in &self.session.specs {
            let below = output_folder(spec);
            let paths = output.list(&below, &|name| Format::of(name).is_some())?;
            let is_other = |path: &String| {
                others
                    .iter()
                    .any(|o| path.starts_with(o) && !below.starts_with(o))
            };
            found.extend(
                paths
                    .into_iter()
                    .filter(|path| !kept.contains(&**path) && !is_other(path))
                    .filter(|path| !self.is_part(path)),
            );
        }
        Ok(found.into_iter().collect())
    }

    fn remove_abandoned(&self, output: &mut Output) -> io::Result<()> {
        let folders: BTreeSet<&str> = self.artifacts.iter().map(|a| split(&a.path).0).collect();
        for below in folders {
            match output.folder(below, false) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                folder => drop(folder?.remove_abandoned()?),
            }
        }
        output.root(true)?.remove_abandoned()?;
        Ok(())
    }
}

fn is_ours(entry: &Entry, digest: Digest) -> bool {
    entry.digests.contains(&digest)
}
