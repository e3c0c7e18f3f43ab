//! Surfaces and solids from specs to files, and files that are no meshes.

use std::io::Cursor;
use std::path::Path;

use fretwork::geometry::{Mesh, MeshTopology, Point3};

use super::project::{Project, copy};

const SPEC: &str = r##"fretwork: 1
units: cm
regions:
  page: { rectangle: { width: 4, height: 3 } }
  hole: { circle: { radius: 0.5, at: [1, 1] } }
  plate: { difference: [page, hole] }
surfaces:
  cone: { revolve: { profile: [[0, 0], [1, 0], [0, 2]], segments: 24 } }
  blade: { mesh: { file: blade.obj, longest_side: 2, at: [5, 0, 0] } }
solids:
  base: { extrude: { region: plate, height: 0.5 } }
  peg: { cylinder: { radius: 0.2, height: 2, segments: 32, at: [3, -1, 0], repeat: { count: 2, step: [0, -1] } } }
  both: { union: [base, peg] }
  bored: { difference: [base, peg] }
  rest: { intersection: [base, peg] }
  group: { assemble: { parts: [{ from: base }, { from: cone, at: [0, 0, 3], rotate: [0, 90, 0] }, { from: blade, mirror: x }] } }
  joined: { assemble: { union: true, parts: [{ from: base }, { from: base, at: [4, 0, 0] }] } }
artifacts:
  both.stl: { from: both }
  bored.stl: { from: bored }
  rest.stl: { from: rest }
  joined.stl: { from: joined }
  half.stl: { from: base, scale: "1:2" }
  group.3mf: { from: group }
  group.glb: { parts: [{ from: group }, { from: blade, repeat: { count: [2, 3], step: [9, 9] } }] }
  both.json: { from: both }
  group.png: { from: group, width: 80 }
"##;

const BLADE: &str = "v 0 0 0\nv 10 0 0\nv 0 5 0\nv 0 0 5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

fn project() -> Project {
    let project = Project::of(SPEC);
    project.write("specs/blade.obj", BLADE);
    project
}

fn stl(bytes: &[u8]) -> (Mesh, MeshTopology) {
    let read = stl_io::read_stl(&mut Cursor::new(bytes)).unwrap();
    let position = |v: &stl_io::Vertex| Point3::new(v[0].into(), v[1].into(), v[2].into());
    let mesh = Mesh {
        positions: read.vertices.iter().map(position).collect(),
        triangles: read
            .faces
            .iter()
            .map(|f| f.vertices.map(|v| v as u32))
            .collect(),
    };
    let topology = mesh.check_closed().unwrap();
    (mesh, topology)
}

/// The least and the greatest distance of a mesh from the z axis.
fn radii(bytes: &[u8]) -> [f64; 2] {
    let (mesh, _) = stl(bytes);
    let radii = mesh
        .positions
        .iter()
        .map(|p| (p.x * p.x + p.y * p.y).sqrt());
    radii.fold([f64::MAX, 0.0], |[low, high], r| [low.min(r), high.max(r)])
}

fn assert_radii(bytes: &[u8], expected: [f64; 2]) {
    let found = radii(bytes);
    let off = (0..2).map(|i| (found[i] - expected[i]).abs());
    let off = off.fold(0.0, f64::max);
    assert!(off < 0.01, "{found:?}, not {expected:?}");
}

#[test]
fn the_inside_of_the_bracelet_has_the_size_of_the_wrist() {
    let project = Project::empty();
    let home = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs");
    copy(&home.join("bands"), &project.path("specs/bands"));
    copy(&home.join("assets"), &project.path("specs/assets"));
    project.succeed(&["build", "specs/bands/bracelet.yaml"]);
    let files = project.files("out/bands/bracelet");
    let wrist = 165.0 / std::f64::consts::TAU;
    assert_radii(&files["cuff.stl"], [wrist, wrist + 2.4]);
}

