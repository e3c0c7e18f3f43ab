//! What has no thickness of its own, analysed and as the surface of shells: cutouts on planes, curves and surfaces, regions,
//! surfaces. How it is made thick is told in `solids` and `wrapping`.

use serde_json::Value as Json;

use super::project::{Project, Run};

fn built(spec: &str) -> (Project, Run) {
    let project = Project::of(spec);
    project.write("specs/bar.svg", BAR);
    let run = project.run(&["build", "specs/spec.yaml"]);
    (project, run)
}

fn json(project: &Project, path: &str) -> Json {
    let path = project.path(&format!("out/spec/{path}"));
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

fn number(of: &Json) -> f64 {
    of.as_f64().unwrap()
}

/// An ornament that is a plain bar, 4 long and 3 high.
const BAR: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="4mm" height="3mm" viewBox="0 0 4 3"><path d="M0 0H4V3H0Z"/></svg>"#;

/// A wall that is turned, with a window wrapped on it, and a plate.
const HEAD: &str = r##"fretwork: 1
regions:
  plate: { rectangle: { width: 40, height: 20 } }
  sign: { rectangle: { width: 30, height: 24 } }
  tile: { rectangle: { width: 6, height: 6, periodic: true } }
  hole: { circle: { radius: 1.8, at: [3, 3] } }
  net: { difference: [tile, hole] }
surfaces:
  pipe: { revolve: { profile: [[20, 0], [20, 40]], segments: 64 } }
arrangements:
  label: { wrap: { from: sign, onto: pipe } }
exemplars:
  holes: { rasterize: { from: net, region: tile, pixel_size: 0.5, feature_radius: 0.8 } }
  bar: { vector: { file: bar.svg } }
curves:
  ring: { circle: { radius: 15 } }
bands:
  hoop: { exemplar: bar, curve: ring, height: 3, across: normal }
force_profiles:
  hung: { material: pla, supports: [ { lowest: 10% } ] }
"##;

/// The body that is analysed is the one of its file: it weighs as much.
#[test]
fn cutouts_regions_and_surfaces_are_analysed_with_their_thickness() {
    for (of, more) in [
        ("label", "thickness: 2"),
        ("label", "thickness: 2, side: outside"),
        ("hoop", "thickness: 2"),
        ("plate", "thickness: 3"),
        ("pipe", "thickness: 2, side: center"),
    ] {
        let spec = format!(
            "{HEAD}solids:\n  b: {{ assemble: {{ parts: [ {{ from: {of}, {more} }} ] }} }}\n\
             analyses:\n  a: {{ of: {of}, {more}, force_profile: hung, voxel: 0.7 }}\n\
             artifacts:\n  a.json: {{ from: a }}\n  b.json: {{ from: b }}\n"
        );
        let (project, run) = built(&spec);
        assert_eq!(run.code, Some(0), "{of} {more}: {}", run.stderr);
        let volume = number(&json(&project, "b.json")["volume"]);
        let mass = number(&json(&project, "a.json")["mass"]);
        let heavy = volume * 1e-9 * 1240.0;
        assert!(
            (mass / heavy - 1.0).abs() < 0.02,
            "{of} {more}: {mass} kg, {heavy} kg"
        );
    }
}

/// What is flat, and what is open, is told with what helps.
#[test]
fn an_analysis_of_what_has_no_volume_says_what_helps() {
    for (of, what) in [("label", "has no thickness"), ("pipe", "the mesh is open")] {
        let spec = format!(
            "{HEAD}analyses:\n  a: {{ of: {of}, force_profile: hung, voxel: 0.7 }}\nartifacts:\n  a.json: {{ from: a }}\n"
        );
        let (_, run) = built(&spec);
        assert_eq!(run.code, Some(1));
        assert!(run.stderr.contains(what), "{}", run.stderr);
        assert!(run.stderr.contains("`of`"), "{}", run.stderr);
    }
}

/// A shell on a shape that is wrapped, drawn or stands along a curve covers that shape and no more: where its pattern is
/// all but full, its volume is about the shape's area times the thickness.
#[test]
fn shells_cover_the_shape_that_they_are_on() {
    for (surface, area) in [
        ("label", 720.0),
        ("plate", 800.0),
        ("hoop", 282.7),
        ("pipe", 5026.5),
    ] {
        let spec = format!(
            "{HEAD}shells:\n  s: {{ surface: {surface}, exemplar: holes, voxel: 0.75, thickness: 2, orientation: {{ up: [0, 1, 1] }} }}\n\
             artifacts:\n  s.json: {{ from: s }}\n"
        );
        let (project, run) = built(&spec);
        assert_eq!(run.code, Some(0), "{surface}: {}", run.stderr);
        let found = json(&project, "s.json");
        assert_eq!(
            (&found["components"], &found["watertight"]),
            (&1.into(), &true.into()),
            "{surface}"
        );
        let solid = number(&found["volume"]) / (2.0 * area);
        let fraction = number(&found["solid_fraction"]["after"]);
        assert!(
            (solid / fraction - 1.0).abs() < 0.15,
            "{surface}: {solid} of the shape, {fraction} of the pattern"
        );
    }
}

/// A shape that stands in the drawing plane is mirrored into space as its file is.
#[test]
fn a_shell_on_a_region_lies_where_its_extrusion_does() {
    let spec = format!(
        "{HEAD}shells:\n  s: {{ surface: plate, exemplar: holes, voxel: 0.75, thickness: 2, orientation: {{ up: [0, 1, 0] }} }}\n\
         artifacts:\n  s.json: {{ from: s }}\n"
    );
    let (project, run) = built(&spec);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let found = json(&project, "s.json");
    let bounds = &found["bounds"];
    let near = |of: &Json, wanted: [f64; 3]| {
        let found = of.as_array().unwrap().iter().map(number);
        assert!(
            found.zip(wanted).all(|(a, b)| (a - b).abs() < 0.8),
            "{bounds}"
        );
    };
    near(&bounds[0], [0.0, -20.0, -1.0]);
    near(&bounds[1], [40.0, 0.0, 1.0]);
}

/// A flat shape only stands in: what has a volume, or is a surface, is meant where both have the name.
#[test]
fn flat_shapes_give_way_to_bodies_and_surfaces_of_their_name() {
    let head = HEAD
        .replace("surfaces:", "  pipe: { circle: { radius: 9 } }\nsurfaces:")
        .replace(
            "exemplars:",
            "solids:\n  label: { box: { size: [10, 10, 10] } }\nexemplars:",
        );
    let spec = format!(
        "{head}shells:\n  s: {{ surface: pipe, exemplar: holes, voxel: 1, thickness: 2 }}\n\
         analyses:\n  a: {{ of: label, force_profile: hung, voxel: 1 }}\n\
         artifacts:\n  a.json: {{ from: a }}\n  s.json: {{ from: s }}\n"
    );
    let (project, run) = built(&spec);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert_eq!(json(&project, "a.json")["elements"], 1000);
    let height = &json(&project, "s.json")["bounds"][1][2];
    assert!(number(height) > 35.0, "{height}");
}

/// A band along a curve that crosses itself is a sheet that does.
#[test]
fn sheets_that_pass_through_themselves_are_told() {
    let spec = HEAD
        .replace("curves:", "curves:\n  loop: { spline: { points: [[0, 0, 0], [40, 0, 0], [40, 30, 0], [20, -30, 0]] } }")
        .replace("curve: ring", "curve: loop");
    let spec = format!(
        "{spec}shells:\n  s: {{ surface: hoop, exemplar: holes, voxel: 0.75, thickness: 2 }}\n\
         artifacts:\n  s.json: {{ from: s }}\n"
    );
    let (_, run) = built(&spec);
    let told = "the mesh passes through itself";
    assert_eq!(run.stderr.matches(told).count(), 1, "{}", run.stderr);
    assert!(run.stderr.contains("in this shell"), "{}", run.stderr);
}
