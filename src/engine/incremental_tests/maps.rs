//! What runs again after an edit of the head `map`, and what it means for the spec.

use super::*;

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
