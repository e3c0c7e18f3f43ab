//! What is wrong with the input of shells and analyses, told with its place: each sentence of what must be diagnosed, from the
//! command line.

use super::project::{Project, Run};

/// The corners of a box and its triangles, as OBJ, numbered after so many others.
fn cuboid(from: [f64; 3], to: [f64; 3], before: usize) -> String {
    let corner = |i: usize| {
        let at = |axis: usize| {
            if i >> axis & 1 == 0 {
                from[axis]
            } else {
                to[axis]
            }
        };
        format!("v {} {} {}\n", at(0), at(1), at(2))
    };
    let sides = [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ];
    let side = |side: &&str| {
        let numbers = side
            .split(' ')
            .map(|n| n.parse::<usize>().unwrap() + before);
        let words: Vec<String> = numbers.map(|n| n.to_string()).collect();
        format!("f {}\n", words.join(" "))
    };
    (0..8).map(corner).chain(sides.iter().map(side)).collect()
}

fn cube() -> String {
    cuboid([0.0; 3], [20.0; 3], 0)
}

/// A spec with a mesh, a pattern of holes, and either a shell on it or an analysis of it. Everything that a case changes stands
/// on a line of its own.
fn spec(last: &str, loads: &str) -> String {
    format!(
        r##"fretwork: 1
regions:
  tile: {{ rectangle: {{ width: 6, height: 6, periodic: true }} }}
  hole: {{ circle: {{ radius: 1.8, at: [3, 3] }} }}
  net: {{ difference: [tile, hole] }}
exemplars:
  holes: {{ rasterize: {{ from: net, region: tile, pixel_size: 0.5, feature_radius: 0.8 }} }}
  picture: {{ image: {{ file: picture.png, pixel_size: 0.5, solid: {{ darker_than: 0.5 }} }} }}
surfaces:
  body: {{ mesh: {{ file: body.obj }} }}
force_profiles:
  held:
    material: pla
    gravity: [0, 0, -1]
    supports: [ {{ lowest: 10% }} ]
    loads: [ {loads} ]
{last}
"##
    )
}

const SHELL: &str = "shells:\n  last: { surface: body, exemplar: holes, voxel: 1.2, thickness: 2, force_profile: held }\n\
                     artifacts: { a.json: { from: last } }";
const ANALYSIS: &str = "analyses:\n  last: { of: body, force_profile: held, voxel: 1.25 }\nartifacts: { a.json: { from: last } }";

/// A square picture of one grey, but for one pixel where `is_mixed`.
fn picture(side: u32, grey: u8, is_mixed: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side, side);
    encoder.set_color(png::ColorType::Grayscale);
    let mut pixels = vec![grey; (side * side) as usize];
    if is_mixed {
        pixels[0] = 255 - grey;
    }
    encoder
        .write_header()
        .unwrap()
        .write_image_data(&pixels)
        .unwrap();
    bytes
}

struct Case {
    mesh: String,
    spec: String,
    picture: Vec<u8>,
}

impl Case {
    fn of(mesh: String, spec: String) -> Case {
        Case {
            mesh,
            spec,
            picture: picture(16, 0, false),
        }
    }

    /// Builds it: the code, and that the message stands at the line that has `at`.
    #[track_caller]
    fn told(&self, code: i32, message: &str, at: &str) -> Run {
        self.found(&self.project(), code, message, at)
    }

    fn project(&self) -> Project {
        let project = Project::of(&self.spec);
        project.write("specs/body.obj", &self.mesh);
        project.write("specs/picture.png", &self.picture);
        project
    }

    #[track_caller]
    fn found(&self, project: &Project, code: i32, message: &str, at: &str) -> Run {
        let run = project.run(&["build", "specs/spec.yaml", "--format", "json"]);
        assert_eq!(run.code, Some(code), "{}", run.stdout);
        let found: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        let list = |key: &str| found[key].as_array().unwrap().clone();
        let all = [list("errors"), list("warnings")].concat();
        let is_it = |d: &&serde_json::Value| d["message"].as_str().unwrap().contains(message);
        let it = all
            .iter()
            .find(is_it)
            .unwrap_or_else(|| panic!("{message} in {all:#?}"));
        let line = self
            .spec
            .lines()
            .position(|line| line.contains(at))
            .unwrap()
            + 1;
        assert_eq!(it["line"], line, "{it}");
        run
    }
}

