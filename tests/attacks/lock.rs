//! `fretwork.lock` and `--locked`.

use std::fs;

use super::super::project::{Project, RECORD, SPEC};

const LESS: (&str, &str) = ("  zig.svg: { from: zig }\n", "");

#[track_caller]
fn told(project: &Project, arguments: &[&str], word: &str) {
    let run = project.run(arguments);
    assert_eq!(run.code, Some(1), "{arguments:?}: {}", run.stderr);
    assert!(
        run.stderr.contains(word),
        "`{word}` is not in {}",
        run.stderr
    );
}

#[test]
fn a_locked_build_sees_files_that_no_spec_names() {
    let project = Project::small();
    project.succeed(&["build"]);
    project.succeed(&["build", "--locked"]);
    project.edit("specs/spec.yaml", LESS.0, LESS.1);
    let before = project.files("out");
    told(
        &project,
        &["build", "--locked"],
        "zig.svg` belongs to no artifact",
    );
    // As in a fresh clone, with the record of builds and without it.
    fs::remove_dir_all(project.path(".fretwork")).unwrap();
    told(
        &project,
        &["build", "--locked"],
        "zig.svg` belongs to no artifact",
    );
    assert_eq!(project.files("out"), before);
    fs::remove_file(project.path(&format!("out/{RECORD}"))).unwrap();
    told(
        &project,
        &["build", "--locked"],
        "zig.svg` belongs to no artifact",
    );
    fs::remove_file(project.path("out/spec/zig.svg")).unwrap();
    project.succeed(&["build", "--locked"]);
    project.write("specs/none.yaml", "fretwork: 1\n");
    project.write("out/none/mine.svg", "mine");
    told(&project, &["build", "--locked"], "mine.svg");
    project.succeed(&["build"]);
    project.succeed(&["build", "--locked"]);
}

#[test]
fn a_lock_needs_no_committed_artifacts() {
    let project = Project::small();
    project.write(
        "specs/inner/other.yaml",
        SPEC.replace("assets/", "../assets/"),
    );
    project.succeed(&["build", "--lock"]);
    let lock = fs::read_to_string(project.path("fretwork.lock")).unwrap();
    assert_eq!(lock.matches("zig.svg").count(), 2);
    for folder in ["out", ".fretwork"] {
        fs::remove_dir_all(project.path(folder)).unwrap();
    }
    project.succeed(&["build", "--locked"]);
    assert!(!project.path("out").exists(), "nothing is written");
    project.succeed(&["build", "specs/spec.yaml", "--locked", "--out", "flat"]);
    project.edit("specs/spec.yaml", "radius: 10", "radius: 11");
    told(
        &project,
        &["build", "--locked"],
        "`spec/plate.svg` is not what `fretwork.lock` holds",
    );
    told(
        &project,
        &["build", "--locked", "--only", "plate.svg"],
        "is not what `fretwork.lock` holds",
    );
    project.succeed(&["build", "--locked", "specs/inner/other.yaml"]);
    project.succeed(&["build", "specs/spec.yaml", "--lock"]);
    project.succeed(&["build", "--locked"]);
    assert_ne!(
        fs::read_to_string(project.path("fretwork.lock")).unwrap(),
        lock
    );
}

#[test]
fn a_lock_names_all_artifacts_and_no_others() {
    let project = Project::small();
    project.succeed(&["build", "--lock"]);
    project.edit("specs/spec.yaml", LESS.0, LESS.1);
    fs::remove_dir_all(project.path("out")).unwrap();
    told(
        &project,
        &["build", "--locked"],
        "`fretwork.lock` holds `zig.svg` of `specs/spec.yaml`",
    );
    project.succeed(&["build", "--lock"]);
    project.edit(
        "specs/spec.yaml",
        "artifacts:\n",
        "artifacts:\n  new.svg: { from: page }\n",
    );
    told(
        &project,
        &["build", "--locked"],
        "`spec/new.svg` is not in `fretwork.lock`",
    );
    project.write("fretwork.lock", "{}");
    assert_eq!(project.run(&["build", "--locked"]).code, Some(2));
    assert_eq!(project.run(&["build", "--lock", "--locked"]).code, Some(2));
    assert_eq!(
        project.run(&["build", "--lock", "--set", "size=50"]).code,
        Some(2)
    );
}

#[test]
fn files_beside_a_lock_are_compared_too() {
    let project = Project::small();
    project.succeed(&["build", "--lock"]);
    project.write("out/spec/zig.svg", "edited by hand");
    told(
        &project,
        &["build", "--locked"],
        "zig.svg` is not what the spec gives",
    );
}

#[test]
fn a_failed_build_changes_no_lock() {
    let project = Project::small();
    project.succeed(&["build", "--lock"]);
    let lock = fs::read(project.path("fretwork.lock")).unwrap();
    project.edit("specs/spec.yaml", "radius: 10", "radius: -10");
    assert_eq!(project.run(&["build", "--lock"]).code, Some(1));
    assert_eq!(fs::read(project.path("fretwork.lock")).unwrap(), lock);
}
