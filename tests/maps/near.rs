//! Windows of arrangements that are not repeated: built alone they are, byte for byte, what the whole has there, and cost no
//! more when the region is larger.

use super::{UTM, project};
use crate::project::{Project, Random};

/// Arrangements of every kind that knows how far its cells are felt, alone and on one another. Capital letters stand for
/// numbers.
const NODES: &str = r#"
fields:
  height: { raster: { file: data/massif.tif } }
  orient: { attribute: { region: massif, name: orient } }
  aim: { expression: { value: "x / 50 + y / 70", unit: deg } }
  wide: { expression: { value: "SIZE + h / 100", fields: { h: height } } }
exemplars:
  leaf: { vector: { file: leaf.svg } }
partitions:
  cells: { uniform: { cell_size: SIZE, border: crop_add_boundary, face_labels: { a: 1, b: 2 } } }
  kept: { random: { cell_size: SIZE, border: keep_outside } }
  inner: { uniform: { cell_size: SIZE, border: keep_inside } }
  dense: { uniform: { cell_size: wide, border: crop_add_boundary } }
  rows: { stripes: { angle: aim, spacing: [11.3, 17], edge_labels: [a, b] } }
  lines: { stripes: { angle: ANGLE, spacing: 23, anchor: origin } }
  net: { grid: { across: { angle: ANGLE, spacing: SIZE }, along: { angle: 110, spacing: [53, 27] }, border: keep_outside } }
  cut: { grid: { across: { angle: 20, spacing: 39, face_labels: [a, b] }, along: { angle: 110, spacing: [53, 27] }, border: crop_add_boundary } }
  turned: { stripes: { angle: orient, spacing: 40 } }
  contours: { isolines: { field: height, every: 20 } }
arrangements:
  jitter: { map: { faces: cells, reach: 9, with: "def m(f):\n  return translate(scale(contour(f), 0.7), point(random(f, -4, 4, 1), random(f, -4, 4, 2)))\n" } }
  shaken: { map: { faces: net, reach: 9, with: "def m(f):\n  return translate(scale(contour(f), 0.7), point(random(f, -4, 4, 1), 0))\n" } }
  asking: { map: { edges: cells, reach: 1, with: "def m(e):\n  return to_curve(e) if not is_boundary(e) and has_label(left_face(e), 'a') else nothing()\n" } }
  ends: { map: { vertices: cut, reach: 90, with: "def m(v):\n  return translate(to_curve(incident_edges(v)[0]), point(3, 2)) if len(incident_edges(v)) == 4 and random(v, 0, 1, 1) < 0.1 else nothing()\n" } }
  high: { map: { faces: dense, reach: 1, with: { script: high.star, entry: high, args: { height: height } } } }
  few: { map: { faces: cells, reach: 1, with: "def m(f):\n  return scale(contour(f), 0.9) if random(f, 0, 1, 7) < 0.05 else nothing()\n" } }
  clustered: { map: { faces: cells, reach: 1, with: "def m(f):\n  return scale(contour(f), 1.0 if random(f, 0, 1, 7) < 0.6 else 0.7)\n" } }
  among_few: { fill: { faces: few, with: rows } }
  among_clusters: { fill: { faces: clustered, with: rows } }
  hatch: { fill: { faces: cells, with: rows } }
  nested: { fill: { faces: jitter, with: rows } }
  small: { transform: { faces: cells, scale: 0.8, rotate: 20 } }
  inset: { transform: { faces: kept, inset: 4 } }
  again: { map: { faces: small, reach: 3, with: "def m(f):\n  return scale(contour(f), 0.5)\n" } }
  third: { transform: { edges: again, at: [5, 5] } }
  leaves: { place: { edges: cells, element: leaf, chance: 0.7, flip: 0.5 } }
  round: { place: { faces: inner, element: leaf, fit: true, rotate: [0, 360], scale: [0.5, 1.5] } }
  dots: { place: { vertices: cells, element: leaf, scale: [0.2, 0.4] } }
  masked: { inside: { input: lines, mask: disc } }
  outer: { outside: { input: cut, mask: disc, border: crop_add_boundary } }
  whole: { inside: { input: hatch, mask: disc, border: keep_outside } }
  among: { inside: { input: lines, mask: cells } }
  both: { union: [small, lines, shaken] }
  faces: { fill: { faces: massif, with: turned } }
  rocky: { inside: { input: lines, mask: massif } }
  above: { inside: { input: contours, mask: disc } }
  crossed: { union: [contours, cut] }
  named: { relabel: { from: hatch, labels: { a: x } } }
  varied: { vary: { faces: inner, with: "def m(f):\n  return rotate(contour(f), random(f, 0, 1, 3))\n" } }
"#;

const SHOWN: &[&str] = &[
    "cells",
    "kept",
    "inner",
    "dense",
    "lines",
    "net",
    "cut",
    "jitter",
    "shaken",
    "asking",
    "ends",
    "high",
    "hatch",
    "nested",
    "small",
    "inset",
    "again",
    "third",
    "leaves",
    "round",
    "dots",
    "masked",
    "outer",
    "whole",
    "among",
    "both",
    "faces",
    "rocky",
    "named",
    "varied",
    "contours",
    "above",
    "crossed",
    "among_few",
    "among_clusters",
];

