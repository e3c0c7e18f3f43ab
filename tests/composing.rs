//! What one part makes, another takes: cutouts and faces as regions.

use serde_json::Value;

use super::project::Project;

/// The measures of `node`.
fn measures(project: &Project, node: &str) -> Value {
    let json = project.succeed(&["inspect", "specs/spec.yaml", node, "--format", "json"]);
    serde_json::from_str(&json).unwrap()
}

/// One of them, a number.
fn measure(project: &Project, node: &str, name: &str) -> f64 {
    let measures = measures(project, node);
    measures[name]
        .as_f64()
        .unwrap_or_else(|| panic!("{node} has no {name}: {measures}"))
}

/// A frame and a lattice in its window, which laps over it by `lap`.
fn framed(lap: &str) -> Project {
    let spec = "fretwork: 1
params: { lap: LAP }
regions:
  board: { rectangle: { width: 80, height: 60 } }
  window: { inset: { from: board, by: 8 } }
  field: { inset: { from: window, by: \"${-lap}\" } }
  frame: { difference: [board, window] }
  screws: { circle: { radius: 2, at: [4, 4], repeat: { count: [2, 2], step: [72, 52] } } }
  whole: { union: [frame, lattice] }
  panel: { difference: [whole, screws] }
  thin: { inset: { from: lattice, by: 0.2 } }
  lace: { intersection: [window, lattice] }
partitions:
  cells: { uniform: { cell_size: 14, border: crop } }
arrangements:
  lattice: { connect: { input: cells, region: field, width: 1.5 } }
solids:
  plate: { extrude: { region: panel, height: 2 } }
  grid: { extrude: { region: lattice, height: 2 } }
artifacts:
  panel.dxf: { from: panel, kerf: 0.1 }
  plate.stl: { from: plate }
";
    Project::of(&spec.replace("LAP", lap))
}

#[test]
fn a_lattice_becomes_one_piece_with_its_frame_and_takes_holes() {
    let project = framed("1");
    let lattice = measures(&project, "lattice");
    assert_eq!(lattice["components"], 1);
    let panel = measures(&project, "panel");
    assert_eq!(panel["components"], 1);
    // The lattice closes cells with the frame that ended free at the border before.
    assert!(panel["holes"].as_u64() > lattice["holes"].as_u64().map(|holes| holes + 4));
    let screws = measure(&project, "whole", "area") - measure(&project, "panel", "area");
    assert!(
        (screws - 4.0 * std::f64::consts::PI * 4.0).abs() < 0.05,
        "{screws}"
    );
    let volume = |node: &str| measure(&project, node, "volume");
    assert!((volume("plate") - 2.0 * measure(&project, "panel", "area")).abs() < 1e-3);
    assert!((volume("grid") - 2.0 * measure(&project, "lattice", "area")).abs() < 1e-3);
    assert!(measure(&project, "thin", "area") < measure(&project, "lattice", "area"));
    let kept = measure(&project, "frame", "area") + measure(&project, "lace", "area");
    assert!((kept - measure(&project, "whole", "area")).abs() < 1e-4);
    let run = project.run(&["build", "--deny", "warnings"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn parts_that_do_not_touch_are_told_with_the_gap() {
    let project = framed("-0.4");
    let run = project.run(&["build", "--only", "panel.dxf"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for said in [
        "`lattice` does not touch `frame`",
        "a gap of 0.4 is",
        "specs/spec.yaml:9:27",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    assert_eq!(measure(&project, "whole", "components"), 2.0);
}

#[test]
fn outlines_that_touch_at_a_point_are_told() {
    let project = Project::of(
        "fretwork: 1
regions:
  page: { rectangle: { width: 40, height: 40 } }
  wedge: { rectangle: { width: 30, height: 30, at: [0, -21.213203435596427], rotate: 45 } }
  left: { rectangle: { width: 20, height: 40 } }
  cut: { difference: [whole, diamond] }
  diamond: { svg: { file: diamond.svg } }
arrangements:
  whole: { connect: { input: left, region: page, width: 1, frame: 10 } }
artifacts:
  cut.svg: { from: cut }
",
    );
    project.write(
        "specs/diamond.svg",
        r##"<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 20 L5 15 L10 20 L5 25 Z"/></svg>"##,
    );
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stderr.contains("the outline touches itself at (0, 20)"),
        "{}",
        run.stderr
    );
}

const FACES: &str = "fretwork: 1
seed: 3
regions:
  board: { rectangle: { width: 100, height: 60 } }
  window: { inset: { from: board, by: 6 } }
  all: { faces: { of: cells, region: window } }
  open: { faces: { of: cells, region: window, where: open, inset: 1 } }
  shut: { faces: { of: cells, region: window, where: [shut] } }
  some: { faces: { of: cells, region: window, where: [open] } }
  screen: { difference: [board, open] }
  grown: { faces: { of: net, region: board, inset: -0.5 } }
partitions:
  cells: { uniform: { cell_size: 12, border: crop_add_boundary, face_labels: { open: 2, shut: 1 } } }
arrangements:
  net: { connect: { input: cells, region: window, width: 1.2 } }
artifacts:
  screen.svg: { from: screen }
  open.svg: { from: open, style: { open: { fill: teal } } }
";

#[test]
fn faces_of_an_arrangement_are_a_region() {
    let project = Project::of(FACES);
    let area = |node: &str| measure(&project, node, "area");
    assert!((area("all") - 88.0 * 48.0).abs() < 1e-3);
    assert!((area("shut") + area("some") - area("all")).abs() < 1e-3);
    assert!(area("open") < area("some"));
    assert!((area("screen") - (6000.0 - area("open"))).abs() < 1e-3);
    assert_eq!(measure(&project, "screen", "components"), 1.0);
    assert_eq!(
        measure(&project, "screen", "holes"),
        measure(&project, "open", "components")
    );
    // The faces of a cutout are its material without its openings, here moved outward.
    assert!(area("grown") > 1.2 * area("net") && area("grown") < 0.8 * 88.0 * 48.0);
    let run = project.run(&["build", "--deny", "warnings"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn faces_that_are_not_there_are_told() {
    let project = Project::of(FACES);
    project.edit("specs/spec.yaml", "where: open,", "where: opne,");
    for command in [&["check"][..], &["build"]] {
        let run = project.run(command);
        for said in [
            "labelled `opne`",
            "did you mean `open`?",
            "specs/spec.yaml:7:47",
        ] {
            assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        }
    }
    project.edit("specs/spec.yaml", "where: opne, inset: 1", "inset: 30");
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("no face is as wide as the inset needs")
            && run.stderr.contains("specs/spec.yaml:7:3"),
        "{}",
        run.stderr
    );
    assert!(!project.files("out").contains_key("spec/open.svg"));
}

/// A cutout stands in for a region only where no region has its name.
#[test]
fn a_region_is_meant_before_a_cutout_of_the_same_name() {
    let project = Project::of(
        "fretwork: 1
regions:
  net: { rectangle: { width: 20, height: 10 } }
  solid: { inset: { from: net, by: 1 } }
  lines: { inset: { from: arrangements.net, by: 0.1 } }
arrangements:
  net: { connect: { input: regions.net, region: regions.net, width: 2 } }
artifacts:
  solid.svg: { from: solid }
",
    );
    assert_eq!(measure(&project, "solid", "area"), 18.0 * 8.0);
    let lines = measure(&project, "lines", "area");
    assert!((lines - (19.8 * 9.8 - 18.2 * 8.2)).abs() < 1e-3, "{lines}");
    project.succeed(&["build"]);
}

/// A cup of a turned wall, with a foot.
const CUP: &str = "fretwork: 1
surfaces:
  outer: { revolve: { profile: [[0, 0], [20, 0], [26, 30], [0, 30]], segments: 64 } }
regions:
  foot: { rectangle: { width: 30, height: 20, at: [5, 3] } }
  hole: { circle: { radius: 4, at: [12, 12] } }
  plate: { difference: [foot, hole] }
  again: { section: { of: block, plane: { at: [0, 0, 2] } } }
  side: { section: { of: block, plane: { at: [0, -12, 0], normal: [0, -1, 0] } } }
  miss: { section: { of: block, plane: { at: [0, 0, 9] } } }
  sheets: { slices: { of: cup, every: 0.5, gap: 3 } }
  pinned: { slices: { of: block, along: x, every: 3, pins: 4 } }
solids:
  block: { extrude: { region: plate, height: 5 } }
  bore: { cylinder: { radius: 15, height: 40, at: [0, 0, 3], segments: 64 } }
  cup: { difference: [outer, bore] }
arrangements:
  marks: { registration: { slices: sheets } }
  front: { projection: { of: block, from: [0, -1, 0] } }
  corner: { projection: { of: block, from: [1, -1, 1], lines: all } }
artifacts:
  sheets.svg: { parts: [{ from: sheets, role: cut }, { from: marks, role: engrave }] }
  sheets.dxf: { from: sheets, kerf: 0.1 }
  corner.svg: { from: corner, style: { hidden: { stroke: gray } } }
  front.png: { from: front, width: 300 }
";

#[test]
fn sections_give_back_what_was_extruded_and_slices_the_volume() {
    let project = Project::of(CUP);
    let (plate, again) = (measures(&project, "plate"), measures(&project, "again"));
    for name in ["components", "holes"] {
        assert_eq!(plate[name], again[name], "{name}");
    }
    let corner = |measures: &Value, i: usize| measures["bounds"][0][i].as_f64().unwrap();
    for i in 0..2 {
        assert!((corner(&plate, i) - corner(&again, i)).abs() < 1e-6);
    }
    let area = |node: &str| measure(&project, node, "area");
    assert!((area("again") - area("plate")).abs() < 1e-3);
    // Through the middle of the hole: 30 wide less 8, and 5 high.
    assert!((area("side") - 22.0 * 5.0).abs() < 0.05, "{}", area("side"));
    let volume = measure(&project, "cup", "volume");
    assert!((area("sheets") * 0.5 / volume - 1.0).abs() < 2e-3);
    assert_eq!(measure(&project, "sheets", "components"), 60.0);
    let run = project.run(&["build", "--deny", "warnings"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let svg = String::from_utf8(project.files("out")["spec/sheets.svg"].clone()).unwrap();
    for layer in ["\"60\"", "\"outline\"", "\"number\""] {
        assert!(svg.contains(layer), "{layer}");
    }
}

#[test]
fn the_front_of_a_block_is_a_rectangle_and_hidden_lines_are_apart() {
    let project = Project::of(CUP);
    let front = measures(&project, "front");
    // The borders of its outline are one rectangle; the hole is seen from above only.
    assert!((front["length"].as_f64().unwrap() - 70.0).abs() < 1e-6);
    assert_eq!(front["faces"], 1);
    project.succeed(&["build"]);
    let svg = String::from_utf8(project.files("out")["spec/corner.svg"].clone()).unwrap();
    assert!(svg.contains("\"hidden\"") && svg.contains("\"crease\""));
}

#[test]
fn what_cannot_be_cut_is_told_at_its_place() {
    let project = Project::of(CUP);
    let told = |edit: [&str; 2], only: &str, said: &[&str]| {
        project.edit("specs/spec.yaml", edit[0], edit[1]);
        let run = project.run(&["build", "--only", only]);
        assert_eq!(run.code, Some(1), "{only}: {}", run.stderr);
        for said in said {
            assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        }
        project.edit("specs/spec.yaml", edit[1], edit[0]);
    };
    let artifact = "front.png: { from: front, width: 300 }";
    told(
        [artifact, "front.png: { from: miss }"],
        "front.png",
        &[
            "the plane misses `block`",
            "specs/spec.yaml:10:",
            "the solid reaches from 0 to 5",
        ],
    );
    told(
        ["every: 0.5, gap: 3", "every: 0.001, gap: 3"],
        "sheets.dxf",
        &[
            "there would be 30000 slices",
            "specs/spec.yaml:11:",
            "0.006 or thicker",
        ],
    );
    told(
        [artifact, "front.png: { from: pinned }"],
        "front.png",
        &["no place for pins lies inside", "specs/spec.yaml:12:"],
    );
    told(
        ["slices: sheets }", "slices: plate }"],
        "sheets.svg",
        &["the region has no slices", "specs/spec.yaml:18:"],
    );
    told(
        ["of: cup, every", "of: open, every"],
        "sheets.dxf",
        &["nothing is named `open`"],
    );
}

/// Windows that are meshes are seen in a drawing of the front.
#[test]
fn the_elevation_of_a_facade_shows_its_meshes() {
    let front = |shape: &str| {
        let project = Project::of(&format!(
            "fretwork: 1
units: m
symbols:
  A: {{ size: 1, opaque: true }}
patterns:
  row: \"A(A)^3\"
layers:
  wall: {{ x: row, y: row }}
facades:
  house: {{ canvas: {{ width: 6, height: 4 }}, layers: [wall], shapes: {{ \"*\": {shape} }} }}
arrangements:
  front: {{ projection: {{ of: house, from: [0, -1, 0] }} }}
artifacts:
  front.svg: {{ from: front }}
"
        ));
        project.write(
            "specs/window.obj",
            "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 -0.4 0.5\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 1 4 3 2\n",
        );
        project.succeed(&["build"]);
        measure(&project, "front", "length")
    };
    let plain = front("{ box: { depth: 0.1 } }");
    let meshes = front("{ mesh: window.obj }");
    // Every window has four edges that run to its middle.
    assert!(meshes > plain + 16.0, "{meshes} and {plain}");
}

#[test]
fn parts_have_looks_of_their_own_unless_they_become_one_body() {
    let spec = "fretwork: 1
solids:
  base: { box: { size: [10, 10, 2] } }
  knob: { sphere: { radius: 3, at: [5, 5, 2] } }
  both:
    assemble:
      parts:
        - { from: base, color: teal }
        - { from: knob, material: { color: '#ffcc00', metallic: 1, roughness: 0.2 } }
artifacts:
  both.glb: { from: both }
  laid.3mf: { parts: [ { from: base, color: '#102030' }, { from: both, at: [20, 0, 0] } ] }
";
    let project = Project::of(spec);
    project.succeed(&["build", "specs/spec.yaml"]);
    let glb = std::fs::read(project.path("out/spec/both.glb")).unwrap();
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let scene: Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    let materials = scene["materials"].as_array().unwrap();
    assert_eq!(materials.len(), 2);
    let gold = &materials[1]["pbrMetallicRoughness"];
    assert_eq!(
        (
            gold["metallicFactor"].as_f64(),
            gold["roughnessFactor"].as_f64()
        ),
        (Some(1.0), Some(0.2))
    );
    let united = spec.replace("assemble:\n", "assemble:\n      union: true\n");
    project.write("specs/spec.yaml", &united);
    let run = project.run(&["build", "specs/spec.yaml"]);
    let told = &run.stderr;
    assert!(
        told.contains("parts that become one body have no looks of their own"),
        "{told}"
    );
    assert!(told.contains("specs/spec.yaml:9:"), "{told}");
}

#[test]
fn all_gaps_that_part_a_union_are_told() {
    let project = Project::of(
        "fretwork: 1
regions:
  a: { rectangle: { width: 10, height: 10 } }
  far: { rectangle: { width: 10, height: 10, at: [30, 0] } }
  near: { rectangle: { width: 10, height: 10, at: [42, 0] } }
  page: { rectangle: { width: 9, height: 9 } }
  whole: { union: [a, far, near, net] }
partitions:
  cells: { uniform: { cell_size: 4 } }
arrangements:
  net: { connect: { input: cells, region: page, width: 1 } }
artifacts:
  whole.svg: { from: whole }
",
    );
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    // The two on the right are nearest to each other, and one of them to the first.
    for said in [
        "`far` does not touch `a` and the other parts: a gap of 20 is left",
        "`near` does not touch `far` and the other parts: a gap of 2 is left",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

#[test]
fn faces_of_a_cutout_are_its_area_in_the_region() {
    let project = Project::of(
        "fretwork: 1
regions:
  page: { rectangle: { width: 20, height: 20 } }
  inner: { rectangle: { width: 10, height: 10, at: [5, 5] } }
  half: { rectangle: { width: 10, height: 20 } }
  ring: { difference: [page, inner] }
  whole: { faces: { of: ring, region: page } }
  left: { faces: { of: ring, region: half } }
  net_left: { faces: { of: net, region: half } }
  net_whole: { faces: { of: net, region: page } }
partitions:
  cells: { uniform: { cell_size: 4 } }
arrangements:
  net: { connect: { input: cells, region: page, width: 1 } }
",
    );
    let area = |node: &str| measure(&project, node, "area");
    assert!((area("whole") - 300.0).abs() < 1e-6);
    assert!((area("left") - 150.0).abs() < 1e-6);
    assert!((area("net_whole") - area("net")).abs() < 1e-3);
    assert!(area("net_left") < 0.8 * area("net"));
}

#[test]
fn a_facade_stands_the_same_in_sections_and_in_elevations() {
    let project = Project::of(
        "fretwork: 1
symbols: { A: { size: 1, opaque: true } }
patterns: { x: \"A^3\", y: \"A^2\" }
layers: { wall: { x: x, y: y } }
facades:
  front: { canvas: { width: 3, height: 2 }, layers: [wall], shapes: { \"*\": { box: { depth: 0.2 } } } }
arrangements:
  seen: { projection: { of: front, from: [0, -1, 0] } }
regions:
  plan: { section: { of: front, plane: { at: [0, 0, 1.1], normal: [0, 0, 1] } } }
  sheets: { slices: { of: front, every: 0.5 } }
",
    );
    let sizes = |node: &str| {
        let bounds = measures(&project, node)["bounds"].clone();
        let at = |corner: usize, axis: usize| bounds[corner][axis].as_f64().unwrap();
        [at(1, 0) - at(0, 0), at(1, 1) - at(0, 1)]
    };
    let ([wide, high], [across, deep]) = (sizes("seen"), sizes("plan"));
    assert!((wide - 3.0).abs() < 1e-6 && (high - 2.0).abs() < 1e-6);
    assert!((across - 3.0).abs() < 1e-6 && deep < 0.4, "{across} {deep}");
    // Four sheets from the foot to the top.
    assert_eq!(measure(&project, "sheets", "components"), 4.0);
}

#[test]
fn a_plane_through_a_face_has_the_face_in_it_from_either_side() {
    let project = Project::of(
        "fretwork: 1
solids:
  block: { box: { size: [20, 10, 30] } }
  ball: { sphere: { radius: 5 } }
regions:
  foot: { section: { of: block, plane: { at: [0, 0, 0] } } }
  top: { section: { of: block, plane: { at: [0, 0, 30] } } }
  tip: { section: { of: ball, plane: { at: [0, 0, -5] } } }
",
    );
    for node in ["foot", "top"] {
        assert!(
            (measure(&project, node, "area") - 200.0).abs() < 1e-3,
            "{node}"
        );
    }
    let run = project.run(&["inspect", "specs/spec.yaml", "tip"]);
    assert!(
        run.stderr.contains("the plane misses `ball`"),
        "{}",
        run.stderr
    );
}

#[test]
fn sheets_that_are_not_filled_are_told() {
    let project = Project::of(
        "fretwork: 1
solids:
  block: { box: { size: [20, 10, 30] } }
regions:
  sheets: { slices: { of: block, every: 7 } }
artifacts:
  sheets.svg: { from: sheets }
",
    );
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for said in [
        "5 sheets of 7 are 35 high, and `block` is 30",
        "sheets of 7.5 or 6 fill it evenly",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    project.edit("specs/spec.yaml", "every: 7", "every: 6");
    let run = project.run(&["build", "--deny", "warnings"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn a_region_gets_a_thickness_and_is_no_cutout_on_a_surface() {
    let project = Project::of(
        "fretwork: 1
regions:
  disc: { circle: { radius: 5 } }
  hole: { circle: { radius: 2 } }
  ring: { difference: [disc, hole] }
surfaces:
  tube: { revolve: { profile: [[10, 0], [10, 20]] } }
solids:
  plate: { extrude: { region: ring, height: 2 } }
  part: { assemble: { parts: [ { from: ring, thickness: 2 } ] } }
  bare: { assemble: { parts: [ { from: ring } ] } }
artifacts:
  ring.stl: { from: ring, thickness: 2, expect: { components: 1, genus: 1 } }
",
    );
    project.succeed(&["build", "--only", "ring.stl"]);
    let volume = |node: &str| measure(&project, node, "volume");
    assert!((volume("plate") - volume("part")).abs() < 1e-9);
    let run = project.run(&["inspect", "specs/spec.yaml", "bare"]);
    assert!(
        run.stderr.contains("add `thickness: 2` beside `from`"),
        "{}",
        run.stderr
    );
    project.edit(
        "specs/spec.yaml",
        "  bare:",
        "  cut: { carve: { surface: tube, cutout: ring, thickness: 1 } }\n  bare:",
    );
    let run = project.run(&["check"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for said in [
        "`ring` is a region, but a cutout is needed",
        "wrap: { from: ring, onto: SURFACE }",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

#[test]
fn labels_that_are_not_there_are_told_when_they_are_changed() {
    let project = Project::of(
        "fretwork: 1
regions:
  page: { rectangle: { width: 60, height: 40 } }
partitions:
  rows: { stripes: { spacing: 8, edge_labels: [thin, thick] } }
arrangements:
  other: { relabel: { from: rows, labels: { thick: major, thinn: minor } } }
artifacts:
  other.svg: { from: other, region: page }
",
    );
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for said in [
        "nothing in `rows` is labelled `thinn` here",
        "did you mean `thin`?",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

#[test]
fn a_gap_between_slices_is_told() {
    let spec = "fretwork: 1
solids:
  plate: { box: { size: [20, 20, 10] } }
  pair: { assemble: { parts: [{ from: plate }, { from: plate, at: [0, 0, 25] }] } }
regions: { sheets: { slices: { of: pair, every: 5 } } }
artifacts: { sheets.svg: { from: sheets } }
";
    let project = Project::of(spec);
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let said = "3 sheets are empty, the first of them sheet 3";
    assert!(run.stderr.contains(said), "{}", run.stderr);
    project.edit("specs/spec.yaml", "at: [0, 0, 25]", "at: [0, 0, 10]");
    project.succeed(&["build", "--deny", "warnings"]);
}
