//! Every command of the binary, run on a small project: what is built, and what is wrong with a command line.

mod reports;
mod surroundings;

use std::fs;

use serde_json::{Value, json};

use super::project::{Project, finish};

fn parse(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// The keys of an object, sorted.
fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<&str> = value
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    keys.sort_unstable();
    keys
}

#[test]
fn init_makes_a_project_that_builds() {
    let project = Project::empty();
    project.succeed(&["init", "new"]);
    for template in ["print", "laser", "texture", "facade", "band"] {
        project.succeed(&["init", template, "--template", template]);
    }
    for folder in ["new", "print", "laser", "texture", "facade", "band"] {
        let run = finish({
            let mut command = project.command(&["build", "--deny", "warnings"]);
            command.current_dir(project.path(folder));
            command
        });
        assert_eq!(run.code, Some(0), "{folder}: {}", run.stderr);
        let files = project.files(&format!("{folder}/out"));
        let has_picture = files.keys().any(|name| name.ends_with(".png"));
        assert!(
            has_picture && files.len() > 1,
            "{folder}: {files:?}",
            files = files.keys()
        );
    }
    let again = project.run(&["init", "new"]);
    assert_eq!(
        (again.code, again.stderr.contains("not empty")),
        (Some(2), true)
    );
}

#[test]
fn a_wrong_command_line_ends_with_2_and_builds_nothing() {
    let project = Project::small();
    for arguments in [
        &[][..],
        &["biuld"],
        &["build", "--bogus"],
        &["build", "--jobs", "0"],
        &["build", "--jobs", "many"],
        &["build", "--set", "size"],
        &["build", "--set", "=3"],
        &["build", "--format", "xml"],
        &["build", "--deny", "errors"],
        &["build", "--prune", "--locked"],
        &["build", "--prune", "--only", "rows"],
        &["build", "specs/none.yaml"],
        &["build", "/"],
        &["graph"],
        &["graph", "specs/spec.yaml", "--format", "svg"],
        &["explain", "specs/spec.yaml"],
        &["inspect", "specs/spec.yaml"],
        &["cache"],
        &["completions", "csh"],
        &["help", "build"],
    ] {
        let run = project.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stdout, "", "{arguments:?}");
        assert!(!run.stderr.is_empty(), "{arguments:?}");
    }
    assert!(!project.path("out").exists());
    assert!(
        project.run(&["biuld"]).stderr.contains("build"),
        "the nearest command is named"
    );
}

#[test]
fn help_and_version_are_results() {
    let project = Project::empty();
    assert!(project.succeed(&["--help"]).contains("build"));
    assert!(project.succeed(&["build", "--help"]).contains("--jobs"));
    assert!(project.succeed(&["--version"]).starts_with("fretwork "));
}

