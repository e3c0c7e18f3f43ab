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
            ],
        ),
        (
            "spec.yaml",
            "lid.panel",
            "ldi.panel",
            &["there is no section `ldi`", "did you mean `lid`?"],
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
