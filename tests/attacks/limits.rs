//! Machines that give few threads, files and bytes.

use std::fs;
use std::process::{Command, Stdio};

use super::super::project::{Project, Run, finish};

/// A build in a shell that has given `before` as a command.
fn limited(project: &Project, before: &str) -> Run {
    let mut command = Command::new("bash");
    command.current_dir(project.path(""));
    command.args(["-c", &format!("{before}; exec \"$0\" build --jobs 8")]);
    command.arg(env!("CARGO_BIN_EXE_fretwork"));
    finish(command)
}

#[test]
#[cfg(target_os = "linux")]
fn fewer_threads_than_asked_for_are_a_slower_build() {
    use std::os::unix::fs::PermissionsExt as _;
    let project = Project::small();
    let expected = {
        project.succeed(&["build", "--no-cache"]);
        project.files("out")
    };
    // Root has no limit, and so becomes somebody who owns no process yet.
    let open =
        |path: &str| fs::set_permissions(project.path(path), fs::Permissions::from_mode(0o777));
    for threads in [1, 2, 3, 4, 6, 9] {
        let _ = fs::remove_dir_all(project.path("out"));
        let _ = fs::remove_dir_all(project.path(".fretwork"));
        open("").unwrap();
        let mut command = Command::new("setpriv");
        command.args([
            "--reuid",
            "65532",
            "--regid",
            "65532",
            "--clear-groups",
            "bash",
            "-c",
        ]);
        command.arg(format!("cd '{}' && \"$0\" params specs/spec.yaml && ulimit -u {threads} && exec \"$0\" build --jobs 8", project.path("").display()));
        command
            .arg(env!("CARGO_BIN_EXE_fretwork"))
            .stderr(Stdio::piped());
        let Ok(child) = command.stdout(Stdio::piped()).spawn() else {
            return;
        };
        let run = super::super::project::wait(child);
        if !run.stdout.contains("spacing") {
            return;
        }
        assert_eq!(run.code, Some(0), "{threads}: {}", run.stderr);
        assert_eq!(project.files("out"), expected, "{threads}");
    }
}

#[test]
#[cfg(unix)]
fn a_limit_of_bytes_ends_no_process() {
    let project = Project::small();
    project.edit("specs/spec.yaml", "cell_size: 9", "cell_size: 1");
    let run = limited(&project, "ulimit -f 1");
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("cannot write"), "{}", run.stderr);
    assert!(
        project.files("out").is_empty(),
        "a set is written as a whole or not at all"
    );
    project.succeed(&["build"]);
}

#[test]
#[cfg(unix)]
fn a_limit_of_open_files_is_an_error_or_none() {
    let project = Project::small();
    project.succeed(&["build", "--no-cache"]);
    let expected = project.files("out");
    for files in [5, 6, 8, 10, 12, 16, 24] {
        fs::remove_dir_all(project.path("out")).unwrap();
        let run = limited(&project, &format!("ulimit -n {files}"));
        assert!(
            matches!(run.code, Some(0..=2 | 127)),
            "{files}: {}",
            run.stderr
        );
        assert!(!run.stderr.contains("panicked"), "{files}: {}", run.stderr);
        project.succeed(&["build"]);
        assert_eq!(project.files("out"), expected);
    }
}

#[test]
fn any_number_of_threads_gives_the_same_outcome() {
    let good = Project::small();
    let bad = Project::small();
    bad.edit("specs/spec.yaml", "cell_size: 9", "cell_size: 1e-300");
    for project in [good, bad] {
        let outcome = |jobs: &str| {
            let _ = fs::remove_dir_all(project.path("out"));
            let mut command = project.command(&["build", "--no-cache", "--jobs", jobs]);
            command.env("RAYON_NUM_THREADS", jobs);
            let run = finish(command);
            (run.code, run.stderr, project.files("out"))
        };
        let [one, two, many] = ["1", "2", "16"].map(outcome);
        assert_eq!(one, two);
        assert_eq!(one, many);
    }
}
