//! Maps from the command line: windows and tiles of what is drawn, GeoJSON, and the plane with y to the north.
//! GeoJSON is read here, strictly, by code of its own.

use super::project::Project;
use serde_json::Value;

/// A sheet far from the origin, as maps have them.
const MAP: &str = r#"fretwork: 1
seed: SEED
map: { crs: "EPSG:32616", tiles: { origin: [735000, 4048900], size: 800 } }
regions:
  sheet: { rectangle: { width: 400, height: 300, at: [735000, 4048500] } }
  hole: { circle: { radius: 60, at: [735200, 4048650] } }
  ring: { difference: [sheet, hole] }
partitions:
  cells: { uniform: { cell_size: 30, border: crop_add_boundary } }
  rows: { stripes: { angle: 33, spacing: 7.3, edge_labels: [a, b], anchor: origin } }
  net: { grid: { across: { angle: 20, spacing: 19 }, along: { angle: 110, spacing: [13, 7] }, border: keep_outside } }
arrangements:
  hatch: { fill: { faces: cells, with: rows } }
  shaken: { map: { faces: net, with: "def m(f):\n  return translate(scale(contour(f), 0.7), point(random(f, -3, 3, 1), 0))\n" } }
  masked: { inside: { input: net, mask: ring } }
artifacts:
  hatch.geojson: { from: hatch, region: sheet, clip: true, crs: map }
  shaken.geojson: { from: shaken, region: sheet, clip: true, crs: map }
  masked.geojson: { from: masked, region: sheet, crs: map, optimize: true }
  cells.geojson: { from: cells, region: sheet, draw: filled, crs: map }
  ring.geojson: { from: ring, region: sheet, draw: filled, crs: map }
"#;

const LINES: [&str; 3] = ["hatch", "shaken", "masked"];

/// A position as it is written.
type Position = [f64; 2];

/// A feature: the rings of a polygon or the one line, and its properties.
#[derive(Debug)]
struct Feature {
    is_area: bool,
    lines: Vec<Vec<Position>>,
    properties: Value,
}

/// The features of a GeoJSON file, all of whose rules are looked at.
fn features(text: &str) -> Vec<Feature> {
    let file: Value = serde_json::from_str(text).expect("the file is JSON");
    assert_eq!(file["type"], "FeatureCollection");
    let features = file["features"].as_array().expect("it has features");
    features.iter().map(feature).collect()
}

fn feature(json: &Value) -> Feature {
    assert_eq!(json["type"], "Feature");
    assert!(json["properties"]["labels"].is_array() && json["properties"]["node"].is_string());
    let geometry = &json["geometry"];
    let coordinates = &geometry["coordinates"];
    let line = |of: &Value| -> Vec<Position> {
        let items = of.as_array().expect("a list of positions");
        let position = |p: &Value| {
            let p = p.as_array().expect("a position");
            assert_eq!(p.len(), 2);
            [p[0].as_f64().expect("x"), p[1].as_f64().expect("y")]
        };
        items.iter().map(position).collect()
    };
    let (is_area, lines) = match geometry["type"].as_str() {
        Some("LineString") => (false, vec![line(coordinates)]),
        Some("Polygon") => {
            let rings = coordinates.as_array().expect("rings").iter().map(line);
            (true, rings.collect())
        }
        other => panic!("{other:?}"),
    };
    for (number, line) in lines.iter().enumerate() {
        assert!(line.windows(2).all(|w| w[0] != w[1]), "a position twice");
        if is_area {
            assert!(line.len() > 3 && line.first() == line.last());
            assert_eq!(
                area(line) > 0.0,
                number == 0,
                "exterior rings run counter-clockwise"
            );
        } else {
            assert!(line.len() > 1);
        }
    }
    Feature {
        is_area,
        lines,
        properties: json["properties"].clone(),
    }
}

fn area(ring: &[Position]) -> f64 {
    let [x, y] = ring[0];
    let at = |p: Position| (p[0] - x, p[1] - y);
    let cross = |w: &[Position]| {
        let (a, b) = (at(w[0]), at(w[1]));
        a.0 * b.1 - a.1 * b.0
    };
    ring.windows(2).map(cross).sum::<f64>() / 2.0
}

fn length(features: &[Feature]) -> f64 {
    let lines = features.iter().flat_map(|f| &f.lines);
    let pairs = lines.flat_map(|line| line.windows(2));
    pairs
        .map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]))
        .sum()
}

