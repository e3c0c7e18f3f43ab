//! What programs read of a build: codes, annotations and the summary of GitHub, SARIF, the workflow of `init`.

use super::project::Project;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// A spec with a mistake, and the code of its diagnostic.
fn code_of(spec: &str) -> BTreeSet<String> {
    let project = Project::of(spec);
    let run = project.run(&["build", "--format", "json"]);
    let report: Value = serde_json::from_str(&run.stdout).expect("a report");
    let all = ["errors", "warnings"].map(|key| report[key].as_array().expect("a list").clone());
    let codes = all.iter().flatten().map(|one| {
        one["code"]
            .as_str()
            .expect("every diagnostic has a code")
            .to_string()
    });
    codes.collect()
}

#[test]
fn every_sort_of_mistake_has_its_code() {
    let spec = |body: &str| {
        format!(
            "fretwork: 1\nregions: {{ page: {{ rectangle: {{ width: 40, height: 30 }} }} }}\n{body}"
        )
    };
    let svg = |from: &str| format!("artifacts: {{ x.svg: {{ from: {from}, region: page }} }}\n");
    let cases = [
        ("syntax", "fretwork: 1\nregions: [\n".to_string()),
        (
            "field",
            spec("partitions: { a: { stripes: { spacng: 3 } } }\n"),
        ),
        ("reference", spec(&svg("pge"))),
        (
            "value",
            spec("partitions: { a: { stripes: { spacing: -3 } } }\n"),
        ),
        (
            "file",
            spec(&format!(
                "exemplars: {{ a: {{ vector: {{ file: none.svg }} }} }}\n{}",
                svg("a")
            )),
        ),
        (
            "script",
            spec(&format!(
                "partitions: {{ g: {{ grid: {{ across: {{ spacing: 9 }}, along: {{ angle: 90, spacing: 9 }} }} }} }}\n\
                 arrangements: {{ a: {{ map: {{ faces: g, with: \"def f(c):\\n  return missing(c)\\n\" }} }} }}\n{}",
                svg("a")
            )),
        ),
        ("format", spec("artifacts: { x.abc: { from: page } }\n")),
        (
            "output",
            spec("artifacts: { x.svg: { from: page }, X.svg: { from: page } }\n"),
        ),
    ];
    for (code, spec) in cases {
        let found = code_of(&spec);
        assert!(found.contains(code), "{code}: {found:?}\n{spec}");
    }
}

const WRONG: &str = "fretwork: 1
regions: { page: { rectangle: { width: 40, height: 30 } } }
params: { unused: 3 }
artifacts: { x.svg: { from: pge } }
";

#[test]
fn annotations_stand_on_standard_output_and_people_s_text_on_the_other() {
    let project = Project::of(WRONG);
    for command in ["build", "check"] {
        let run = project.run(&[command, "--format", "github"]);
        assert_eq!(run.code, Some(1));
        let error = run
            .stdout
            .lines()
            .find(|line| line.starts_with("::error "))
            .expect("an annotation");
        let start =
            "::error file=specs/spec.yaml,line=4,col=29,endLine=4,endColumn=32,title=reference::";
        assert!(error.starts_with(start), "{error}");
        assert!(error.contains("%0Ahelp: did you mean `page`?"), "{error}");
        assert!(
            run.stderr.contains("did you mean `page`?"),
            "{}",
            run.stderr
        );
    }
}

#[test]
fn the_summary_of_a_job_is_appended_where_the_service_says() {
    let project = Project::small();
    project.write("summary.md", "before\n");
    let at = |file: &str| {
        let mut command = project.command(&["build", "--format", "github"]);
        command.env("GITHUB_STEP_SUMMARY", project.path(file));
        command.output().expect("it runs")
    };
    assert!(at("summary.md").status.success());
    let text = std::fs::read_to_string(project.path("summary.md")).unwrap();
    assert!(text.starts_with("before\n### fretwork"), "{text}");
    assert!(
        text.contains("0 errors")
            && text.contains("| `spec/plate.svg` |")
            && text.contains("slowest"),
        "{text}"
    );
    // One that cannot be written is told and harms nothing.
    let run = at("no/folder/summary.md");
    assert!(run.status.success());
    assert!(String::from_utf8_lossy(&run.stderr).contains("summary"));
}

#[test]
fn the_log_has_every_result_at_its_place() {
    let project = Project::of(WRONG);
    let run = project.run(&["check", "--format", "sarif"]);
    assert_eq!(run.code, Some(1));
    let log: Value = serde_json::from_str(&run.stdout).expect("a log");
    assert_eq!(log["version"], "2.1.0");
    let one = &log["runs"][0];
    assert_eq!(one["columnKind"], "unicodeCodePoints");
    let rules = one["tool"]["driver"]["rules"].as_array().expect("rules");
    let results = one["results"].as_array().expect("results");
    assert!(!results.is_empty());
    for result in results {
        let rule = &rules[result["ruleIndex"].as_u64().expect("an index") as usize];
        assert_eq!(rule["id"], result["ruleId"]);
        let place = &result["locations"][0]["physicalLocation"];
        assert_eq!(place["artifactLocation"]["uri"], "specs/spec.yaml");
        assert_eq!(place["artifactLocation"]["uriBaseId"], "%SRCROOT%");
        assert!(place["region"]["startLine"].as_u64() >= Some(1));
    }
    // Two comments above move the lines, not the findings.
    let prints = |log: &Value| -> Vec<Value> {
        let results = log["runs"][0]["results"]
            .as_array()
            .cloned()
            .unwrap_or_default();
        results
            .into_iter()
            .map(|result| result["partialFingerprints"].clone())
            .collect()
    };
    project.write("specs/spec.yaml", format!("# one\n# two\n{WRONG}"));
    let moved: Value =
        serde_json::from_str(&project.run(&["check", "--format", "sarif"]).stdout).unwrap();
    assert_eq!(prints(&log), prints(&moved));
}

