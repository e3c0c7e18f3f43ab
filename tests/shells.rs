//! Shells from specs to files: pictures and drawings as exemplars, one piece, what a build says of strength.

use std::collections::BTreeMap;
use std::io::Cursor;

use expect_test::expect;
use fretwork::geometry::{Mesh, Point3};
use serde_json::Value as Json;

use super::project::{Project, Run};

/// A tube of 16 mm with a net of round holes, and an empty slot for more fields.
const TUBE: &str = r##"fretwork: 1
seed: 1
regions:
  tile: { rectangle: { width: 8, height: 8, periodic: true } }
  hole: { circle: { radius: 2.4, at: [4, 4] } }
  ground: { difference: [tile, hole] }
exemplars:
  net: { rasterize: { from: ground, region: tile, pixel_size: 0.5, feature_radius: 1.5 } }
surfaces:
  tube: { revolve: { profile: [[8, 0], [8, 24]], segments: 48 } }
force_profiles:
  standing: { material: pla, supports: [ { lowest: 10% } ], max_stress: "8MPa" }
shells:
  net: { surface: tube, exemplar: exemplars.net, voxel: 0.8, thickness: 2, keep_solid: [ { lowest: "2mm" } ], force_profile: standing }
artifacts:
  net.stl: { from: shells.net }
  net.3mf: { from: shells.net }
  net.glb: { from: shells.net }
  net.json: { from: shells.net }
  net.png: { from: shells.net, width: 160 }
  stress.png: { from: shells.net, width: 160, show: stress }
  exemplar.png: { from: exemplars.net, width: 64 }
"##;

fn json(project: &Project, path: &str) -> Json {
    serde_json::from_slice(&std::fs::read(project.path(path)).unwrap()).unwrap()
}

fn mesh(project: &Project, path: &str) -> Mesh {
    let bytes = std::fs::read(project.path(path)).unwrap();
    let read = stl_io::read_stl(&mut Cursor::new(bytes)).unwrap();
    let position = |v: &stl_io::Vertex| Point3::new(v[0].into(), v[1].into(), v[2].into());
    Mesh {
        positions: read.vertices.iter().map(position).collect(),
        triangles: read
            .faces
            .iter()
            .map(|f| f.vertices.map(|v| v as u32))
            .collect(),
    }
}

#[test]
fn a_shell_is_one_closed_body_in_every_format() {
    let project = Project::of(TUBE);
    let run = project.run(&["build", "specs/spec.yaml"]);
    quiet(&run);
    let found = json(&project, "out/spec/net.json");
    let counts = ["voxels", "solid_voxels", "iterations", "elements", "genus"];
    let counts = counts
        .map(|name| format!("{name} {}", found[name]))
        .join(", ");
    expect!["voxels 2480, solid_voxels 1902, iterations 0, elements 6508, genus 13"]
        .assert_eq(&counts);
    assert_eq!(found["components"], 1);
    assert_eq!(found["watertight"], true);
    assert_eq!(found["done"], true);
    let body = mesh(&project, "out/spec/net.stl").welded();
    let topology = body.check_closed().unwrap();
    assert_eq!(topology.components, 1);
    assert!((body.volume() / found["volume"].as_f64().unwrap() - 1.0).abs() < 1e-3);
    // A tube with holes: more handles than its own one.
    assert!(found["genus"].as_u64().unwrap() > 8, "{}", found["genus"]);
    let bounds = body.bounds();
    assert!(
        bounds.min.z.abs() < 0.05 && (bounds.max.z - 24.0).abs() < 0.5,
        "{bounds:?}"
    );
    let stress = &found["stress"];
    let of = |name: &str| stress[name].as_f64().unwrap();
    assert!(0.0 < of("median") && of("median") <= of("p99") && of("p99") <= of("max"));
    // The whole weighs what its volume says: 1,240 kg/m³.
    let mass = found["mass"].as_f64().unwrap();
    assert!(
        (mass / (body.volume() * 1e-9 * 1240.0) - 1.0).abs() < 0.05,
        "{mass}"
    );
    let plain = std::fs::read(project.path("out/spec/net.png")).unwrap();
    let colored = std::fs::read(project.path("out/spec/stress.png")).unwrap();
    assert_ne!(plain, colored);
}

#[test]
fn the_colours_of_a_glb_have_a_legend() {
    let project = Project::of(TUBE);
    project.run(&["build", "specs/spec.yaml", "--only", "net.glb"]);
    let bytes = std::fs::read(project.path("out/spec/net.glb")).unwrap();
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&bytes).unwrap();
    let primitive = document
        .meshes()
        .next()
        .unwrap()
        .primitives()
        .next()
        .unwrap();
    let reader = primitive.reader(|_| blob.as_deref());
    let colors: Vec<[f32; 3]> = reader.read_colors(0).unwrap().into_rgb_f32().collect();
    assert_eq!(colors.len(), reader.read_positions().unwrap().count());
    assert!(colors.iter().any(|c| c != &colors[0]));
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let root: Json = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    assert_eq!(root["meshes"][0]["extras"]["unit"], "Pa");
}

