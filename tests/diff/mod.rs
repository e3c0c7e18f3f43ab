//! Two states of a project compared: what is the same, what differs and how much, in every format and with all that can be wrong.

mod refusals;

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use serde_json::{Value, json};

use super::project::{Project, Run, finish};

pub const SPEC: &str = r#"fretwork: 1
params: { width: 20 }
regions:
  page: { rectangle: { width: "${width}", height: 10 } }
  small: { rectangle: { width: 3, height: 3 } }
fields:
  ramp: { expression: { value: x } }
partitions:
  rows: { stripes: { spacing: 2 } }
solids:
  base: { extrude: { region: page, height: 2 } }
artifacts:
  page.svg: { from: page }
  page.json: { from: page }
  rows.svg: { from: rows, region: page }
  small.dxf: { from: small }
  small.json: { from: small }
  ramp.png: { from: ramp, region: small, width: 16 }
  base.stl: { from: base }
"#;

/// Runs git in the project's folder, which must succeed.
#[track_caller]
pub fn git(project: &Project, arguments: &[&str]) -> String {
    let run = finish({
        let mut command = Command::new("git");
        command
            .args(["-c", "user.name=a", "-c", "user.email=a@example.org"])
            .args([
                "-c",
                "commit.gpgsign=false",
                "-c",
                "protocol.file.allow=always",
            ])
            .args(arguments)
            .current_dir(project.path("."));
        command
    });
    assert_eq!(run.code, Some(0), "{arguments:?}: {}", run.stderr);
    run.stdout
}

/// A project with `text` as its spec, and a commit of it.
pub fn repository(text: &str) -> Project {
    let project = Project::of(text);
    project.write(".gitignore", "/.fretwork\n/out\n");
    git(&project, &["init", "-q", "-b", "main"]);
    commit(&project);
    project
}

/// Commits all that is there.
pub fn commit(project: &Project) {
    git(project, &["add", "-A"]);
    git(project, &["commit", "-q", "-m", "a state"]);
}

/// What `diff` finds, artifact by artifact.
#[track_caller]
pub fn compared(project: &Project, arguments: &[&str]) -> BTreeMap<String, Value> {
    let run = project.run(&[&["diff", "--format", "json"], arguments].concat());
    of_json(&run)
}

#[track_caller]
fn of_json(run: &Run) -> BTreeMap<String, Value> {
    let found: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|e| panic!("{e}: {run:?}"));
    let all = found["artifacts"].as_array().unwrap().iter();
    all.map(|one| (one["path"].as_str().unwrap().to_owned(), one.clone()))
        .collect()
}

/// The paths of each status but `same`, without the folder of the spec.
#[track_caller]
pub fn statuses(project: &Project, arguments: &[&str]) -> String {
    let found = compared(project, arguments);
    let differing = found.iter().filter(|(_, one)| one["status"] != "same");
    let lines = differing.map(|(path, one)| {
        let name = path.strip_prefix("spec/").unwrap_or(path);
        format!("{} {name}", one["status"].as_str().unwrap())
    });
    lines.collect::<Vec<_>>().join(", ")
}

#[test]
fn equal_states_are_the_same() {
    let project = repository(SPEC);
    let found = compared(&project, &["HEAD"]);
    assert_eq!(found.len(), 7);
    assert!(found.values().all(|one| one["status"] == "same"
        && one["geometry"].is_null()
        && one["measures"] == json!({})));
    project.write("specs/spec.yaml", format!("# A comment.\n{SPEC}"));
    assert_eq!(statuses(&project, &["HEAD"]), "");
    commit(&project);
    assert_eq!(statuses(&project, &["HEAD~1", "HEAD", "--exit-code"]), "");
    let said = project.succeed(&["diff", "HEAD~1", "--exit-code"]);
    assert_eq!(said, "HEAD~1 to work tree: 7 same\n");
}

#[test]
fn geometry_and_measures_that_changed_are_told() {
    let project = repository(SPEC);
    project.edit("specs/spec.yaml", "width: 20", "width: 21");
    let found = compared(&project, &["HEAD"]);
    let geometry = |name: &str| found[name]["geometry"].clone();
    assert_eq!(
        geometry("spec/page.svg"),
        json!({ "added": 10.0, "removed": 0.0, "common": 200.0, "unit": "mm2" })
    );
    assert_eq!(
        geometry("spec/base.stl"),
        json!({ "added": 20.0, "removed": 0.0, "common": 400.0, "unit": "mm3" })
    );
    let lines = geometry("spec/rows.svg");
    assert_eq!(lines["unit"], "mm");
    assert!(lines["added"].as_f64() > Some(1.0), "{lines}");
    assert_eq!(
        found["spec/page.svg"]["measures"]["area"],
        json!([200.0, 210.0])
    );
    assert_eq!(
        found["spec/page.json"]["measures"]["bounds"],
        json!([[[0.0, 0.0], [20.0, 10.0]], [[0.0, 0.0], [21.0, 10.0]]])
    );
    assert_eq!(found["spec/page.json"]["status"], "changed");
    for same in ["spec/small.dxf", "spec/small.json", "spec/ramp.png"] {
        assert_eq!(found[same]["status"], "same", "{same}");
    }
    // The other way round what was added is removed.
    commit(&project);
    let back = compared(&project, &["HEAD", "HEAD~1"]);
    let back = &back["spec/page.svg"];
    assert_eq!(
        (&back["geometry"]["removed"], &back["geometry"]["added"]),
        (&json!(10.0), &json!(0.0))
    );
    assert_eq!(back["measures"]["area"], json!([210.0, 200.0]));
}

