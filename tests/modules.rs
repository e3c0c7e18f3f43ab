//! Files as modules of others: their names, their params, and what is told of them.

use super::project::Project;

const BOX: &str = "fretwork: 1
params:
  width: { default: 30, type: length, min: 5 }
  holes: 2
let: { half: \"${width / 2}\" }
regions:
  panel: { rectangle: { width: \"${width}\", height: \"${half}\" } }
  hole: { circle: { radius: 2, at: [5, 5], repeat: { count: \"${holes}\", step: [10, 0] } } }
  side: { difference: [panel, hole] }
artifacts:
  side.svg: { from: side }
";

const SPEC: &str = "fretwork: 1
params: { wide: 40 }
use:
  - { box: parts/box.yaml, with: { width: \"${wide}\" } }
  - { lid: parts/box.yaml }
regions:
  panel: { rectangle: { width: 7, height: 7 } }
  both: { union: [box.side, shifted] }
  shifted: { inset: { from: lid.panel, by: 1 } }
artifacts:
  both.json: { from: both }
  box.json: { from: box.side }
  lid.json: { from: regions.lid.side }
";

fn project() -> Project {
    let project = Project::of(SPEC);
    project.write("specs/parts/box.yaml", BOX);
    project
}

fn area(project: &Project, node: &str) -> f64 {
    let json = project.succeed(&["inspect", "specs/spec.yaml", node, "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    json["area"].as_f64().unwrap()
}

#[test]
fn a_module_has_names_and_params_of_its_own() {
    let project = project();
    let report = project.build(&["specs/spec.yaml"]);
    let mut written = report.artifacts("written");
    written.sort();
    assert_eq!(written.len(), 3, "{written:?}");
    assert_eq!(area(&project, "panel"), 49.0);
    assert_eq!(area(&project, "box.panel"), 800.0);
    assert_eq!(area(&project, "lid.panel"), 450.0);
    let run = project.succeed(&["params", "specs/spec.yaml"]);
    assert!(run.contains("wide") && !run.contains("width"), "{run}");
    project.succeed(&["build", "specs/spec.yaml", "--set", "wide=20"]);
    // The module is a spec too.
    project.succeed(&["build", "specs/parts/box.yaml", "--set", "width=60"]);
    let spec = project.run(&["build", "specs/spec.yaml", "--set", "width=60"]);
    assert!(
        spec.stderr.contains("no parameter `width`"),
        "{}",
        spec.stderr
    );
}

#[test]
fn an_edit_of_a_module_evaluates_what_depends_on_it() {
    let project = project();
    project.build(&["specs/spec.yaml"]);
    // What `both` shows lies over the holes, and comes out as before.
    project.edit("specs/parts/box.yaml", "radius: 2", "radius: 3");
    let report = project.build(&["specs/spec.yaml"]);
    let mut evaluated = report.nodes("evaluated");
    evaluated.sort();
    assert_eq!(
        evaluated,
        [
            "artifacts.box.json",
            "artifacts.lid.json",
            "regions.both",
            "regions.box.hole",
            "regions.box.side",
            "regions.lid.hole",
            "regions.lid.side"
        ]
    );
    // Values for one module are none of the other's business.
    project.edit("specs/spec.yaml", "wide: 40", "wide: 50");
    let report = project.build(&["specs/spec.yaml"]);
    let evaluated = report.nodes("evaluated");
    assert!(
        evaluated.iter().all(|name| !name.contains("lid")),
        "{evaluated:?}"
    );
    assert!(
        evaluated.iter().any(|name| name == "regions.box.panel"),
        "{evaluated:?}"
    );
}

#[test]
fn modules_have_modules() {
    let project = project();
    project.write(
        "specs/parts/chest.yaml",
        "fretwork: 1
params: { size: 10 }
use: { drawer: box.yaml, with: { width: \"${2 * size}\" } }
regions:
  front: { inset: { from: drawer.panel, by: 0 } }
",
    );
    project.write(
        "specs/spec.yaml",
        "fretwork: 1
use: { chest: parts/chest.yaml, with: { size: 25 } }
artifacts:
  front.json: { from: chest.front, expect: { area: 1250 } }
  deep.json: { from: chest.drawer.panel, expect: { area: 1250 } }
",
    );
    project.succeed(&["build", "specs/spec.yaml"]);
}

#[test]
fn what_is_wrong_with_a_module_is_told_where_it_is_and_through_which_use() {
    let cases: [(&str, &str, &str, &[&str]); 9] = [
        (
            "parts/box.yaml",
            "radius: 2",
            "radius: -2",
            &[
                "specs/parts/box.yaml:8:29",
                "used as `box` here",
                "specs/spec.yaml:4",
            ],
        ),
        (
            "parts/box.yaml",
            "[panel, hole]",
            "[panel, whole]",
            &[
                "`box.whole`",
                "specs/parts/box.yaml:9",
                "used as `box` here",
            ],
        ),
        (
            "parts/box.yaml",
            "width / 2",
            "width / 0",
            &["specs/parts/box.yaml:5", "used as `box` here"],
        ),
        (
            "parts/box.yaml",
            "[panel, hole]",
            "[hole, hole]",
            &["specs/parts/box.yaml:9:3", "used as `box` here"],
        ),
        (
            "spec.yaml",
            "with: { width:",
            "with: { wdth:",
            &[
                "the module `box` has no parameter `wdth`",
                "did you mean `width`?",
                "specs/spec.yaml:4",
            ],
        ),
        (
            "spec.yaml",
            "wide: 40",
            "wide: 1",
            &[
                "below the least value, the number 5",
                "specs/spec.yaml:4",
                "declared here",
            ],
        ),
        (
            "spec.yaml",
            "parts/box.yaml, with",
            "parts/bx.yaml, with",
            &[
                "cannot read `parts/bx.yaml`",
                "did you mean `parts/box.yaml`?",
                "1 error",
            ],
        ),
        (
            "spec.yaml",
            "lid.panel",
            "ldi.panel",
            &[
                "there is no section and no module `ldi`",
                "did you mean `lid`?",
            ],
        ),
        (
            "spec.yaml",
            "{ lid:",
            "{ regions:",
            &["`regions` cannot be the name of a module: it is that of a section"],
        ),
    ];
    for (file, from, to, said) in cases {
        let project = project();
        project.edit(&format!("specs/{file}"), from, to);
        let run = project.run(&["build", "specs/spec.yaml"]);
        assert_eq!(run.code, Some(1), "{to}: {}", run.stderr);
        for words in said {
            assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
        }
    }
}

#[test]
fn modules_that_use_themselves_are_told() {
    let project = project();
    project.edit(
        "specs/parts/box.yaml",
        "params:",
        "use: { self: box.yaml }\nparams:",
    );
    let run = project.run(&["check", "specs/spec.yaml"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let cycle = "a cycle of modules: specs/parts/box.yaml → specs/parts/box.yaml";
    assert!(run.stderr.contains(cycle), "{}", run.stderr);
    assert!(
        run.stderr.contains("specs/parts/box.yaml:2:"),
        "{}",
        run.stderr
    );
    let run = project.run(&["check", "specs/parts/box.yaml"]);
    assert!(
        run.stderr.contains("uses `specs/parts/box.yaml`"),
        "{}",
        run.stderr
    );
    let other = self::project();
    other.edit(
        "specs/parts/box.yaml",
        "params:",
        "use: { back: ../spec.yaml }\nparams:",
    );
    let run = other.run(&["check", "specs/spec.yaml"]);
    let cycle = "specs/spec.yaml → specs/parts/box.yaml → specs/spec.yaml";
    assert!(run.stderr.contains(cycle), "{}", run.stderr);
}

const IN_CENTIMETRES: &str = "fretwork: 1
units: cm
seed: \"${seed}\"
params:
  seed: 3
  side: { default: 2, type: length, max: 5 }
regions:
  sheet: { rectangle: { width: \"${side}\", height: 1 } }
  drawn: { svg: { file: ../square.svg } }
fields:
  along: { expression: { value: x } }
  steep: { derive: { from: along, operator: slope } }
  many: { expression: { value: \"400 + 10 * x\" } }
partitions:
  steps: { isolines: { field: along, every: 0.5 } }
  dense: { random: { density: many } }
  rows: { stripes: { angle: 90, spacing: 0.5 } }
  cells: { random: { cell_size: 0.05 } }
arrangements:
  moved: { map: { edges: rows, with: \"def up(edge):\\n  return translate(to_curve(edge), point(0, 0.25))\\n\" } }
surfaces:
  block: { mesh: { file: ../block.obj } }
";

/// A project whose spec takes `parts/cm.yaml` in the way of `head`, under names with `prefix`.
fn in_other_units(head: &str, prefix: &str) -> Project {
    let artifact =
        |name: &str| format!("  {name}.json: {{ from: {prefix}{name}, region: {prefix}sheet }}\n");
    let drawn: String = ["steps", "dense", "cells", "moved"].map(artifact).concat();
    let spec = format!(
        "fretwork: 1\n{head}\nartifacts:\n{drawn}  moved.svg: {{ from: {prefix}moved, region: {prefix}sheet }}\n"
    );
    let project = Project::of(&spec);
    project.write("specs/parts/cm.yaml", IN_CENTIMETRES);
    let square = "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M0 0H1V1H0Z\"/></svg>";
    project.write("specs/square.svg", square);
    project.write(
        "specs/block.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    );
    project
}

#[test]
fn what_a_module_says_in_its_units_is_in_them_wherever_it_is_evaluated() {
    let alone = in_other_units("include: parts/cm.yaml\nunits: cm", "");
    let within = in_other_units("use: { m: parts/cm.yaml }", "m.");
    let included = in_other_units("include: parts/cm.yaml", "");
    let measure = |project: &Project, node: &str, name: &str| {
        let json = project.succeed(&["inspect", "specs/spec.yaml", node, "--format", "json"]);
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        json[name].as_f64().unwrap()
    };
    let powers = [
        ("sheet", "area", 100.0),
        ("drawn", "area", 100.0),
        ("steps", "length", 10.0),
        ("steps", "edges", 1.0),
        ("dense", "faces", 1.0),
        ("cells", "faces", 1.0),
        ("moved", "length", 10.0),
        ("block", "volume", 1000.0),
    ];
    for (node, name, power) in powers {
        let expected = power * measure(&alone, node, name);
        for (project, prefix) in [(&within, "m."), (&included, "")] {
            let found = measure(project, &format!("{prefix}{node}"), name);
            // Random cells are others, but about as many.
            let slack = if name == "faces" { 0.15 } else { 1e-6 };
            assert!(
                (found - expected).abs() < slack * expected,
                "{prefix}{node}: {name} {found}, not {expected}"
            );
        }
    }
    // The mapper moves lines by a quarter of a centimetre.
    within.succeed(&["build"]);
    alone.succeed(&["build"]);
    let svg = |project: &Project| {
        let svg = String::from_utf8(project.files("out")["spec/moved.svg"].clone()).unwrap();
        let shape = svg
            .find("<path")
            .or(svg.find("<line"))
            .or(svg.find("<poly"))
            .unwrap();
        svg[shape..].lines().next().unwrap().to_owned()
    };
    assert_eq!(svg(&within), svg(&alone));
}

#[test]
fn a_number_given_to_a_length_of_a_module_is_of_the_unit_of_who_gives_it() {
    let with = |side: &str| {
        let head = format!("use: {{ m: parts/cm.yaml, with: {{ side: {side} }} }}");
        in_other_units(&head, "m.")
    };
    assert!((area(&with("20"), "m.sheet") - 200.0).abs() < 1e-9);
    assert!((area(&with("\"20mm\""), "m.sheet") - 200.0).abs() < 1e-9);
    let run = with("51").run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(
        run.stderr.contains("5.1 is above the greatest value"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_module_has_a_seed_of_its_own() {
    let faces = |head: &str| {
        let project = in_other_units(head, "m.");
        project.succeed(&["build"]);
        project.files("out")["spec/cells.json"].clone()
    };
    let three = faces("use: { m: parts/cm.yaml }");
    assert_eq!(three, faces("seed: 8\nuse: { m: parts/cm.yaml }"));
    assert_ne!(three, faces("use: { m: parts/cm.yaml, with: { seed: 4 } }"));
    let project = in_other_units("use: { m: parts/cm.yaml, with: { seed: 1.5 } }", "m.");
    let run = project.run(&["check"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for said in ["specs/parts/cm.yaml:3:", "used as `m` here"] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    // A file without a seed has that of the file that names it.
    let bare = |head: &str| {
        let project = in_other_units(head, "m.");
        project.edit("specs/parts/cm.yaml", "seed: \"${seed}\"\n", "");
        project.succeed(&["build"]);
        project.files("out")["spec/cells.json"].clone()
    };
    assert_eq!(bare("seed: 3\nuse: { m: parts/cm.yaml }"), three);
    assert_ne!(bare("seed: 8\nuse: { m: parts/cm.yaml }"), three);
}