/// The schema of SARIF, from a package of schemas that `.ci/run` installs; where it is missing, that is said.
fn schema_of_sarif() -> Option<Value> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/schemas/node_modules");
    let path = folder.join("schemastore/schemas/json/sarif-2.1.0.json");
    let Ok(text) = std::fs::read(&path) else {
        println!("skipped: there is no {}", path.display());
        return None;
    };
    let mut schema: Value = serde_json::from_slice(&text).expect("a schema is JSON");
    // A bracket too much makes these patterns none.
    for of in ["run", "toolComponent"] {
        let language = format!("/definitions/{of}/properties/language");
        if let Some(Value::Object(language)) = schema.pointer_mut(&language) {
            language.remove("pattern");
        }
    }
    Some(schema)
}

#[test]
fn logs_are_valid_by_the_schema_of_their_format() {
    let Some(schema) = schema_of_sarif() else {
        return;
    };
    let validator = jsonschema::draft7::new(&schema).expect("a schema");
    // It would refuse what is none.
    assert!(!validator.is_valid(&serde_json::json!({ "version": "2.1.0", "runs": 3 })));
    let mut texts = vec![WRONG.to_string()];
    let bad = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    for entry in std::fs::read_dir(bad).expect("there are wrong specs") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "yaml") {
            texts.push(String::from_utf8_lossy(&std::fs::read(path).expect("a spec")).into());
        }
    }
    let mut results = 0;
    for text in texts {
        let project = Project::of(&text);
        let run = project.run(&["check", "--format", "sarif"]);
        let log: Value = serde_json::from_str(&run.stdout).expect("a log");
        let wrong: Vec<String> = validator
            .iter_errors(&log)
            .map(|error| error.to_string())
            .collect();
        assert!(wrong.is_empty(), "{text}: {wrong:?}");
        results += log["runs"][0]["results"].as_array().map_or(0, Vec::len);
    }
    assert!(results > 20, "{results}");
}

#[test]
fn the_commands_of_the_workflow_work_in_a_new_project() {
    let project = Project::empty();
    project.succeed(&["init", "new", "--ci", "github"]);
    let text = std::fs::read_to_string(project.path("new/.github/workflows/fretwork.yml")).unwrap();
    let commands: Vec<&str> = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("run: fretwork "))
        .collect();
    assert_eq!(commands.len(), 2);
    for command in commands {
        let words: Vec<&str> = command.split(" > ").next().unwrap().split(' ').collect();
        let mut run = project.command(&words);
        run.current_dir(project.path("new"));
        let output = run.output().expect("it runs");
        assert!(
            output.status.success(),
            "{command}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        if command.contains(" > fretwork.sarif") {
            assert!(serde_json::from_slice::<Value>(&output.stdout).is_ok());
        }
    }
}

#[test]
fn a_report_stands_alone_and_is_the_same_again() {
    let project = Project::small();
    project.succeed(&["report", "--stable"]);
    let read = || std::fs::read_to_string(project.path("out/report.html")).unwrap();
    let first = read();
    for path in ["plate.svg", "cells.dxf", "cells.json"] {
        assert!(
            first.contains(&format!("data-artifact=\"spec/{path}\"")),
            "{path}"
        );
    }
    // A picture for each name: those of drawings, and one made for the DXF file.
    assert_eq!(first.matches("<img ").count(), 4);
    // Its own script is the only one, and runs by its digest.
    assert!(first.contains("default-src 'none'") && first.contains("script-src 'sha256-"));
    assert!(!first.contains("unsafe") && !first.contains("<script "));
    assert_eq!(first.matches("<script>").count(), 1);
    assert!(!first.contains("https://"));
    project.succeed(&["report", "--stable", "--no-cache", "--jobs", "1"]);
    assert_eq!(first, read());
    // What is no report stays.
    project.write("out/mine.html", "mine");
    let run = project.run(&["report", "--out", "out/mine.html"]);
    assert!(
        run.code == Some(2) && run.stderr.contains("no report"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_report_shows_what_is_wrong_with_its_line() {
    let project = Project::of(&WRONG.replace("page: { rect", "\"<b>\": { rect"));
    let run = project.run(&["report"]);
    assert_eq!(run.code, Some(1));
    let text = std::fs::read_to_string(project.path("out/report.html")).unwrap();
    assert!(
        text.contains("data-severity=\"error\"") && text.contains("from: pge"),
        "{text}"
    );
    assert!(!text.contains("<b>"), "names are escaped");
}
