//! Whole commands in fresh processes on the shipped specs: cold, with nothing to do, after a comment, and
//! after the edit of one node. The no-op build is to take at most 5 % of the cold one or 20 ms.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::super::Bench;

/// A copy of the shipped specs whose artifacts and cache are thrown away in the end.
pub struct Project(tempfile::TempDir);

impl Project {
    fn new() -> Project {
        let folder = tempfile::tempdir().expect("a folder can be made");
        fs::write(folder.path().join("fretwork.toml"), "").expect("the folder is writable");
        copy(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join("specs"),
            &folder.path().join("specs"),
        );
        Project(folder)
    }

    /// The copy, built.
    pub fn built() -> Project {
        let project = Project::new();
        project.build(&[]);
        project
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        self.0.path()
    }

    /// Writes a file.
    pub fn write(&self, path: &str, text: &str) {
        fs::write(self.0.path().join(path), text).expect("the folder is writable");
    }

    /// What a build prints.
    pub fn build(&self, arguments: &[&str]) -> String {
        self.run(&[&["build"], arguments].concat())
    }

    /// What the binary prints.
    pub fn run(&self, arguments: &[&str]) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
        let output = command
            .args(arguments)
            .current_dir(self.0.path())
            .output()
            .expect("it starts");
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    /// Replaces a text in the jigsaw's spec and gives what it was.
    pub fn edit(&self, change: impl Fn(&str) -> String) {
        self.edit_in("specs/jigsaw.yaml", change);
    }

    /// Replaces a text in a spec.
    pub fn edit_in(&self, path: &str, change: impl Fn(&str) -> String) {
        let path = self.0.path().join(path);
        let text = fs::read_to_string(&path).expect("the spec is there");
        fs::write(&path, change(&text)).expect("the folder is writable");
    }
}

/// Copies a folder with all that is in it.
pub fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("the folder is writable");
    for entry in fs::read_dir(from)
        .expect("the folder is there")
        .map(|e| e.expect("the folder can be read"))
    {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).expect("the folder is writable");
        }
    }
}

/// Runs the benchmarks of this file.
pub fn run(bench: &Bench) {
    bench.run("build cold", Project::new, |project| {
        project.build(&["--no-cache"])
    });
    bench.run("build with nothing to do", Project::built, |project| {
        project.build(&[])
    });
    bench.run("build after a comment", Project::built, |project| {
        project.edit(|text| format!("# A comment.\n{text}"));
        project.build(&[])
    });
    let piece = std::cell::Cell::new(0);
    bench.run(
        "build after the edit of one node",
        Project::built,
        |project| {
            // Another size at every run, so that nothing is in the cache.
            piece.set(piece.get() + 1);
            let flip = format!("flip: {}%", piece.get());
            project.edit(|text| {
                let at = text.find("flip: ").expect("the jigsaw flips its tabs");
                let end = at + text[at..].find('%').expect("by a part of them");
                format!("{}{flip}{}", &text[..at], &text[end + 1..])
            });
            project.build(&[])
        },
    );
}
