//! What runs again after an edit of the head `map`, and what it means for the spec.

use super::*;
use crate::windows::{Cutting, TileRange, TileSpan};
use fretwork_action::Window;

const MAP: &str = r#"fretwork: 1
map: { crs: "EPSG:32616", scale: "1:25000", tiles: { origin: [0, 100], size: 100 } }
regions: { page: { rectangle: { width: 100, height: "10 cm" } } }
partitions: { rows: { stripes: { spacing: 5 } } }
artifacts: { x.json: { from: rows, region: page } }
"#;

fn stages_after(before: &str, after: &str) -> Vec<String> {
    let mut bench = Bench::new(before);
    bench.build(&[]);
    bench.compiler.database.take_executed();
    bench.edit(SPEC, after);
    let report = bench.build(&[]);
    let ran = summary(&bench.compiler, &report);
    let stages = ran.lines().filter_map(|line| line.strip_prefix("-> "));
    stages.map(str::to_string).collect()
}

#[test]
fn an_edit_of_a_map_runs_what_reads_it() {
    let none: [&str; 0] = [];
    assert_eq!(
        stages_after(MAP, &MAP.replace("size: 100 ", "size: 200 ")),
        none
    );
    let artifact = ["artifacts.x.json"];
    assert_eq!(stages_after(MAP, &MAP.replace("25000", "10000")), artifact);
    assert_eq!(stages_after(MAP, &MAP.replace("32616", "32617")), artifact);
}

/// The message of the first error of a spec.
fn error_of(bench: &Bench) -> String {
    let diagnostics = bench.report(&[]).diagnostics;
    let error = diagnostics.iter().find(|d| d.is_error());
    error.map_or_else(String::new, |d| d.message.clone())
}

#[test]
fn paper_is_known_to_expressions_of_maps_with_a_scale() {
    let lets = "let: { gap: \"${2 * paper_mm}\" }\n";
    let spec = MAP.replace("spacing: 5", "spacing: \"${gap}\"") + lets;
    Bench::new(&spec).build(&[]);
    let without = spec.replace("scale: \"1:25000\", ", "");
    assert!(error_of(&Bench::new(&without)).contains("paper_mm"));
    let own = without + "params: { paper_mm: 3 }\n";
    Bench::new(&own).build(&[]);
}

#[test]
fn lengths_in_maps_are_metres() {
    let inside = |spec: &str| {
        let bench = Bench::new(spec);
        let report = bench.build(&[]);
        let bytes = bench.compiler.bytes(&report.artifacts[0]).expect("built");
        String::from_utf8(bytes.to_vec()).expect("text")
    };
    // The stripes are 5 m apart, and the page 10 cm high: one line at its lower side.
    let metres = inside(MAP);
    let millimetres = MAP.replace("fretwork: 1", "fretwork: 1\nunits: mm");
    let millimetres = millimetres.replace("width: 100", "width: 100000");
    let millimetres = millimetres.replace("spacing: 5", "spacing: 5000");
    assert_eq!(metres, inside(&millimetres));
}

#[test]
fn a_map_that_is_included_is_an_error_in_other_specs() {
    let bench = Bench::new("fretwork: 1\ninclude: [part.yaml]\n");
    bench
        .files
        .write("specs/part.yaml", "fretwork: 1\nmap: {}\n");
    assert!(error_of(&bench).contains("included"));
    let root = "fretwork: 1\nmap: {}\ninclude: [part.yaml]\n";
    let both = Bench::new(root);
    both.files
        .write("specs/part.yaml", "fretwork: 1\nmap: {}\n");
    assert_eq!(error_of(&both), "");
}

#[test]
fn what_is_wrong_with_a_map_is_told_once() {
    let bench = Bench::new(&MAP.replace("scale: ", "scala: "));
    let errors = bench.report(&[]).diagnostics;
    let errors: Vec<_> = errors.iter().filter(|d| d.is_error()).collect();
    assert_eq!(errors.len(), 1, "{errors:?}");
}

/// Faces with two columns, of which each is read by a hatching of its own, and lines that read none.
const TABLE: &str = r#"fretwork: 1
map: { crs: "EPSG:32616" }
regions:
  area: { geodata: { file: area.geojson } }
  sheet: { rectangle: { width: 2000, height: 3000, at: [500000, 3983900] } }
fields:
  gap: { attribute: { region: area, name: gap } }
  turn: { attribute: { region: area, name: turn } }
partitions:
  rows: { stripes: { spacing: gap } }
  turned: { stripes: { angle: turn, spacing: 40 } }
  lines: { stripes: { spacing: 30 } }
arrangements:
  spaced: { fill: { faces: area, with: rows } }
  aimed: { fill: { faces: area, with: turned } }
  cut: { inside: { input: lines, mask: area } }
artifacts:
  spaced.geojson: { from: spaced, region: sheet, crs: map }
  aimed.geojson: { from: aimed, region: sheet, crs: map }
  cut.geojson: { from: cut, region: sheet, crs: map }
"#;

fn area(gap: f64, turn: f64, east: f64) -> String {
    let ring = [
        [-87.0, 36.0],
        [east, 36.0],
        [east, 36.01],
        [-87.0, 36.01],
        [-87.0, 36.0],
    ];
    let ring = ring.map(|[x, y]| format!("[{x},{y}]")).join(",");
    format!(
        r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","properties":{{"gap":{gap},"turn":{turn}}},"geometry":{{"type":"Polygon","coordinates":[[{ring}]]}}}}]}}"#
    )
}