fn total_area(features: &[Feature]) -> f64 {
    let rings = features.iter().flat_map(|f| &f.lines);
    rings.map(|ring| area(ring)).sum()
}

fn read(project: &Project, path: &str) -> Vec<Feature> {
    let file = project.path(&format!("out/spec/{path}"));
    features(&std::fs::read_to_string(file).expect("the file was written"))
}

/// The four windows around a point.
fn windows(at: Position) -> Vec<[f64; 4]> {
    let (x, y) = (
        [735_000.0, at[0], 735_400.0],
        [4_048_500.0, at[1], 4_048_800.0],
    );
    let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
    let window = |(i, j): (usize, usize)| [x[i], y[j], x[i + 1], y[j + 1]];
    corners.into_iter().map(window).collect()
}

fn named(window: [f64; 4]) -> String {
    window.map(|number| number.to_string()).join("_")
}

/// The ends of lines on a cut, as their bits.
fn ends(features: &[Feature], at: Position) -> Vec<[u64; 2]> {
    let lines = features.iter().flat_map(|f| &f.lines);
    let ends = lines.flat_map(|line| [line[0], line[line.len() - 1]]);
    let on_cut = ends.filter(|p| p[0] == at[0] || p[1] == at[1]);
    on_cut.map(|p| p.map(f64::to_bits)).collect()
}

#[test]
fn windows_together_are_the_whole() {
    let mut random = super::project::Random(11);
    for round in 0..3 {
        let project = Project::of(&MAP.replace("SEED", &random.below(1000).to_string()));
        project.succeed(&["build", "--jobs", "1"]);
        let at = [
            735_100.0 + random.below(2_000_000) as f64 * 1e-4,
            4_048_600.0 + random.below(1_000_000) as f64 * 1e-4,
        ];
        let at = at.map(|v| (v * 1e4).round() / 1e4);
        for (number, window) in windows(at).into_iter().enumerate() {
            let cache = format!("cache{number}");
            let jobs = (1 + number % 2).to_string();
            let window = window.map(|v| v.to_string()).join(",");
            project.succeed(&[
                "build",
                "--window",
                &window,
                "--cache-dir",
                &cache,
                "--jobs",
                &jobs,
            ]);
        }
        for name in LINES {
            let whole = read(&project, &format!("{name}.geojson"));
            let parts = windows(at).into_iter().map(named);
            let parts: Vec<Feature> = parts
                .flat_map(|window| read(&project, &format!("{name}/{window}.geojson")))
                .collect();
            let (all, sum) = (length(&whole), length(&parts));
            assert!(
                all > 1000.0 && (all - sum).abs() < 1e-3 * (parts.len() as f64),
                "{round} {name} {all} {sum}"
            );
            let mut ends = ends(&parts, at);
            ends.sort_unstable();
            assert!(ends.len() > 10);
            let is_paired = ends.chunk_by(|a, b| a == b).all(|same| same.len() % 2 == 0);
            assert!(is_paired, "{round} {name}: an end has no partner");
        }
        for name in ["cells", "ring"] {
            let whole = total_area(&read(&project, &format!("{name}.geojson")));
            let parts = windows(at).into_iter().map(named);
            let sum: f64 = parts
                .map(|window| total_area(&read(&project, &format!("{name}/{window}.geojson"))))
                .sum();
            assert!((whole - sum).abs() < 0.05, "{round} {name} {whole} {sum}");
        }
    }
}

#[test]
fn a_window_is_the_same_from_any_build() {
    let project = Project::of(&MAP.replace("SEED", "5"));
    let window = "735050.5,4048550.25,735200,4048700";
    let build = |more: &[&str]| {
        let arguments = [
            &["build", "--only", "hatch.geojson", "--window", window][..],
            more,
        ];
        project.succeed(&arguments.concat());
        project.files("out")
    };
    let alone = build(&["--cache-dir", "a", "--jobs", "1"]);
    assert_eq!(alone, build(&["--cache-dir", "b", "--jobs", "2"]));
    assert_eq!(alone, build(&["--no-cache"]));
    let features = read(&project, "hatch/735050.5_4048550.25_735200_4048700.geojson");
    let positions = features.iter().flat_map(|f| f.lines.iter().flatten());
    assert!(positions.clone().count() > 100);
    for [x, y] in positions {
        assert!((735_050.5..=735_200.0).contains(x) && (4_048_550.25..=4_048_700.0).contains(y));
    }
}