const HIGH: &str = "def high(height):
    def keep(face):
        z = height(face)
        return contour(face) if z != None and z > 500 else nothing()
    return keep
";

const LEAF: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="8mm" height="4mm" viewBox="0 0 8 4"><path d="M0 2 L4 0 L8 2 L4 4 Z" fill="none" stroke="black"/><circle data-label="point:start" cx="0" cy="2" r="1"/><circle data-label="point:end" cx="8" cy="2" r="1"/></svg>"#;

const REGIONS: &str = "regions:
  sheet: { rectangle: { width: 4000, height: 3000, at: [736000, 4050000] } }
  massif: { geodata: { file: data/faces.shp } }
  disc: { circle: { radius: 1300, at: [738100, 4051500] } }";

fn spec(random: &mut Random) -> String {
    let nodes = NODES
        .replace("SIZE", &(50 + random.below(40)).to_string())
        .replace("ANGLE", &(1 + random.below(88)).to_string());
    let artifacts: String = SHOWN
        .iter()
        .map(|name| {
            format!("  {name}.geojson: {{ from: {name}, region: sheet, clip: true, crs: map }}\n")
        })
        .collect();
    let seed = random.below(1000);
    format!("fretwork: 1\nseed: {seed}\n{UTM}\n{REGIONS}\n{nodes}artifacts:\n{artifacts}")
}

fn of(spec: &str) -> Project {
    let project = project(spec);
    project.write("specs/high.star", HIGH);
    project.write("specs/leaf.svg", LEAF);
    project
}

/// A window of a sheet, from 200 to 700 wide and high; some reach beyond its border.
fn window(random: &mut Random) -> String {
    let mut number = |from: u64, range: u64| from as f64 + random.below(range * 100) as f64 / 100.0;
    let (x, y) = (number(735_800, 3900), number(4_049_800, 2900));
    let (width, height) = (number(200, 500), number(200, 500));
    format!("{x},{y},{},{}", x + width, y + height)
}

#[test]
fn a_window_alone_is_that_of_the_whole() {
    let mut random = Random(5);
    for round in 0..2 {
        let project = of(&spec(&mut random));
        let windows: Vec<String> = (0..2).map(|_| window(&mut random)).collect();
        // With one that shows all of the page, the page is drawn once for all of them.
        let page = "736000,4050000,740000,4053000".to_string();
        let all = windows.iter().chain([&page]);
        let all = all.flat_map(|window| ["--window", window.as_str()]);
        let all: Vec<&str> = ["build", "--no-cache"].into_iter().chain(all).collect();
        project.succeed(&all);
        let whole = project.files("out");
        let mut drawn = 0;
        for window in &windows {
            let name = window.replace(',', "_");
            project.succeed(&["build", "--no-cache", "--window", window]);
            for (path, bytes) in project.files("out") {
                if path.contains(&name) {
                    assert!(whole[&path] == bytes, "{round}: {path} is another one");
                    drawn += usize::from(bytes.len() > 400);
                }
            }
        }
        assert!(drawn > 40, "{drawn} windows have something in them");
    }
}

/// Lines to be cut are in one order however a window is built: what is inside before what is around it.
#[test]
fn cuts_of_a_window_alone_are_in_the_order_of_the_whole() {
    let files = |args: &[&str]| {
        let nodes = "partitions:
  cells: { uniform: { cell_size: 90, face_labels: { a: 1, b: 1 } } }
arrangements:
  outer: { transform: { faces: cells, scale: 0.9 } }
  inner: { transform: { faces: outer, scale: 0.6 } }
artifacts:
  cut.dxf: { region: sheet, parts: [{ from: outer, role: cut }, { from: inner, role: cut, layer: inner }] }
  cut.svg: { region: sheet, parts: [{ from: outer, role: cut }, { from: inner, role: cut }] }
";
        let project = project(&format!("fretwork: 1\n{UTM}\n{REGIONS}\n{nodes}"));
        project.succeed(&[&["build", "--no-cache"], args].concat());
        project.files("out")
    };
    let windows = [
        "736400,4050300,736900,4050800",
        "738011.5,4051003.25,738400,4051600",
    ];
    let page = "736000,4050000,740000,4053000";
    let all = windows.iter().chain([&page]);
    let whole = files(
        &all.flat_map(|window| ["--window", window])
            .collect::<Vec<_>>(),
    );
    let mut compared = 0;
    for window in windows {
        let name = window.replace(',', "_");
        for (path, bytes) in files(&["--window", window]) {
            if path.contains(&name) {
                assert!(whole[&path] == bytes, "{path} is another one");
                compared += usize::from(bytes.len() > 2000);
            }
        }
    }
    assert_eq!(compared, 4);
}

