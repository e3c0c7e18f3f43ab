//! Artifacts, traces and pruning touch nothing that fretwork has not written.

use std::fs;
#[cfg(unix)]
use std::os::unix::fs::symlink;

use super::super::project::{Project, RECORD, SPEC, ZIG};

const PAGE: &str = "fretwork: 1\nregions: { page: { rectangle: { width: 9, height: 9 } } }\n";

/// A project with one spec, whose artifacts show the same square.
fn project(artifacts: &[&str]) -> Project {
    let project = Project::empty();
    write(&project, "specs/a.yaml", artifacts);
    project
}

fn write(project: &Project, spec: &str, artifacts: &[&str]) {
    let lines: String = artifacts
        .iter()
        .map(|a| format!("  \"{a}\": {{ from: page }}\n"))
        .collect();
    project.write(spec, format!("{PAGE}artifacts:\n{lines}"));
}

#[track_caller]
fn refused(project: &Project, arguments: &[&str], code: i32, words: &[&str]) {
    let run = project.run(arguments);
    assert_eq!(run.code, Some(code), "{arguments:?}: {}", run.stderr);
    // Long lines are wrapped, depending on the length of the folder's path.
    let said: Vec<&str> = run
        .stderr
        .split_whitespace()
        .filter(|w| *w != "│")
        .collect();
    let said = said.join(" ");
    for word in words {
        assert!(said.contains(word), "`{word}` is not in {}", run.stderr);
    }
}

#[test]
#[cfg(unix)]
fn a_committed_link_gets_nothing_written_or_removed_outside() {
    let outside = tempfile::tempdir().unwrap();
    let mine = outside.path().join("package.json");
    for place in ["out", "out/a", "out/a/package.json"] {
        fs::write(&mine, "mine").unwrap();
        let project = project(&["package.json", "deep/b.svg"]);
        let link = project.path(place);
        fs::create_dir_all(link.parent().unwrap()).unwrap();
        let target = if place.ends_with("json") {
            mine.clone()
        } else {
            outside.path().to_path_buf()
        };
        symlink(target, &link).unwrap();
        for arguments in [
            &["build"][..],
            &["build", "--prune"],
            &["build", "--overwrite"],
            &["build", "--out", "out"],
        ] {
            refused(&project, arguments, 1, &[place, "symbolic link"]);
            assert_eq!(fs::read_dir(outside.path()).unwrap().count(), 1, "{place}");
            assert_eq!(fs::read(&mine).unwrap(), b"mine", "{place}");
        }
        assert!(fs::symlink_metadata(link).unwrap().is_symlink());
    }
}

#[test]
fn pruning_removes_what_a_build_has_written_and_nothing_else() {
    let project = project(&[
        "page.svg",
        "old.svg",
        "old.dxf",
        "deep/old.svg",
        "edited.svg",
    ]);
    project.succeed(&["build"]);
    let mine = [
        "a/mine.svg",
        "a/sub/jig.dxf",
        "notes.stl",
        "a/deep/mine.json",
    ];
    for path in mine {
        project.write(&format!("out/{path}"), "mine");
    }
    project.write("out/a/edited.svg", "edited by hand");
    write(&project, "specs/a.yaml", &["page.svg"]);
    let run = project.run(&["build", "--prune"]);
    assert!(
        run.stderr.contains("kept") && run.stderr.contains("edited.svg"),
        "{}",
        run.stderr
    );
    let mut left: Vec<String> = project.files("out").into_keys().collect();
    left.sort();
    assert_eq!(
        left,
        [
            "a/deep/mine.json",
            "a/edited.svg",
            "a/mine.svg",
            "a/page.svg",
            "a/sub/jig.dxf",
            "notes.stl"
        ]
    );
}