/// Bug: a line that lies beside the side of two windows by less than the last digit of the file was in neither of them: it was
/// left out of the upper one by where it lies, and of the lower one by where it is written.
#[test]
fn a_line_on_a_seam_by_rounding_is_in_one_window() {
    let spec = "fretwork: 1\nmap: { tiles: { origin: [0.1, 24.1], size: 24 } }\nregions: { page: { rectangle: { width: 24, height: 24, at: [0.1, 0.1] } } }\npartitions:\n  rows: { stripes: { angle: 0, spacing: 0.3, anchor: [0.25, 0.25] } }\n  net: { grid: { across: { angle: 0, spacing: 0.3 }, along: { angle: 90, spacing: 0.3 }, anchor: [0.25, 0.25] } }\narrangements:\n  bent: { map: { edges: net, reach: 1, with: \"def m(e):\\n  return to_curve(e)\\n\" } }\nartifacts:\n  rows.geojson: { from: rows, region: page, crs: map }\n  net.geojson: { from: net, region: page, crs: map }\n  bent.geojson: { from: bent, region: page, crs: map }\n";
    let project = Project::of(spec);
    project.succeed(&["build"]);
    for engine in ["auto", "general"] {
        for name in ["rows", "net", "bent"] {
            let whole = length(&read(&project, &format!("{name}.geojson")));
            let only = format!("{name}.geojson");
            let build = |more: &[&str]| {
                let all = ["build", "--no-cache", "--engine", engine, "--only", &only];
                project.succeed(&[&all[..], more].concat());
            };
            // Each alone, and all of them together.
            for (level, side) in [(1u32, 2u32), (2, 4), (3, 8)] {
                let mut sum = 0.0;
                if level < 3 {
                    for k in 0..side * side {
                        let tile = format!("{level}/{}/{}", k / side, k % side);
                        build(&["--tile", &tile]);
                    }
                } else {
                    build(&["--tile", "3/*/*"]);
                }
                for k in 0..side * side {
                    let tile = format!("{name}/{level}/{}/{}.geojson", k / side, k % side);
                    sum += length(&read(&project, &tile));
                }
                assert!(
                    (sum - whole).abs() < 1e-6,
                    "{name} {engine} {level}: {sum} of {whole}"
                );
            }
        }
    }
    // The line y = 1, by chance a little below.
    let only = ["build", "--no-cache", "--only", "rows.geojson", "--window"];
    for window in ["0.1,0.4,24.1,1", "0.1,1,24.1,1.6"] {
        project.succeed(&[&only[..], &[window]].concat());
    }
    // Two lines, and as much of the sides of the page.
    for name in ["0.1_0.4_24.1_1", "0.1_1_24.1_1.6"] {
        let found = length(&read(&project, &format!("rows/{name}.geojson")));
        assert!((found - 49.2).abs() < 1e-6, "{name}: {found}");
    }
}

/// Tiles that are built together are cut of one sheet that was made ready as a whole.
#[test]
fn tiles_built_together_are_those_that_are_built_alone() {
    let more = [
        "  hatch.svg: { from: hatch, region: sheet, clip: true }\n",
        "  rows.svg: { from: rows, region: ring, clip: true, style: { b: { width: 0.5 } } }\n",
        "  cells.svg: { from: cells, region: sheet, draw: filled }\n",
        "  both.dxf: { parts: [{ from: rows, role: draw }, { from: cells, role: draw }], region: sheet }\n",
        "  over.geojson: { parts: [{ from: net }, { from: net }, { from: sheet }], region: sheet, crs: map }\n",
    ];
    let project = Project::of(&(MAP.replace("SEED", "6") + &more.concat()));
    project.succeed(&["build", "--tile", "2/0-1/0-1", "--out", "together"]);
    let together = project.files("together");
    assert_eq!(together.len(), 4 * 10);
    for tile in ["2/0/0", "2/0/1", "2/1/0", "2/1/1"] {
        project.succeed(&["build", "--no-cache", "--tile", tile, "--out", "alone"]);
    }
    let alone = project.files("alone");
    for (name, bytes) in &together {
        assert!(alone.get(name) == Some(bytes), "{name} differs");
        assert!(bytes.len() > 300, "{name}");
    }
}

