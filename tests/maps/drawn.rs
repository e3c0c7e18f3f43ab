//! What is drawn of maps: the page about them, masks with lakes, curves that keep to their reach.

use super::{UTM, measures, project};

#[test]
fn the_specs_of_the_page_about_maps_build() {
    let page = include_str!("../../schemas/maps.md");
    let specs = page.split("```yaml\n").skip(1);
    let specs = specs.filter_map(|rest| rest.split("```").next());
    let mut count = 0;
    for spec in specs {
        let project = project(spec);
        let island = include_bytes!("../../specs/maps/data/island.geojson");
        project.write("specs/data/island.geojson", island);
        let done = project.run(&["build"]);
        assert!(
            done.code == Some(0) && !done.stderr.contains('⚠'),
            "{}",
            done.stderr
        );
        count += 1;
    }
    assert_eq!(count, 5);
}

/// Points of a map, the second of them at the end of a line, and the line.
const POINTS: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{"kind":"hut"},"geometry":{"type":"MultiPoint","coordinates":[[10,20],[30,5]]}},
{"type":"Feature","properties":{"kind":"top"},"geometry":{"type":"Point","coordinates":[40,40]}},
{"type":"Feature","properties":{"kind":"path"},"geometry":{"type":"LineString","coordinates":[[0,40],[40,40]]}}]}"#;

/// Points of a map are vertices with labels, for `place` and for mappers.
#[test]
fn points_of_a_map_are_vertices() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
regions:
  all: {{ geodata: {{ file: data/points.geojson, labels: kind }} }}
  page: {{ rectangle: {{ width: 60, height: 60 }} }}
exemplars:
  mark: {{ vector: {{ file: data/mark.svg }} }}
arrangements:
  marks: {{ place: {{ vertices: all, where: [hut, top], element: mark }} }}
  signs: {{ map: {{ vertices: all, with: {{ script: signs.star, entry: signs, args: {{ mark: mark }} }} }} }}
artifacts:
  marks.geojson: {{ from: marks, region: page, crs: map }}
  signs.geojson: {{ from: signs, region: page, crs: map }}
"
    ));
    project.write("specs/data/points.geojson", POINTS);
    project.write(
        "specs/signs.star",
        "def signs(mark):\n    def sign(v):\n        if not has_label(v, 'hut'):\n            return nothing()\n        at = match_point(mark, bbox_center(mark), location(v))\n        return translate(at, point(len(incident_faces(v)), 2))\n    return sign\n",
    );
    project.write(
        "specs/data/mark.svg",
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 4 4" width="4" height="4"><path d="M0 2H4" fill="none" stroke="black"/></svg>"#,
    );
    let done = project.run(&["build"]);
    assert!(
        done.code == Some(0) && !done.stderr.contains('⚠'),
        "{}",
        done.stderr
    );
    let middles = |name: &str| -> Vec<[f64; 2]> {
        let text = std::fs::read_to_string(project.path(&format!("out/spec/{name}"))).unwrap();
        let file: serde_json::Value = serde_json::from_str(&text).unwrap();
        let lines = file["features"].as_array().expect("a list").iter();
        let middle = |line: &serde_json::Value| {
            let ends = &line["geometry"]["coordinates"];
            [0, 1].map(|k| (ends[0][k].as_f64().unwrap() + ends[1][k].as_f64().unwrap()) / 2.0)
        };
        lines.map(middle).collect()
    };
    assert_eq!(
        middles("marks.geojson"),
        [[10.0, 20.0], [30.0, 5.0], [40.0, 40.0]]
    );
    assert_eq!(middles("signs.geojson"), [[11.0, 22.0], [31.0, 7.0]]);
    let faces = measures(&project, &["all"]);
    assert_eq!(faces["area"].as_f64(), Some(0.0), "{faces}");
}

/// A country of which one province has a lake that is no part of it.
const COUNTRY: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{"name":"west"},"geometry":{"type":"Polygon","coordinates":[[[0,0],[100,0],[100,100],[0,100],[0,0]],[[30,30],[30,70],[70,70],[70,30],[30,30]]]}},
{"type":"Feature","properties":{"name":"east"},"geometry":{"type":"Polygon","coordinates":[[[100,0],[200,0],[200,100],[100,100],[100,0]]]}}]}"#;

#[test]
fn a_lake_is_neither_masked_nor_filled() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
regions:
  country: {{ geodata: {{ file: data/country.geojson }} }}
  page: {{ rectangle: {{ width: 220, height: 120, at: [-10, -10] }} }}
partitions:
  rows: {{ stripes: {{ angle: 90, spacing: 20, anchor: origin, edge_labels: row }} }}
arrangements:
  masked: {{ inside: {{ input: rows, mask: country }} }}
  filled: {{ fill: {{ faces: country, with: rows }} }}
  lines:
    map:
      edges: filled
      with: \"def row(e):\\n  return to_curve(e) if has_label(e, 'row') else nothing()\\n\"
artifacts:
  x.svg: {{ from: masked, region: page }}
"
    ));
    project.write("specs/data/country.geojson", COUNTRY);
    // Rows stand at 10, 30, … 190; in the lake from 30 to 70 half of the height of three of them is missing, of which
    // those at its sides run along its shore.
    let length = |node: &str| {
        measures(&project, &[node, "--region", "page"])["length"]
            .as_f64()
            .expect("a length")
    };
    let (masked, filled) = (length("masked"), length("lines"));
    assert!((masked - 960.0).abs() < 1e-3, "{masked}");
    assert!((filled - 880.0).abs() < 81.0, "{filled}");
}

#[test]
fn curves_beyond_their_reach_are_told_with_the_cell() {
    let spec = |reach: &str| {
        format!(
            "fretwork: 1
{UTM}
regions:
  page: {{ rectangle: {{ width: 40, height: 20 }} }}
partitions:
  net: {{ grid: {{ across: {{ spacing: 10 }}, along: {{ angle: 90, spacing: 10 }}, border: keep_inside, anchor: [5, 5] }} }}
arrangements:
  moved: {{ vary: {{ faces: net, with: \"def f(c):\\n  return translate(contour(c), point(12, 0))\\n\"{reach} }} }}
artifacts:
  x.geojson: {{ from: moved, region: page, crs: map }}
"
        )
    };
    let done = project(&spec(", reach: 5")).run(&["build"]);
    assert_eq!(done.code, Some(1));
    for said in [
        "reaches 12",
        "`reach: 5`",
        "the face at (5, 5)",
        "spec.yaml:",
    ] {
        assert!(done.stderr.contains(said), "{said}: {}", done.stderr);
    }
    assert_eq!(project(&spec(", reach: 12")).run(&["build"]).code, Some(0));
    // `vary` promises the diagonal without being asked.
    assert_eq!(project(&spec("")).run(&["build"]).code, Some(0));
    let far = spec("").replace("point(12", "point(15");
    let done = project(&far).run(&["build"]);
    assert!(
        done.code == Some(1) && done.stderr.contains("diagonal"),
        "{}",
        done.stderr
    );
}
