//! What the binary says about projects that are wrong: every folder in `bad/` is the `specs/`
//! folder of one, and its snapshot is what `fretwork build` prints to standard error.

use std::fs;
use std::path::Path;

use expect_test::expect;

use super::project::{Project, Run, ZIG, copy};

/// Builds `specs/spec.yaml` of a project that has artifacts of an earlier build, and checks what
/// holds for every mistake: exit code 1, nothing is written, and there is a place to look at.
#[track_caller]
fn build(project: &Project) -> Run {
    project.write("out/spec/a.svg", "an earlier artifact");
    project.write(
        "out/spec/older.svg",
        "an artifact that the spec no longer names",
    );
    let before = project.files("out");
    let run = project.run(&["build", "specs/spec.yaml", "--prune"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert_eq!(project.files("out"), before);
    run
}

/// The places named in `text`, as `file:line:column`.
fn places(text: &str) -> usize {
    let is_number = |part: Option<&str>| {
        part.is_some_and(|p| !p.is_empty() && p.bytes().all(|b| b.is_ascii_digit()))
    };
    let is_place = |inner: &&str| {
        let mut parts = inner.rsplit(':');
        is_number(parts.next())
            && is_number(parts.next())
            && parts.next().is_some_and(|file| !file.is_empty())
    };
    text.split('[')
        .filter_map(|rest| rest.split_once(']').map(|(inner, _)| inner))
        .filter(is_place)
        .count()
}

fn settings() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}

#[test]
fn every_mistake_is_shown_at_its_place() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut names: Vec<String> = fs::read_dir(&cases)
        .unwrap()
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert!(
        names.len() > 10,
        "the cases are not where they are looked for"
    );
    settings().bind(|| {
        for name in names {
            let project = Project::empty();
            copy(&cases.join(&name), &project.path("specs"));
            let run = build(&project);
            assert!(
                run.stdout.is_empty() || run.stdout.starts_with("0 written"),
                "{name}: {}",
                run.stdout
            );
            assert!(
                places(&run.stderr) > 0,
                "{name} has no place:\n{}",
                run.stderr
            );
            insta::assert_snapshot!(format!("mistake_{name}"), run.stderr);
        }
    });
}

/// Mistakes in one file, whose explanations are compared beside the reader of specs.
#[test]
fn every_mistake_in_one_file_ends_the_build() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    for entry in fs::read_dir(cases).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            let project = Project::empty();
            project.write("specs/spec.yaml", fs::read(&path).unwrap());
            let run = build(&project);
            assert!(
                places(&run.stderr) > 0 || run.stderr.contains("[specs/spec.yaml]"),
                "{path:?}\n{}",
                run.stderr
            );
        }
    }
}

/// Builds a project whose mistake cannot be kept in a folder, and compares what is said.
#[track_caller]
fn check(project: &Project, expected: &expect_test::Expect) {
    expected.assert_eq(&build(project).stderr);
}

/// A spec that draws `assets/zig.svg`.
const DRAWS: &str = "fretwork: 1
exemplars:
  zig: { vector: { file: assets/zig.svg } }
artifacts:
  a.svg: { from: zig }
";

