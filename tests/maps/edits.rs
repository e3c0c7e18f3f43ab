//! Edits of a map's data: what runs again, and how far from a field's change lines may differ.

use super::{UTM, project};
use crate::project::{Project, Random};

/// Hatching by an attribute and by heights, in artifacts of their own, through a mapper.
const EDITED: &str = "regions:
  sheet: { rectangle: { width: 7200, height: 6000, at: [735000, 4048500] } }
  massif: { geodata: { file: data/faces.shp } }
fields:
  height: { raster: { file: data/massif.tif } }
  gap: { attribute: { region: massif, name: gap } }
  orient: { attribute: { region: massif, name: orient } }
partitions:
  rows: { stripes: { angle: 30, spacing: gap } }
  turned: { stripes: { angle: orient, spacing: 90 } }
  cells: { uniform: { cell_size: 600 } }
arrangements:
  spaced: { fill: { faces: massif, with: rows } }
  aimed: { fill: { faces: massif, with: turned } }
  high: { map: { faces: cells, with: { script: high.star, entry: high, args: { height: height } } } }
artifacts:
  spaced.geojson: { from: spaced, region: sheet, crs: map }
  aimed.geojson: { from: aimed, region: sheet, crs: map }
  high.geojson: { from: high, region: sheet, crs: map }
";

const HIGH: &str = "def high(height):
    def keep(face):
        z = height(face)
        return contour(face) if z != None and z > 600 else nothing()
    return keep
";

/// The names of the nodes that a build evaluates, and the artifacts that it writes.
fn ran(project: &Project) -> (Vec<String>, Vec<String>) {
    let report = project.succeed(&["build", "--format", "json"]);
    let report: serde_json::Value = serde_json::from_str(&report).expect("a report");
    let of = |list: &str, status: &str, key: &str| -> Vec<String> {
        let all = report[list].as_array().expect("a list").iter();
        let meant = all.filter(|one| one["status"] == status);
        meant
            .map(|one| one[key].as_str().expect("a name").to_string())
            .collect()
    };
    (
        of("nodes", "evaluated", "name"),
        of("artifacts", "written", "path"),
    )
}

#[test]
fn an_edit_of_the_data_reaches_what_reads_it_and_nothing_else() {
    let project = project(&format!("fretwork: 1\n{UTM}\n{EDITED}"));
    project.write("specs/high.star", HIGH);
    assert_eq!(ran(&project).1.len(), 3);
    assert_eq!(ran(&project), (vec![], vec![]));
    // The first digit of one value in the column `gap`.
    let mut table = include_bytes!("../../specs/maps/data/faces.dbf").to_vec();
    let header = usize::from(u16::from_le_bytes([table[8], table[9]]));
    let (mut at, mut offset) = (32, 1);
    while !table[at..].starts_with(b"gap\0") {
        offset += usize::from(table[at + 16]);
        at += 32;
    }
    let field = header + offset;
    let width = usize::from(table[at + 16]);
    let first = (field..field + width).find(|byte| table[*byte].is_ascii_digit());
    let digit = first.expect("the first value is a number");
    table[digit] = if table[digit] == b'7' { b'3' } else { b'7' };
    project.write("specs/data/faces.dbf", table);
    let (nodes, written) = ran(&project);
    assert_eq!(written, ["spec/spaced.geojson"]);
    assert!(nodes.contains(&"spaced".to_string()), "{nodes:?}");
    for other in ["high", "aimed"] {
        assert!(!nodes.contains(&other.to_string()), "{nodes:?}");
    }
    // Another raster.
    project.write(
        "specs/data/massif.tif",
        include_bytes!("../../specs/maps/data/lake.tif"),
    );
    let (nodes, written) = ran(&project);
    assert_eq!(written, ["spec/high.geojson"]);
    assert!(
        nodes.contains(&"high".to_string()) && !nodes.contains(&"spaced".to_string()),
        "{nodes:?}"
    );
    // A comment in a script changes no file.
    project.write("specs/high.star", format!("# Only what is high.\n{HIGH}"));
    assert_eq!(ran(&project).1, Vec::<String>::new());
}

/// The lines of a GeoJSON file, a feature a line.
fn drawn(project: &Project, name: &str) -> Vec<(String, Vec<[f64; 2]>)> {
    let path = project.path(&format!("out/spec/{name}"));
    let text = std::fs::read_to_string(path).expect("it was written");
    let features = text
        .lines()
        .filter(|line| line.starts_with("{\"type\":\"Feature\""));
    let points = |line: &str| -> Vec<[f64; 2]> {
        let json: serde_json::Value =
            serde_json::from_str(line.trim_end_matches(',')).expect("a feature");
        let all = json["geometry"]["coordinates"]
            .as_array()
            .expect("coordinates")
            .iter();
        all.map(|p| [0, 1].map(|i| p[i].as_f64().expect("a number")))
            .collect()
    };
    features
        .map(|line| (line.trim_end_matches(',').to_string(), points(line)))
        .collect()
}

