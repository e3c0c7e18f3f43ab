//! Points of maps: what a table says of them as fields, as features of GeoJSON, and on lines.

use super::{UTM, measures, project};
use serde_json::{Value, json};

/// Two huts, a spring in the middle of a path, and the path.
const PLACES: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{"kind":"hut","beds":12},"geometry":{"type":"MultiPoint","coordinates":[[10,20],[30,60]]}},
{"type":"Feature","properties":{"kind":"spring","beds":null},"geometry":{"type":"Point","coordinates":[20,40]}},
{"type":"Feature","properties":{"kind":"path","beds":3},"geometry":{"type":"LineString","coordinates":[[0,40],[40,40]]}}]}"#;

/// A line beside the path.
const WAY: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{"kind":"way"},"geometry":{"type":"LineString","coordinates":[[0,50],[40,50]]}}]}"#;

/// A line along a part of the path.
const TRACK: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{"kind":"track"},"geometry":{"type":"LineString","coordinates":[[10,40],[30,40]]}}]}"#;

const SPEC: &str = "regions:
  all: { geodata: { file: data/places.geojson, labels: kind } }
  way: { geodata: { file: data/way.geojson, labels: kind } }
  track: { geodata: { file: data/track.geojson, labels: kind } }
  page: { rectangle: { width: 60, height: 60 } }
fields:
  beds: { attribute: { region: all, name: beds } }
  known: { attribute: { region: all, name: beds, otherwise: 1 } }
arrangements:
  both: { union: [all] }
  two: { union: [all, way] }
  along: { union: [all, way, track] }
  bars:
    map:
      vertices: all
      with: { script: bars.star, entry: bars, args: { beds: beds, known: known } }
  parts:
    map:
      edges: all
      with: \"def part(e):\\n  return scale(to_curve(e), 0.5)\\n\"
artifacts:
  all.geojson: { from: all, region: page, crs: map }
  earth.geojson: { from: all, region: page }
  union.geojson: { from: two, region: page, crs: map }
  along.geojson: { from: along, region: page, crs: map }
  both.geojson: { from: both, region: page, crs: map }
  filled.geojson: { from: all, region: page, crs: map, draw: filled }
  bars.geojson: { from: bars, region: page, crs: map }
  parts.geojson: { from: parts, region: page, crs: map }
";

/// A line as long as the place has beds, of a place without any a line down as long as the field says instead.
const BARS: &str = "
def bars(beds, known):
    def bar(v):
        at = location(v)
        to = point(beds(v), 0) if beds(v) != None else point(0, -known(at))
        line = import_svg('line.svg')
        return match_points(line, point(0, 0), point(1, 0), at, at + to)
    return bar
";

fn built(args: &[&str]) -> crate::project::Project {
    let project = project(&format!("fretwork: 1\n{UTM}\n{SPEC}"));
    project.write("specs/data/places.geojson", PLACES);
    project.write("specs/data/way.geojson", WAY);
    project.write("specs/data/track.geojson", TRACK);
    project.write("specs/bars.star", BARS);
    let line = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1" width="1" height="1"><path d="M0 0H1" fill="none" stroke="black"/></svg>"#;
    project.write("specs/line.svg", line);
    let done = project.run(&[&["build"], args].concat());
    let is_quiet = !done.stderr.contains('⚠') || !args.is_empty();
    assert!(done.code == Some(0) && is_quiet, "{}", done.stderr);
    project
}

/// The features of a file: coordinates and properties.
fn features(project: &crate::project::Project, name: &str) -> Vec<(Value, Value)> {
    let text = std::fs::read_to_string(project.path(&format!("out/spec/{name}.geojson")));
    let file: Value = serde_json::from_str(&text.expect("it was written")).expect("JSON");
    let features = file["features"].as_array().expect("features").iter();
    let feature = |f: &Value| {
        (
            f["geometry"]["coordinates"].clone(),
            f["properties"].clone(),
        )
    };
    features.map(feature).collect()
}

