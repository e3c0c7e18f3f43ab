//! Tiled planar maps from specs: walls whose counts follow from formulas, which engine draws them and why, windows and
//! places of a wall that nobody could draw whole.

use super::project::Project;

const SPEC: &str = r#"fretwork: 1
units: m
map: {}
params: { courses: 120, halves: 181 }
regions: { page: { rectangle: { width: "${(halves + 1) * 10}", height: "${(courses + 1) * 5}" } } }
fields: { slant: { expression: { value: "0.001 * x" } } }
partitions:
  halves:
    grid:
      across: { spacing: 5, edge_labels: bed, face_labels: [odd, even] }
      along: { angle: 90, spacing: 10, edge_labels: [odd, even] }
      border: keep_inside
  odd_ones: { grid: { across: { spacing: 7 }, along: { angle: 90, spacing: "${sqrt(2)}" } } }
  rows: { stripes: { spacing: 3, anchor: origin } }
arrangements:
  wall: { map: { edges: halves, with: { script: wall.star, entry: bond } } }
  bricks: { map: { faces: wall, with: { script: wall.star, entry: shrink } } }
  hatched: { fill: { faces: bricks, with: rows } }
  dug: { outside: { input: wall, mask: bricks } }
  both: { union: [wall, bricks] }
  noisy: { vary: { faces: wall, with: { script: wall.star, entry: shake } }, seed: 5 }
  noisy_map: { map: { faces: wall, with: { script: wall.star, entry: shake } }, seed: 5 }
  leaning: { map: { faces: wall, with: { script: wall.star, entry: lean, args: { by: slant } } } }
  placed: { map: { faces: wall, with: { script: wall.star, entry: look } } }
  torn: { union: [halves, odd_ones] }
  over_torn: { transform: { faces: torn, scale: 0.5 } }
artifacts:
  wall.geojson: { from: wall, region: page, crs: map }
  noisy.geojson: { from: noisy, region: page, crs: map }
  all.json: { from: hatched, region: page }
  dug.json: { from: dug, region: page }
  both.json: { from: both, region: page }
  map.json: { from: noisy_map, region: page }
  leaning.json: { from: leaning, region: page }
  placed.json: { from: placed, region: page }
  torn.json: { from: over_torn, region: page }
"#;

const SCRIPT: &str = r#"
def bond():
    def joint(edge):
        if is_boundary(edge) or has_label(edge, "bed"):
            return to_curve(edge)
        course = "odd" if has_label(left_face(edge), "odd") else "even"
        return to_curve(edge) if has_label(edge, course) else nothing()
    return joint

def shrink():
    return lambda face: scale(contour(face), 0.9)

def shake():
    def mapper(face):
        if random(face, 0, 1, 2) < 0.1:
            return nothing()
        return translate(scale(contour(face), random(face, 0.7, 0.8, 1)), point(random(face, -0.4, 0.4, 0), 0))
    return mapper

def lean(by):
    return lambda face: scale(contour(face), 0.5 + 0.01 * by(face))

def look():
    def mapper(face):
        return contour(face) if centroid(face).x > 100 else nothing()
    return mapper
"#;

fn project() -> Project {
    let project = Project::empty();
    project.write("specs/wall.yaml", SPEC);
    project.write("specs/wall.star", SCRIPT);
    project
}

fn measures(project: &Project, args: &[&str]) -> serde_json::Value {
    let args = [&["inspect", "specs/wall.yaml"], args, &["--format", "json"]].concat();
    serde_json::from_str(&project.succeed(&args)).unwrap()
}

/// Bricks of two half bricks, with a half one at one end of every other course.
#[test]
fn counts_of_a_wall_follow_from_its_size() {
    let project = project();
    let found = measures(
        &project,
        &["wall", "--set", "courses=121", "--set", "halves=181"],
    );
    let (courses, halves) = (121, 181);
    let bricks = courses * (halves + 1) / 2;
    assert_eq!(found["faces"], bricks);
    assert_eq!(found["area"], f64::from(courses * halves) * 50.0);
    assert_eq!(found["components"], 1);
}