#[test]
fn pruning_into_the_sources_removes_no_source() {
    let project = Project::empty();
    let spec = SPEC.replace("assets/", "../a/assets/");
    project.write(
        "specs/a.yaml",
        &*PAGE.replace("regions", "artifacts: { p.svg: { from: page } }\nregions"),
    );
    project.write("specs/a/b.yaml", spec);
    project.write("specs/a/assets/zig.svg", ZIG);
    project.write("src/data/config.json", "{}");
    project.write(
        "specs/src.yaml",
        &*PAGE.replace("regions", "artifacts: { p.svg: { from: page } }\nregions"),
    );
    project.succeed(&["build", "--out", "specs", "--prune"]);
    project.succeed(&["build", "--out", ".", "--prune"]);
    assert_eq!(
        fs::read(project.path("specs/a/assets/zig.svg")).unwrap(),
        ZIG.as_bytes()
    );
    assert_eq!(
        fs::read(project.path("src/data/config.json")).unwrap(),
        b"{}"
    );
}

#[test]
fn a_record_from_a_stranger_removes_no_input_and_nothing_outside() {
    let project = project(&["page.svg"]);
    project.write("specs/b.yaml", SPEC);
    project.write("specs/assets/zig.svg", ZIG);
    project.write("secret.svg", "mine");
    project.succeed(&["build"]);
    let head = fs::read_to_string(project.path(&format!("out/{RECORD}"))).unwrap();
    let head = head.lines().next().unwrap();
    let line = |path: &str, bytes: &[u8]| {
        format!(
            "[\"{path}\",\"specs/a.yaml\",[\"{}\"]]\n",
            blake3::hash(bytes).to_hex()
        )
    };
    let lines = [
        line("../secret.svg", b"mine"),
        line("../specs/assets/zig.svg", ZIG.as_bytes()),
    ];
    project.write(
        &format!("out/{RECORD}"),
        format!("{head}\n{}", lines.concat()),
    );
    project.succeed(&["build", "--prune"]);
    project.write(
        &format!("specs/{RECORD}"),
        format!("{head}\n{}", line("assets/zig.svg", ZIG.as_bytes())),
    );
    project.succeed(&["build", "--out", "specs", "--prune"]);
    assert_eq!(fs::read(project.path("secret.svg")).unwrap(), b"mine");
    assert_eq!(
        fs::read(project.path("specs/assets/zig.svg")).unwrap(),
        ZIG.as_bytes()
    );
}

#[test]
fn an_artifact_never_replaces_what_the_build_reads() {
    let project = Project::empty();
    project.write("specs/assets/zig.svg", ZIG);
    project.write(
        "specs/a.yaml",
        SPEC.replace(
            "  zig.svg: { from: zig }",
            "  assets/zig.svg: { from: zig }",
        ),
    );
    let words = ["`assets/zig.svg` would overwrite a file that this build reads"];
    for arguments in [
        &["build", "specs/a.yaml", "--out", "specs"][..],
        &["build", "specs/a.yaml", "--out", "specs", "--overwrite"],
    ] {
        refused(&project, arguments, 1, &words);
        assert_eq!(
            fs::read(project.path("specs/assets/zig.svg")).unwrap(),
            ZIG.as_bytes()
        );
    }
    // Also where an earlier build has written it.
    let chain = SPEC.replace("assets/zig.svg", "../out/a/zig.svg");
    project.write("specs/a.yaml", SPEC);
    project.succeed(&["build", "specs/a.yaml"]);
    let before = fs::read(project.path("out/a/zig.svg")).unwrap();
    project.write(
        "specs/a.yaml",
        chain.replace("vector: {", "vector: { scale: 2,"),
    );
    let run = project.run(&["build", "specs/a.yaml"]);
    assert_eq!(
        (run.code, fs::read(project.path("out/a/zig.svg")).unwrap()),
        (Some(1), before),
        "{}",
        run.stderr
    );
}

#[test]
fn an_artifact_replaces_a_foreign_file_only_when_told_to() {
    let project = project(&["data/config.json", "page.svg"]);
    project.write("out/a/data/config.json", "mine");
    refused(
        &project,
        &["build"],
        1,
        &["config.json", "no build has written", "--overwrite"],
    );
    assert_eq!(
        fs::read(project.path("out/a/data/config.json")).unwrap(),
        b"mine"
    );
    assert!(
        project.path("out/a/page.svg").exists(),
        "the others are written"
    );
    project.succeed(&["build", "--overwrite"]);
    assert_ne!(
        fs::read(project.path("out/a/data/config.json")).unwrap(),
        b"mine"
    );
    // From now on it is ours, whatever becomes of it.
    project.write("out/a/data/config.json", "edited by hand");
    project.succeed(&["build"]);
}

