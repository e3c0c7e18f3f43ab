//! What tables of features say, as it comes out again: whole numbers of any length, what is left out, and parts of one feature
//! that are faces of their own.

use super::super::project::Project;
use serde_json::{Value, json};

/// Squares in the corners of a plane of 100 by 100 metres, the second and the third one feature.
const SQUARES: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{"id":9007199254740993,"size":1.0,"name":null,"wet":true},"geometry":{"type":"Polygon","coordinates":[[[0,0],[20,0],[20,20],[0,20],[0,0]]]}},
{"type":"Feature","properties":{"id":9007199254740992,"size":2.5,"name":" b","wet":null},"geometry":{"type":"MultiPolygon","coordinates":[[[[80,80],[100,80],[100,100],[80,100],[80,80]]],[[[80,0],[100,0],[100,20],[80,20],[80,0]]]]}}]}"#;

fn project(regions: &str, rest: &str) -> Project {
    let project = Project::of(&format!(
        "fretwork: 1\nmap: {{ crs: \"EPSG:32616\" }}\nregions:\n{regions}{rest}"
    ));
    project.write("specs/squares.geojson", SQUARES);
    project
}

/// The properties of the features of an artifact, in its order.
fn properties(project: &Project, name: &str) -> Vec<Value> {
    let text = project
        .files("out/spec")
        .remove(name)
        .expect("it was written");
    let file: Value = serde_json::from_slice(&text).expect("it is JSON");
    let features = file["features"].as_array().expect("a list").iter();
    features
        .map(|feature| feature["properties"].clone())
        .collect()
}

/// Bug: whole numbers went through floats: `1` came out as `1.0`, and numbers of 16 digits as others. What was null was left
/// out of the properties.
#[test]
fn whole_numbers_stay_as_they_are_and_nothing_is_null() {
    let regions = "  all: { geodata: { file: squares.geojson, labels: id } }\n  one: { geodata: { file: squares.geojson, where: { id: 9007199254740993 } } }\n";
    let artifacts = "artifacts:\n  all.geojson: { from: all, region: all, draw: filled, crs: map }\n  one.geojson: { from: one, region: one, draw: filled, crs: map }\n";
    let project = project(regions, artifacts);
    project.succeed(&["build"]);
    let first = json!({
        "id": 9_007_199_254_740_993_i64, "size": 1.0, "name": null, "wet": true,
        "labels": ["9007199254740993"], "node": "all",
    });
    let second = json!({
        "id": 9_007_199_254_740_992_i64, "size": 2.5, "name": " b", "wet": null,
        "labels": ["9007199254740992"], "node": "all",
    });
    let all = properties(&project, "all.geojson");
    assert_eq!(all.len(), 3);
    assert_eq!(
        all.iter().filter(|one| **one == first).count(),
        1,
        "{all:?}"
    );
    assert_eq!(
        all.iter().filter(|one| **one == second).count(),
        2,
        "{all:?}"
    );
    let one = properties(&project, "one.geojson");
    assert_eq!(one.len(), 1);
    assert_eq!(one[0]["id"], first["id"]);
    let text = String::from_utf8(project.files("out/spec").remove("one.geojson").unwrap()).unwrap();
    assert!(text.contains("\"id\":9007199254740993,"), "{text}");
}

/// Bug: the parts of a feature had one statistic together, although they are faces of their own.
#[test]
fn each_part_of_a_feature_has_its_own_statistic() {
    let fields = "fields:\n  ramp: { expression: { value: \"x + 1000 * y\" } }\n  mean: { zonal: { faces: all, from: ramp, statistic: mean } }\n";
    let project = project("  all: { geodata: { file: squares.geojson } }\n", fields);
    let at = [
        "inspect",
        "specs/spec.yaml",
        "mean",
        "--format",
        "json",
        "--at",
    ];
    let value = |place: &str| {
        let found = project.succeed(&[&at[..], &[place]].concat());
        let found: Value = serde_json::from_str(&found).unwrap();
        found["at"][0]["value"].as_f64().unwrap()
    };
    for (place, x, y) in [
        ("81,99", 90.0, 90.0),
        ("99,1", 90.0, 10.0),
        ("1,1", 10.0, 10.0),
    ] {
        let (found, mean) = (value(place), x + 1000.0 * y);
        assert!((found - mean).abs() < 1e-6, "{place}: {found}, not {mean}");
    }
}

/// What lies at a place of a region of features: the face, its labels and what the table says of it.
#[test]
fn a_region_tells_what_it_has_at_places() {
    let project = project(
        "  all: { geodata: { file: squares.geojson, labels: name } }\n",
        "",
    );
    let at = [
        "inspect",
        "specs/spec.yaml",
        "all",
        "--format",
        "json",
        "--at",
        "85,5",
        "--at",
        "50,50",
    ];
    let found: Value = serde_json::from_str(&project.succeed(&at)).unwrap();
    let [inside, outside] = [&found["at"][0], &found["at"][1]];
    assert_eq!(inside["labels"], json!([" b"]), "{found}");
    assert_eq!(inside["attributes"]["id"], json!(9_007_199_254_740_992_i64));
    assert_eq!(inside["attributes"]["wet"], Value::Null);
    let near = |value: &Value, wanted: f64| (value.as_f64().unwrap() - wanted).abs() < 1e-6;
    assert!(
        near(&inside["area"], 400.0) && near(&inside["distance"], 5.0),
        "{found}"
    );
    assert_eq!(
        (&outside["labels"], &outside["attributes"]),
        (&Value::Null, &Value::Null)
    );
}

