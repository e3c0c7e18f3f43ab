//! Every command of the binary, run on a small project.

use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::project::{Project, SPEC, finish};

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
    let run = finish({
        let mut command = project.command(&["build", "--deny", "warnings"]);
        command.current_dir(project.path("new"));
        command
    });
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(!project.files("new/out").is_empty());
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
fn the_report_has_the_shape_of_the_language_page() {
    let project = Project::small();
    let report = project.build(&[]).0;
    assert_eq!(keys(&report), ["artifacts", "errors", "nodes", "warnings"]);
    for node in report["nodes"].as_array().unwrap() {
        assert!(
            ["name", "kind", "status", "ms"]
                .iter()
                .all(|key| keys(node).contains(key)),
            "{node}"
        );
        assert!(node["ms"].as_f64().unwrap() >= 0.0);
        assert!(
            ["evaluated", "cached", "reused"].contains(&node["status"].as_str().unwrap()),
            "{node}"
        );
    }
    let files = project.files("out");
    let artifacts = report["artifacts"].as_array().unwrap();
    assert_eq!(artifacts.len(), 5);
    for artifact in artifacts {
        assert_eq!(keys(artifact), ["blake3", "bytes", "path", "status"]);
        let bytes = &files[artifact["path"].as_str().unwrap()];
        assert_eq!(artifact["bytes"], bytes.len());
        assert_eq!(artifact["blake3"], blake3::hash(bytes).to_hex().as_str());
    }
}