#[test]
fn a_thickness_goes_to_the_side_that_is_asked_for() {
    let project = Project::of(
        r#"fretwork: 1
exemplars: { bars: { vector: { file: bars.svg } } }
curves: { round: { circle: { radius: 20 } }, back: { arc: { radius: 20, from: 300, to: 0 } } }
bands:
  middle: { exemplar: bars, curve: round, height: 12, across: normal }
  outer: { exemplar: bars, curve: round, height: 12, across: normal, side: outside }
  clockwise: { exemplar: bars, curve: back, height: 12, across: normal, flip: true, side: inside }
panels: { plate: { exemplar: bars, width: 80, height: 24, components: any, side: center } }
artifacts:
  middle.stl: { from: middle, thickness: 2 }
  outer.stl: { from: outer, thickness: 2 }
  clockwise.stl: { from: clockwise, thickness: 2 }
  plate.stl: { from: plate, thickness: 3 }
"#,
    );
    project.write(
        "specs/bars.svg",
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="12mm" viewBox="0 0 40 12">
  <path d="M0 0H40V2H0ZM0 10H40V12H0ZM6 1H9V11H6ZM20 1H23V11H20ZM30 1H33V11H30Z"/></svg>"#,
    );
    project.succeed(&["build"]);
    let files = project.files("out/spec");
    assert_radii(&files["middle.stl"], [19.0, 21.0]);
    assert_radii(&files["outer.stl"], [20.0, 22.0]);
    assert_radii(&files["clockwise.stl"], [18.0, 20.0]);
    let heights = |name: &str| {
        let bounds = stl(&files[name]).0.bounds();
        [bounds.min.z, bounds.max.z]
    };
    assert_eq!(heights("plate.stl"), [-1.5, 1.5]);
}

#[test]
fn solids_are_closed_have_their_volumes_and_are_in_millimetres() {
    let project = project();
    let mut command = project.command(&["build", "--no-cache", "--jobs", "1"]);
    command.env("FRETWORK_CHECK", "1");
    let run = super::project::finish(command);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let files = project.files("out/spec");
    let volume = |name: &str| stl(&files[name]).0.volume();
    let topology = |name: &str| {
        (
            stl(&files[name]).1.components,
            stl(&files[name]).1.genus.unwrap(),
        )
    };
    let (base, inside) = (volume("half.stl") * 8.0, volume("rest.stl"));
    assert!((volume("bored.stl") + inside - base).abs() < 1.0);
    assert!((volume("both.stl") - (base + 3.0 * inside)).abs() < 2.0);
    assert_eq!(
        ["half.stl", "bored.stl", "rest.stl", "both.stl"].map(topology),
        [(1, 1), (1, 3), (2, 0), (1, 1)]
    );
    assert!((volume("joined.stl") - 2.0 * base).abs() < 1.0);
    assert_eq!(topology("joined.stl"), (1, 2));
    // The drawing plane is mirrored: the hole is in the far left corner.
    let bounds = stl(&files["bored.stl"]).0.bounds();
    assert_eq!(
        (bounds.min, bounds.max),
        (Point3::new(0.0, -30.0, 0.0), Point3::new(40.0, 0.0, 5.0))
    );
    let json: serde_json::Value = serde_json::from_slice(&files["both.json"]).unwrap();
    assert!((json["volume"].as_f64().unwrap() * 1000.0 - volume("both.stl")).abs() < 1.0);
    assert_eq!(
        (&json["watertight"], &json["components"], &json["genus"]),
        (&true.into(), &1.into(), &1.into())
    );
    let gltf = gltf::Gltf::from_slice(&files["group.glb"]).unwrap();
    assert_eq!((gltf.nodes().len(), gltf.meshes().len()), (9, 4));
    let picture = size_of(&files["group.png"]);
    assert_eq!(picture.0, 80);
}

/// The width and height in the head of a PNG.
fn size_of(png: &[u8]) -> (u32, u32) {
    let word = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    (word(16), word(20))
}

#[test]
fn files_of_solids_depend_neither_on_threads_nor_on_the_cache() {
    let project = project();
    project.succeed(&["build", "--jobs", "1"]);
    let first = project.files("out");
    assert_eq!(first.len(), 9);
    std::fs::remove_dir_all(project.path("out")).unwrap();
    project.succeed(&["build", "--jobs", "2"]);
    assert_eq!(project.files("out"), first);
    project.succeed(&["build", "--jobs", "3", "--no-cache", "--out", "other"]);
    assert_eq!(project.files("other"), first);
}