/// The whole Earth in the web's plane is wider than 2^43 micrometres.
#[test]
fn a_map_of_the_whole_earth_is_built() {
    let project = Project::of(
        "fretwork: 1\nmap: { crs: \"EPSG:3857\" }\nregions: { page: { rectangle: { width: 40075016, height: 20000000, at: [-20037508, -10000000] } } }\npartitions: { rows: { stripes: { angle: 0, spacing: 200000 } } }\nartifacts: { rows.geojson: { from: rows, region: page, crs: map } }\n",
    );
    // 100 rows and the border of the page as a planar map.
    let found = project.succeed(&["inspect", "specs/spec.yaml", "rows", "--format", "json"]);
    let found: Value = serde_json::from_str(&found).unwrap();
    assert_eq!(
        (&found["faces"], &found["vertices"]),
        (&json!(101), &json!(204))
    );
}

/// What a build of a region from `file` says.
fn said(project: &Project, file: &str) -> String {
    project.write(
        "specs/spec.yaml",
        format!(
            "fretwork: 1\nmap: {{ crs: \"EPSG:32616\" }}\nregions:\n  all: {{ geodata: {{ {file} }} }}\nartifacts:\n  all.geojson: {{ from: all, region: all, crs: map }}\n"
        ),
    );
    project.run(&["build"]).stderr
}

#[test]
fn a_layer_that_is_a_view_is_told_with_a_way_out() {
    let project = Project::empty();
    let file = include_bytes!("data/views.gpkg");
    project.write("specs/views.gpkg", file);
    let told = said(&project, "file: views.gpkg, layer: steep tracks");
    let words: Vec<&str> = told.split_whitespace().filter(|w| *w != "│").collect();
    let told = words.join(" ");
    for part in [
        "its layer `steep tracks` is a view",
        "export `steep tracks` as a table",
        "`ogr2ogr -f GPKG table.gpkg specs/views.gpkg \"steep tracks\"`",
    ] {
        assert!(told.contains(part), "{told}");
    }
    let told = said(&project, "file: views.gpkg");
    assert!(told.contains("tracks, steep tracks"), "{told}");
    // What lies beside a view is read.
    said(&project, "file: views.gpkg, layer: tracks");
    let sheet =
        "  sheet: { rectangle: { width: 900, height: 900, at: [699900, 3999900] } }\nartifacts:";
    project.edit("specs/spec.yaml", "artifacts:", sheet);
    project.edit("specs/spec.yaml", "region: all", "region: sheet");
    project.succeed(&["build"]);
    let written = project.files("out/spec").remove("all.geojson");
    let text = String::from_utf8(written.expect("it was written")).expect("it is text");
    assert_eq!(text.matches("LineString").count(), 2, "{text}");
}

/// Bug: features without a value could not be taken, and nothing said that there are any.
#[test]
fn features_without_a_value_are_taken_by_null() {
    let one = "geodata: { file: squares.geojson, where: ";
    let regions = format!(
        "  none: {{ {one}{{ name: null }} }} }}\n  either: {{ {one}{{ name: [null, \" b\"], wet: true }} }} }}\n  dry: {{ {one}{{ wet: null }} }} }}\n"
    );
    let artifacts = ["none", "either", "dry"].map(|name| {
        format!("  {name}.geojson: {{ from: {name}, region: {name}, draw: filled, crs: map }}\n")
    });
    let project = project(&regions, &format!("artifacts:\n{}", artifacts.concat()));
    project.succeed(&["build"]);
    for (name, id, count) in [
        ("none.geojson", 9_007_199_254_740_993_i64, 1),
        ("either.geojson", 9_007_199_254_740_993, 1),
        ("dry.geojson", 9_007_199_254_740_992, 2),
    ] {
        let found = properties(&project, name);
        assert_eq!(found.len(), count, "{name}");
        assert!(found.iter().all(|one| one["id"] == json!(id)), "{name}");
    }
    let told = said(&project, "file: squares.geojson, where: { name: a }");
    let help = "`name` has  b, features without a value, which `null` takes";
    assert!(told.contains(help), "{told}");
}

/// Bug: what is wrong with the table of a Shapefile was told of the `.shp`.
#[test]
fn a_table_that_is_cut_is_named() {
    let project = super::project("fretwork: 1\n");
    let whole = include_bytes!("../../specs/maps/data/faces.dbf");
    project.write("specs/data/faces.dbf", &whole[..whole.len() / 2]);
    let told = said(&project, "file: data/faces.shp");
    let message = "cannot read `specs/data/faces.dbf`: the table is shorter than it says";
    assert!(told.contains(message), "{told}");
}

/// Bug: a text in UTF-16 was told as an unexpected character of line 1, or as nested.
#[test]
fn letters_of_two_bytes_are_told() {
    let project = Project::empty();
    let wide: Vec<u8> = SQUARES.encode_utf16().flat_map(u16::to_le_bytes).collect();
    for bytes in [[&[0xff, 0xfe][..], &wide].concat(), wide] {
        project.write("specs/squares.geojson", bytes);
        let told = said(&project, "file: squares.geojson");
        assert!(told.contains("save it again in UTF-8"), "{told}");
    }
}