/// A build that has nothing to say.
#[track_caller]
fn quiet(run: &Run) {
    assert!(
        run.code == Some(0) && !run.stderr.contains(['×', '⚠']),
        "{}",
        run.stderr
    );
}

/// What a build says of a spec in which `from` is replaced.
fn said(from: &str, to: &str) -> (Option<i32>, String) {
    let spec = TUBE.replace(from, to);
    assert_ne!(spec, TUBE, "`{from}` is not in the spec");
    let run = Project::of(&spec).run(&["build", "specs/spec.yaml", "--only", "net.json"]);
    (run.code, run.stderr)
}

#[test]
fn the_specs_of_the_page_about_shells_build() {
    let page = include_str!("../schemas/shells.md");
    let specs = page
        .split("```yaml\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap());
    let mut count = 0;
    for spec in specs {
        let run = Project::of(spec).run(&["build", "specs/spec.yaml"]);
        quiet(&run);
        count += 1;
    }
    assert_eq!(count, 3);
}

#[test]
fn what_cannot_be_is_told_with_its_place() {
    let cases = [
        ("from: ground", "from: tile", "solid"),
        (
            "lowest: 10% }",
            "box: [[90, 90, 90], [91, 91, 91]] }",
            "support",
        ),
        (
            "max_stress",
            "loads: [ { sphere: { center: [0, 0, 99], radius: 1 }, force: [1, 0, 0] } ], max_stress",
            "catches no",
        ),
        ("voxel: 0.8", "voxel: 0.001", "lower the resolution"),
        ("pixel_size: 0.5,", "pixel_size: 4,", "exemplar"),
        ("pixel_size: 0.5,", "pixel_size: 0.0001,", "pixel_size"),
    ];
    for (from, to, words) in cases {
        let (code, text) = said(from, to);
        assert_eq!(code, Some(1), "{to}: {text}");
        assert!(
            text.contains(words) && text.contains("specs/spec.yaml:"),
            "{to}:\n{text}"
        );
        assert!(
            !text.contains("NaN") && !text.contains("panicked"),
            "{text}"
        );
    }
}

#[test]
fn a_limit_is_a_warning_and_an_error_where_it_is_required() {
    let (code, text) = said("\"8MPa\"", "\"1Pa\"");
    assert_eq!(code, Some(0), "{text}");
    assert!(
        text.contains("the stress is too large") && text.contains("weakest place"),
        "{text}"
    );
    let (code, text) = said("\"8MPa\"", "\"1Pa\", require: true");
    assert_eq!(code, Some(1), "{text}");
    let limits = "\"8MPa\", limits: { safety_factor: 1e9, max_displacement: 1e-9 }, require: true";
    let (code, text) = said("\"8MPa\"", limits);
    assert_eq!(code, Some(1));
    assert!(
        text.contains("the safety factor is") && text.contains("moves by"),
        "{text}"
    );
}

#[test]
fn random_exemplars_give_one_piece() {
    // Squares that nothing joins among them: the pattern must be bridged.
    for (radius, seed) in [(2.9, 1), (3.4, 2), (0.8, 3)] {
        let spec = TUBE
            .replace("from: ground", "from: hole")
            .replace("radius: 2.4", &format!("radius: {radius}"))
            .replace("seed: 1", &format!("seed: {seed}"))
            .replace(
                ", force_profile: standing",
                ", geodesic_limit: 2, min_feature: 1.6",
            );
        let project = Project::of(&spec);
        let run = project.run(&["build", "specs/spec.yaml", "--only", "net.json"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let found = json(&project, "out/spec/net.json");
        assert_eq!(found["components"], 1, "radius {radius}");
        assert!(found["stress"].is_null());
        // A tenth of a voxel is how precisely it is made.
        assert!(
            found["min_feature"].as_f64().unwrap() >= 1.6 - 0.08,
            "{}",
            found["min_feature"]
        );
    }
}

/// Bands around a tube that only bridges join, and a push against its top.
const BANDS: &str = r##"fretwork: 1
seed: 3
regions:
  tile: { rectangle: { width: 6, height: 6, periodic: true } }
  band: { rectangle: { width: 6, height: 3, at: [0, 1.5] } }
exemplars:
  bands: { rasterize: { from: band, region: tile, pixel_size: 0.25, feature_radius: 1.4 } }
surfaces:
  tube: { revolve: { profile: [[14, 0], [14, 40]], segments: 64 } }
force_profiles:
  pushed: { material: pla, supports: [ { lowest: 10% } ], loads: [ { highest: 10%, force: [2, 0, 0] } ], max_stress: "1MPa" }
shells:
  joined: { surface: tube, exemplar: bands, voxel: 1, thickness: 2, keep_solid: [ { highest: "3mm" } ], min_feature: 2 }
  strong: { surface: tube, exemplar: bands, voxel: 1, thickness: 2, keep_solid: [ { highest: "3mm" } ], min_feature: 2, force_profile: pushed }
  guarded: { surface: tube, exemplar: bands, voxel: 1, thickness: 2, keep_solid: [ { highest: "3mm" } ], min_feature: 2, force_profile: pushed, geodesic_limit: 1 }
analyses:
  one: { of: joined, force_profile: pushed, voxel: 1 }
  two: { of: strong, force_profile: pushed, voxel: 1 }
  three: { of: guarded, force_profile: pushed, voxel: 1 }
artifacts:
  joined.json: { from: joined }
  strong.json: { from: strong }
  guarded.json: { from: guarded }
  one.json: { from: one }
  two.json: { from: two }
  three.json: { from: three }
"##;

#[test]
fn reinforcement_takes_the_stress_away() {
    let project = Project::of(BANDS);
    let run = project.run(&["build", "specs/spec.yaml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let stress = |name: &str, field: &str| {
        json(&project, &format!("out/spec/{name}.json"))["stress"][field]
            .as_f64()
            .unwrap()
    };
    let bridges = |name: &str, field: &str| {
        json(&project, &format!("out/spec/{name}.json"))["bridges"][field]
            .as_u64()
            .unwrap()
    };
    assert!(bridges("joined", "connection") > 3 && bridges("strong", "stress") > 3);
    // Those of the worst case by lengths come beside them, not in their place.
    assert!(bridges("guarded", "geodesic") > 0 && bridges("guarded", "stress") > 3);
    for field in ["mean", "p99"] {
        let (one, two, three) = (
            stress("one", field),
            stress("two", field),
            stress("three", field),
        );
        assert!(two < one / 2.0, "{field}: {one} to {two}");
        assert!(three < two, "{field}: {two} to {three}");
    }
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let files = |jobs: &str| -> BTreeMap<String, Vec<u8>> {
        let project = Project::of(TUBE);
        let run = project.run(&["build", "specs/spec.yaml", "--jobs", jobs]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        ["net.stl", "net.3mf", "net.json", "stress.png"]
            .map(|name| {
                let bytes = std::fs::read(project.path(&format!("out/spec/{name}"))).unwrap();
                (name.to_owned(), bytes)
            })
            .into()
    };
    let one = files("1");
    assert!(one == files("2") && one == files("7"));
}

#[test]
fn a_solid_is_analysed_like_an_independent_solver_does() {
    // 10 × 10 × 40 mm of ABS, clamped at its base, under its own weight.
    let project = Project::of(
        r##"fretwork: 1
solids: { bar: { box: { size: [10, 10, 40] } } }
force_profiles:
  stand: { material: abs, supports: [ { lowest: "0mm" } ] }
  lean: { material: abs, gravity: [1, 0, 0], supports: [ { lowest: "0mm" } ], sweep: gravity }
analyses:
  standing: { of: bar, force_profile: stand, voxel: 1 }
  leaning: { of: bar, force_profile: lean, voxel: 1 }
artifacts: { standing.json: { from: standing }, leaning.json: { from: leaning } }
"##,
    );
    let run = project.run(&["build", "specs/spec.yaml"]);
    quiet(&run);
    let near = |found: &Json, expected: f64| {
        let found = found.as_f64().unwrap();
        assert!(
            (found / expected - 1.0).abs() < 1e-4,
            "{found} of {expected}"
        );
    };
    let standing = json(&project, "out/spec/standing.json");
    near(&standing["max_displacement"], 3.481126e-6);
    let leaning = json(&project, "out/spec/leaning.json");
    near(&leaning["max_displacement"], 1.767154e-4);
    near(&leaning["stress"]["mean"], 1054.7);
    near(&leaning["stress"]["median"], 746.8);
    near(&leaning["stress"]["p99"], 4963.0);
    assert!(leaning["worst_gravity"]["p99"].as_f64().unwrap() >= 4963.0);
}

/// Times stand in what is printed, never in files, and only of what ran.
#[test]
fn inspect_tells_how_long_the_steps_took() {
    let project = Project::of(TUBE);
    let inspect = |more: &[&str]| {
        let of_shell = ["inspect", "specs/spec.yaml", "shells.net"];
        project.succeed(&[&of_shell, more].concat())
    };
    let told: Json = serde_json::from_str(&inspect(&["--format", "json"])).unwrap();
    for step in ["voxels", "pattern", "structure"] {
        let seconds = told["seconds"][format!("shells.net.{step}")].as_f64();
        assert!(seconds.is_some_and(|s| s > 0.0), "{told}");
    }
    let again = inspect(&[]);
    assert!(!again.contains("shells.net.pattern took"), "{again}");
    let cold = inspect(&["--no-cache"]);
    assert!(cold.contains("shells.net.pattern took"), "{cold}");
}