#[test]
fn what_a_field_changes_within_a_window_changes_nothing_beyond_the_reach() {
    let mut random = Random(23);
    for _ in 0..4 {
        let (x, y) = (random.below(3000) as f64, random.below(2000) as f64);
        let (half, reach) = (100.0 + random.below(300) as f64, 80.0);
        let spec = |hill: f64| {
            format!(
                "fretwork: 1
map: {{}}
seed: {}
regions:
  sheet: {{ rectangle: {{ width: 3000, height: 2000 }} }}
fields:
  height: {{ expression: {{ value: \"100 + x / 40 + {hill} * max(0, 1 - max(abs(x - {x}), abs(y - {y})) / {half})\" }} }}
partitions:
  cells: {{ uniform: {{ cell_size: 60 }} }}
arrangements:
  strokes:
    map:
      faces: cells
      with: {{ script: stroke.star, entry: strokes, args: {{ height: height }} }}
      reach: {reach}
artifacts:
  strokes.geojson: {{ from: strokes, region: sheet, crs: map }}
",
                random.0 % 1000
            )
        };
        let script = "def strokes(height):
    def one(face):
        z = height(centroid(face))
        return scale(contour(face), min(z / 500, 1.0))
    return one
";
        let build = |hill: f64| {
            let project = project(&spec(hill));
            project.write("specs/stroke.star", script);
            project.succeed(&["build"]);
            drawn(&project, "strokes.geojson")
        };
        let (before, after) = (build(0.0), build(90.0));
        // A cell that touches the window is not larger than twice the size asked for, and reaches so far.
        let far = |line: &(String, Vec<[f64; 2]>)| {
            line.1.iter().all(|p| {
                let distance = (p[0] - x).abs().max((p[1] - y).abs()) - half;
                distance > reach + 120.0
            })
        };
        let lines = |all: &[(String, Vec<[f64; 2]>)], is_far: bool| -> Vec<String> {
            let some = all.iter().filter(|line| far(line) == is_far);
            some.map(|line| line.0.clone()).collect()
        };
        assert!(lines(&before, true).len() > 500);
        assert_eq!(lines(&before, true), lines(&after, true));
        assert_ne!(lines(&before, false), lines(&after, false));
    }
}

/// Pixels of the raster that is written here, along each side, and how many metres one is wide.
const PIXELS: [u32; 2] = [120, 90];
const PIXEL: f64 = 10.0;

/// A GeoTIFF of floats in one strip, from the corner (0, 900) to the right and downward; `height` gives the sample of a column
/// and a row.
fn geotiff(height: impl Fn(u32, u32) -> f32) -> Vec<u8> {
    let [columns, rows] = PIXELS;
    let doubles = [
        PIXEL,
        PIXEL,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        f64::from(rows) * PIXEL,
        0.0,
    ];
    let (scale, tie) = (134u32, 134 + 24);
    let samples = tie + 48;
    let entries: [(u16, u16, u32, u32); 10] = [
        (256, 4, 1, columns),
        (257, 4, 1, rows),
        (258, 3, 1, 32),
        (259, 3, 1, 1),
        (262, 3, 1, 1),
        (273, 4, 1, samples),
        (279, 4, 1, 4 * columns * rows),
        (339, 3, 1, 3),
        (33550, 12, 3, scale),
        (33922, 12, 6, tie),
    ];
    let mut bytes = b"II\x2a\0\x08\0\0\0\x0a\0".to_vec();
    for (tag, kind, count, value) in entries {
        bytes.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
        bytes.extend([count.to_le_bytes(), value.to_le_bytes()].concat());
    }
    bytes.extend([0; 4]);
    bytes.extend(doubles.iter().flat_map(|v| v.to_le_bytes()));
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    bytes.extend(places.flat_map(|(column, row)| height(column, row).to_le_bytes()));
    bytes
}

/// Squares of 100 m that cover the raster but for its right side.
fn parcels() -> String {
    let square = |n: u32| {
        let (x, y) = (100 * (n % 11), 100 * (n / 11));
        let (x1, y1) = (x + 100, y + 100);
        format!(
            r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"Polygon","coordinates":[[[{x},{y}],[{x1},{y}],[{x1},{y1}],[{x},{y1}],[{x},{y}]]]}}}}"#
        )
    };
    let all: Vec<String> = (0..99).map(square).collect();
    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}}"#;
    format!(
        r#"{{"type":"FeatureCollection",{crs},"features":[{}]}}"#,
        all.join(",")
    )
}