#[test]
fn meshes_that_are_none_are_told() {
    let body = |mesh: &str| Case::of(mesh.into(), spec(SHELL, ""));
    let at = "  body:";
    body("v 0 0 0\n").told(1, "it has no triangles", at);
    body("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").told(
        1,
        "line 1: a vertex needs three finite numbers",
        at,
    );
    body("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").told(
        1,
        "no triangle of the mesh has an area; one is near (1.000, 0.000, 0.000)",
        at,
    );
}

#[test]
fn triangles_without_area_are_told_with_their_place() {
    let mesh = cube() + "v 10 0 0\nv 0 0 0\nf 1 9 2\nf 1 10 2\n";
    let case = Case::of(mesh, spec(SHELL, ""));
    let run = case.told(
        0,
        "a triangle of the mesh has no area, near (10.000, 0.000, 0.000)",
        "  body:",
    );
    assert_eq!(
        run.stdout.matches("mesh has no area").count(),
        1,
        "{}",
        run.stdout
    );
    // What the file says is told at the file.
    let collapsed =
        "`specs/body.obj`: 1 triangle has two corners in one place, near (6.667, 0.000, 0.000)";
    assert!(run.stdout.contains(collapsed), "{}", run.stdout);
}

#[test]
fn meshes_that_pass_through_themselves_are_told_with_a_place() {
    let crossing = cube() + &cuboid([10.0; 3], [30.0; 3], 8);
    for last in [SHELL, ANALYSIS] {
        let case = Case::of(crossing.clone(), spec(last, ""));
        let run = case.told(0, "the mesh passes through itself: ", "  body:");
        let near = run.stdout.split("one near (").nth(1).unwrap();
        let near: Vec<f64> = near
            .split(')')
            .next()
            .unwrap()
            .split(", ")
            .map(|n| n.parse().unwrap())
            .collect();
        // The surfaces of both cubes.
        let is_on = |low: f64, high: f64| {
            near.iter().all(|v| (low..=high).contains(v))
                && near.iter().any(|v| *v == low || *v == high)
        };
        assert!(is_on(0.0, 20.0) && is_on(10.0, 30.0), "{near:?}");
    }
    // Bodies that only touch are no fault.
    let beside = cube() + &cuboid([20.0, 0.0, 0.0], [40.0, 20.0, 20.0], 8);
    let project = Project::of(&spec(SHELL, ""));
    project.write("specs/body.obj", beside);
    project.write("specs/picture.png", picture(16, 0, false));
    let run = project.run(&["build"]);
    assert!(!run.stderr.contains("passes through"), "{}", run.stderr);
}

#[test]
fn bodies_thinner_than_a_voxel_are_told() {
    let sheet = cuboid([0.0; 3], [20.0, 0.2, 20.0], 0);
    Case::of(sheet.clone(), spec(SHELL, "")).told(
        0,
        "hold sides of the surface that face apart, one near (",
        "  last:",
    );
    Case::of(sheet, spec(ANALYSIS, "")).told(
        0,
        "where the body is thinner than three of them",
        "  last:",
    );
    let speck = cuboid([0.0; 3], [0.2, 0.2, 0.2], 0);
    Case::of(
        speck,
        spec(&ANALYSIS.replace("voxel: 1.25", "voxel: 12"), ""),
    )
    .told(0, "thinner than three of them", "  last:");
}

#[test]
fn exemplars_that_are_none_are_told() {
    let last = SHELL.replace("exemplar: holes,", "\n    exemplar: picture,");
    for (side, grey, is_mixed, message, at) in [
        (
            16,
            0,
            false,
            "all pixels of the exemplar are solid",
            "  picture:",
        ),
        (
            16,
            255,
            false,
            "all pixels of the exemplar are empty",
            "  picture:",
        ),
        (2, 0, true, "must be at least 5 × 5", "    exemplar:"),
    ] {
        let case = Case {
            picture: picture(side, grey, is_mixed),
            ..Case::of(cube(), spec(&last, ""))
        };
        case.told(1, message, at);
    }
    let drawn = spec(SHELL, "").replace("from: net", "from: tile");
    Case::of(cube(), drawn).told(1, "all pixels of the exemplar are solid", "  holes:");
    let mask = spec(&last, "").replace("darker_than: 0.5", "mask: mask.png");
    let case = Case::of(cube(), mask);
    let project = case.project();
    project.write("specs/mask.png", picture(8, 0, true));
    case.found(
        &project,
        1,
        "the mask has 8 × 8 pixels, the picture has 16 × 16",
        "  picture:",
    );
}