#[test]
fn lines_are_drawn_once_and_have_their_labels() {
    let project = Project::of(&MAP.replace("SEED", "5"));
    project.succeed(&["build"]);
    let hatch = read(&project, "hatch.geojson");
    let label = |f: &Feature| f.properties["labels"].as_array().map_or(0, Vec::len);
    assert!(hatch.iter().any(|f| label(f) == 1) && hatch.iter().any(|f| label(f) == 0));
    assert!(
        hatch
            .iter()
            .all(|f| f.properties["node"] == "hatch" && !f.is_area)
    );
    let segments = hatch.iter().flat_map(|f| f.lines[0].windows(2));
    let mut segments: Vec<[[u64; 2]; 2]> = segments
        .map(|w| {
            let mut ends = [w[0].map(f64::to_bits), w[1].map(f64::to_bits)];
            ends.sort_unstable();
            ends
        })
        .collect();
    segments.sort_unstable();
    assert!(segments.windows(2).all(|pair| pair[0] != pair[1]));
    let cells = read(&project, "cells.geojson");
    assert!(cells.iter().all(|f| f.is_area));
    assert!((total_area(&cells) - 400.0 * 300.0).abs() < 0.1);
    let [ring] = &read(&project, "ring.geojson")[..] else {
        panic!("one polygon")
    };
    assert_eq!(ring.lines.len(), 2);
    let text = std::fs::read_to_string(project.path("out/spec/ring.geojson")).expect("written");
    assert!(text.contains("urn:ogc:def:crs:EPSG::32616"));
}

#[test]
fn tiles_stand_in_folders_of_their_level_and_column() {
    let project = Project::of(&MAP.replace("SEED", "5"));
    let tile = |text: &str| project.run(&["build", "--only", "hatch.geojson", "--tile", text]);
    assert_eq!(tile("3/*/0-7").code, Some(0));
    let files: Vec<String> = project.files("out").into_keys().collect();
    let tiles: Vec<&str> = files
        .iter()
        .filter_map(|f| f.split_once("hatch/3/").map(|(_, t)| t))
        .collect();
    // Tiles are 100 wide; the sheet's far sides lie on their borders.
    assert!(
        tiles.contains(&"0/1.geojson") && tiles.contains(&"3/3.geojson"),
        "{tiles:?}"
    );
    assert!(
        !tiles.iter().any(|t| t.ends_with("/7.geojson")),
        "{tiles:?}"
    );
    let inner: Vec<Feature> = tiles
        .iter()
        .flat_map(|t| read(&project, &format!("hatch/3/{t}")))
        .collect();
    project.succeed(&["build", "--only", "hatch.geojson"]);
    let whole = length(&read(&project, "hatch.geojson"));
    assert!((length(&inner) - whole).abs() < 1e-3 * inner.len() as f64);
    // An empty tile is a file without features.
    assert_eq!(tile("3/7/7").code, Some(0));
    assert!(read(&project, "hatch/3/7/7.geojson").is_empty());
    let outside = tile("3/8/0");
    assert_eq!(outside.code, Some(1));
    assert!(
        outside.stderr.contains("tile") && outside.stderr.contains("spec.yaml"),
        "{}",
        outside.stderr
    );
}

#[test]
fn tiles_belong_to_their_artifact() {
    let project = Project::of(&MAP.replace("SEED", "5"));
    project.succeed(&["build"]);
    project.succeed(&["build", "--only", "hatch.geojson", "--tile", "3/1/*"]);
    let window = [
        "build",
        "--only",
        "hatch.geojson",
        "--window",
        "735000.5,4048500,735100,4048600",
    ];
    project.succeed(&window);
    let parts = || {
        let files = project.files("out").into_keys();
        files.filter(|path| path.starts_with("spec/hatch/")).count()
    };
    let all = parts();
    assert!(all > 2);
    project.succeed(&["build", "--locked"]);
    project.succeed(&["build", "--prune"]);
    assert_eq!(parts(), all);
    // When the artifact goes they go with it.
    project.edit(
        "specs/spec.yaml",
        "  hatch.geojson: { from: hatch, region: sheet, clip: true, crs: map }\n",
        "",
    );
    project.succeed(&["build", "--prune"]);
    assert_eq!(parts(), 0);
}