#[test]
fn an_edit_of_a_column_runs_what_reads_that_column() {
    let mut bench = Bench::new(TABLE);
    bench.edit("specs/area.geojson", &area(50.0, 20.0, -86.985));
    bench.build(&[]);
    let mut drawn_after = |text: &str| {
        bench.compiler.database.take_executed();
        bench.edit("specs/area.geojson", text);
        let report = bench.build(&[]);
        let ran = summary(&bench.compiler, &report);
        let stages = ran.lines().filter_map(|line| line.strip_prefix("-> "));
        let is_drawn =
            |stage: &&str| stage.starts_with("arrangements") || stage.starts_with("artifacts");
        let drawn: Vec<String> = stages.filter(is_drawn).map(str::to_string).collect();
        drawn
    };
    let of = |names: &[&str]| -> Vec<String> {
        let arrangements = names.iter().map(|name| format!("arrangements.{name}"));
        let artifacts = names.iter().map(|name| format!("artifacts.{name}.geojson"));
        arrangements.chain(artifacts).collect()
    };
    let sorted = |mut all: Vec<String>| {
        all.sort();
        all
    };
    let spaced = drawn_after(&area(60.0, 20.0, -86.985));
    assert_eq!(sorted(spaced), of(&["spaced"]));
    let aimed = drawn_after(&area(60.0, 30.0, -86.985));
    assert_eq!(sorted(aimed), of(&["aimed"]));
    let all = drawn_after(&area(60.0, 30.0, -86.984));
    assert_eq!(sorted(all), of(&["aimed", "cut", "spaced"]));
}

/// The arrangements and artifacts that are drawn after an edit of the table of [`TABLE`], in parts of the plane.
fn drawn_in(windows: &[Cutting], after: &str) -> Vec<String> {
    let tiles = "32616\", tiles: { origin: [500000, 3986900], size: 3000 }";
    let mut bench = Bench::new(&TABLE.replace("32616\"", tiles));
    bench.edit("specs/area.geojson", &area(50.0, 20.0, -86.985));
    let build = |bench: &Bench| {
        let report = bench.compiler.build(&Request {
            specs: vec![SPEC.to_string()],
            settings: Settings::default(),
            only: Vec::new(),
            windows: windows.to_vec(),
            threads: 1,
            progress: &Silent,
        });
        assert_eq!(report.diagnostics, []);
        report
    };
    let parts = build(&bench).artifacts.len();
    assert_eq!(parts, 3 * windows.len());
    bench.edit("specs/area.geojson", after);
    let mut drawn = evaluated(&build(&bench));
    drawn.retain(|node| node.starts_with("arrangements") || node.starts_with("artifacts"));
    drawn.sort();
    drawn
}

#[test]
fn an_edit_of_a_column_runs_what_reads_it_in_windows_and_tiles() {
    let window = |low: [f64; 2], high: [f64; 2]| {
        let window = Window::new(low, high).expect("it is a window");
        Cutting::Window(window, format!("{}", low[0]))
    };
    let windows = [
        window([500200.0, 3984000.0], [500700.0, 3984400.0]),
        window([500700.0, 3984000.0], [501000.0, 3984400.0]),
    ];
    let tile = Cutting::Tiles(TileRange {
        level: 2,
        x: TileSpan::One(0),
        y: TileSpan::One(3),
    });
    for parts in [&windows[..], &[tile]] {
        let spaced = drawn_in(parts, &area(60.0, 20.0, -86.985));
        assert_eq!(spaced, ["arrangements.spaced", "artifacts.spaced.geojson"]);
        let aimed = drawn_in(parts, &area(50.0, 30.0, -86.985));
        assert_eq!(aimed, ["arrangements.aimed", "artifacts.aimed.geojson"]);
    }
}

/// A mapper in the text of a spec.
const MAPPED: &str = r#"fretwork: 1
map: { crs: "EPSG:32616" }
regions: { page: { rectangle: { width: 100, height: 100 } } }
partitions: { cells: { uniform: { cell_size: 20 } } }
arrangements:
  small:
    map:
      faces: cells
      with: |
        def one(face):
            return scale(contour(face), 0.8)
artifacts: { small.svg: { from: small, region: page } }
"#;

/// Beside a mapper a comment is the spec's, which only the parse sees. In its text a comment is a part of the value: the mapper
/// runs, and since it draws the same lines nothing else does.
#[test]
fn an_edit_of_a_comment_in_a_mapper_ends_there() {
    let beside = MAPPED.replace("      faces: cells", "      # Smaller.\n      faces: cells");
    check_edit(MAPPED, &beside, expect!["parse"]);
    let folder = tempfile::tempdir().expect("a folder can be made");
    let mut bench = Bench::new(MAPPED).process(LocalStore::new(folder.path()));
    let first = digests(&bench.build(&[]));
    let within = MAPPED.replace("def one(face):", "def one(face):  # Smaller.");
    bench.edit(SPEC, &within);
    let report = bench.build(&[]);
    assert_eq!(evaluated(&report), ["arrangements.small"]);
    assert_eq!(digests(&report), first);
}