/// Bytes that are others and geometry that is the same: another look, another way to say it, another beam.
#[test]
fn what_is_only_drawn_anew_is_redrawn() {
    let project = repository(SPEC);
    project.edit(
        "specs/spec.yaml",
        "{ from: page }",
        "{ from: page, stroke: 1, kerf: 0.2 }",
    );
    project.edit(
        "specs/spec.yaml",
        "small.json: { from: small",
        "small.json: { scale: 1, from: small",
    );
    project.edit(
        "specs/spec.yaml",
        "ramp, region: small",
        "ramp, clip: true, region: small",
    );
    assert_eq!(
        statuses(&project, &["HEAD", "--exit-code"]),
        "redrawn page.svg, redrawn ramp.png, redrawn small.json"
    );
    assert_eq!(project.run(&["diff", "HEAD", "--exit-code"]).code, Some(0));
    project.edit("specs/spec.yaml", "value: x", "value: \"x + y\"");
    assert!(statuses(&project, &["HEAD"]).contains("changed ramp.png"));
}

#[test]
fn artifacts_and_specs_come_and_go() {
    let project = repository(SPEC);
    project.edit("specs/spec.yaml", "  page.json: { from: page }\n", "");
    project.edit("specs/spec.yaml", "small.dxf", "tiny.dxf");
    project.write(
        "specs/new.yaml",
        SPEC.replace("  page.json: { from: page }\n", ""),
    );
    let found = compared(&project, &["HEAD"]);
    let status = |name: &str| found[name]["status"].as_str().unwrap();
    assert_eq!(status("spec/page.json"), "removed");
    assert_eq!(
        (status("spec/small.dxf"), status("spec/tiny.dxf")),
        ("removed", "added")
    );
    assert_eq!(status("new/page.svg"), "added");
    assert_eq!(found["spec/small.dxf"]["geometry"]["removed"], 9.0);
    assert_eq!(
        found["new/page.svg"]["geometry"],
        json!({ "added": 200.0, "removed": 0.0, "common": 0.0, "unit": "mm2" })
    );
    assert_eq!(
        found["new/page.svg"]["measures"]["area"],
        json!([null, 200.0])
    );
    commit(&project);
    fs::remove_file(project.path("specs/spec.yaml")).unwrap();
    let run = project.run(&["diff", "HEAD", "--exit-code"]);
    assert_eq!(run.code, Some(3), "{run:?}");
    assert!(run.stdout.contains("6 removed, 6 same"), "{}", run.stdout);
}

#[test]
fn a_part_of_the_project_is_compared() {
    let project = repository(SPEC);
    project.write("specs/deep/other.yaml", SPEC);
    project.edit("specs/spec.yaml", "width: 20", "width: 21");
    assert_eq!(
        compared(&project, &["HEAD", "--spec", "specs/spec.yaml"]).len(),
        7
    );
    let deep = compared(&project, &["HEAD", "--spec", "specs/deep"]);
    assert!(deep.len() == 7 && deep.values().all(|one| one["status"] == "added"));
    let only = compared(
        &project,
        &["HEAD", "--only", "small.json", "--only", "base"],
    );
    let only: Vec<&String> = only.keys().collect();
    assert_eq!(
        only,
        [
            "deep/other/base.stl",
            "deep/other/small.json",
            "spec/base.stl",
            "spec/small.json"
        ]
    );
    // A name of one state alone means what there is in both.
    project.edit(
        "specs/spec.yaml",
        "region: page, height",
        "region: plate, height",
    );
    project.edit(
        "specs/spec.yaml",
        "fields:",
        "  plate: { union: [page] }\nfields:",
    );
    assert_eq!(
        statuses(
            &project,
            &["HEAD", "--only", "plate", "--spec", "specs/spec.yaml"]
        ),
        "changed base.stl"
    );
    assert_eq!(
        statuses(
            &project,
            &[
                "HEAD",
                "--set",
                "width=30",
                "--spec",
                "specs/spec.yaml",
                "--exit-code"
            ]
        ),
        ""
    );
}