#[test]
fn a_window_is_measured_as_it_is_cut() {
    let project = Project::of(&MAP.replace("SEED", "5"));
    let measure = |node: &str, more: &[&str], name: &str| {
        let arguments = [
            &["inspect", "specs/spec.yaml", node, "--format", "json"][..],
            more,
        ]
        .concat();
        let json: Value = serde_json::from_str(&project.succeed(&arguments)).expect("measures");
        json[name].as_f64().expect("a number")
    };
    for (node, name) in [("masked", "length"), ("ring", "area")] {
        let page: &[&str] = if node == "masked" {
            &["--region", "sheet"]
        } else {
            &[]
        };
        let whole = measure(node, page, name);
        let parts = windows([735_130.5, 4_048_620.25])
            .into_iter()
            .map(|window| {
                let window = window.map(|v| v.to_string()).join(",");
                measure(node, &[page, &["--window", &window]].concat(), name)
            });
        let sum: f64 = parts.sum();
        assert!(
            whole > 100.0 && (whole - sum).abs() < 1e-3,
            "{node} {whole} {sum}"
        );
    }
    let wrong = project.run(&["inspect", "specs/spec.yaml", "ring", "--window", "1,1,0,0"]);
    assert_eq!(wrong.code, Some(2));
}

#[test]
fn wrong_windows_and_tiles_are_told() {
    let project = Project::of(&MAP.replace("SEED", "5"));
    for window in [
        "735400,4048500,735000,4048800",
        "0,0,0,1",
        "1,2,3",
        "a,b,c,d",
    ] {
        let run = project.run(&["build", "--window", window]);
        assert_eq!(run.code, Some(2), "{window}");
        assert!(run.stderr.contains("window"), "{}", run.stderr);
    }
    for tile in ["1/2", "x/0/0", "3/2-1/0", "99/0/0"] {
        assert_eq!(
            project.run(&["build", "--tile", tile]).code,
            Some(2),
            "{tile}"
        );
    }
    let negative = project.run(&["build", "--only", "ring.geojson", "--window", "-5,-5,5,5"]);
    assert_eq!(negative.code, Some(0), "{}", negative.stderr);
    project.edit(
        "specs/spec.yaml",
        ", tiles: { origin: [735000, 4048900], size: 800 }",
        "",
    );
    let without = project.run(&["build", "--tile", "0/0/0"]);
    assert_eq!(without.code, Some(1));
    assert!(without.stderr.contains("tiles"), "{}", without.stderr);
}

#[test]
fn geojson_needs_a_map() {
    let spec = "fretwork: 1\nregions: { page: { rectangle: { width: 4, height: 3 } } }\n\
                artifacts: { x.geojson: { from: page, crs: map } }\n";
    let run = Project::of(spec).run(&["build"]);
    assert_eq!(run.code, Some(1));
    assert!(run.stderr.contains("map: {}"), "{}", run.stderr);
    let plane = spec.replace("fretwork: 1\n", "fretwork: 1\nmap: {}\n");
    let project = Project::of(&plane);
    project.succeed(&["build"]);
    let text = std::fs::read_to_string(project.path("out/spec/x.geojson")).expect("written");
    assert!(!text.contains("crs"));
    // A rectangle has a curve a side.
    assert_eq!(features(&text).len(), 4);
}

/// A flag whose drawn point is above its foot, in a drawing whose y goes down.
const FLAG: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="10mm" height="20mm" viewBox="0 0 10 20"><path d="M0 0 H10 L0 8 V20" fill="none" stroke="black"/></svg>"#;

