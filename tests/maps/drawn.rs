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

#[test]
fn points_that_bound_nothing_are_told() {
    let point =
        r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[10,20]}}"#;
    let line = r#"{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[0,0],[9,9]]}}"#;
    let run = |features: &str| {
        let project = project(&format!(
            "fretwork: 1\n{UTM}\nregions:\n  land: {{ geodata: {{ file: data/points.geojson }} }}\n\
             artifacts:\n  x.geojson: {{ from: land, crs: map }}\n"
        ));
        let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}}"#;
        let file = format!(r#"{{"type":"FeatureCollection",{crs},"features":[{features}]}}"#);
        project.write("specs/data/points.geojson", file);
        project.run(&["build"])
    };
    let alone = run(point);
    assert!(
        alone.code == Some(1) && alone.stderr.contains("points alone"),
        "{}",
        alone.stderr
    );
    let both = run(&format!("{point},{line}"));
    assert!(
        both.code == Some(0) && both.stderr.contains("are left out: 1"),
        "{}",
        both.stderr
    );
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
