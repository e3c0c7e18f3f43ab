//! Where files come from: what they say of it in each format, that it is the same everywhere, and what `origin` makes of it.

use std::collections::BTreeMap;
use std::fs;

use serde_json::{Value, json};

use super::project::{Project, finish};

const SPEC: &str = r#"fretwork: 1
params: { size: 20 }
regions:
  page: { rectangle: { width: "${size}", height: 10 } }
  small: { rectangle: { width: 3, height: 3 } }
fields:
  ramp: { expression: { value: x } }
partitions:
  rows: { stripes: { spacing: 2 } }
solids:
  base: { extrude: { region: page, height: 2 } }
artifacts:
  page.svg: { from: page }
  page.dxf: { from: page }
  page.png: { from: page, width: 64 }
  page.json: { from: page }
  rows.svg: { from: rows, region: page }
  ramp.png: { from: ramp, region: page, width: 64 }
  small.svg: { from: small }
  deep/base.stl: { from: base }
  base.3mf: { from: base }
  base.glb: { from: base }
"#;

/// The origins that the binary finds in all files of a folder, by their paths in it.
fn origins(project: &Project, folder: &str) -> BTreeMap<String, Value> {
    let files: Vec<String> = project.files(folder).into_keys().collect();
    let paths = files.iter().map(|file| format!("{folder}/{file}"));
    let paths: Vec<String> = paths.collect();
    let mut arguments = vec!["origin", "--format", "json"];
    arguments.extend(paths.iter().map(String::as_str));
    let found: Vec<Value> = serde_json::from_str(&project.run(&arguments).stdout).unwrap();
    files.into_iter().zip(found).collect()
}

fn recipe(found: &Value) -> String {
    let recipe = found["origin"]["recipe"].as_str().unwrap().to_owned();
    assert!(recipe.len() == 32 && recipe.bytes().all(|b| b.is_ascii_hexdigit()));
    recipe
}

fn recipes(project: &Project, folder: &str) -> BTreeMap<String, String> {
    let found = origins(project, folder);
    found
        .iter()
        .map(|(file, found)| (file.clone(), recipe(found)))
        .collect()
}

/// Formats whose origins are looked for without the code that writes them.
#[test]
fn each_format_says_its_origin_in_its_own_way() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    let files = project.files("out");
    let recipes = recipes(&project, "out");
    assert_eq!(recipes.len(), 10);
    let line = |name: &str| format!("fretwork spec {name} {}", recipes[&format!("spec/{name}")]);
    let text = |name: &str| String::from_utf8_lossy(&files[&format!("spec/{name}")]).into_owned();
    let element = format!(
        "<metadata><origin xmlns=\"urn:fretwork:origin:1\" spec=\"spec\" artifact=\"page.svg\" recipe=\"{}\"/></metadata>",
        recipes["spec/page.svg"]
    );
    assert!(text("page.svg").contains(&element), "{}", text("page.svg"));
    assert!(text("page.dxf").starts_with(&format!("999\n{}\n0\nSECTION\n", line("page.dxf"))));
    let object = |name: &str| json!({ "spec": "spec", "artifact": name, "recipe": recipes[&format!("spec/{name}")] });
    let measures: Value = serde_json::from_str(&text("page.json")).unwrap();
    assert_eq!(measures["origin"], object("page.json"));
    let glb = &files["spec/base.glb"];
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let scene: Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    assert_eq!(scene["asset"]["extras"]["origin"], object("base.glb"));
    assert!(gltf::Gltf::from_slice(glb).is_ok());
    for name in ["page.png", "ramp.png"] {
        let reader = png::Decoder::new(std::io::Cursor::new(&files[&format!("spec/{name}")]));
        let reader = reader.read_info().unwrap();
        let texts = &reader.info().uncompressed_latin1_text;
        assert_eq!(
            (&*texts[0].keyword, &*texts[0].text),
            ("Origin", &*line(name))
        );
    }
    let stl = &files["spec/deep/base.stl"];
    let head = String::from_utf8_lossy(&stl[..80]).into_owned();
    assert_eq!(head.trim_end(), line("deep/base.stl"));
    assert!(stl_io::read_stl(&mut std::io::Cursor::new(stl)).is_ok());
}