#[test]
fn both_engines_give_the_same_cells() {
    let project = project();
    for node in ["wall", "bricks", "hatched", "dug", "both", "noisy"] {
        let auto = measures(&project, &[node]);
        let general = measures(&project, &[node, "--engine", "general"]);
        for key in ["vertices", "edges", "faces", "components"] {
            assert_eq!(auto[key], general[key], "{node}.{key}");
        }
        for key in ["length", "area"] {
            let [a, b] = [&auto, &general].map(|m| m[key].as_f64().unwrap());
            assert!(
                (a - b).abs() <= 1e-9 * b.abs() + 1e-6,
                "{node}.{key}: {a} {b}"
            );
        }
    }
    let (vary, map) = (
        measures(&project, &["noisy"]),
        measures(&project, &["noisy_map"]),
    );
    assert_eq!(vary["edges"], map["edges"]);
    let [a, b] = [vary, map].map(|m| m["length"].as_f64().unwrap());
    assert!((a - b).abs() < 1e-4, "{a} {b}");
}

#[test]
fn explain_says_which_engine_and_why_not_the_other() {
    let project = project();
    project.succeed(&["build", "specs/wall.yaml"]);
    let said = |node: &str| project.succeed(&["explain", "specs/wall.yaml", node]);
    for node in ["wall", "bricks", "hatched", "dug", "both", "noisy"] {
        assert!(
            said(node).contains("engine: tiled, period ("),
            "{}",
            said(node)
        );
    }
    for (node, why) in [
        ("noisy_map", "a random value (specs/wall.star:15"),
        ("leaning", "the value of a field (specs/wall.star:21"),
        ("placed", "where a place lies (specs/wall.star:25"),
        ("over_torn", "no common multiple: "),
        // What lies in no one place is told at the node itself.
        ("over_torn", "degrees) (specs/wall.yaml:"),
    ] {
        let said = said(node);
        assert!(said.contains("engine: general, because"), "{said}");
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn a_window_of_a_wall_that_nobody_could_draw() {
    let project = project();
    let giant = ["--set", "courses=400000", "--set", "halves=200000"];
    let window = ["--window", "1000000.25,1000000.25,1000200.25,1000150.25"];
    let build = |only: &str| {
        let args = [
            &["build", "specs/wall.yaml", "--only", only][..],
            &giant,
            &window,
        ]
        .concat();
        project.succeed(&args);
        let stem = only.strip_suffix(".geojson").unwrap();
        let path = format!("out/wall/{stem}/1000000.25_1000000.25_1000200.25_1000150.25.geojson");
        let text = std::fs::read_to_string(project.path(&path)).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()
    };
    let length = |drawn: &serde_json::Value| -> f64 {
        let features = drawn["features"].as_array().unwrap();
        let lines = features
            .iter()
            .map(|f| f["geometry"]["coordinates"].as_array().unwrap());
        let of_line = |line: &Vec<serde_json::Value>| -> f64 {
            let number = |p: &serde_json::Value, i: usize| p[i].as_f64().unwrap();
            let ends = line.windows(2);
            ends.map(|e| {
                (number(&e[0], 0) - number(&e[1], 0)).hypot(number(&e[0], 1) - number(&e[1], 1))
            })
            .sum()
        };
        lines.map(of_line).sum()
    };
    assert!((length(&build("wall.geojson")) - 7500.0).abs() < 1e-6);
    assert!(length(&build("noisy.geojson")) > 5000.0);
    let args = [&["wall", "--at", "1000000.25,1000000.25"][..], &giant].concat();
    let found = &measures(&project, &args)["at"][0];
    assert_eq!(found["area"], 100.0);
    assert_eq!(found["distance"], 2.25);
    assert_eq!(found["labels"], serde_json::json!(["odd"]));
}

#[test]
fn places_outside_of_all_and_in_what_the_general_engine_draws() {
    let project = project();
    let outside = &measures(&project, &["wall", "--at", "-40,300"])["at"][0];
    assert!(outside["labels"].is_null() && outside["area"].is_null());
    assert_eq!(outside["distance"], 45.0);
    for node in ["bricks", "noisy"] {
        let asked = [node, "--at", "905.5,305"];
        let auto = measures(&project, &asked);
        let general = measures(&project, &[&asked[..], &["--engine", "general"]].concat());
        for key in ["area", "distance"] {
            let [a, b] = [&auto, &general].map(|m| m["at"][0][key].as_f64().unwrap());
            assert!((a - b).abs() < 1e-6, "{node}.{key}: {a} {b}");
        }
    }
}
