//! What runs again after an edit: the names of the executed queries, and the nodes whose stages
//! ran. Everything happens in memory; what two processes share is tested with a store that two
//! compilers use.

mod edits;
mod facades;
mod files;
mod kinds;
mod maps;
mod origins;
mod overtaken;
mod processes;
mod shells;

use std::sync::{Arc, Mutex};

use expect_test::{Expect, expect};

use super::cache::{Cache, Versions};
use super::compile::{Compiler, Progress, Request};
use super::report::Report;
use super::settings::Settings;
use super::world::{MemoryWorld, World};
use fretwork_action::ReadError;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::progress::Steps;
use fretwork_store::LocalStore;

/// Files that change while a compiler holds them.
#[derive(Default)]
struct Files(Mutex<MemoryWorld>);

impl World for Files {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.0.lock().unwrap().read(path)
    }

    fn names(&self, folder: &str) -> Vec<String> {
        self.0.lock().unwrap().names(folder)
    }
}

impl Files {
    fn write(&self, path: &str, text: &str) {
        self.0
            .lock()
            .unwrap()
            .files
            .insert(path.to_string(), text.as_bytes().to_vec());
    }

    fn remove(&self, path: &str) {
        self.0.lock().unwrap().files.remove(path);
    }
}

struct Silent;

impl Progress for Silent {
    fn total(&self, _: usize) {}
    fn started(&self, _: &str, _: &Arc<Steps>) {}
    fn finished(&self, _: &str) {}
}

/// A compiler, its files, and the folder of its store, if it has one.
struct Bench {
    files: Arc<Files>,
    compiler: Compiler,
}

const SPEC: &str = "specs/spec.yaml";

impl Bench {
    fn new(spec: &str) -> Bench {
        let files = Arc::new(Files::default());
        files.write(SPEC, spec);
        files.write("specs/zig.svg", ZIG);
        files.write("specs/blob.svg", BLOB);
        files.write("specs/m.star", MAPPERS);
        files.write("specs/lib.star", LIBRARY);
        Bench {
            compiler: Compiler::new(files.clone(), None, true),
            files,
        }
    }

    /// The same files for another process, which uses `store`.
    fn process(&self, store: LocalStore) -> Bench {
        Bench {
            files: self.files.clone(),
            compiler: Compiler::new(
                self.files.clone(),
                Some(Cache {
                    store,
                    versions: Versions::default(),
                }),
                true,
            ),
        }
    }

    fn report(&self, sets: &[(&str, &str)]) -> Report {
        self.compiler.build(&Request {
            specs: vec![SPEC.to_string()],
            settings: Settings::new(sets.iter().copied()),
            only: Vec::new(),
            windows: Vec::new(),
            threads: 1,
            progress: &Silent,
        })
    }

    /// Builds without errors.
    #[track_caller]
    fn build(&self, sets: &[(&str, &str)]) -> Report {
        let report = self.report(sets);
        // That a parameter is unused is told, but is no matter here.
        let mut diagnostics = report.diagnostics.clone();
        diagnostics.retain(|d| !d.message.starts_with("no expression uses the parameter"));
        assert_eq!(diagnostics, []);
        report
    }

    /// Writes a file and tells the compiler.
    fn edit(&mut self, path: &str, text: &str) {
        self.files.write(path, text);
        self.compiler.refresh();
    }
}

/// The queries in the order in which they first ran, with their numbers, and the nodes whose stages
/// ran.
fn summary(compiler: &Compiler, report: &Report) -> String {
    let mut counts: Vec<(String, usize)> = Vec::new();
    for name in compiler.database.take_executed() {
        match counts.iter_mut().find(|(n, _)| *n == name) {
            Some((_, count)) => *count += 1,
            None => counts.push((name, 1)),
        }
    }
    let mut lines: Vec<String> = counts
        .into_iter()
        .map(|(name, count)| {
            if count == 1 {
                name
            } else {
                format!("{name} {count}")
            }
        })
        .collect();
    lines.extend(
        evaluated(report)
            .into_iter()
            .map(|node| format!("-> {node}")),
    );
    lines.join("\n")
}

fn evaluated(report: &Report) -> Vec<String> {
    report
        .nodes
        .iter()
        .filter(|n| n.was_evaluated())
        .map(|n| format!("{}.{}", n.section, n.name))
        .collect()
}

fn digests(report: &Report) -> Vec<(String, String)> {
    report
        .artifacts
        .iter()
        .map(|a| (a.path.clone(), a.digest.hex()))
        .collect()
}

/// Builds `before`, then `after` in the same compiler, and gives what ran for it. The artifacts are those that a new
/// compiler gives.
#[track_caller]
fn edited(before: &str, after: &str) -> String {
    let mut bench = Bench::new(before);
    bench.build(&[]);
    bench.compiler.database.take_executed();
    bench.edit(SPEC, after);
    let report = bench.build(&[]);
    assert_eq!(digests(&report), digests(&Bench::new(after).build(&[])));
    summary(&bench.compiler, &report)
}

/// Compares what runs for an edit.
#[track_caller]
fn check_edit(before: &str, after: &str, expect: Expect) {
    expect.assert_eq(&edited(before, after));
}

/// What runs for every edit of a value, before any entry is looked at.
const FRONT: &str = "parse\nprogram\ncheck\nscope\nbasis\nlinked\n";

/// Compares what runs for an edit of a value, from the entries on.
#[track_caller]
fn check_value_edit(before: &str, after: &str, expect: Expect) {
    let ran = edited(before, after);
    let entries = ran.strip_prefix(FRONT);
    expect.assert_eq(entries.unwrap_or_else(|| panic!("more or less than {FRONT}: {ran}")));
}

const ZIG: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 4'><path d='M0 2 L3 0 L7 4 L10 2' fill='none' stroke='black'/></svg>";
const BLOB: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 4 4'><path id='blob' d='M0 0 H4 V4 H0 Z'/></svg>";
const MAPPERS: &str = "load('lib.star', 'outline')

def hatch(gap):
    def mapper(face):
        return outline(face)
    return mapper

def jitter():
    def mapper(face):
        return contour(face)
    return mapper

def overview(cells):
    return map_to_faces(outline, cells)
";
const LIBRARY: &str = "def outline(face):\n    return contour(face)\n";
