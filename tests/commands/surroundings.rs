//! Commands and what is around them: output folders, the cache, terminals, closed pipes, files that change.

use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::super::project::{Project, SPEC};

#[test]
fn locked_compares_and_writes_nothing() {
    let project = Project::small();
    assert_eq!(
        project.run(&["build", "--locked"]).code,
        Some(1),
        "nothing is there yet"
    );
    assert!(!project.path("out").exists());
    project.succeed(&["build"]);
    project.succeed(&["build", "--locked"]);
    project.succeed(&["build", "--locked", "--no-cache"]);
    project.write("out/spec/zig.svg", "edited by hand");
    let before = project.files("out");
    let run = project.run(&["build", "--locked"]);
    assert_eq!((run.code, project.files("out")), (Some(1), before));
    assert!(
        run.stderr.contains("spec/zig.svg") && run.stderr.contains("1 error"),
        "{}",
        run.stderr
    );
}

#[test]
fn prune_removes_stale_artifacts_and_nothing_else() {
    let project = Project::small();
    project.write(
        "specs/spec/inner.yaml",
        SPEC.replace("assets/", "../assets/"),
    );
    project.write("specs/assets.yaml", "fretwork: 1");
    project.succeed(&["build"]);
    for path in [
        "spec/notes.txt",
        "spec/.keep",
        "spec/gone/a.svg",
        "spec/b.3mf",
        "other/c.svg",
        "d.svg",
    ] {
        project.write(&format!("out/{path}"), "x");
    }
    let mut expected = project.files("out");
    project.edit("specs/spec.yaml", "  zig.svg: { from: zig }\n", "");
    project.succeed(&["build", "specs/spec.yaml"]);
    assert_eq!(
        project.files("out"),
        expected,
        "without --prune nothing is removed"
    );
    let run = project.run(&["build", "specs/spec.yaml", "--prune"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    expected.remove("spec/zig.svg");
    assert!(
        run.stderr.contains("removed") && run.stderr.contains("zig.svg"),
        "{}",
        run.stderr
    );
    assert_eq!(
        project.files("out").keys().collect::<Vec<_>>(),
        expected.keys().collect::<Vec<_>>()
    );
    project.succeed(&["build", "--prune"]);
    assert_eq!(project.files("out"), expected);
    // A spec that is gone leaves nothing.
    fs::remove_file(project.path("specs/spec/inner.yaml")).unwrap();
    project.succeed(&["build", "specs/spec.yaml", "--prune"]);
    assert_eq!(
        project.files("out"),
        expected,
        "one spec says nothing of the others"
    );
    project.succeed(&["build", "--prune"]);
    expected.retain(|path, _| !path.starts_with("spec/inner/"));
    assert_eq!(project.files("out"), expected);
    assert!(!project.path("out/spec/inner").exists());
}

#[test]
fn locked_tells_missing_artifacts_from_other_ones() {
    let project = Project::small();
    let run = project.run(&["build", "--locked", "--only", "plate.svg"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("plate.svg` is missing"),
        "{}",
        run.stderr
    );
}

#[test]
fn the_cache_can_be_measured_verified_and_emptied() {
    let project = Project::small();
    assert!(
        project
            .succeed(&["cache", "size"])
            .contains("0 results, 0 values, 0.0 MB")
    );
    project.succeed(&["build"]);
    assert!(!project.succeed(&["cache", "size"]).contains(" 0 results"));
    assert!(
        project
            .succeed(&["cache", "verify"])
            .starts_with("0 damaged")
    );
    let blob = project
        .files(".fretwork/v3/blobs")
        .into_keys()
        .next()
        .unwrap();
    project.write(&format!(".fretwork/v3/blobs/{blob}"), "damaged");
    assert!(
        project
            .succeed(&["cache", "verify"])
            .starts_with("1 damaged")
    );
    assert!(
        project
            .succeed(&["cache", "verify"])
            .starts_with("0 damaged")
    );
    project.succeed(&["cache", "gc", "--keep", "0"]);
    assert!(
        project
            .succeed(&["cache", "size"])
            .contains("0 results, 0 values")
    );
    assert_eq!(project.build(&[]).artifacts("unchanged").len(), 5);
    assert!(
        project
            .succeed(&["cache", "size", "--cache-dir", "none"])
            .contains("0 results")
    );
}

#[test]
fn completions_are_printed_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(
            Project::empty()
                .succeed(&["completions", shell])
                .contains("cache-dir"),
            "{shell}"
        );
    }
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let project = Project::small();
    for arguments in [
        &["graph", "specs/spec.yaml"][..],
        &["build"],
        &["schema"],
        &["completions", "bash"],
        &["--help"],
    ] {
        let mut child = project
            .command(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let run = super::super::project::wait(child);
        assert!(
            !run.stderr.contains("panicked"),
            "{arguments:?}: {}",
            run.stderr
        );
        assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
    }
}

#[test]
fn output_that_cannot_be_written_is_said() {
    let Ok(full) = fs::File::options().write(true).open("/dev/full") else {
        return;
    };
    let mut command = Project::empty().command(&["schema"]);
    let child = command
        .current_dir("/")
        .stdout(full)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let run = super::super::project::wait(child);
    assert!(
        run.code != Some(0) && run.stderr.contains("standard output"),
        "{}",
        run.stderr
    );
}

#[test]
fn colours_are_for_terminals() {
    let project = Project::of("fretwork: 1\nregion: {}\n");
    let run = project.run(&["build"]);
    assert!(!run.stderr.contains('\u{1b}'), "{}", run.stderr);
}

/// Waits until `done` or fails.
#[track_caller]
fn eventually(mut done: impl FnMut() -> bool) {
    let started = Instant::now();
    while !done() {
        assert!(
            started.elapsed() < Duration::from_secs(20),
            "this takes too long"
        );
        sleep(Duration::from_millis(10));
    }
}

#[test]
fn watch_builds_again_when_a_file_changes() {
    let project = Project::small();
    let mut child = project
        .command(&["watch"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let read = |path: &str| fs::read_to_string(project.path(path)).unwrap_or_default();
    let result = std::panic::catch_unwind(|| {
        eventually(|| !read("out/spec/zig.svg").is_empty());
        let (zig, plate) = (read("out/spec/zig.svg"), read("out/spec/plate.svg"));
        project.edit("specs/spec.yaml", "radius: 10", "radius: 12");
        eventually(|| read("out/spec/plate.svg") != plate);
        assert_eq!(read("out/spec/zig.svg"), zig);
        // Many editors write a new file and move it over the old one.
        project.write(
            "specs/assets/new",
            super::super::project::ZIG.replace("L3 0", "L3 1"),
        );
        fs::rename(
            project.path("specs/assets/new"),
            project.path("specs/assets/zig.svg"),
        )
        .unwrap();
        eventually(|| read("out/spec/zig.svg") != zig);
        project.edit("specs/spec.yaml", "radius: 12", "radius: wrong");
        sleep(Duration::from_millis(300));
        project.edit("specs/spec.yaml", "radius: wrong", "radius: 10");
        eventually(|| read("out/spec/plate.svg") == plate);
    });
    child.kill().unwrap();
    child.wait().unwrap();
    result.unwrap();
}

#[test]
fn one_spec_can_be_built_into_a_folder_of_its_own() {
    let project = Project::small();
    project.succeed(&["build"]);
    let files = project.files("out/spec");
    project.succeed(&["build", "specs/spec.yaml", "--out", "flat"]);
    assert_eq!(project.files("flat"), files);
    project.succeed(&[
        "build",
        "specs/spec.yaml",
        "--out",
        "flat",
        "--locked",
        "--no-cache",
    ]);
    // Whatever else lies there is not ours.
    project.write("flat/mine.svg", "mine");
    project.edit("specs/spec.yaml", "  zig.svg: { from: zig }\n", "");
    project.succeed(&["build", "specs/spec.yaml", "--out", "flat", "--prune"]);
    assert!(!project.path("flat/zig.svg").exists());
    assert_eq!(fs::read(project.path("flat/mine.svg")).unwrap(), b"mine");
}