#[test]
fn drawings_stay_upright_in_maps() {
    let spec = "fretwork: 1\nmap: {}\n\
        regions: { page: { rectangle: { width: 2, height: 3, at: [10, 20] } } }\n\
        exemplars: { flag: { vector: { file: flag.svg } } }\n\
        artifacts:\n  a.svg: { from: page }\n  b.geojson: { from: flag, crs: map }\n  c.svg: { from: flag }\n  \
        d.svg: { from: page, region: page, scale: \"1:100\", stroke: 0.1 }\n  e.dxf: { from: page, region: page }\n";
    let project = Project::empty();
    project.write("specs/spec.yaml", spec);
    project.write("specs/flag.svg", FLAG);
    project.succeed(&["build", "specs/spec.yaml"]);
    let text = |path: &str| {
        std::fs::read_to_string(project.path(&format!("out/spec/{path}"))).expect("written")
    };
    // North is at the top, at -23.
    assert!(
        text("a.svg").contains("M10 -20") || text("a.svg").contains("-23"),
        "{}",
        text("a.svg")
    );
    // The top of the flag is the greatest y of the map: the file is 20 mm high, which lies below 0.
    let [flag] = &features(&text("b.geojson"))[..] else {
        panic!("one line")
    };
    let y = |f: fn(f64, f64) -> f64| {
        flag.lines[0]
            .iter()
            .map(|p| p[1])
            .reduce(f)
            .expect("points")
    };
    assert_eq!((y(f64::max), y(f64::min)), (0.0, -0.02));
    assert_eq!(flag.lines[0].first().map(|p| p[1]), Some(0.0));
    assert!(text("c.svg").contains("0.008"), "{}", text("c.svg"));
    // Paper begins at its upper left corner: 2 m by 3 m at 1:100.
    assert!(
        text("d.svg").contains("viewBox=\"0 0 20 30\""),
        "{}",
        text("d.svg")
    );
    assert!(text("d.svg").contains("stroke-width=\"0.1\""));
    // DXF is not mirrored.
    let dxf = text("e.dxf");
    let numbers: Vec<&str> = dxf.lines().map(str::trim).collect();
    assert!(numbers.contains(&"23") && !numbers.contains(&"-23"));
    // Without a scale files are in metres.
    let unit = numbers.iter().position(|line| *line == "$INSUNITS");
    assert_eq!(unit.map(|at| numbers[at + 2]), Some("6"));
    assert!(!text("a.svg").contains("mm\""), "{}", text("a.svg"));
}

/// What counts are the lines in the region, however far it lies from where they are counted from.
#[test]
fn lines_anchored_far_from_the_region_are_those_in_it() {
    let project = Project::of(
        "fretwork: 1\nmap: { crs: \"EPSG:32632\" }\nregions: { site: { rectangle: { width: 60, height: 40, at: [600000, 5200000] } } }\n\
         partitions:\n  net: { grid: { across: { spacing: 0.5 }, along: { angle: 90, spacing: 0.5 }, anchor: origin } }\n  \
         rows: { stripes: { spacing: 2.5, anchor: origin } }\n\
         artifacts:\n  net.geojson: { from: net, region: site, crs: map }\n  rows.geojson: { from: rows, region: site, crs: map }\n",
    );
    project.succeed(&["build"]);
    let rows = read(&project, "rows.geojson");
    let ends = |row: &&Feature| row.lines[0].iter().map(|p| p[0]).collect::<Vec<_>>();
    let inner = rows
        .iter()
        .filter(|row| ends(row) == [600_000.0, 600_060.0]);
    assert!((15..=18).contains(&inner.count()), "{rows:?}");
    let net = read(&project, "net.geojson");
    let length = |line: &[Position]| -> f64 {
        let pairs = line.windows(2);
        pairs
            .map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]))
            .sum()
    };
    let whole: f64 = net.iter().flat_map(|f| &f.lines).map(|l| length(l)).sum();
    assert!((whole - 9600.0).abs() < 120.0, "{whole}");
}

#[test]
fn neighbouring_sheets_match_where_they_are_anchored() {
    let spec = |at: f64| {
        format!(
            "fretwork: 1\nmap: {{}}\nregions: {{ page: {{ rectangle: {{ width: 10, height: 10, at: [{at}, 0] }} }} }}\n\
             partitions:\n  rows: {{ stripes: {{ angle: 30, spacing: 0.7, anchor: origin }} }}\n  \
             net: {{ grid: {{ across: {{ spacing: 3 }}, along: {{ angle: 90, spacing: 4 }}, anchor: [1, 2] }} }}\n\
             artifacts:\n  rows.geojson: {{ from: rows, region: page, crs: map }}\n  \
             net.geojson: {{ from: net, region: page, crs: map }}\n"
        )
    };
    let ends = |at: f64, name: &str| {
        let project = Project::of(&spec(at));
        project.succeed(&["build"]);
        let all = read(&project, name);
        let points = all.iter().flat_map(|f| f.lines[0].iter());
        let mut on_border: Vec<i64> = points
            .filter(|p| p[0] == 10.0)
            .map(|p| (p[1] * 1e4).round() as i64)
            .collect();
        on_border.sort_unstable();
        on_border.dedup();
        on_border
    };
    for name in ["rows.geojson", "net.geojson"] {
        let (left, right) = (ends(0.0, name), ends(10.0, name));
        assert!(left.len() > 2);
        assert_eq!(left, right, "{name}");
    }
}
