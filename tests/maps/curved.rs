//! Curves of drawings in maps: how finely they are flattened, and how large files of many copies are.

use super::project;

/// A leaf of two Béziers, 90 m long.
const LEAF: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 -20 90 40" width="90" height="40"><path d="M0 0 C30 -20 60 -20 90 0 C60 20 30 20 0 0 Z" fill="none" stroke="black"/></svg>"#;

/// A leaf drawn in the west of a page, from an exemplar and from what scripts import.
fn spec(head: &str, exemplar: &str) -> String {
    format!(
        "fretwork: 1
{head}
regions:
  page: {{ rectangle: {{ width: 200, height: 200, at: [-50, -100] }} }}
exemplars:
  leaf: {{ vector: {{ file: leaf.svg{exemplar} }} }}
arrangements:
  named: {{ map: {{ faces: page, with: {{ script: leaf.star, entry: named, args: {{ leaf: leaf }} }} }} }}
  imported: {{ map: {{ faces: page, with: {{ script: leaf.star, entry: imported }} }} }}
  coarse: {{ map: {{ faces: page, with: {{ script: leaf.star, entry: coarse }} }} }}
artifacts:
  named.geojson: {{ from: named, region: page, crs: map }}
  imported.geojson: {{ from: imported, region: page, crs: map }}
  coarse.geojson: {{ from: coarse, region: page, crs: map }}
"
    )
}

const SCRIPT: &str = "
def named(leaf):
    return lambda face: leaf

def imported():
    return lambda face: import_svg('leaf.svg')

def coarse():
    return lambda face: import_svg('leaf.svg', tolerance = 3)
";

type Place = [f64; 2];

/// The corners of the lines in an artifact, line by line.
fn lines(project: &crate::project::Project, name: &str) -> Vec<Vec<Place>> {
    let text = std::fs::read_to_string(project.path(&format!("out/spec/{name}.geojson")));
    let file: serde_json::Value =
        serde_json::from_str(&text.expect("it was written")).expect("JSON");
    let features = file["features"].as_array().expect("features").iter();
    let place = |at: &serde_json::Value| [0, 1].map(|axis| at[axis].as_f64().expect("a number"));
    let line = |feature: &serde_json::Value| {
        let all = feature["geometry"]["coordinates"].as_array();
        all.expect("a line").iter().map(place).collect()
    };
    features.map(line).collect()
}

/// The distance of a place from the segment from a to b.
fn distance(at: Place, a: Place, b: Place) -> f64 {
    let (along, off) = ([b[0] - a[0], b[1] - a[1]], [at[0] - a[0], at[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let t = ((off[0] * along[0] + off[1] * along[1]) / square).clamp(0.0, 1.0);
    (off[0] - t * along[0]).hypot(off[1] - t * along[1])
}

/// How far the leaf's curves are from these lines, at a thousand places of each.
fn deviation(lines: &[Vec<Place>]) -> f64 {
    let bezier = |side: f64, t: f64| {
        let u = 1.0 - t;
        let x = 3.0 * u * u * t * 30.0 + 3.0 * u * t * t * 60.0 + t * t * t * 90.0;
        [x, side * 3.0 * u * t * 20.0]
    };
    let sides = [1.0, -1.0].into_iter();
    let places = sides.flat_map(|side| (0..=1000).map(move |n| bezier(side, f64::from(n) / 1e3)));
    let nearest = |at: Place| {
        let segments = lines.iter().flat_map(|line| line.windows(2));
        let all = segments.map(|ends| distance(at, ends[0], ends[1]));
        all.fold(f64::INFINITY, f64::min)
    };
    places.map(nearest).fold(0.0, f64::max)
}

/// How many corners the three leaves have, and how far they are from the drawing.
fn measured(head: &str, exemplar: &str) -> [(usize, f64); 3] {
    let project = project(&spec(head, exemplar));
    project.write("specs/leaf.svg", LEAF);
    project.write("specs/leaf.star", SCRIPT);
    project.succeed(&["build"]);
    ["named", "imported", "coarse"].map(|name| {
        let lines = lines(&project, name);
        (lines.iter().map(Vec::len).sum(), deviation(&lines))
    })
}

#[test]
fn curves_of_drawings_in_maps_are_as_fine_as_paper_shows() {
    // A thousandth of 90 m is less than the 0.25 m that nobody sees at this scale, and it is the rule without a scale.
    for head in ["map: { scale: \"1:25000\" }", "map: {}"] {
        let [named, imported, coarse] = measured(head, "");
        assert_eq!(named, imported, "{head}");
        assert!(named.1 > 0.01 && named.1 <= 0.0901, "{head}: {named:?}");
        assert!((20..60).contains(&named.0), "{head}: {named:?}");
        assert!(coarse.1 > 0.1 && coarse.1 <= 3.0001, "{head}: {coarse:?}");
        assert!(coarse.0 < 14, "{head}: {coarse:?}");
    }
}

#[test]
fn curves_of_drawings_in_maps_of_a_large_scale_are_finer() {
    // 0.01 mm at 1:500 is 5 mm.
    let [named, imported, _] = measured("map: { scale: \"1:500\" }", "");
    assert_eq!(named, imported);
    assert!(named.1 > 5e-4 && named.1 <= 5.2e-3, "{named:?}");
    // What a spec says counts.
    let [named, imported, _] = measured("map: { scale: \"1:500\" }", ", tolerance: 1");
    assert!(named.1 > 0.05 && named.1 <= 1.0001, "{named:?}");
    assert!(imported.1 <= 5.2e-3, "{imported:?}");
}

#[test]
fn import_svg_refuses_a_tolerance_that_is_none() {
    let of = |tolerance: &str| {
        let project = project(&spec("map: {}", ""));
        project.write("specs/leaf.svg", LEAF);
        project.write(
            "specs/leaf.star",
            SCRIPT.replace("tolerance = 3", &format!("tolerance = {tolerance}")),
        );
        project.run(&["build"]).stderr
    };
    assert!(of("0").contains("a positive tolerance"), "{}", of("0"));
    assert!(
        of("1e-12").contains("finer than anything"),
        "{}",
        of("1e-12")
    );
    assert!(of("'1'").contains("takes a number"), "{}", of("'1'"));
}