#[test]
fn supports_and_loads_that_miss_are_told_where_they_stand() {
    let missing = "lowest: 10%";
    let away = "box: [[90, 90, 90], [91, 91, 91]]";
    let push = "{ highest: 10%, force: [1, 0, 0] }";
    let aside = "{ sphere: { center: [0, 0, 90], radius: 5 }, force: [1, 0, 0] }";
    for (last, message) in [
        (SHELL, "no support catches the part of the surface near ("),
        (ANALYSIS, "the supports hold no part of the body"),
    ] {
        let run =
            Case::of(cube(), spec(last, "").replace(missing, away)).told(1, message, "supports:");
        assert!(
            run.stdout
                .contains("the body lies between (0.00, 0.00, 0.00) and (20.00, 20.00, 20.00)"),
            "{}",
            run.stdout
        );
    }
    for (last, message) in [
        (SHELL, "load 2 lies outside the surface"),
        (ANALYSIS, "load 2 catches no part of the body"),
    ] {
        let loads = format!("{push},\n      {aside}");
        Case::of(cube(), spec(last, &loads)).told(1, message, "center: [0, 0, 90]");
    }
}

#[test]
fn loads_that_do_nothing_are_told_where_they_stand() {
    let idle = |load: &str| {
        let loads = format!("{{ highest: 10%, force: [1, 0, 0] }},\n      {load}");
        Case::of(cube(), spec(ANALYSIS, &loads)).told(0, "load 2 does nothing", load);
    };
    idle("{ lowest: 5%, force: [0, 0, -9] }");
    idle("{ highest: 5%, force: [0, 0, 0] }");
}

/// What has no safety factor has none in its file, and none that could be expected.
#[test]
fn a_safety_factor_that_is_none_is_null() {
    let held = spec(ANALYSIS, "").replace("lowest: 10%", "lowest: 100%");
    let case = Case::of(cube(), held.clone());
    let project = case.project();
    case.found(&project, 0, "nothing strains the body", "last: {");
    let bytes = std::fs::read(project.path("out/spec/a.json")).unwrap();
    let found: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
    let none = serde_json::json!({ "p99": null, "max": null });
    assert_eq!(found["safety_factor"], none);
    assert!(found["weakest_at"].is_null());
    let expected = held.replace(
        "{ from: last }",
        "{ from: last, expect: { safety_factor.max: { min: 2 } } }",
    );
    Case::of(cube(), expected).told(
        1,
        "there is no `safety_factor.max`, as nothing strains the body, and at least 2 is expected",
        "expect:",
    );
}

/// Solids that lie in one another without a `union` are analysed as if they were united: that is told, and they weigh once.
#[test]
fn solids_in_one_another_are_told_and_weigh_once() {
    let mass = |of: &str, is_told: bool| {
        let last = format!(
            "solids:\n  a: {{ box: {{ size: [20, 20, 20] }} }}\n  b: {{ box: {{ size: [20, 20, 20], at: [10, 0, 0] }} }}\n  \
             both: {{ {of} }}\n{}",
            ANALYSIS.replace("of: body", "of: both")
        );
        let case = Case::of(cube(), spec(&last, ""));
        let project = case.project();
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let told = "parts of the body lie in one another, in 2048 voxels of it";
        assert_eq!(run.stderr.contains(told), is_told, "{}", run.stderr);
        let bytes = std::fs::read(project.path("out/spec/a.json")).unwrap();
        let found: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        found["mass"].as_f64().unwrap()
    };
    let put = mass("assemble: { parts: [{ from: a }, { from: b }] }", true);
    let united = mass("union: [a, b]", false);
    assert!((put / united - 1.0).abs() < 0.01, "{put} {united}");
    assert!((united / (12e-6 * 1240.0) - 1.0).abs() < 0.01, "{united}");
}