#[test]
#[cfg(unix)]
fn a_link_out_of_the_project_is_not_followed() {
    let outside = tempfile::tempdir().unwrap();
    fs::write(outside.path().join("zig.svg"), ZIG).unwrap();
    let project = Project::of(DRAWS);
    std::os::unix::fs::symlink(outside.path(), project.path("specs/assets")).unwrap();
    check(
        &project,
        &expect![[r#"
          × `assets/zig.svg` leaves the project root
           ╭─[specs/spec.yaml:3:26]
         2 │ exemplars:
         3 │   zig: { vector: { file: assets/zig.svg } }
           ·                          ───────┬──────
           ·                                 ╰── outside
         4 │ artifacts:
           ╰────
          help: the root is the nearest folder with `.git` or `fretwork.toml`; move the file into it and
                name it with a relative path

        1 error
    "#]],
    );
    fs::remove_file(project.path("specs/assets")).unwrap();
    project.write("drawings/zig.svg", ZIG);
    std::os::unix::fs::symlink("../drawings", project.path("specs/assets")).unwrap();
    project.succeed(&["build", "--overwrite"]);
}

#[test]
fn a_file_over_the_limit_is_not_read() {
    let project = Project::of(DRAWS);
    project.write("specs/assets/zig.svg", "");
    fs::File::options()
        .write(true)
        .open(project.path("specs/assets/zig.svg"))
        .unwrap()
        .set_len(1 << 31)
        .unwrap();
    check(
        &project,
        &expect![[r#"
          × cannot read `assets/zig.svg`: it is larger than 1024 MiB
           ╭─[specs/spec.yaml:3:26]
         2 │ exemplars:
         3 │   zig: { vector: { file: assets/zig.svg } }
           ·                          ───────┬──────
           ·                                 ╰── this file
         4 │ artifacts:
           ╰────

        1 error
    "#]],
    );
    project.write("specs/assets/zig.svg", ZIG);
    project.write("specs/large.yaml", "");
    fs::File::options()
        .write(true)
        .open(project.path("specs/large.yaml"))
        .unwrap()
        .set_len(1 << 31)
        .unwrap();
    project.write(
        "specs/spec.yaml",
        DRAWS.replace("fretwork: 1", "fretwork: 1\ninclude: [large.yaml]"),
    );
    check(
        &project,
        &expect![[r#"
          × cannot read `large.yaml`: it is larger than 1024 MiB
           ╭─[specs/spec.yaml:2:11]
         1 │ fretwork: 1
         2 │ include: [large.yaml]
           ·           ─────┬────
           ·                ╰── this file
         3 │ exemplars:
           ╰────

        1 error
    "#]],
    );
}

#[test]
#[cfg(unix)]
fn a_pipe_is_no_file() {
    let project = Project::of(DRAWS);
    fs::create_dir(project.path("specs/assets")).unwrap();
    let made = std::process::Command::new("mkfifo")
        .arg(project.path("specs/assets/zig.svg"))
        .status();
    if made.is_ok_and(|status| status.success()) {
        check(
            &project,
            &expect![[r#"
              × cannot read `assets/zig.svg`: it is not a file
               ╭─[specs/spec.yaml:3:26]
             2 │ exemplars:
             3 │   zig: { vector: { file: assets/zig.svg } }
               ·                          ───────┬──────
               ·                                 ╰── this file
             4 │ artifacts:
               ╰────

            1 error
        "#]],
        );
    }
}

#[test]
fn a_drawing_of_deeply_nested_groups_is_no_crash() {
    let project = Project::of(DRAWS);
    let (open, close) = ("<g>".repeat(100_000), "</g>".repeat(100_000));
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg'>{open}<path d='M0 0 L1 1' stroke='red'/>{close}</svg>"
    );
    project.write("specs/assets/zig.svg", svg);
    let run = project.run(&["build"]);
    assert!(matches!(run.code, Some(0 | 1)), "{}", run.stderr);
}

#[test]
fn errors_of_several_specs_are_reported_together() {
    let project = Project::of("fretwork: 1\nregions:\n  a: { circle: { radius: 0 } }\n");
    project.write("specs/other.yaml", "fretwork: 2\n");
    project.write(
        "specs/deep/third.yml",
        "fretwork: 1\nregions:\n  a: { inset: { from: b, by: 1 } }\n",
    );
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1));
    expect![[r#"
          × there is no region or cutout `b`
           ╭─[specs/deep/third.yml:3:23]
         2 │ regions:
         3 │   a: { inset: { from: b, by: 1 } }
           ·                       ┬
           ·                       ╰── not defined
           ╰────
          help: known are: a

          × this fretwork reads version 1 of the language, not 2
           ╭─[specs/other.yaml:1:11]
         1 │ fretwork: 2
           ·           ─
           ╰────

          × expected a length above 0, found the number 0
           ╭─[specs/spec.yaml:3:26]
         2 │ regions:
         3 │   a: { circle: { radius: 0 } }
           ·                          ─
           ╰────

        3 errors
    "#]]
    .assert_eq(&run.stderr);
}

#[test]
fn an_error_of_a_good_spec_beside_a_bad_one_builds_nothing() {
    let project = Project::small();
    project.write("specs/bad.yaml", "fretwork: 1\nregion: {}\n");
    assert_eq!(project.run(&["build"]).code, Some(1));
    assert!(!project.path("out").exists());
    project.succeed(&["build", "specs/spec.yaml"]);
}