#[test]
fn points_of_a_map_are_features_with_their_columns() {
    let project = built(&[]);
    let of = |kind: &str, beds: Value| json!({ "labels": [kind], "node": "all", "kind": kind, "beds": beds });
    let hut = of("hut", json!(12));
    let path = json!({ "labels": ["path"], "node": "all" });
    // The hut in the north lies on the border of the page.
    let expected = [
        (json!([[0, 40], [40, 40]]), path),
        (json!([10, 20]), hut.clone()),
        (json!([20, 40]), of("spring", Value::Null)),
        (json!([30, 60]), hut),
    ];
    assert_eq!(features(&project, "all"), expected);
    let filled = features(&project, "filled");
    assert_eq!(filled.len(), 3, "{filled:?}");
    // Of a union labels are left.
    let both = features(&project, "both");
    let spring = json!({ "labels": ["spring"], "node": "both" });
    assert!(both.contains(&(json!([20, 40]), spring)), "{both:?}");
    let earth = features(&project, "earth");
    let degrees = |(at, _): &(Value, Value)| at[0].as_f64();
    let degrees: Vec<f64> = earth.iter().filter_map(degrees).collect();
    assert_eq!(degrees.len(), 3);
    assert!(
        degrees.iter().all(|x| (-92.0..-91.0).contains(x)),
        "{degrees:?}"
    );
}

#[test]
fn points_of_a_map_are_in_one_of_the_windows_that_meet_there() {
    let windows = ["0,0,60,20", "0,20,20,60", "20,20,60,40", "20,40,60,60"];
    let args = windows.iter().flat_map(|window| ["--window", window]);
    let project = built(&args.collect::<Vec<_>>());
    let found = windows.map(|window| {
        let name = format!("all/{}", window.replace(',', "_"));
        let all = features(&project, &name).into_iter();
        let points = all.filter(|(at, _)| at[0].is_number());
        points.map(|(at, _)| at.to_string()).collect::<Vec<_>>()
    });
    let none: [&str; 0] = [];
    assert_eq!(found[0], none);
    assert_eq!(found[1], ["[10,20]"]);
    assert_eq!(found[2], none);
    assert_eq!(found[3], ["[20,40]", "[30,60]"]);
}

#[test]
fn attributes_of_points_are_fields() {
    let project = built(&[]);
    let bars: Vec<Value> = features(&project, "bars")
        .into_iter()
        .map(|f| f.0)
        .collect();
    // Ends of the path lie on no point of the table; the page cuts what reaches beyond it.
    let expected = [
        json!([[0, 39], [0, 40]]),
        json!([[10, 20], [22, 20]]),
        json!([[20, 39], [20, 40]]),
        json!([[40, 39], [40, 40]]),
    ];
    let ordered = |line: &Value| {
        let mut ends = line.as_array().expect("a line").clone();
        ends.sort_by_key(Value::to_string);
        Value::from(ends)
    };
    let inside = bars.iter().map(ordered).filter(|bar| bar[0][1] != 60);
    assert_eq!(inside.collect::<Vec<_>>(), expected);
    let place = |at: &str| measures(&project, &["all", "--at", at])["at"][0]["attributes"].clone();
    assert_eq!(place("30,60"), json!({ "kind": "hut", "beds": 12 }));
    assert_eq!(place("31,60"), Value::Null);
}

/// The lines and points of a file that have a label.
fn labelled(project: &crate::project::Project, name: &str, kind: &str) -> Vec<Value> {
    let all = features(project, name);
    let has = all.into_iter().filter(|(_, properties)| {
        let labels = properties["labels"].as_array().expect("labels");
        labels.contains(&json!(kind))
    });
    has.map(|(at, _)| at).collect()
}

#[test]
fn lines_of_several_labels_have_points_on_them() {
    let project = built(&[]);
    let labelled = |kind: &str| labelled(&project, "union", kind);
    // The spring stands on the path, beside which another line runs.
    assert_eq!(labelled("path"), [json!([[0, 40], [40, 40]])]);
    assert_eq!(labelled("way"), [json!([[0, 50], [40, 50]])]);
    assert_eq!(labelled("spring"), [json!([20, 40])]);
}

#[test]
fn lines_along_one_another_are_parted_by_the_points_on_them() {
    let project = built(&[]);
    let labelled = |kind: &str| labelled(&project, "along", kind);
    let line = |from: i32, to: i32| json!([[from, 40], [to, 40]]);
    // The spring stands where both of them run.
    assert_eq!(labelled("track"), [line(10, 20), line(20, 30)]);
    let path = [line(0, 10), line(10, 20), line(20, 30), line(30, 40)];
    assert_eq!(labelled("path"), path);
    assert_eq!(labelled("way"), [json!([[0, 50], [40, 50]])]);
    assert_eq!(labelled("spring"), [json!([20, 40])]);
}

#[test]
fn a_point_on_a_line_parts_it() {
    let project = built(&[]);
    let parts: Vec<Value> = features(&project, "parts")
        .into_iter()
        .map(|f| f.0)
        .collect();
    assert_eq!(
        parts,
        [json!([[5, 40], [15, 40]]), json!([[25, 40], [35, 40]])]
    );
}
