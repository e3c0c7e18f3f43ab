//! What commands tell of a project: reports, graphs, measures, times, and why something was built.

use std::fs;

use serde_json::{Value, json};

use super::super::project::Project;

use super::{WITH_TEXT, keys, parse};

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
    let measures = measures(&project, "spec/ramp.json");
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
fn explain_names_the_steps_of_shells() {
    let project = Project::of(
        "fretwork: 1
regions:
  tile: { rectangle: { width: 6, height: 6, periodic: true } }
  hole: { circle: { radius: 1.8, at: [3, 3] } }
  net: { difference: [tile, hole] }
exemplars: { holes: { rasterize: { from: net, region: tile, pixel_size: 0.5 } } }
surfaces: { cup: { revolve: { profile: [[8, 0], [8, 20]] } } }
shells: { lamp: { surface: cup, exemplar: holes, voxel: 1, thickness: 2 } }
artifacts: { lamp.json: { from: lamp } }
",
    );
    project.succeed(&["build"]);
    let explain = |node: &str| project.succeed(&["explain", "specs/spec.yaml", node]);
    assert!(explain("lamp").contains("shells.lamp.pattern"));
    for name in ["shells.lamp.pattern", "lamp.pattern"] {
        let text = explain(name);
        assert!(
            text.starts_with("shells.lamp.pattern: evaluated")
                && text.contains("shells.lamp.voxels"),
            "{text}"
        );
    }
    let run = project.run(&["explain", "specs/spec.yaml", "shells.lamp.patern"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("did you mean `shells.lamp.pattern`?"),
        "{}",
        run.stderr
    );
    // No other kind of node has steps.
    let run = project.run(&["explain", "specs/spec.yaml", "surfaces.cup.voxels"]);
    assert!(
        run.stderr.contains("the spec has no node"),
        "{}",
        run.stderr
    );
}

/// The measures in a file, which names its origin beside them.
fn measures(project: &Project, file: &str) -> Value {
    let mut measures = parse(&String::from_utf8_lossy(&project.files("out")[file]));
    let origin = measures.as_object_mut().unwrap().remove("origin");
    assert!(origin.is_some(), "{measures}");
    measures
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
    assert_eq!(measures(&project, "spec/cells.json"), cells);
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