#[test]
fn an_artifact_without_provenance_says_nothing() {
    let project = Project::of(&SPEC.replace(": { from:", ": { provenance: false, from:"));
    project.succeed(&["build"]);
    for (file, found) in origins(&project, "out") {
        assert_eq!(found["origin"], Value::Null, "{file}");
        assert_eq!(found["state"], "unknown", "{file}");
        let bytes = &project.files("out")[&file];
        let says = |text: &[u8]| bytes.windows(text.len()).any(|part| part == text);
        assert!(!says(b"origin") && !says(b"Origin"), "{file}");
    }
    // Nothing but the origin goes, and a name is then none of what the file depends on.
    let with = Project::of(SPEC);
    with.succeed(&["build"]);
    let measures = |project: &Project| -> Value {
        serde_json::from_slice(&project.files("out")["spec/page.json"]).unwrap()
    };
    let (mut with, without) = (measures(&with), measures(&project));
    with.as_object_mut().unwrap().remove("origin");
    assert_eq!(with, without);
}

#[test]
fn the_same_spec_gives_the_same_bytes_wherever_and_however_it_is_built() {
    let project = Project::of(SPEC);
    project.succeed(&["build", "--jobs", "1"]);
    let files = project.files("out");
    project.write(
        "specs/spec.yaml",
        format!("# A comment.\n\n{SPEC}  # Another.\n"),
    );
    project.succeed(&["build"]);
    assert!(project.files("out") == files, "after a comment");
    project.succeed(&["build", "--no-cache", "--jobs", "4", "--out", "other"]);
    let there = |(file, bytes): (&String, &Vec<u8>)| (format!("spec/{file}"), bytes.clone());
    let other = project.files("other");
    let keys: Vec<&String> = other.keys().collect();
    let other = match keys[0].starts_with("spec/") {
        true => other.clone(),
        false => other.iter().map(there).collect(),
    };
    assert!(
        other == files,
        "in another folder, without a cache, by four threads"
    );
    let elsewhere = Project::of(SPEC);
    elsewhere.succeed(&[
        "build",
        "specs/spec.yaml",
        "--out",
        "flat",
        "--engine",
        "general",
    ]);
    let flat = elsewhere.files("flat");
    let flat: BTreeMap<_, _> = flat.iter().map(there).collect();
    assert!(
        flat == files,
        "in another project, by itself, by the general engine"
    );
}

#[test]
fn a_recipe_changes_with_what_its_file_is_made_of_alone() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    let before = recipes(&project, "out");
    let unlike = |folder: &str| -> Vec<String> {
        let after = recipes(&project, folder);
        let changed = after
            .into_iter()
            .filter(|(file, recipe)| before[file] != *recipe);
        changed.map(|(file, _)| file).collect()
    };
    project.succeed(&["build", "--set", "size=21", "--out", "wide"]);
    let wide = unlike("wide");
    assert_eq!(wide.len(), 9, "{wide:?}");
    assert!(!wide.contains(&"spec/small.svg".to_owned()));
    project.edit("specs/spec.yaml", "value: x", "value: y");
    project.edit("specs/spec.yaml", "from: small", "from: small, stroke: 1");
    project.succeed(&["build"]);
    assert_eq!(unlike("out"), ["spec/ramp.png", "spec/small.svg"]);
}