#[test]
fn a_project_without_specs_is_told_what_to_do() {
    let run = Project::empty().run(&["build"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("fretwork init"), "{}", run.stderr);
}

#[test]
fn a_spec_without_artifacts_is_checked_and_not_built() {
    let project =
        Project::of("fretwork: 1\nregions:\n  page: { rectangle: { width: 3, height: 3 } }\n");
    let report = project.build(&[]);
    assert_eq!(
        report.0,
        json!({ "nodes": [], "artifacts": [], "errors": [], "warnings": [] })
    );
}

#[test]
fn check_finds_what_needs_no_synthesis_and_writes_nothing() {
    let project = Project::small();
    assert_eq!(project.succeed(&["check"]), "1 spec checked\n");
    project.edit("specs/spec.yaml", "assets/zig.svg", "assets/zag.svg");
    let run = project.run(&["check"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("specs/spec.yaml:12:26"),
        "{}",
        run.stderr
    );
    assert!(!project.path("out").exists() && !project.path(".fretwork").exists());
}

#[test]
fn a_failing_node_leaves_alone_what_needs_it_and_the_others_are_built() {
    let project = Project::small();
    project.write("out/spec/zig.svg", "old");
    project.write("specs/assets/zig.svg", "<svg><path d='M0'");
    let run = project.run(&["build", "--format", "json"]);
    assert_eq!(run.code, Some(1));
    let report = parse(&run.stdout);
    assert_eq!(report["errors"].as_array().unwrap().len(), 1, "{report}");
    assert_eq!(report["errors"][0]["file"], "specs/assets/zig.svg");
    assert_eq!(report["artifacts"].as_array().unwrap().len(), 4);
    let names: Vec<&Value> = report["nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| &n["name"])
        .collect();
    assert!(
        names.contains(&&json!("zig")) && !names.contains(&&json!("zig.svg")),
        "{names:?}"
    );
    let files = project.files("out");
    assert_eq!((files.len(), &*files["spec/zig.svg"]), (5, &b"old"[..]));
}

#[test]
fn set_changes_parameters_and_says_what_is_wrong_with_them() {
    let project = Project::small();
    let inspect = |set: &str| {
        parse(&project.succeed(&[
            "inspect",
            "specs/spec.yaml",
            "page",
            "--format",
            "json",
            "--set",
            set,
        ]))
    };
    assert_eq!(inspect("size=30")["area"], 900.0);
    assert_eq!(inspect(" size = 10 ")["area"], 100.0);
    for (set, messages) in [
        (
            "spacng=4",
            &["no parameter `spacng`", "did you mean `spacing`?"][..],
        ),
        (
            "spacing=50",
            &["parameter `spacing`", "20", "specs/spec.yaml:5:3"],
        ),
        ("spacing=wide", &["parameter `spacing`", "wide"]),
        ("spacing=", &["parameter `spacing`"]),
        ("spacing=NaN", &["parameter `spacing`"]),
        ("spacing=4kg", &["parameter `spacing`", "kg"]),
        ("half=4", &["no parameter `half`"]),
        ("size=-4", &["specs/spec.yaml:8:"]),
    ] {
        let run = project.run(&["build", "--set", set]);
        assert_eq!(run.code, Some(1), "{set}: {}", run.stderr);
        for message in messages {
            assert!(run.stderr.contains(message), "{set}: {}", run.stderr);
        }
    }
    assert!(!project.path("out").exists());
    assert_eq!(inspect("spacing=0.2in")["area"], 3600.0);
}

#[test]
fn only_builds_the_artifacts_that_are_meant() {
    let project = Project::small();
    assert_eq!(
        project.build(&["--only", "zig.svg"]).artifacts("written"),
        ["spec/zig.svg"]
    );
    assert_eq!(
        project
            .build(&["--only", "spec/plate.svg"])
            .artifacts("written"),
        ["spec/plate.svg"]
    );
    assert_eq!(
        project.build(&["--only", "cells"]).artifacts("written"),
        ["spec/cells.dxf", "spec/cells.json"]
    );
    let of_plate = project.build(&["--only", "regions.plate", "--only", "zig"]);
    assert_eq!(
        of_plate.artifacts("unchanged"),
        ["spec/plate.svg", "spec/zig.svg"]
    );
    assert_eq!(of_plate.artifacts("written"), ["spec/rows.svg"]);
    let run = project.run(&["build", "--only", "cels"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("did you mean `cells`?"),
        "{}",
        run.stderr
    );
}

#[test]
fn artifacts_of_two_specs_may_not_share_a_file() {
    let project = Project::empty();
    let spec = |path: &str| {
        format!(
            "fretwork: 1\nregions:\n  page: {{ circle: {{ radius: 3 }} }}\nartifacts:\n  {path}: {{ from: page }}\n"
        )
    };
    project.write("specs/a.yaml", spec("b/c.svg"));
    project.write("specs/a/b.yaml", spec("c.svg"));
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr
            .contains("two artifacts have the path `a/b/c.svg`"),
        "{}",
        run.stderr
    );
    project.write("specs/a/b.yaml", spec("c.svg/d.svg"));
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr
            .contains("`a/b/c.svg` is the path of an artifact, and a folder of another"),
        "{}",
        run.stderr
    );
}

/// A drawing with a text, which is not read, beside a line.
const WITH_TEXT: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><text>a</text><path d='M0 0 L9 9' stroke='black' fill='none'/></svg>";

#[test]
fn folders_stand_for_their_specs_and_locks_of_editors_are_none() {
    let project = Project::small();
    let text = fs::read(project.path("specs/spec.yaml")).unwrap();
    project.write("specs/more/other.yaml", "fretwork: 1\n");
    for name in ["specs/.#spec.yaml", "specs/._spec.yaml", "specs/spec.yaml~"] {
        project.write(name, "no spec: [");
    }
    assert_eq!(project.succeed(&["check"]), "2 specs checked\n");
    assert_eq!(
        project.succeed(&["check", "specs/more"]),
        "1 spec checked\n"
    );
    assert_eq!(project.succeed(&["check", "specs"]), "2 specs checked\n");
    assert_eq!(project.run(&["params", "specs"]).code, Some(2));
    assert_eq!(fs::read(project.path("specs/spec.yaml")).unwrap(), text);
}

#[test]
fn values_of_parameters_are_set_for_params_graph_and_explain() {
    let project = Project::of(
        "fretwork: 1
params: { size: { default: 9, max: 10 } }
regions: { page: { rectangle: { width: \"${size}\", height: 9 } } }
artifacts: { a.svg: { from: page } }
",
    );
    project.succeed(&["build"]);
    for command in [
        &["params", "specs/spec.yaml"][..],
        &["graph", "specs/spec.yaml"],
        &["explain", "specs/spec.yaml", "page"],
    ] {
        let set = |value| [command, &["--set", value]].concat();
        project.succeed(&set("size=8"));
        let run = project.run(&set("size=12"));
        assert_eq!(run.code, Some(1), "{command:?}");
        assert!(
            run.stderr.contains("above the greatest value"),
            "{}",
            run.stderr
        );
    }
}

#[test]
fn text_stays_as_it_is_written() {
    for text in [
        "0510210600",
        "007",
        "1.50",
        "1e3",
        "0x1F",
        "+49",
        "-0",
        ".5",
        "1.0",
        "True",
    ] {
        let project = Project::of(&format!(
            "fretwork: 1
params: {{ part: {{ default: {text}, type: text }} }}
regions: {{ page: {{ rectangle: {{ width: 9, height: 9 }} }} }}
artifacts: {{ \"plate-${{part}}.svg\": {{ from: page }} }}
"
        ));
        project.succeed(&["build"]);
        let file = format!("out/spec/plate-{text}.svg");
        assert!(
            project.path(&file).exists(),
            "{text}: {:?}",
            project.files("out").keys()
        );
    }
}

#[test]
fn fields_of_an_artifact_that_do_nothing_are_told() {
    let project = Project::of(
        "fretwork: 1
solids: { ball: { sphere: { radius: 3 } } }
regions: { page: { rectangle: { width: 9, height: 9 } } }
artifacts:
  a.stl: { from: ball, kerf: 1, thickness: 2 }
  a.svg: { from: page, width: 9, kerf: 0.1 }
",
    );
    let warnings: Vec<String> = project.build(&[]).0["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|w| format!("{}:{} {}", w["line"], w["column"], w["message"]))
        .collect();
    assert_eq!(
        warnings,
        [
            "5:24 \"`kerf` has no effect in `spec/a.stl`\"",
            "6:24 \"`width` has no effect in `spec/a.svg`\"",
        ]
    );
}

#[test]
fn what_is_too_large_for_a_file_is_refused_in_every_format() {
    for format in ["svg", "dxf", "png"] {
        let project = Project::of(&format!(
            "fretwork: 1\nregions: {{ r: {{ circle: {{ radius: 1e15 }} }} }}\nartifacts:\n  a.{format}: {{ from: r }}\n"
        ));
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(1));
        assert!(run.stderr.contains("too far out"), "{}", run.stderr);
    }
}

#[test]
fn settings_go_to_the_specs_that_have_them() {
    let project = Project::empty();
    for (name, param) in [("a", "wrist"), ("b", "ankle")] {
        let spec = format!(
            "fretwork: 1\nparams: {{ {param}: 3 }}\nregions: {{ r: {{ circle: {{ radius: \"${{{param}}}\" }} }} }}\n\
             artifacts: {{ r.json: {{ from: r }} }}\n"
        );
        project.write(&format!("specs/{name}.yaml"), spec);
    }
    project.succeed(&["build"]);
    let before = project.files("out");
    project.succeed(&["build", "--set", "wrist=5"]);
    let after = project.files("out");
    assert_ne!(after["a/r.json"], before["a/r.json"]);
    assert_eq!(after["b/r.json"], before["b/r.json"]);
    let run = project.run(&["build", "--set", "wrst=5"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("no spec has a parameter `wrst`") && run.stderr.contains("`wrist`"),
        "{}",
        run.stderr
    );
}

#[test]
fn tolerances_finer_than_anything_are_refused() {
    let project = Project::small();
    project.edit(
        "specs/spec.yaml",
        "{ file: assets/zig.svg }",
        "{ file: assets/zig.svg, tolerance: 1e-300 }",
    );
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("finer than anything can be made"),
        "{}",
        run.stderr
    );
}