#[test]
fn pictures_are_written_where_they_are_asked_for_and_nothing_else_is() {
    let project = repository(SPEC);
    project.edit("specs/spec.yaml", "width: 20", "width: 21");
    let before = project.files(".");
    let run = project.run(&["diff", "HEAD", "--no-cache"]);
    assert_eq!(run.code, Some(0));
    assert!(project.files(".") == before, "something was written");
    let found = compared(&project, &["HEAD", "--out", "pictures"]);
    assert_eq!(
        found["spec/page.svg"]["pictures"],
        json!(["spec/page.svg.diff.svg"])
    );
    let names: Vec<String> = project.files("pictures").into_keys().collect();
    assert_eq!(
        names,
        [
            ".fretwork-diffs",
            "spec/base.stl.diff.glb",
            "spec/base.stl.diff.png",
            "spec/page.svg.diff.svg",
            "spec/rows.svg.diff.svg"
        ]
    );
    let glb = fs::read(project.path("pictures/spec/base.stl.diff.glb")).unwrap();
    let (document, ..) = (gltf::Gltf::from_slice(&glb).unwrap().document,);
    let names: Vec<_> = document
        .nodes()
        .filter_map(|node| node.name().map(str::to_owned))
        .collect();
    assert_eq!(names, ["common", "added"]);
    // What no longer differs has no picture, and a stranger's file stays.
    project.write("pictures/spec/mine.txt", "mine");
    project.edit("specs/spec.yaml", "width: 21", "width: 20");
    project.succeed(&["diff", "HEAD", "--out", "pictures"]);
    let names: Vec<String> = project.files("pictures").into_keys().collect();
    assert_eq!(names, [".fretwork-diffs", "spec/mine.txt"]);
    project.edit("specs/spec.yaml", "width: 20", "width: 22");
    project.write("pictures/spec/page.svg.diff.svg", "mine");
    let run = project.run(&["diff", "HEAD", "--out", "pictures"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("no diff has written"), "{}", run.stderr);
    assert_eq!(
        fs::read(project.path("pictures/spec/page.svg.diff.svg")).unwrap(),
        b"mine"
    );
}

/// What `diff` evaluates stays for builds, and what builds have evaluated it takes; what the last build did is still told.
#[test]
fn the_cache_is_shared() {
    let project = repository(SPEC);
    project.succeed(&["build"]);
    let told = project.succeed(&["explain", "specs/spec.yaml", "base"]);
    project.edit("specs/spec.yaml", "width: 20", "width: 21");
    project.succeed(&["diff", "HEAD"]);
    assert_eq!(
        project.succeed(&["explain", "specs/spec.yaml", "base"]),
        told
    );
    let report: Value =
        serde_json::from_str(&project.succeed(&["build", "--format", "json"])).unwrap();
    let nodes = report["nodes"].as_array().unwrap();
    assert!(
        nodes.iter().all(|node| node["status"] != "evaluated"),
        "{report}"
    );
}

#[test]
fn a_project_below_a_repository_is_compared() {
    let outer = Project::empty();
    outer.write("inner/fretwork.toml", "");
    outer.write("inner/specs/spec.yaml", SPEC);
    outer.write("inner/.gitignore", "/.fretwork\n");
    git(&outer, &["init", "-q", "-b", "main"]);
    commit(&outer);
    outer.edit("inner/specs/spec.yaml", "width: 20", "width: 21");
    let run = finish({
        let mut command = outer.command(&["diff", "HEAD"]);
        command.current_dir(outer.path("inner/specs"));
        command
    });
    assert!(run.stdout.contains("4 changed, 3 same"), "{run:?}");
}

#[test]
fn a_reviewer_on_github_sees_what_a_change_does() {
    let project = repository(SPEC);
    project.edit("specs/spec.yaml", "width: 20", "width: 21");
    let run = finish({
        let mut command = project.command(&["diff", "HEAD", "--format", "github"]);
        command.env("GITHUB_STEP_SUMMARY", project.path("summary.md"));
        command
    });
    assert_eq!(run.code, Some(0), "{run:?}");
    let notice = "::notice file=specs/spec.yaml,title=changed::spec/page.svg +10 mm² -0 mm², 200 mm² in common\n";
    assert!(run.stdout.contains(notice), "{}", run.stdout);
    let summary = fs::read_to_string(project.path("summary.md")).unwrap();
    let line = "| changed | `spec/page.svg` | 10 mm² | 0 mm² | 200 mm² |";
    assert!(
        summary.contains(line) && summary.contains("area 200.0 → 210.0"),
        "{summary}"
    );
}

#[test]
fn the_report_shows_what_differs() {
    let project = repository(SPEC);
    let page = |arguments: &[&str]| {
        project.succeed(&[&["report", "--stable"], arguments].concat());
        fs::read_to_string(project.path("out/report.html")).unwrap()
    };
    assert!(!page(&[]).contains("id=\"changes\""));
    assert!(page(&["--against", "HEAD"]).contains("HEAD to work tree: 7 same"));
    project.edit("specs/spec.yaml", "width: 20", "width: 21");
    let shown = page(&["--against", "HEAD"]);
    for said in [
        "<article data-diff=\"spec/page.svg\" data-status=\"changed\">",
        "+10 mm² -0 mm², 200 mm² in common",
        "<th>area</th><td>200.0 → 210.0</td>",
        "4 changed, 3 same",
        "data-recipe=",
    ] {
        assert!(shown.contains(said), "{said}");
    }
    assert!(!shown.contains("data-diff=\"spec/small.dxf\"") && !shown.contains("<th>origin</th>"));
    assert_eq!(page(&["--against", "HEAD"]), shown);
    assert_eq!(project.run(&["report", "--against", "none"]).code, Some(2));
}
