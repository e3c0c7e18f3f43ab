//! Windows of what is built as a whole and then cut: copies that are packed, lines of equal height, scripts, and what is made of
//! them. They are what a cut of the whole that is done here has there, half-open, and the same whichever others are built.

use std::collections::BTreeSet;

use super::super::project::{Project, Random};

const SPEC: &str = r#"fretwork: 1
seed: SEED
map: {}
regions:
  sheet: { rectangle: { width: 400, height: 300, at: [1000, 2000] } }
exemplars:
  leaf: { vector: { file: leaf.svg } }
fields:
  wave: { expression: { value: "30 * sin(x / 40) * cos(y / 30)" } }
partitions:
  dust: { packed: { elements: leaf, scale: [1000, 2500], rotate: [0, 360], gap: 1 } }
  contours: { isolines: { field: wave, every: 4 } }
  rows: { stripes: { angle: 31, spacing: 3 } }
arrangements:
  own: { script: { file: own.star, entry: own } }
  within: { inside: { input: rows, mask: dust } }
  kept: { inside: { input: contours, mask: own, border: keep_outside } }
artifacts:
"#;

const SHOWN: [&str; 5] = ["dust", "contours", "own", "within", "kept"];

const OWN: &str = "def own():
    cells = uniform_partition(irregular_properties(0.003), CROP_ADD_BOUNDARY)
    def moved(f):
        return translate(scale(contour(f), 0.7), point(random(f, -2, 2, 1), 0))
    return map_to_faces(moved, cells)
";

const LEAF: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="8mm" height="4mm" viewBox="0 0 8 4"><path d="M0 2 L4 0 L8 2 L4 4 Z" fill="none" stroke="black"/></svg>"#;

type Line = Vec<[f64; 2]>;

/// The lines of a GeoJSON file.
fn lines(text: &[u8]) -> Vec<Line> {
    let json: serde_json::Value = serde_json::from_slice(text).expect("it is JSON");
    let features = json["features"].as_array().expect("a list").iter();
    features
        .map(|feature| {
            let all = feature["geometry"]["coordinates"].as_array();
            let points = all.expect("coordinates").iter();
            let number = |v: &serde_json::Value| v.as_f64().expect("a number");
            points.map(|p| [number(&p[0]), number(&p[1])]).collect()
        })
        .collect()
}

/// How long the part of a segment in a box is: its middle decides for the pieces between all crossings with the sides.
fn length_within([a, b]: [[f64; 2]; 2], window: [f64; 4]) -> f64 {
    let at = |t: f64| [0, 1].map(|i| a[i] + t * (b[i] - a[i]));
    let crossings = (0..4).map(|side| (window[side] - a[side % 2]) / (b[side % 2] - a[side % 2]));
    let mut cuts: Vec<f64> = crossings.filter(|t| *t > 0.0 && *t < 1.0).collect();
    cuts.extend([0.0, 1.0]);
    cuts.sort_by(f64::total_cmp);
    let whole = (b[0] - a[0]).hypot(b[1] - a[1]);
    let parts = cuts.windows(2).map(|t| {
        let [x, y] = at((t[0] + t[1]) / 2.0);
        let is_in = x >= window[0] && x < window[2] && y >= window[1] && y < window[3];
        if is_in { (t[1] - t[0]) * whole } else { 0.0 }
    });
    parts.sum()
}

fn length(lines: &[Line], window: [f64; 4]) -> f64 {
    let segments = lines.iter().flat_map(|line| line.windows(2));
    segments.map(|s| length_within([s[0], s[1]], window)).sum()
}

/// The points that lie in a window, away from its sides, as they are written.
fn points(lines: &[Line], [x0, y0, x1, y1]: [f64; 4]) -> BTreeSet<[u64; 2]> {
    let all = lines.iter().flatten();
    let is_in = |p: &&[f64; 2]| {
        let gaps = [p[0] - x0, x1 - p[0], p[1] - y0, y1 - p[1]];
        gaps.into_iter().fold(f64::INFINITY, f64::min) > 1e-3
    };
    all.filter(is_in).map(|p| p.map(f64::to_bits)).collect()
}

#[test]
fn windows_of_what_is_built_whole_are_cuts_of_it() {
    const EVERYWHERE: [f64; 4] = [f64::MIN, f64::MIN, f64::MAX, f64::MAX];
    let mut random = Random(41);
    for round in 0..2 {
        let artifacts = SHOWN.map(|n| {
            format!("  {n}.geojson: {{ from: {n}, region: sheet, clip: true, crs: map }}\n")
        });
        let seed = random.below(1000).to_string();
        let project = Project::of(&(SPEC.replace("SEED", &seed) + &artifacts.concat()));
        project.write("specs/own.star", OWN);
        project.write("specs/leaf.svg", LEAF);
        project.succeed(&["build"]);
        let mut number = |from: f64, range: u64| from + random.below(range * 10) as f64 / 10.0;
        let (x, y) = (number(1050.0, 200), number(2050.0, 150));
        let (x2, y2) = (number(x + 20.0, 90), number(y + 20.0, 60));
        // A window, and the one to the right of it.
        let windows = [[x, y, x2, y2], [x2, y, x2 + 40.0, y2]];
        let named = |window: &[f64; 4], by: &str| window.map(|v| v.to_string()).join(by);
        let [one, other] = windows.each_ref().map(|window| named(window, ","));
        project.succeed(&["build", "--no-cache", "--window", &one, "--window", &other]);
        let both = project.files("out");
        let whole = |name: &str| lines(&both[&format!("spec/{name}.geojson")]);
        for window in windows {
            project.succeed(&["build", "--no-cache", "--window", &named(&window, ",")]);
            let files = project.files("out");
            for name in SHOWN {
                let path = format!("spec/{name}/{}.geojson", named(&window, "_"));
                assert!(
                    files[&path] == both[&path],
                    "{round}: {path} is another one"
                );
                let (all, own) = (whole(name), lines(&files[&path]));
                let (expected, found) = (length(&all, window), length(&own, EVERYWHERE));
                assert!(expected > 20.0, "{round} {name}: nothing to see");
                let close = 1e-3 * own.len() as f64;
                assert!(
                    (expected - found).abs() < close,
                    "{round} {name}: {expected} {found}"
                );
                assert_eq!(points(&all, window), points(&own, window), "{round} {name}");
            }
        }
    }
}
