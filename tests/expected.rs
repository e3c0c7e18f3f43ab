//! What artifacts are expected to measure: failures keep files from being written, and what shipped specs claim is
//! expected of their files.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::project::{Project, copy};

const SPEC: &str = r#"fretwork: 1
units: cm
regions:
  page: { rectangle: { width: 4, height: 3 } }
  hole: { circle: { radius: 0.5, at: [1, 1] } }
  plate: { difference: [page, hole] }
partitions:
  rows: { stripes: { spacing: 1 } }
solids:
  base: { extrude: { region: plate, height: 0.5 } }
artifacts:
  plate.svg: { from: plate, expect: { holes: 1, components: 1 } }
  both.svg: { parts: [{ from: plate }, { from: page, at: [9, 0] }], expect: { holes: 1, components: 2, bounds: [13, 3] } }
  rows.svg: { from: rows, region: page, expect: { edges: [1, 99] } }
  base.stl: { from: base, expect: { bounds: { max: [4, 0.1, 0.5] }, watertight: true, genus: 1, volume: ["5cm3", null] } }
"#;

#[test]
fn what_is_expected_and_measured_is_written() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    assert_eq!(project.files("out").len(), 4);
}

#[test]
fn an_unmet_expectation_is_told_at_its_line_and_the_old_file_stays() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    let before = project.files("out");
    project.edit("specs/spec.yaml", "radius: 0.5", "radius: 0.25");
    project.edit(
        "specs/spec.yaml",
        "holes: 1, components: 1",
        "holes: 2, components: 1",
    );
    project.edit("specs/spec.yaml", "\"5cm3\", null", "1, 2");
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for said in [
        "`holes` is 1, and 2 is expected",
        "specs/spec.yaml:12:46",
        "`volume` is 5.9018 cm³, and 1 cm³ to 2 cm³ is expected",
        "specs/spec.yaml:15",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    let after = project.files("out");
    for kept in ["spec/plate.svg", "spec/base.stl"] {
        assert_eq!(before[kept], after[kept], "{kept}");
    }
    // What is not wrong is not kept back.
    assert_ne!(before["spec/both.svg"], after["spec/both.svg"]);
}

/// Every measure of a node as `inspect` prints it, expected of a file that shows it.
#[test]
fn every_measure_that_inspect_prints_can_be_expected() {
    let project = Project::of(SPEC);
    for (node, file) in [("plate", "a.svg"), ("rows", "b.svg"), ("base", "c.stl")] {
        let path = "specs/spec.yaml";
        let measures = project.succeed(&["inspect", path, node, "--format", "json"]);
        let mut measures: Value = serde_json::from_str(&measures).unwrap();
        assert_eq!(measures["units"], json!("cm"));
        measures.as_object_mut().unwrap().remove("units");
        let count = measures.as_object().unwrap().len();
        assert!(count >= 4, "{measures}");
        let region = if node == "rows" { "region: page, " } else { "" };
        project.write(
            path,
            format!("{SPEC}  {file}: {{ from: {node}, {region}expect: {measures} }}\n"),
        );
        project.succeed(&["build"]);
        let wrong = measures
            .to_string()
            .replace("\"bounds\":[[0.0", "\"bounds\":[[0.1");
        assert_ne!(wrong, measures.to_string());
        project.write(
            path,
            format!("{SPEC}  {file}: {{ from: {node}, {region}expect: {wrong} }}\n"),
        );
        let run = project.run(&["build"]);
        assert!(run.stderr.contains("`bounds` is"), "{}", run.stderr);
    }
}

#[test]
fn expectations_that_cannot_be_are_told_by_check() {
    for (wrong, said) in [
        ("{ hole: 1 }", "did you mean `holes`?"),
        ("{ weight: 1 }", "there is no measure `weight`"),
        ("{ holes: [3, 1] }", "the range ends before it begins"),
        ("{ holes: 1.5 }", "expected a whole number"),
        ("{ area: {} }", "one of them"),
        ("{ area: { least: 3 } }", "unknown field `least`"),
        ("{ bounds: 3 }", "expected corners"),
        (
            "{ bounds: { max: [1, 2], min: [1, 2, 3] } }",
            "different numbers",
        ),
        ("[holes]", "expected measures by name"),
        ("{ volume: \"3mm2\" }", "not a unit of volume"),
    ] {
        let project = Project::of(&SPEC.replace("{ holes: 1, components: 1 }", wrong));
        let run = project.run(&["check"]);
        assert_eq!(run.code, Some(1), "{wrong}");
        assert!(run.stderr.contains(said), "{wrong}: {}", run.stderr);
    }
    let lost = Project::of(&SPEC.replace("{ holes: 1, components: 1 }", "{ genus: 1 }"));
    let run = lost.run(&["build"]);
    assert!(
        run.stderr.contains("has no measure `genus`") && run.stderr.contains("`holes`"),
        "{}",
        run.stderr
    );
}

/// The comment at the head of a spec, as one line.
fn head(text: &str) -> String {
    let lines = text.lines().take_while(|line| line.starts_with('#'));
    let words: Vec<&str> = lines
        .flat_map(|line| line[1..].split_whitespace())
        .collect();
    words.join(" ")
}

/// The specs below a folder, as paths in it.
fn specs(folder: &Path, below: &str, found: &mut Vec<String>) {
    let mut entries: Vec<_> = fs::read_dir(folder.join(below)).unwrap().collect();
    entries.sort_by_key(|entry| entry.as_ref().unwrap().file_name());
    for entry in entries {
        let entry = entry.unwrap();
        let path = format!("{below}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            specs(folder, &path, found);
        } else if path.ends_with(".yaml") {
            found.push(path);
        }
    }
}

#[test]
fn shipped_specs_claim_only_what_is_expected_of_their_files() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    specs(home, "specs", &mut paths);
    let project = Project::empty();
    copy(&home.join("specs"), &project.path("specs"));
    let (mut claims, mut built, mut progress) = (0, 0, Vec::new());
    for path in &paths {
        let text = fs::read_to_string(home.join(path)).unwrap();
        let claim = ["one piece", "one body"]
            .iter()
            .find(|claim| head(&text).contains(*claim));
        let expects = text.contains("expect: { components: 1");
        assert!(
            claim.is_none() || expects,
            "{path} claims {claim:?} and expects no `components: 1`"
        );
        // What is one solid in a file is told by its measures too.
        let has_solids = text.contains("\nsolids:") || text.contains("\nbands:");
        assert!(!has_solids || text.contains("expect:"), "{path}");
        claims += usize::from(claim.is_some());
        if text.contains("expect:") {
            let run = project.run(&["build", path]);
            assert_eq!(run.code, Some(0), "{path}: {}", run.stderr);
            progress.extend(run.progress);
            built += 1;
        }
    }
    assert!(claims >= 4 && built >= 9, "{claims} {built}");
    // What takes long says what it does, where no terminal shows a bar.
    assert!(
        progress.iter().any(|line| line.contains("solids.")),
        "{progress:?}"
    );
}
