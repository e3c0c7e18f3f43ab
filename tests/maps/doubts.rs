//! What is told of tables and shapes that are odd but can be used, and of formulas without a value.

use super::{UTM, project};

/// A build of a spec with one file of features: what it says, and the file that it writes.
fn told(features: &str, spec: &str) -> (String, serde_json::Value) {
    let project = project(&format!("fretwork: 1\n{UTM}\n{spec}"));
    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}}"#;
    let file = format!(r#"{{"type":"FeatureCollection",{crs},"features":[{features}]}}"#);
    project.write("specs/data/odd.geojson", file);
    let done = project.run(&["build"]);
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let text = std::fs::read_to_string(project.path("out/spec/x.geojson"));
    let written = serde_json::from_str(&text.expect("it was written")).expect("JSON");
    (done.stderr, written)
}

const SQUARE: &str = "[[[0,0],[10,0],[10,10],[0,10],[0,0]]]";

fn square(properties: &str) -> String {
    format!(
        r#"{{"type":"Feature","properties":{properties},"geometry":{{"type":"Polygon","coordinates":{SQUARE}}}}}"#
    )
}

const LABELLED: &str = "regions:
  all: { geodata: { file: data/odd.geojson, labels: tags } }
  page: { rectangle: { width: 60, height: 60 } }
artifacts:
  x.geojson: { from: all, region: page, crs: map, draw: filled }
";

#[test]
fn lists_of_texts_are_labels_and_objects_are_told() {
    let (said, file) = told(&square(r#"{"tags":["wood","steep",7]}"#), LABELLED);
    assert!(!said.contains('⚠'), "{said}");
    let properties = &file["features"][0]["properties"];
    assert_eq!(
        properties["labels"],
        serde_json::json!(["7", "steep", "wood"])
    );
    assert_eq!(properties["tags"], serde_json::json!(["wood", "steep", 7]));
    for odd in [r#"{"a":1}"#, r#"[["a"]]"#, "[null]"] {
        let (said, file) = told(&square(&format!(r#"{{"tags":{odd}}}"#)), LABELLED);
        assert!(
            said.contains("`tags` is no text in 1 of the features"),
            "{said}"
        );
        let labels = &file["features"][0]["properties"]["labels"];
        assert_eq!(labels, &serde_json::json!([]), "{odd}");
    }
    let (said, _) = told(&square(r#"{"tags":[]}"#), LABELLED);
    assert!(!said.contains('⚠'), "{said}");
}

#[test]
fn a_ring_that_is_not_closed_is_told() {
    let open = square(r#"{"tags":"a"}"#).replace(",[0,0]]]", "]]");
    let (said, file) = told(&open, LABELLED);
    assert!(said.contains("feature 1 of"), "{said}");
    assert!(
        said.contains("a ring of it does not end where it begins"),
        "{said}"
    );
    let corners = file["features"][0]["geometry"]["coordinates"][0].as_array();
    assert_eq!(corners.map(Vec::len), Some(5));
}

#[test]
fn a_formula_that_divides_by_zero_has_no_value() {
    for formula in ["10 / h", "sqrt(h - 1)", "log(h)"] {
        let spec = format!(
            "regions:
  all: {{ geodata: {{ file: data/odd.geojson }} }}
  page: {{ rectangle: {{ width: 60, height: 60 }} }}
fields:
  h: {{ attribute: {{ region: all, name: h }} }}
  apart: {{ expression: {{ value: \"{formula}\", fields: {{ h: h }} }} }}
partitions:
  rows: {{ stripes: {{ spacing: apart }} }}
arrangements:
  lines: {{ fill: {{ faces: all, with: rows }} }}
artifacts:
  x.geojson: {{ from: lines, region: page, crs: map }}
"
        );
        let (said, _) = told(&square(r#"{"h":0}"#), &spec);
        assert!(
            said.contains("has no value at (5.000, 5.000)"),
            "{formula}: {said}"
        );
        assert!(said.contains("divides by zero"), "{formula}: {said}");
    }
}