#[test]
fn errors_and_warnings_of_the_report_have_places() {
    let project =
        Project::of("fretwork: 1\nregions:\n  pagé: { rectangle: { width: 1, hight: 3 } }\n");
    let run = project.run(&["build", "--format", "json"]);
    assert_eq!(run.code, Some(1));
    let errors = parse(&run.stdout)["errors"].clone();
    let places: Vec<_> = errors
        .as_array()
        .unwrap()
        .iter()
        .map(|e| (&e["file"], &e["line"], &e["column"]))
        .collect();
    assert!(
        places.contains(&(&json!("specs/spec.yaml"), &json!(3), &json!(34))),
        "{errors}"
    );
    let fields = [
        "code",
        "column",
        "end_column",
        "end_line",
        "file",
        "help",
        "line",
        "message",
        "severity",
    ];
    assert_eq!(keys(&errors[0]), fields);
    let error = errors
        .as_array()
        .unwrap()
        .iter()
        .find(|e| e["column"] == 34);
    let error = error.unwrap();
    assert_eq!(
        (&error["end_line"], &error["end_column"]),
        (&json!(3), &json!(39))
    );
    assert_eq!(error["help"], "did you mean `height`?");
    let check = project.run(&["check", "--format", "json"]);
    assert_eq!(
        (check.code, parse(&check.stdout)["errors"].clone()),
        (Some(1), errors)
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
fn warnings_are_repeated_from_the_cache_and_can_be_denied() {
    let project = Project::small();
    project.write("specs/assets/zig.svg", WITH_TEXT);
    let denied = project.run(&["build", "--deny", "warnings"]);
    assert_eq!(denied.code, Some(1));
    assert!(!project.path("out").exists());
    let first = project.build(&["--only", "zig"]);
    let second = project.build(&["--only", "zig"]);
    assert_eq!(second.nodes("evaluated"), [""; 0]);
    assert_eq!(first.0["warnings"], second.0["warnings"]);
    assert_eq!(
        first.0["warnings"].as_array().unwrap().len(),
        1,
        "{}",
        first.0
    );
    assert_eq!(first.0["warnings"][0]["file"], "specs/assets/zig.svg");
    let before = project.files("out");
    assert_eq!(project.run(&["build", "--deny", "warnings"]).code, Some(1));
    assert_eq!(project.files("out"), before);
}

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
fn unused_parameters_are_warned_of() {
    let project = Project::of(
        "fretwork: 1
params: { used: 9, named: a, seeded: 1, idle: 3 }
seed: \"${seeded}\"
regions: { page: { rectangle: { width: \"${used}\", height: 9 } } }
artifacts: { \"${named}.svg\": { from: page } }
",
    );
    let run = project.run(&["check"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stderr
            .contains("no expression uses the parameter `idle`")
    );
    assert_eq!(
        run.stderr.matches("no expression uses").count(),
        1,
        "{}",
        run.stderr
    );
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
fn errors_of_the_report_are_in_the_order_of_their_places() {
    let project = Project::of(
        "fretwork: 1\nregions:\n  b: { circle: {} }\n  a: { nothing: {} }\n  c: { cicle: {} }\n",
    );
    let run = project.run(&["build", "--format", "json"]);
    let lines: Vec<u64> = parse(&run.stdout)["errors"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines, [3, 4, 5]);
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
fn fields_and_curves_are_pictured_and_measured() {
    let project = Project::of(
        "fretwork: 1
regions: { page: { rectangle: { width: 20, height: 10 } } }
fields: { ramp: { expression: { value: x } } }
curves: { rim: { circle: { radius: 5 } } }
artifacts:
  ramp.png: { from: ramp, region: page, width: 64 }
  ramp.json: { from: ramp, region: page }
  rim.png: { from: rim, width: 64 }
",
    );
    project.succeed(&["build"]);
    let files = project.files("out");
    let measures = parse(&String::from_utf8_lossy(&files["spec/ramp.json"]));
    assert!(
        (measures["mean"].as_f64().unwrap() - 10.0).abs() < 1e-9,
        "{measures}"
    );
    assert_eq!(
        parse(&project.succeed(&["inspect", "specs/spec.yaml", "ramp", "--format", "json"])),
        measures
    );
    assert!(
        files["spec/ramp.png"].starts_with(b"\x89PNG")
            && files["spec/rim.png"].starts_with(b"\x89PNG")
    );
    project.edit(
        "specs/spec.yaml",
        "from: ramp, region: page, width",
        "from: ramp, width",
    );
    assert!(project.run(&["build"]).stderr.contains("names no region"));
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
fn explain_names_files_that_scripts_load() {
    let project = Project::of(
        "fretwork: 1
regions: { page: { rectangle: { width: 9, height: 9 } } }
arrangements: { a: { script: { file: m.star, entry: whole } } }
artifacts: { a.svg: { from: a, region: page } }
",
    );
    project.write(
        "specs/m.star",
        "load(\"h.star\", \"factor\")\ndef whole():\n  return lambda f: scale(contour(f), factor)\n",
    );
    project.write("specs/h.star", "factor = 0.5\n");
    project.succeed(&["build"]);
    project.edit("specs/h.star", "0.5", "0.75");
    project.succeed(&["build"]);
    let text = project.succeed(&["explain", "specs/spec.yaml", "a"]);
    assert!(text.contains("file specs/h.star changed"), "{text}");
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

#[test]
fn timings_are_a_chrome_trace() {
    let project = Project::small();
    project.succeed(&["build", "--timings", "trace/t.json"]);
    let trace = parse(&fs::read_to_string(project.path("trace/t.json")).unwrap());
    let events = trace["traceEvents"].as_array().unwrap();
    assert!(
        events.iter().any(|e| e["name"] == "partitions.cells"),
        "{trace}"
    );
    for event in events {
        assert_eq!((&event["ph"], &event["pid"]), (&json!("X"), &json!(1)));
        assert!(
            event["ts"].is_u64() && event["dur"].is_u64() && event["tid"].is_u64(),
            "{event}"
        );
        assert!(event["name"].is_string() && event["cat"].is_string());
    }
    let run = project.run(&["build", "--timings", "fretwork.toml/t.json"]);
    assert!(
        run.code != Some(0) && run.stderr.contains("fretwork.toml/t.json"),
        "{}",
        run.stderr
    );
}

#[test]
fn the_graph_is_printed_in_three_formats() {
    let project = Project::small();
    let dot = project.succeed(&["graph", "specs/spec.yaml"]);
    assert!(
        dot.starts_with("digraph") && dot.contains("\"regions.page\" -> \"regions.plate\";"),
        "{dot}"
    );
    assert_eq!(dot.matches('{').count(), dot.matches('}').count());
    let mermaid = project.succeed(&["graph", "specs/spec.yaml", "--format", "mermaid"]);
    assert!(
        mermaid.starts_with("flowchart LR\n")
            && mermaid.matches(" --> ").count() == dot.matches(" -> ").count()
    );
    let json = parse(&project.succeed(&["graph", "specs/spec.yaml", "--format", "json"]));
    assert_eq!(
        json["edges"].as_array().unwrap().len(),
        dot.matches(" -> ").count()
    );
    assert_eq!(json["nodes"].as_array().unwrap().len(), 11);
    let rows = json!({ "section": "partitions", "name": "rows", "kind": "stripes", "type": "arrangement" });
    assert!(json["nodes"].as_array().unwrap().contains(&rows), "{json}");
    project.edit("specs/spec.yaml", "[page, hole]", "[page, holl]");
    let run = project.run(&["graph", "specs/spec.yaml"]);
    assert_eq!((run.code, run.stdout), (Some(1), String::new()));
}

#[test]
fn explain_names_the_input_that_changed() {
    let project = Project::small();
    let explain = |node: &str| project.succeed(&["explain", "specs/spec.yaml", node]);
    let run = project.run(&["explain", "specs/spec.yaml", "plate"]);
    assert_eq!(run.code, Some(1));
    assert!(run.stderr.contains("has not been built"), "{}", run.stderr);
    project.succeed(&["build"]);
    assert!(
        explain("plate")
            .contains("regions.plate: evaluated, because it was not part of the build before")
    );
    project.succeed(&["build"]);
    assert!(
        explain("plate").contains(
            "regions.plate: taken from the cache: nothing that it depends on has changed"
        )
    );
    project.edit("specs/spec.yaml", "radius: 10", "radius: 11");
    project.succeed(&["build"]);
    let text = explain("regions.plate");
    assert!(
        text.contains("regions.plate: evaluated, because regions.hole changed\n"),
        "{text}"
    );
    assert!(
        text.lines()
            .any(|l| l.contains("regions.hole") && l.contains("changed, was")),
        "{text}"
    );
    assert!(explain("hole").contains("evaluated, because definition changed"));
    project.write("specs/assets/zig.svg", WITH_TEXT);
    project.succeed(&["build"]);
    assert!(
        explain("exemplars.zig").contains("evaluated, because file specs/assets/zig.svg changed")
    );
    let json = parse(&project.succeed(&["explain", "specs/spec.yaml", "rows", "--format", "json"]));
    assert_eq!(json[0]["job"], "partitions.rows on regions.plate", "{json}");
    let run = project.run(&["explain", "specs/spec.yaml", "plat"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("did you mean `plate`?"),
        "{}",
        run.stderr
    );
}

#[test]
fn inspect_measures_any_node() {
    let project = Project::small();
    let json = |node: &str| {
        parse(&project.succeed(&["inspect", "specs/spec.yaml", node, "--format", "json"]))
    };
    let page = json("page");
    assert_eq!(
        (&page["area"], &page["components"], &page["holes"]),
        (&json!(3600.0), &json!(1), &json!(0))
    );
    let cells = json("cells");
    for key in ["vertices", "edges", "faces", "components", "length", "area"] {
        assert!(cells[key].is_number(), "{cells}");
    }
    project.succeed(&["build"]);
    assert_eq!(
        parse(&String::from_utf8_lossy(
            &project.files("out")["spec/cells.json"]
        )),
        cells
    );
    let human = project.succeed(&["inspect", "specs/spec.yaml", "page"]);
    assert!(
        human
            .lines()
            .any(|line| line.split_whitespace().eq(["area", "3600", "mm²"])),
        "{human}"
    );
    let on = project.succeed(&[
        "inspect",
        "specs/spec.yaml",
        "rows",
        "--region",
        "page",
        "--format",
        "json",
    ]);
    assert_ne!(
        parse(&on)["length"],
        json("rows")["length"],
        "the plate has a hole"
    );
    for (arguments, message) in [
        (&["pgae"][..], "did you mean `page`?"),
        (&["rows", "--region", "pgae"], "did you mean `page`?"),
        (&["rows", "--region", "cells"], "no "),
    ] {
        let run = project.run(&[&["inspect", "specs/spec.yaml"], arguments].concat());
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
}

#[test]
fn params_lists_what_a_caller_may_set() {
    let project = Project::small();
    let text = project.succeed(&["params", "specs/spec.yaml"]);
    assert!(
        text.contains(
            "spacing = 8 mm  (length, at least 2 mm, at most 20 mm)\n    between lines\n"
        ),
        "{text}"
    );
    let set = project.succeed(&["params", "specs/spec.yaml", "--set", "spacing=1cm"]);
    assert!(
        set.contains("spacing = 10 mm  (length, default 8 mm, at least"),
        "{set}"
    );
    let json = parse(&project.succeed(&["params", "specs/spec.yaml", "--format", "json"]));
    assert_eq!(
        (&json[1]["name"], &json[1]["default"], &json[1]["max"]),
        (&json!("spacing"), &json!(8), &json!(20))
    );
}

#[test]
fn schema_is_a_json_schema() {
    let schema = parse(&Project::empty().succeed(&["schema"]));
    assert!(
        schema["$schema"]
            .as_str()
            .unwrap()
            .contains("json-schema.org")
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
        let run = super::project::wait(child);
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
    let run = super::project::wait(child);
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
            super::project::ZIG.replace("L3 0", "L3 1"),
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
