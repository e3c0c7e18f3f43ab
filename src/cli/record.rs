//! The record of the files that builds have written, kept in the output folder: what is not in it
//! is somebody else's.

use std::collections::{BTreeMap, BTreeSet};
use std::io;

use fretwork_language::kinds::artifacts::Format;
use fretwork_store::{Digest, Folder, Lasting};

/// The name of its file, which no artifact has.
pub const NAME: &str = ".fretwork-record";

/// The first line of its file.
const HEAD: &str = "\"fretwork record 1: what builds have written here; only this is pruned\"";

/// How many digests are kept of one file. More than one are known after builds that were killed or ran at once.
const MAX_DIGESTS: usize = 4;

/// What builds have written below an output folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Record {
    files: BTreeMap<String, Entry>,
}

/// A file of the record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The spec that names it.
    pub spec: String,
    /// The digests that it may have, the newest first.
    pub digests: Vec<Digest>,
}

impl Record {
    /// The record `name` of `folder`; none where there is none that can be read.
    pub fn load(folder: &Folder, name: &str) -> Option<Record> {
        let text = String::from_utf8(folder.read(name).ok()?).ok()?;
        let mut lines = text.lines();
        if lines.next() != Some(HEAD) {
            return None;
        }
        // A line that says nothing stands for no file: what it meant is kept.
        Some(Record {
            files: lines.filter_map(parsed).collect(),
        })
    }

    /// Puts it into `folder` as `name`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn store(&self, folder: &Folder, name: &str) -> io::Result<()> {
        let mut text = format!("{HEAD}\n");
        for (path, entry) in &self.files {
            let line = serde_json::to_string(&(path, &entry.spec, &entry.digests));
            text += &line.map_err(io::Error::other)?;
            text.push('\n');
        }
        folder.write(name, &[text.as_bytes()], Lasting::UntilPowerFails)
    }

    /// Whether a build has written, or has begun to write, the file at `path`.
    pub fn has(&self, path: &str) -> bool {
        self.files.contains_key(path)
    }

    /// Whether the file at `path` has the bytes that were last written there.
    pub fn is_settled(&self, path: &str, spec: &str, digest: Digest) -> bool {
        let entry = self.files.get(path);
        entry.is_some_and(|entry| entry.spec == spec && entry.digests == [digest])
    }

    /// Notes that a build of `spec` is about to write `path`; what was there may stay.
    pub fn announce(&mut self, path: &str, spec: &str, digest: Digest) {
        let entry = self.files.entry(path.to_string()).or_insert_with(|| Entry {
            spec: String::new(),
            digests: Vec::new(),
        });
        entry.spec = spec.to_string();
        entry.digests.retain(|known| *known != digest);
        entry.digests.insert(0, digest);
        entry.digests.truncate(MAX_DIGESTS);
    }

    /// Notes that `path` has these bytes now.
    pub fn settle(&mut self, path: &str, spec: &str, digest: Digest) {
        let entry = Entry {
            spec: spec.to_string(),
            digests: vec![digest],
        };
        self.files.insert(path.to_string(), entry);
    }

    /// Forgets a file.
    pub fn forget(&mut self, path: &str) {
        self.files.remove(path);
    }

    /// The files of specs for which `is_meant` holds that are not in `keep`.
    pub fn stale(
        &self,
        is_meant: impl Fn(&str) -> bool,
        keep: &BTreeSet<&str>,
    ) -> Vec<(String, Entry)> {
        let is_stale = |(path, entry): &(&String, &Entry)| {
            is_meant(&entry.spec) && !keep.contains(path.as_str())
        };
        let stale = self.files.iter().filter(is_stale);
        stale
            .map(|(path, entry)| (path.clone(), entry.clone()))
            .collect()
    }
}

/// A line of the file, if it names a path that an artifact may have.
fn parsed(line: &str) -> Option<(String, Entry)> {
    let (path, spec, digests): (String, String, Vec<Digest>) = serde_json::from_str(line).ok()?;
    let is_plain = |part: &str| {
        !part.is_empty()
            && !part.starts_with('.')
            && !part.contains(|c: char| c.is_control() || "\\:".contains(c))
    };
    let is_artifact = path.split('/').all(is_plain) && Format::of(&path).is_some();
    is_artifact.then_some((path, Entry { spec, digests }))
}

/// The folder of an artifact below the output folder, and its name in it.
pub fn split(path: &str) -> (&str, &str) {
    path.rsplit_once('/').unwrap_or(("", path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_comes_back_as_it_was_written() {
        let scratch = tempfile::tempdir().expect("a folder can be made");
        let folder = Folder::open(scratch.path()).expect("it is there");
        assert_eq!(Record::load(&folder, NAME), None);
        let mut record = Record::default();
        let [one, two] = [b"1", b"2"].map(|bytes| Digest::of(bytes));
        record.announce("a/\"b\".svg", "specs/a.yaml", one);
        record.announce("a/\"b\".svg", "specs/a.yaml", two);
        record.settle("c.dxf", "specs/c\n.yaml", two);
        record.store(&folder, NAME).expect("it is written");
        assert_eq!(Record::load(&folder, NAME), Some(record.clone()));
        assert!(record.is_settled("c.dxf", "specs/c\n.yaml", two) && record.has("a/\"b\".svg"));
        let stale = record.stale(|spec| spec == "specs/a.yaml", &BTreeSet::new());
        assert_eq!(stale[0].1.digests, [two, one]);
    }

    #[test]
    fn lines_that_name_no_artifact_are_nothing() {
        let digest = Digest::of(b"x").hex();
        for path in [
            "../a.svg",
            "/a.svg",
            "a//b.svg",
            ".git/a.svg",
            "a.txt",
            "a\\b.svg",
            "a/..",
            "c:/a.svg",
        ] {
            let line =
                serde_json::to_string(&(path, "specs/a.yaml", [&digest])).expect("it is text");
            assert!(parsed(&line).is_none(), "{path}");
        }
        for line in ["", "[]", "[\"a.svg\"]", "[\"a.svg\", \"s\", [\"12\"]]"] {
            assert!(parsed(line).is_none(), "{line}");
        }
    }
}
