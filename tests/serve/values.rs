//! W6: values that are tried out.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

use serde_json::Value;

use super::super::project::Project;
use super::ask;
use super::watched::{Watched, digests};

/// When each file of a project was last changed, without the cache.
fn times(project: &Project) -> BTreeMap<String, SystemTime> {
    fn add(folder: &Path, times: &mut BTreeMap<String, SystemTime>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.ends_with(".fretwork") {
                continue;
            }
            let time = fs::metadata(&path).unwrap().modified().unwrap();
            times.insert(path.display().to_string(), time);
            if path.is_dir() {
                add(&path, times);
            }
        }
    }
    let mut times_found = BTreeMap::new();
    add(&project.path(""), &mut times_found);
    times_found
}

fn number(body: &str) -> u64 {
    let answer: Value = serde_json::from_str(body).unwrap();
    answer["build"].as_u64().unwrap()
}

fn value(state: &Value, name: &str) -> f64 {
    let params = state["specs"][0]["params"].as_array().unwrap();
    let param = params.iter().find(|param| param["name"] == name);
    param.unwrap()["value"].as_f64().unwrap()
}

#[test]
fn values_are_built_as_set_would_and_nothing_is_written() {
    let watched = Watched::new(Project::small());
    let first = watched.digests();
    let before = times(&watched.project);
    let reply = watched.set(r#"{"spec":"specs/spec.yaml","values":{"spacing":"1cm"}}"#);
    assert_eq!(reply.status, 202, "{reply:?}");
    let build = number(&reply.body);
    let state = watched.until(|state| state["build"].as_u64() >= Some(build));
    assert_eq!(value(&state, "spacing"), 10.0);
    assert_ne!(digests(&state)["spec/rows.svg"], first["spec/rows.svg"]);
    assert_eq!(digests(&state)["spec/zig.svg"], first["spec/zig.svg"]);
    let page = ask(watched.port, "GET /", &[], "").body;
    let line = "fretwork build specs/spec.yaml --set spacing=1cm";
    assert!(page.contains(line), "the page shows the command line");
    assert_eq!(times(&watched.project), before);
    // It is what the command line gives.
    let arguments = ["build", "--set", "spacing=1cm", "--out", "other"];
    watched.project.succeed(&arguments);
    let other = watched.project.files("other");
    for (path, digest) in digests(&state) {
        assert_eq!(
            blake3::hash(&other[&path]).to_hex().as_str(),
            digest,
            "{path}"
        );
    }
    // Null takes it back.
    let reply = watched.set(r#"{"spec":"specs/spec.yaml","values":{"spacing":null}}"#);
    let build = number(&reply.body);
    let state = watched.until(|state| state["build"].as_u64() >= Some(build));
    assert_eq!(digests(&state), first);
    assert!(!ask(watched.port, "GET /", &[], "").body.contains("--set"));
}

#[test]
fn values_survive_edits_until_their_param_is_gone() {
    let watched = Watched::new(Project::small());
    let reply = watched.set(r#"{"spec":"specs/spec.yaml","values":{"spacing":"12"}}"#);
    let build = number(&reply.body);
    watched.until(|state| state["build"].as_u64() >= Some(build));
    watched
        .project
        .edit("specs/spec.yaml", "radius: 10", "radius: 11");
    let state = watched.until(|state| state["build"].as_u64() > Some(build));
    assert_eq!(value(&state, "spacing"), 12.0);
    // A spec that cannot be read keeps them.
    watched
        .project
        .edit("specs/spec.yaml", "radius: 11", "radius: [");
    watched.until(|state| state["ok"] == false);
    watched
        .project
        .edit("specs/spec.yaml", "radius: [", "radius: 11");
    let state = watched.until(|state| state["ok"] == true);
    assert_eq!(value(&state, "spacing"), 12.0);
    // One that has another name is another.
    let text = fs::read_to_string(watched.project.path("specs/spec.yaml")).unwrap();
    watched.project.write(
        "specs/spec.yaml",
        text.replace("spacing", "distance")
            .replace("{ angle: 30, distance:", "{ angle: 30, spacing:"),
    );
    let state = watched.until(|state| state["specs"][0]["params"][1]["name"] == "distance");
    assert_eq!(
        (&state["ok"], value(&state, "distance")),
        (&true.into(), 8.0)
    );
    watched.project.write("specs/spec.yaml", text);
    let state = watched.until(|state| state["specs"][0]["params"][1]["name"] == "spacing");
    assert_eq!(value(&state, "spacing"), 8.0);
}

#[test]
fn a_value_that_is_refused_changes_nothing() {
    let watched = Watched::new(Project::small());
    let state = watched.state();
    for (values, code) in [
        (r#"{"spacing":"21"}"#, "value"),
        (r#"{"spacing":"1"}"#, "value"),
        (r#"{"spacing":"wide"}"#, "value"),
        (r#"{"spacing":""}"#, "value"),
        (r#"{"spacing":"${size}"}"#, "value"),
        (r#"{"spacin":"9"}"#, "reference"),
        (r#"{"size":"7","spacing":"99"}"#, "value"),
    ] {
        let reply = watched.set(&format!(
            r#"{{"spec":"specs/spec.yaml","values":{values}}}"#
        ));
        assert_eq!(reply.status, 422, "{values}: {reply:?}");
        let answer: Value = serde_json::from_str(&reply.body).unwrap();
        let wrong = &answer["diagnostics"][0];
        assert_eq!(wrong["code"], code, "{values}: {answer}");
        assert_eq!(wrong["severity"], "error");
    }
    let reply = watched.set(r#"{"spec":"specs/spec.yaml","values":{"spacing":"21"}}"#);
    let answer: Value = serde_json::from_str(&reply.body).unwrap();
    let wrong = &answer["diagnostics"][0];
    assert_eq!(
        (&wrong["file"], &wrong["line"]),
        (&"specs/spec.yaml".into(), &5.into())
    );
    let reply = watched.set(r#"{"spec":"specs/other.yaml","values":{"spacing":"9"}}"#);
    assert_eq!(reply.status, 422);
    for body in [
        "",
        "null",
        "{",
        "[]",
        "{}",
        r#"{"spec":"specs/spec.yaml"}"#,
        r#"{"spec":"specs/spec.yaml","values":{"spacing":9}}"#,
        r#"{"spec":"specs/spec.yaml","values":[],"more":1}"#,
        "\u{0}",
    ] {
        assert_eq!(watched.set(body).status, 400, "{body}");
    }
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(watched.state()["build"], state["build"]);
}

/// What a build of [`SLOW`] may use.
const ALLOWED: [&str; 2] = ["--budget", "20"];

/// A spec that takes some seconds for each small value.
const SLOW: &str = r#"fretwork: 1
params:
  cell: { default: 9, type: number, min: 0.2, max: 40 }
regions: { page: { rectangle: { width: 300, height: 300 } } }
partitions: { cells: { uniform: { cell_size: "${cell}" } } }
artifacts: { cells.svg: { from: cells, region: page } }
"#;

#[test]
fn the_newest_value_wins_and_the_others_are_given_up() {
    let watched = Watched::with(Project::of(SLOW), &ALLOWED);
    let mut last = 0;
    let started = Instant::now();
    for step in 0..1000 {
        let body = format!(
            r#"{{"spec":"specs/spec.yaml","values":{{"cell":"{}"}}}}"#,
            1.2 + f64::from(step) * 0.0001
        );
        let asked = Instant::now();
        let reply = watched.set(&body);
        assert_eq!(reply.status, 202);
        assert!(asked.elapsed() < Duration::from_secs(2), "a control waits");
        let build = number(&reply.body);
        assert!(build >= last);
        last = build;
    }
    let asked = started.elapsed();
    let body = r#"{"spec":"specs/spec.yaml","values":{"cell":"30"}}"#;
    let build = number(&watched.set(body).body);
    let started = Instant::now();
    let state = watched.until(|state| state["build"].as_u64() >= Some(build));
    assert_eq!(value(&state, "cell"), 30.0);
    // A thousand builds would take many minutes.
    assert!(started.elapsed() < Duration::from_secs(10) && asked < Duration::from_secs(60));
    let file = ask(watched.port, "GET /files/spec/cells.svg", &[], "");
    watched.project.succeed(&[
        "build", "--set", "cell=30", "--out", "other", "--budget", "20",
    ]);
    let built = &watched.project.files("other")["spec/cells.svg"];
    assert_eq!(file.body.as_bytes(), &built[..]);
}

#[test]
fn a_value_that_was_given_up_can_be_had_again() {
    let watched = Watched::with(Project::of(SLOW), &ALLOWED);
    let set = |cell: &str| {
        let body = format!(r#"{{"spec":"specs/spec.yaml","values":{{"cell":"{cell}"}}}}"#);
        number(&watched.set(&body).body)
    };
    set("1.2");
    std::thread::sleep(Duration::from_millis(150));
    set("20");
    let build = set("1.2");
    let state = watched.until(|state| state["build"].as_u64() >= Some(build));
    assert_eq!((&state["ok"], value(&state, "cell")), (&true.into(), 1.2));
    watched.project.succeed(&[
        "build", "--set", "cell=1.2", "--out", "other", "--budget", "20",
    ]);
    let built = &watched.project.files("other")["spec/cells.svg"];
    assert_eq!(
        digests(&state)["spec/cells.svg"],
        blake3::hash(built).to_hex().as_str()
    );
}