#[test]
fn a_window_of_a_region_that_is_too_large_is_drawn() {
    // A thousand million cells: more than a partition may have.
    let large = "regions:
  sheet: { rectangle: { width: 2000000, height: 2000000, at: [0, 4000000] } }
  massif: { geodata: { file: data/faces.shp } }
  disc: { circle: { radius: 1300, at: [738100, 4051500] } }";
    let text = spec(&mut Random(8)).replace(REGIONS, large);
    let window = "738000,4051000,738300,4051200";
    for name in ["jitter", "nested", "third", "leaves", "shaken"] {
        let project = of(&text);
        let path = format!("{name}.geojson");
        let arguments = ["build", "--no-cache", "--only", path.as_str()];
        let failed = project.run(&arguments);
        assert!(failed.code == Some(1), "{name} is drawn as a whole");
        project.succeed(&[&arguments[..], &["--window", window]].concat());
        let files = project.files("out");
        assert!(files.values().any(|bytes| bytes.len() > 1000), "{name}");
    }
}

#[test]
fn a_mapper_without_a_reach_is_drawn_as_a_whole_and_told() {
    let text = spec(&mut Random(3)).replace("reach: 9, ", "");
    let project = of(&text);
    let window = "738000,4051000,738300,4051200";
    let arguments = [
        "build",
        "--no-cache",
        "--only",
        "nested.geojson",
        "--window",
        window,
    ];
    let run = project.run(&arguments);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert_eq!(
        run.stderr.matches("add `reach: LENGTH`").count(),
        1,
        "{}",
        run.stderr
    );
    assert!(
        run.stderr.contains("`jitter` is evaluated on all cells"),
        "{}",
        run.stderr
    );
    let denied = project.run(&[&arguments[..], &["--deny", "warnings"]].concat());
    assert_eq!(denied.code, Some(1));
    let with = of(&spec(&mut Random(3))).run(&arguments);
    assert!(!with.stderr.contains("reach"), "{}", with.stderr);
}

#[test]
fn what_a_window_shows_is_not_told_apart_by_how_it_was_measured() {
    let project = of(&spec(&mut Random(4)));
    let inspect = |name: &str, more: &[&str]| {
        let arguments = ["inspect", "specs/spec.yaml", name, "--region", "sheet"];
        let arguments = [&arguments[..], &["--format", "json"], more].concat();
        let json: serde_json::Value =
            serde_json::from_str(&project.succeed(&arguments)).expect("measures");
        json["length"].as_f64().expect("a length")
    };
    for name in ["jitter", "hatch", "masked"] {
        let whole = inspect(name, &[]);
        let (mut sum, mut random) = (0.0, Random(9));
        let mut cuts = |from: f64, length: u64| {
            let mut cuts: Vec<f64> = (0..3).map(|_| from + random.below(length) as f64).collect();
            cuts.extend([from - 100.0, from + length as f64 + 100.0]);
            cuts.sort_by(f64::total_cmp);
            cuts
        };
        let (xs, ys) = (cuts(736_000.0, 4000), cuts(4_050_000.0, 3000));
        for (x, y) in xs
            .windows(2)
            .flat_map(|x| ys.windows(2).map(move |y| (x, y)))
        {
            if x[0] < x[1] && y[0] < y[1] {
                let window = format!("{},{},{},{}", x[0], y[0], x[1], y[1]);
                sum += inspect(name, &["--window", &window]);
            }
        }
        assert!((whole - sum).abs() < 1e-6 * whole, "{name}: {whole} {sum}");
    }
}

#[test]
fn what_is_at_a_place_is_that_of_the_whole() {
    let project = of(&spec(&mut Random(6)));
    let mut random = Random(12);
    for name in ["cells", "jitter", "hatch", "masked", "faces"] {
        let places: Vec<String> = (0..4)
            .map(|_| {
                let (x, y) = (random.below(399_000) as f64, random.below(299_000) as f64);
                format!("{},{}", 736_000.0 + x / 100.0, 4_050_000.0 + y / 100.0)
            })
            .collect();
        let at = |engine: &str| {
            let places = places.iter().flat_map(|place| ["--at", place]);
            let arguments = ["inspect", "specs/spec.yaml", name, "--region", "sheet"];
            let more = ["--format", "json", "--engine", engine];
            let all: Vec<&str> = arguments.into_iter().chain(more).chain(places).collect();
            let json: serde_json::Value =
                serde_json::from_str(&project.succeed(&all)).expect("measures");
            json["at"].as_array().expect("places").clone()
        };
        // Each curve is as near as an edge, but for the resolution.
        let is_same = |a: &serde_json::Value, b: &serde_json::Value| {
            let distance = |of: &serde_json::Value| of["distance"].as_f64().expect("a distance");
            let rest = ["labels", "area", "centroid"];
            rest.iter().all(|name| a[name] == b[name]) && (distance(a) - distance(b)).abs() < 1e-6
        };
        let (near, whole) = (at("auto"), at("general"));
        let mut pairs = near.iter().zip(&whole);
        assert!(
            pairs.all(|(a, b)| is_same(a, b)),
            "{name}: {near:?} {whole:?}"
        );
    }
}