#[test]
fn origin_tells_what_became_of_a_file() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    let states = |project: &Project, file: &str| -> (Option<i32>, String) {
        let run = project.run(&["origin", file, "--format", "json"]);
        let found: Vec<Value> = serde_json::from_str(&run.stdout).unwrap();
        (run.code, found[0]["state"].as_str().unwrap().to_owned())
    };
    for file in project.files("out").keys() {
        let (code, state) = states(&project, &format!("out/{file}"));
        assert_eq!((code, &*state), (Some(0), "current"), "{file}");
    }
    let said = project.succeed(&["origin", "out/spec/page.svg"]);
    assert!(
        said.starts_with("out/spec/page.svg: current, spec page.svg "),
        "{said}"
    );
    let svg = fs::read_to_string(project.path("out/spec/page.svg")).unwrap();
    project.write("edited.svg", svg.replace("</svg>", "<!-- mine --></svg>"));
    let named = svg
        .replace("<origin xmlns=", "<f:origin xmlns:f=")
        .replace("<svg ", "<svg id=\"of-an-editor\"\n");
    project.write("rewritten.svg", named);
    project.write("foreign.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
    project.write("foreign.txt", "Nothing.");
    project.write("lost.svg", svg.replace("spec=\"spec\"", "spec=\"gone\""));
    project.write(
        "unnamed.svg",
        svg.replace("artifact=\"page.svg\"", "artifact=\"gone.svg\""),
    );
    for (file, state) in [
        ("edited.svg", "edited"),
        ("rewritten.svg", "edited"),
        ("foreign.svg", "unknown"),
        ("foreign.txt", "unknown"),
        ("lost.svg", "unknown"),
        ("unnamed.svg", "unknown"),
    ] {
        assert_eq!(
            states(&project, file),
            (Some(1), state.to_owned()),
            "{file}"
        );
    }
    project.edit("specs/spec.yaml", "size: 20", "size: 30");
    assert_eq!(states(&project, "out/spec/page.svg").1, "outdated");
    assert_eq!(states(&project, "out/spec/small.svg").1, "current");
    assert_eq!(
        project.succeed(&["origin", "out/spec/page.svg", "--set", "size=20"]),
        said
    );
    project.edit("specs/spec.yaml", "width: 3", "width: three");
    let run = project.run(&["origin", "out/spec/small.svg"]);
    assert!(
        run.stdout.contains(": unknown") && run.stderr.contains("three"),
        "{run:?}"
    );
    assert_eq!(project.run(&["origin", "none.svg"]).code, Some(2));
}

/// A file that is looked at from outside of its project is that of the project that it lies in.
#[test]
fn origins_are_known_from_elsewhere() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    let file = project.path("out/spec/base.3mf");
    let elsewhere = Project::empty();
    let run = elsewhere.run(&["origin", file.to_str().unwrap()]);
    assert_eq!(run.code, Some(0), "{run:?}");
    elsewhere.write("copy.3mf", fs::read(&file).unwrap());
    assert_eq!(elsewhere.run(&["origin", "copy.3mf"]).code, Some(1));
    let copy = elsewhere.path("copy.3mf");
    let run = project.run(&["origin", copy.to_str().unwrap()]);
    assert_eq!(run.code, Some(0), "{run:?}");
}

#[test]
fn names_of_all_sorts_and_parts_of_the_plane_are_found_again() {
    let project = Project::empty();
    let spec = "specs/a very long folder of many words/höhe, 木 & \"<b>\".yaml";
    let text = SPEC.replace("  small.svg", "  \"größe 木 & co.svg\"");
    project.write(spec, text.replace("page.png:", "\"größe 木 & co.png\":"));
    project.succeed(&["build"]);
    let files = project.files("out");
    assert_eq!(files.len(), 10);
    for (file, found) in origins(&project, "out") {
        assert_eq!(found["state"], "current", "{file}");
        let whole = format!(
            "{}/{}",
            found["origin"]["spec"].as_str().unwrap(),
            found["origin"]["artifact"].as_str().unwrap()
        );
        assert!(file.ends_with(&whole), "{file}: {whole}");
        assert!(whole == file || file.ends_with(".stl"), "{file}: {whole}");
    }
    let project = Project::of(SPEC);
    let built = [
        "build",
        "--window",
        "-1,0,9.5,8",
        "--only",
        "rows.svg",
        "--only",
        "page.dxf",
    ];
    project.succeed(&built);
    let windows = origins(&project, "out");
    assert_eq!(windows.len(), 2);
    project.succeed(&["build"]);
    let whole = recipes(&project, "out");
    for (file, found) in windows {
        assert_eq!(found["state"], "current", "{file}");
        let name = found["origin"]["artifact"].as_str().unwrap();
        assert_ne!(recipe(&found), whole[&format!("spec/{name}")], "{file}");
    }
}

/// An answer is no build: what the last build did is still told after it.
#[test]
fn looking_at_an_origin_leaves_the_record_of_the_last_build() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    let told = |project: &Project| project.succeed(&["explain", "specs/spec.yaml", "base"]);
    let before = told(&project);
    project.run(&["origin", "out/spec/base.glb", "--set", "size=33"]);
    assert_eq!(told(&project), before);
    let run = finish(project.command(&["build", "--format", "json"]));
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let written = report["artifacts"].as_array().unwrap().iter();
    assert!(written.clone().all(|one| one["status"] == "unchanged"));
}
