//! Areas in GeoJSON are valid: no ring comes to a place twice or meets itself, whole and in windows.

use super::{UTM, project};
use crate::project::Project;
use serde_json::Value;

/// A chessboard, whose squares touch at corners; a circle that touches the sides of the window.
const SPEC: &str = "
regions:
  page: { rectangle: { width: 60, height: 60 } }
  disk: { circle: { radius: 20, at: [30, 30] } }
  rest: { difference: [page, disk] }
  pinched: { geodata: { file: data/pinched.geojson } }
partitions:
  net: { grid: { across: { spacing: 10, face_labels: [a, b] }, along: { angle: 90, spacing: 10, face_labels: [x, y] }, border: keep_inside } }
arrangements:
  half: { map: { faces: net, reach: 0, with: \"def m(f):\\n  return contour(f) if has_label(f, 'a') == has_label(f, 'x') and not is_boundary(f) else nothing()\\n\" } }
  board: { union: [half, page] }
artifacts:
  board.geojson: { from: board, region: page, draw: filled, crs: map }
  rest.geojson: { from: rest, region: page, draw: filled, crs: map }
  pinched.geojson: { from: pinched, draw: filled, crs: map }
  degrees.geojson: { from: pinched, draw: filled }
";

/// A square of 100 m with a hole of 1,000 m² that touches its side.
const PINCHED: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[500000,4000000],[500100,4000000],[500100,4000100],[500000,4000100],[500000,4000000]],[[500000,4000050],[500050,4000030],[500050,4000070],[500000,4000050]]]}}]}"#;

type Position = [f64; 2];

/// The rings of all polygons of a file.
fn rings(text: &str) -> Vec<Vec<Position>> {
    let file: Value = serde_json::from_str(text).unwrap();
    let features = file["features"].as_array().unwrap().iter();
    let polygons = features.map(|feature| &feature["geometry"]);
    let polygons = polygons.filter(|geometry| geometry["type"] == "Polygon");
    polygons
        .flat_map(|geometry| {
            serde_json::from_value::<Vec<Vec<Position>>>(geometry["coordinates"].clone()).unwrap()
        })
        .collect()
}

/// Whether two sides of a closed ring meet that do not follow one another.
fn meets_itself(ring: &[Position]) -> bool {
    let sides: Vec<(Position, Position)> = ring.windows(2).map(|w| (w[0], w[1])).collect();
    let turn = |a: Position, b: Position, p: Position| {
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
    };
    let between = |a: Position, b: Position, p: Position| {
        turn(a, b, p) == 0.0 && (p[0] - a[0]) * (p[0] - b[0]) + (p[1] - a[1]) * (p[1] - b[1]) <= 0.0
    };
    let meet = |(a, b): (Position, Position), (c, d): (Position, Position)| {
        let crosses = turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
        crosses
            || [c, d].iter().any(|p| between(a, b, *p))
            || [a, b].iter().any(|p| between(c, d, *p))
    };
    let last = sides.len() - 1;
    (0..=last).any(|i| {
        (i + 2..=last)
            .filter(|j| (i, *j) != (0, last))
            .any(|j| meet(sides[i], sides[j]))
    })
}

fn area(rings: &[Vec<Position>]) -> f64 {
    let signed = |ring: &Vec<Position>| -> f64 {
        let [x0, y0] = ring[0];
        let cross =
            |w: &[Position]| (w[0][0] - x0) * (w[1][1] - y0) - (w[1][0] - x0) * (w[0][1] - y0);
        ring.windows(2).map(cross).sum::<f64>() / 2.0
    };
    rings.iter().map(signed).sum()
}

fn text(project: &Project, name: &str) -> String {
    std::fs::read_to_string(project.path(&format!("out/spec/{name}.geojson"))).unwrap()
}

#[test]
fn no_ring_meets_itself_where_faces_touch_at_corners() {
    let project = project(&format!("fretwork: 1\n{UTM}{SPEC}"));
    project.write("specs/data/pinched.geojson", PINCHED);
    project.succeed(&["build"]);
    let windows = ["--window", "0,0,31,33", "--window", "10,10,50,50"];
    project.succeed(
        &[
            &[
                "build",
                "specs/spec.yaml",
                "--only",
                "board.geojson",
                "--only",
                "rest.geojson",
            ][..],
            &windows,
        ]
        .concat(),
    );
    for (name, expected) in [
        ("board", 3600.0),
        ("rest", 3600.0 - 1256.637),
        ("pinched", 9000.0),
        ("board/0_0_31_33", 1023.0),
        ("board/10_10_50_50", 1600.0),
        ("rest/10_10_50_50", 1600.0 - 1256.637),
    ] {
        let rings = rings(&text(&project, name));
        let bad = rings.iter().find(|ring| meets_itself(ring));
        assert!(bad.is_none(), "{name}: {bad:?}");
        let found = area(&rings);
        assert!(
            (found - expected).abs() < 1.0,
            "{name}: {found} and {expected}"
        );
    }
    let rings = rings(&text(&project, "degrees"));
    assert_eq!(rings.len(), 2);
}
