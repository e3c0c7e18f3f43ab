//! What can be wrong with a revision: that there is none, and that it does not build.

use std::fs;

use super::super::project::{Project, finish};
use super::{SPEC, commit, compared, git, repository, statuses};

#[test]
fn no_repository_no_git_and_no_such_revision_end_with_2() {
    let project = Project::of(SPEC);
    let refused = |project: &Project, arguments: &[&str], said: &str| {
        let run = project.run(&[&["diff"], arguments].concat());
        assert_eq!(run.code, Some(2), "{arguments:?}: {run:?}");
        assert!(run.stderr.contains(said), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stdout, "");
    };
    refused(&project, &["HEAD"], "lies in no git repository");
    let project = repository(SPEC);
    let before = project.files(".");
    for rev in [
        "none",
        "HEAD~7",
        "HEAD..HEAD",
        "",
        "HEAD:specs",
        "^HEAD",
        "a b",
    ] {
        refused(&project, &[rev], &format!("there is no revision `{rev}`"));
        refused(
            &project,
            &["HEAD", rev],
            &format!("there is no revision `{rev}`"),
        );
    }
    refused(
        &project,
        &["--", "--output=x"],
        "there is no revision `--output=x`",
    );
    refused(&project, &["--output=x"], "--output");
    refused(&project, &[], "REV");
    refused(&project, &["HEAD", "HEAD", "HEAD"], "HEAD");
    refused(
        &project,
        &["HEAD", "--only", "none"],
        "no artifact is named or needs `none`",
    );
    refused(
        &project,
        &["HEAD", "--set", "none=3"],
        "no spec has a parameter `none`",
    );
    refused(
        &project,
        &["HEAD", "--spec", "specs/none.yaml"],
        "there is no spec `specs/none.yaml`",
    );
    refused(
        &project,
        &["HEAD", "--spec", "specs/spec.yaml", "--spec", "/"],
        "outside of the project",
    );
    assert!(
        project.files(".").keys().eq(before.keys()),
        "something was written"
    );
    let run = finish({
        let mut command = project.command(&["diff", "HEAD"]);
        command.env("PATH", project.path("nowhere"));
        command
    });
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("`git` is needed"), "{}", run.stderr);
}

#[test]
fn a_shallow_clone_is_told() {
    let project = repository(SPEC);
    project.write("specs/spec.yaml", format!("# A comment.\n{SPEC}"));
    commit(&project);
    let from = format!("file://{}", project.path(".").display());
    let clone = Project::empty();
    git(&clone, &["clone", "-q", "--depth", "1", &from, "clone"]);
    let run = finish({
        let mut command = clone.command(&["diff", "HEAD~1"]);
        command.current_dir(clone.path("clone"));
        command
    });
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(
        run.stderr.contains("the clone is shallow"),
        "{}",
        run.stderr
    );
}

/// One spec that does not parse then is no matter of the others.
#[test]
fn a_spec_that_does_not_build_at_a_revision_is_told_with_its_name() {
    let project = repository(&SPEC.replace("rectangle: { width: 3", "rectangel: { width: 3"));
    project.write("specs/other.yaml", SPEC);
    commit(&project);
    project.write("specs/spec.yaml", SPEC);
    project.edit("specs/other.yaml", "width: 20", "width: 21");
    let run = project.run(&["diff", "HEAD", "--exit-code"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.stderr.contains("at `HEAD`: "), "{}", run.stderr);
    assert!(run.stderr.contains("rectangel") && run.stderr.contains("specs/spec.yaml"));
    let run = project.run(&["report", "--against", "HEAD"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert_eq!(
        run.stderr.matches("at `HEAD`: ").count(),
        1,
        "{}",
        run.stderr
    );
    let found = compared(&project, &["HEAD"]);
    assert_eq!(found["spec/page.svg"]["status"], "failed");
    assert_eq!(found["other/page.svg"]["status"], "changed");
    assert_eq!(found["other/small.dxf"]["status"], "same");
    // The same when the work tree is what does not build; nothing is named then but the place.
    commit(&project);
    project.write("specs/spec.yaml", "fretwork: [");
    let run = project.run(&["diff", "HEAD", "--format", "github"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stdout.starts_with("::error file=specs/spec.yaml"),
        "{}",
        run.stdout
    );
    assert!(!run.stdout.contains("at `HEAD`"));
    assert!(statuses(&project, &["HEAD"]).contains("failed page.svg"));
}

/// A node that fails when it is evaluated keeps its artifacts from being compared, and no others.
#[test]
fn an_artifact_that_fails_is_told_and_others_are_compared() {
    let project = repository(&SPEC.replace(
        "page.svg: { from: page }",
        "page.svg: { from: page, expect: { area: 1 } }",
    ));
    project.write("specs/spec.yaml", SPEC);
    let run = project.run(&["diff", "HEAD"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("at `HEAD`: `area` is 200 mm²"),
        "{}",
        run.stderr
    );
    assert_eq!(statuses(&project, &["HEAD"]), "failed page.svg");
}

#[test]
fn pointers_of_lfs_and_submodules_are_told_for_what_they_are() {
    let drawing = "exemplars:\n  zig: { vector: { file: assets/zig.svg } }\nartifacts:\n  zig.svg: { from: zig }\n";
    let text = SPEC.replace("artifacts:\n", drawing);
    let zig = super::super::project::ZIG;
    let project = repository(SPEC);
    project.write("specs/spec.yaml", &text);
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12345\n";
    project.write("specs/assets/zig.svg", pointer);
    commit(&project);
    project.write("specs/assets/zig.svg", zig);
    let run = project.run(&["diff", "HEAD"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("at `HEAD`: ") && run.stderr.contains("pointer of Git LFS"),
        "{}",
        run.stderr
    );
    let assets = repository("fretwork: 1\n");
    assets.write("zig.svg", zig);
    commit(&assets);
    fs::remove_dir_all(project.path("specs/assets")).unwrap();
    git(&project, &["rm", "-rq", "--cached", "specs/assets"]);
    let from = format!("file://{}", assets.path(".").display());
    git(
        &project,
        &["submodule", "--quiet", "add", &from, "specs/assets"],
    );
    commit(&project);
    let run = project.run(&["diff", "HEAD"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("the submodule `specs/assets`"),
        "{}",
        run.stderr
    );
}

#[test]
#[cfg(unix)]
fn links_are_followed_in_a_revision_as_on_the_disk() {
    let drawing = "exemplars:\n  zig: { vector: { file: assets/link/zig.svg } }\nartifacts:\n  zig.svg: { from: zig }\n";
    let project = Project::of(&SPEC.replace("artifacts:\n", drawing));
    project.write("drawings/zig.svg", super::super::project::ZIG);
    project.write(".gitignore", "/.fretwork\n");
    fs::create_dir_all(project.path("specs/assets")).unwrap();
    std::os::unix::fs::symlink("../../drawings", project.path("specs/assets/link")).unwrap();
    git(&project, &["init", "-q", "-b", "main"]);
    commit(&project);
    assert_eq!(statuses(&project, &["HEAD"]), "");
    fs::remove_file(project.path("specs/assets/link")).unwrap();
    std::os::unix::fs::symlink("../../../drawings", project.path("specs/assets/link")).unwrap();
    commit(&project);
    let run = project.run(&["diff", "HEAD~1", "HEAD"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("at `HEAD`: ") && run.stderr.contains("outside"),
        "{}",
        run.stderr
    );
}