#[test]
fn a_buffer_that_a_gltf_names_is_an_input() {
    let spec = "fretwork: 1\nsurfaces: { a: { mesh: { file: a.gltf } } }\nartifacts: { a.stl: { from: a } }\n";
    let project = Project::of(spec);
    let gltf = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36,"uri":"a%20b.bin"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]}"#;
    let buffer = |top: f32| {
        [0., 0., 0., 1., 0., 0., 0., top, 0.]
            .iter()
            .flat_map(|v: &f32| v.to_le_bytes())
            .collect::<Vec<_>>()
    };
    project.write("specs/a.gltf", gltf);
    project.write("specs/a b.bin", buffer(1.0));
    let report = project.build(&[]);
    assert_eq!(report.artifacts("written").len(), 1);
    assert!(
        report.0["warnings"][0]["message"]
            .as_str()
            .unwrap()
            .contains("open")
    );
    assert!(project.build(&[]).artifacts("written").is_empty());
    project.write("specs/a b.bin", buffer(2.0));
    assert_eq!(project.build(&[]).artifacts("written").len(), 1);
}

/// The message of the first error of a build, and its line.
fn failure(project: &Project) -> (String, u64) {
    let run = project.run(&["build", "--format", "json"]);
    assert_eq!(run.code, Some(1), "{}", run.stdout);
    let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    let error = &report["errors"][0];
    (
        error["message"].as_str().unwrap().to_string(),
        error["line"].as_u64().unwrap(),
    )
}

#[test]
fn broken_meshes_are_told_and_nothing_is_written() {
    let mut claimed = vec![b' '; 80];
    claimed.extend(u32::MAX.to_le_bytes());
    claimed.extend([0; 50]);
    let cases: [(&str, &[u8], &str); 8] = [
        ("a.stl", &claimed, "claims 4294967295 triangles and holds 1"),
        ("a.stl", b"solid a\nfacet\nouter loop\nvertex 0 0", "a vertex needs three numbers"),
        ("a.stl", b"", "too short"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0 0 0", "cut off"),
        ("a.obj", b"v 0 0 nan\n", "three finite numbers"),
        ("a.obj", b"v 0 0 0\n", "no triangles"),
        ("a.glb", b"glTF\x02\0\0\0\xff\xff\xff\xff", "cut off"),
        ("a.step", b"ISO-10303-21;", "stl, glb, gltf, obj, ply"),
    ];
    for (name, bytes, message) in cases {
        let spec = format!(
            "fretwork: 1\nsurfaces: {{ a: {{ mesh: {{ file: {name} }} }} }}\nartifacts: {{ a.stl: {{ from: a }} }}\n"
        );
        let project = Project::of(&spec);
        project.write(&format!("specs/{name}"), bytes);
        let (found, line) = failure(&project);
        assert!(found.contains(message) && line == 2, "{name}: {found}");
        assert!(project.files("out").is_empty());
    }
}

#[test]
fn what_is_no_solid_is_told() {
    let cases = [
        ("vase: { union: [cup] }", "the mesh is open"),
        (
            "vase: { assemble: { parts: [{ from: cup }] } }",
            "the mesh is open",
        ),
        ("vase: { intersection: [a, b] }", "nothing is left"),
        ("vase: { difference: [a, a] }", "nothing is left"),
        ("vase: { sphere: { radius: 1, segments: 2 } }", "at least 3"),
    ];
    for (solid, message) in cases {
        let project = Project::of(&format!(
            "fretwork: 1\nsurfaces:\n  cup: {{ revolve: {{ profile: [[1, 0], [2, 3]] }} }}\nsolids:\n  a: {{ sphere: {{ radius: 1 }} }}\n  \
             b: {{ box: {{ size: [1, 1, 1], at: [5, 5, 5] }} }}\n  {solid}\nartifacts: {{ a.stl: {{ from: vase }} }}\n"
        ));
        let (found, line) = failure(&project);
        assert!(
            found.contains(message) && line == 7,
            "{solid}: {found} at {line}"
        );
        assert!(project.files("out").is_empty());
    }
}