/// Hatching by what is derived from heights, by their means in parcels, and by a formula of both.
const DERIVED: &str = "regions:
  sheet: { rectangle: { width: 1200, height: 900 } }
  parcels: { geodata: { file: parcels.geojson } }
fields:
  height: { raster: { file: heights.tif } }
  slope: { derive: { from: height, operator: slope } }
  aspect: { derive: { from: height, operator: aspect } }
  mean: { zonal: { faces: parcels, from: height, statistic: mean } }
  down: { zonal: { faces: parcels, from: height, statistic: direction } }
  gap: { expression: { value: \"max(4, m / 20)\", fields: { m: mean } } }
partitions:
  cells: { uniform: { cell_size: 30 } }
  turned: { stripes: { angle: aspect, spacing: 6 } }
  rows: { stripes: { angle: down, spacing: gap } }
arrangements:
  steep: { map: { faces: cells, reach: 40, with: { script: steep.star, entry: strokes, args: { slope: slope } } } }
  aimed: { fill: { faces: cells, with: turned } }
  zoned: { fill: { faces: parcels, with: rows } }
artifacts:
  steep.geojson: { from: steep, region: sheet, crs: map }
  aimed.geojson: { from: aimed, region: sheet, crs: map }
  zoned.geojson: { from: zoned, region: sheet, crs: map }
";

const STEEP: &str = "def strokes(slope):
    def one(face):
        s = slope(centroid(face))
        return scale(contour(face), min(s / 90, 1.0)) if s != None else nothing()
    return one
";

/// An edit of a block of a raster changes what is derived from its samples, and the statistics of the parcels in which these
/// lie: no line farther from the block than a sample and a cell, or a parcel.
#[test]
fn an_edit_of_a_block_of_a_raster_changes_nothing_beyond_the_reach() {
    let mut random = Random(29);
    for _ in 0..3 {
        let [column, row] = PIXELS.map(|count| 10 + random.below(u64::from(count) - 40) as u32);
        let (wide, high) = (5 + random.below(15) as u32, 5 + random.below(15) as u32);
        let is_in =
            |i: u32, j: u32| (column..column + wide).contains(&i) && (row..row + high).contains(&j);
        let build = |hill: f32| {
            let project = project(&format!(
                "fretwork: 1\n{UTM}\nseed: {}\n{DERIVED}",
                column * row
            ));
            let height = |i: u32, j: u32| {
                let rough = ((i * 7 + j * 13) % 11) as f32;
                let own = 100.0 + i as f32 * 1.5 + j as f32 * 0.7 + rough;
                own + if is_in(i, j) { hill } else { 0.0 }
            };
            project.write("specs/heights.tif", geotiff(height));
            project.write("specs/parcels.geojson", parcels());
            project.write("specs/steep.star", STEEP);
            project.succeed(&["build"]);
            project
        };
        let (before, after) = (build(0.0), build(60.0));
        let low = [f64::from(column), f64::from(PIXELS[1] - row - high)].map(|v| v * PIXEL);
        let high = [
            low[0] + f64::from(wide) * PIXEL,
            low[1] + f64::from(high) * PIXEL,
        ];
        // The samples beside a changed one are derived from it, and those are felt as far as the next. A cell is no larger than
        // four times the size asked for.
        let of_cells = 2.0 * PIXEL + 4.0 * 30.0;
        for (name, reach) in [("steep", of_cells), ("aimed", of_cells), ("zoned", 100.0)] {
            let far = |line: &(String, Vec<[f64; 2]>)| {
                line.1.iter().all(|p| {
                    let gaps = [0, 1].map(|i| (low[i] - p[i]).max(p[i] - high[i]));
                    gaps[0].max(gaps[1]) > reach + 1e-3
                })
            };
            let of = |project: &Project, is_far: bool| -> Vec<String> {
                let all = drawn(project, &format!("{name}.geojson"));
                let some = all.iter().filter(|line| far(line) == is_far);
                some.map(|line| line.0.clone()).collect()
            };
            assert!(of(&before, true).len() > 300, "{name}");
            assert_eq!(of(&before, true), of(&after, true), "{name}");
            assert_ne!(of(&before, false), of(&after, false), "{name}");
        }
    }
}