/// A proof of nothing is none: where all of a body is held, every limit would hold.
#[test]
fn a_body_that_nothing_strains_is_told() {
    let held = spec(ANALYSIS, "").replace("lowest: 10%", "lowest: 100%");
    let message = "nothing strains the body";
    Case::of(cube(), held.clone()).told(0, message, "last: {");
    let required = held.replace("gravity:", "require: true\n    gravity:");
    Case::of(cube(), required).told(1, message, "last: {");
}

#[test]
fn impossible_materials_are_told() {
    let values = "
      youngs_modulus: 2GPa
      poisson_ratio: 0.35
      density: 1040
      yield_strength: 40MPa
      across_layers: 60%
      build_direction: [0, 0, 1]";
    for (was, is, message) in [
        ("2GPa", "0GPa", "expected a pressure above 0"),
        ("0.35", "0.5", "expected a number above -1 and below 0.5"),
        ("0.35", "-1", "expected a number above -1 and below 0.5"),
        ("1040", "-1", "expected a mass density above 0"),
        ("40MPa", "-40MPa", "expected a pressure above 0"),
        ("60%", "0", "expected a fraction above 0 and at most 1"),
        ("60%", "1.5", "expected a fraction from 0 to 1"),
        ("[0, 0, 1]", "[0, 0, 0]", "direction"),
    ] {
        let spec = spec(ANALYSIS, "").replace(
            "material: pla",
            &format!("material:{}", values.replace(was, is)),
        );
        let line = values.lines().find(|line| line.contains(was)).unwrap();
        let at = line.split(':').next().unwrap();
        Case::of(cube(), spec).told(1, message, at);
    }
}

#[test]
fn parts_that_hang_by_an_edge_or_a_corner_are_told() {
    for (to, message) in [
        ([20, 20, 0], "hangs by one edge, about which it can swing"),
        ([20, 20, 20], "hangs by one corner, about which it can turn"),
    ] {
        let solids = format!(
            "solids:\n  one: {{ box: {{ size: [20, 20, 20] }} }}\n  \
             two: {{ assemble: {{ parts: [ {{ from: one }}, {{ from: one, at: {to:?} }} ] }} }}\n"
        );
        let last = solids
            + &ANALYSIS
                .replace("of: body", "of: two")
                .replace("voxel: 1.25", "voxel: 2");
        let held = spec(&last, "").replace("lowest: 10%", "box: [[0, 0, 0], [20, 20, 2]]");
        Case::of(cube(), held).told(1, message, "  last:");
        // In a file corners in one place are one.
        let mesh = cube() + &cuboid(to.map(f64::from), to.map(|v| f64::from(v + 20)), 8);
        let case = Case::of(mesh, spec(ANALYSIS, ""));
        case.told(1, " (20, 20, ", "  last:");
    }
}

#[test]
fn what_would_not_fit_memory_is_refused_before_it_is_taken() {
    for (last, message) in [
        (
            SHELL.replace("voxel: 1.2", "resolution: 20000"),
            "GiB, more than the 2048 MiB a surface may take",
        ),
        (
            ANALYSIS.replace("voxel: 1.25", "voxel: 0.06"),
            " MB, more than ",
        ),
        (
            ANALYSIS.replace("voxel: 1.25", "voxel: 0.001"),
            "would be too many: choose larger ones",
        ),
    ] {
        Case::of(cube(), spec(&last, "")).told(1, message, "  last:");
    }
}

/// An orientation that says nothing, and a wall for which there is no room.
#[test]
fn what_has_no_effect_and_no_room_is_told() {
    let still = "fields: { still: { expression: { value: [\"0\", \"0\", \"0\"] } } }\n".to_owned()
        + &SHELL.replace("thickness: 2", "thickness: 2, orientation: still");
    Case::of(cube(), spec(&still, "")).told(0, "the field of `orientation` is zero", "  last:");
    let thick = SHELL.replace("thickness: 2", "thickness: 60");
    Case::of(cube(), spec(&thick, "")).told(0, "thicker than there is room for", "  last:");
}