#[test]
fn what_is_there_with_the_right_bytes_is_taken_over() {
    let project = project(&["page.svg"]);
    project.succeed(&["build"]);
    fs::remove_file(project.path(&format!("out/{RECORD}"))).unwrap();
    project.succeed(&["build"]);
    project.edit("specs/a.yaml", "width: 9", "width: 8");
    project.succeed(&["build"]);
}

#[test]
fn a_trace_replaces_nothing_but_a_trace() {
    let project = project(&["page.svg"]);
    let spec = fs::read(project.path("specs/a.yaml")).unwrap();
    refused(
        &project,
        &["build", "--timings", "specs/a.yaml"],
        2,
        &["specs/a.yaml", "no trace"],
    );
    assert_eq!(fs::read(project.path("specs/a.yaml")).unwrap(), spec);
    assert!(
        !project.path("out").exists(),
        "it is refused before anything is built"
    );
    for _ in 0..2 {
        project.succeed(&["build", "--timings", "trace/t.json"]);
    }
    project.write("empty", "");
    project.succeed(&["build", "--timings", "empty"]);
    #[cfg(unix)]
    {
        let made = std::process::Command::new("mkfifo")
            .arg(project.path("pipe"))
            .status();
        if made.is_ok_and(|status| status.success()) {
            refused(
                &project,
                &["build", "--timings", "pipe"],
                2,
                &["pipe` is a device or a pipe"],
            );
        }
        symlink("trace/t.json", project.path("link")).unwrap();
        refused(
            &project,
            &["build", "--timings", "link"],
            2,
            &["link` is a symbolic link"],
        );
        symlink("/", project.path("root")).unwrap();
        refused(
            &project,
            &["build", "--timings", "root/tmp/fretwork-trace.json"],
            2,
            &["root` is a symbolic link"],
        );
    }
}

#[test]
fn paths_that_are_one_file_elsewhere_are_told() {
    let pairs = [
        ["Page.svg", "page.svg"],
        ["e\u{301}.svg", "\u{e9}.svg"],
        ["A.svg/x.svg", "a.svg"],
    ];
    for pair in pairs {
        let project = project(&pair);
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(1), "{pair:?}: {}", run.stderr);
        assert!(!project.path("out").exists());
    }
    let project = project(&["CON.svg", "console.svg"]);
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stderr.contains("Windows has no file `a/CON.svg`"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains("1 warning\n"), "{}", run.stderr);
}

#[test]
#[cfg(unix)]
fn permissions_follow_the_umask() {
    use std::os::unix::fs::PermissionsExt as _;
    for (mask, file, folder) in [
        ("077", 0o600, 0o700),
        ("002", 0o664, 0o775),
        ("022", 0o644, 0o755),
    ] {
        let project = Project::small();
        let mut command = std::process::Command::new("sh");
        command
            .current_dir(project.path(""))
            .args(["-c", &format!("umask {mask}; exec \"$0\" build")]);
        command.arg(env!("CARGO_BIN_EXE_fretwork"));
        assert_eq!(super::super::project::finish(command).code, Some(0));
        let mode = |path: &str| {
            fs::metadata(project.path(path))
                .unwrap()
                .permissions()
                .mode()
                & 0o777
        };
        assert_eq!(
            (mode("out/spec/zig.svg"), mode("out/spec")),
            (file, folder),
            "{mask}"
        );
        let entry = project
            .files(".fretwork/v3/blobs")
            .into_keys()
            .next()
            .unwrap();
        let blob = mode(&format!(".fretwork/v3/blobs/{entry}"));
        assert_eq!((blob, mode(".fretwork/v3/blobs")), (file, folder), "{mask}");
    }
}
