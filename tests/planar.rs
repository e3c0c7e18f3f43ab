//! Letters, pictures and connected lines from a spec to files and measures.

use super::project::Project;

/// A picture of two pixels, black and white.
fn picture() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder
        .write_header()
        .unwrap()
        .write_image_data(&[0, 255])
        .unwrap();
    bytes
}

fn project(spec: &str) -> Project {
    let project = Project::empty();
    project.write("specs/spec.yaml", spec);
    project.write("specs/fret.ttf", include_bytes!("drawings/fret.ttf"));
    project.write("specs/picture.png", picture());
    project
}

/// A measure of `node`.
fn measure(project: &Project, node: &str, name: &str) -> f64 {
    let json = project.succeed(&["inspect", "specs/spec.yaml", node, "--format", "json"]);
    let measures: serde_json::Value = serde_json::from_str(&json).unwrap();
    measures[name]
        .as_f64()
        .unwrap_or_else(|| panic!("{node} has no {name}: {measures}"))
}

#[test]
fn letters_are_regions() {
    let project = project(
        "fretwork: 1
params: { word: FOB }
regions:
  word: { text: { content: \"${word}\", font: fret.ttf, size: 10, at: [5, 20] } }
  lines: { text: { content: \"A\\nI\", font: fret.ttf, size: 10 } }
artifacts:
  word.svg: { from: word }
",
    );
    assert_eq!(measure(&project, "word", "components"), 3.0);
    assert_eq!(measure(&project, "word", "holes"), 3.0);
    assert_eq!(measure(&project, "lines", "components"), 2.0);
    project.succeed(&["build"]);
    let missing = project.run(&["build", "--set", "word=Ж"]);
    assert_eq!(missing.code, Some(1));
    assert!(
        missing.stderr.contains("no letter `Ж`") && missing.stderr.contains("spec.yaml:4:28"),
        "{}",
        missing.stderr
    );
}

#[test]
fn pictures_are_fields() {
    // Black stands for many cells, white for few.
    let project = project(
        "fretwork: 1
regions:
  page: { rectangle: { width: 100, height: 50 } }
  dark: { rectangle: { width: 40, height: 50 } }
  light: { rectangle: { width: 40, height: 50, at: [60, 0] } }
fields:
  tone: { raster: { file: picture.png, region: page, black: 0.1, white: 0.005 } }
partitions:
  cells: { random: { density: tone } }
artifacts:
  cells.svg: { from: cells, region: page }
",
    );
    let faces = |region: &str| {
        let json = project.succeed(&[
            "inspect",
            "specs/spec.yaml",
            "cells",
            "--region",
            region,
            "--format",
            "json",
        ]);
        serde_json::from_str::<serde_json::Value>(&json).unwrap()["faces"]
            .as_f64()
            .unwrap()
    };
    assert!(
        faces("dark") > 4.0 * faces("light"),
        "{} and {}",
        faces("dark"),
        faces("light")
    );
}

#[test]
fn lines_are_connected_into_a_cutout() {
    let project = project(
        "fretwork: 1
regions:
  page: { rectangle: { width: 60, height: 40 } }
  one: { circle: { radius: 8, at: [18, 20] } }
  two: { circle: { radius: 8, at: [42, 20] } }
arrangements:
  rings: { union: [one, two] }
  lace: { connect: { input: rings, region: page, width: 1.4 } }
  loose: { connect: { input: rings, region: page, width: 1.4, components: any } }
artifacts:
  lace.svg: { from: lace }
  lace.dxf: { from: lace, kerf: 0.1 }
  loose.json: { from: loose }
",
    );
    assert_eq!(
        (
            measure(&project, "lace", "components"),
            measure(&project, "lace", "holes")
        ),
        (1.0, 2.0)
    );
    assert_eq!(measure(&project, "loose", "components"), 2.0);
    // Two rings, and a bridge between them.
    let rings = 2.0 * std::f64::consts::TAU * 8.0 * 1.4;
    assert!((measure(&project, "loose", "area") - rings).abs() < 0.01 * rings);
    assert!((measure(&project, "lace", "area") - rings - (24.0 - 2.0 * 8.7) * 1.4).abs() < 1.5);
    project.succeed(&["build"]);
}
