//! Surfaces carved by cutouts of every kind: through or to a depth, one or several, taken or kept.

use serde_json::Value;

use super::project::Project;

/// A flat plate of 60 by 40 that faces up, as the drawing plane does.
const PLATE: &str = "ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
0 -40 0
60 -40 0
60 0 0
0 0 0
3 0 1 2
3 0 2 3
";

const SPEC: &str = "fretwork: 1
regions:
  bar: { rectangle: { width: 50, height: 4, at: [5, 18] } }
  post: { rectangle: { width: 4, height: 36, at: [28, 2] } }
  disc: { circle: { radius: 3 } }
  spot: { circle: { radius: 3, at: [0, 6] } }
arrangements:
  cross: { connect: { input: bar, region: bar, width: 1 } }
  stem: { connect: { input: post, region: post, width: 1 } }
  mark: { wrap: { from: disc, onto: tube, at: [20, 0, 20] } }
  dot: { wrap: { from: spot, onto: tube, at: [20, 0, 20] } }
  far: { wrap: { from: disc, onto: tube, at: [-20, 0, 20] } }
  other: { wrap: { from: disc, onto: wide, at: [25, 0, 20] } }
surfaces:
  plate: { mesh: { file: plate.ply } }
  tube: { revolve: { profile: [[20, 0], [20, 40]], segments: 96 } }
  wide: { revolve: { profile: [[25, 0], [25, 40]], segments: 96 } }
solids:
";

/// A project with these solids, the first of which is written.
fn project(solids: &str) -> Project {
    let name = solids.trim().split(':').next().unwrap();
    let project = Project::of(&format!(
        "{SPEC}{solids}artifacts:\n  made.stl: {{ from: {name} }}\n"
    ));
    project.write("specs/plate.ply", PLATE);
    project
}

/// The measures of the only solid.
fn made(solid: &str) -> Value {
    let project = project(&format!("  made: {{ {solid} }}\n"));
    let json = project.succeed(&["inspect", "specs/spec.yaml", "made", "--format", "json"]);
    serde_json::from_str(&json).unwrap()
}

#[track_caller]
fn check(measures: &Value, counts: (u64, u64), volume: f64) {
    let count = |name: &str| measures[name].as_u64().unwrap();
    assert_eq!((count("components"), count("genus")), counts, "{measures}");
    let found = measures["volume"].as_f64().unwrap();
    assert!((found / volume - 1.0).abs() < 3e-3, "{found}, not {volume}");
}

/// The outlines of a bar and of a post; half of their lines lies inside.
const OUTLINES: [f64; 2] = [50.0 * 4.0 - 49.0 * 3.0, 36.0 * 4.0 - 35.0 * 3.0];

#[test]
fn a_plate_is_carved_by_a_planar_cutout_or_keeps_it_in_a_frame() {
    let [bar, _] = OUTLINES;
    let taken = made("carve: { surface: plate, cutout: cross, thickness: 2 }");
    check(&taken, (2, 1), 2.0 * (2400.0 - bar));
    let alone = made("carve: { surface: plate, cutout: cross, thickness: 2, invert: true }");
    check(&alone, (1, 1), 2.0 * bar);
    // A frame of 6 reaches the bar, which begins 5 from the border, on two sides.
    let held =
        made("carve: { surface: plate, cutout: cross, thickness: 2, invert: true, frame: 6 }");
    let rim = 60.0 * 40.0 - 48.0 * 28.0;
    check(&held, (1, 3), 2.0 * (rim + bar - 2.0 * 2.5));
}

#[test]
fn several_cutouts_count_together() {
    let [bar, post] = OUTLINES;
    // Where the two outlines cross, four squares of half a unit belong to both.
    let both = made("carve: { surface: plate, cutout: [cross, stem], thickness: 2, invert: true }");
    check(&both, (1, 5), 2.0 * (bar + post - 1.0));
    let through = made("carve: { surface: tube, cutout: [mark, far], thickness: 2 }");
    let disc = std::f64::consts::PI * 9.0 * 2.0 * 0.95;
    let tube = std::f64::consts::PI * (400.0 - 324.0) * 40.0;
    check(&through, (1, 3), tube - 2.0 * disc);
    let raised = made("emboss: { surface: tube, cutout: [mark, far], height: 0.5 }");
    check(&raised, (1, 0), std::f64::consts::PI * 400.0 * 40.0);
}

#[test]
fn what_is_engraved_keeps_a_floor() {
    let tube = std::f64::consts::PI * (400.0 - 324.0) * 40.0;
    let disc = std::f64::consts::PI * 9.0;
    let one = made("carve: { surface: tube, cutout: mark, thickness: 2, depth: 0.8 }");
    check(&one, (1, 1), tube - disc * 0.8 * 0.98);
    let two = made("carve: { surface: tube, cutout: [mark, dot, far], thickness: 2, depth: 0.8 }");
    check(&two, (1, 1), tube - 3.0 * disc * 0.8 * 0.98);
    let plate = made("carve: { surface: plate, cutout: cross, thickness: 2, depth: 0.8 }");
    check(&plate, (1, 0), 2.0 * 2400.0 - 0.8 * OUTLINES[0]);
    let kept = made(
        "carve: { surface: tube, cutout: mark, thickness: 2, depth: 0.8, invert: true, frame: 4 }",
    );
    let lowered = std::f64::consts::PI * (400.0 - 19.2f64.powi(2)) * 32.0 - disc * 0.8 * 0.98;
    check(&kept, (1, 1), tube - lowered);
}

/// What a build that must fail says.
fn told(solid: &str) -> String {
    let project = project(&format!("  made: {{ {solid} }}\n"));
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    run.stderr
}

/// The part of a line that is underlined.
#[track_caller]
fn check_underlined(told: &str, text: &str) {
    let lines: Vec<&str> = told.lines().collect();
    let column = |line: &str, found: usize| line[..found].chars().count();
    let is_under = |pair: &[&str]| {
        pair[0].find(text).is_some_and(|at| {
            let first = pair[1].find(['─', '┬']).map(|found| column(pair[1], found));
            first == Some(column(pair[0], at))
        })
    };
    assert!(lines.windows(2).any(is_under), "{told}");
}

#[test]
fn a_depth_that_reaches_through_is_told_at_its_place() {
    let told = told("carve: { surface: tube, cutout: mark, thickness: 2, depth: 2.25 }");
    assert!(told.contains("by 0.250"), "{told}");
    assert!(
        told.contains("a depth below 2.000 leaves a floor"),
        "{told}"
    );
    check_underlined(&told, "2.25");
}

#[test]
fn the_cutout_of_a_list_that_fails_is_told() {
    for kind in [
        "carve: { surface: tube, cutout: [mark, other], thickness: 2 }",
        "emboss: { surface: tube, cutout: [mark, other], height: 1 }",
    ] {
        let told = told(kind);
        assert!(told.contains("lies on another surface"), "{told}");
        check_underlined(&told, "other]");
    }
}

/// The measures of the node `made` of a spec with these sections.
fn measured(sections: &str) -> Value {
    let project = Project::of(&format!(
        "fretwork: 1\n{sections}artifacts:\n  made.stl: {{ from: made }}\n"
    ));
    let json = project.succeed(&["inspect", "specs/spec.yaml", "made", "--format", "json"]);
    serde_json::from_str(&json).unwrap()
}

#[test]
fn a_groove_or_a_relief_that_is_flush_with_its_surface_comes_out_whole() {
    let cylinder = "[[0, 0], [30, 0], [30, 40], [0, 40]]";
    let cone = "[[0, 0], [36, 0], [24, 40], [0, 40]]";
    for (profile, bodies) in [
        (cylinder, "difference: [cup, piece]"),
        (cone, "difference: [cup, piece]"),
        (cylinder, "union: [cup, piece]"),
        (cone, "union: [cup, piece]"),
    ] {
        let side = if bodies.starts_with("union") {
            "outside"
        } else {
            "inside"
        };
        let made = measured(&format!(
            "regions: {{ sq: {{ rectangle: {{ width: 12, height: 12 }} }} }}
surfaces: {{ cup: {{ revolve: {{ profile: {profile} }} }} }}
arrangements: {{ m: {{ wrap: {{ from: sq, onto: cup, at: [30, 3, 20], side: {side} }} }} }}
solids:
  piece: {{ assemble: {{ parts: [{{ from: m, thickness: 0.5 }}] }} }}
  cup_alone: {{ assemble: {{ parts: [{{ from: cup }}] }} }}
  made: {{ {bodies} }}
"
        ));
        let counts = ["components", "genus", "cavities"].map(|name| made[name].as_u64().unwrap());
        assert_eq!(counts, [1, 0, 0], "{profile} {bodies}: {made}");
    }
}

#[test]
fn letters_are_engraved_whole_in_a_body_that_is_solid() {
    let made = measured(
        "regions: { name: { text: { content: FLEUR, size: 9, align: middle, anchor: middle } } }
surfaces: { cup: { revolve: { profile: [[0, 0], [30, 0], [30, 40], [0, 40]] } } }
arrangements: { m: { wrap: { from: name, onto: cup, at: [30, 0, 20], side: inside } } }
solids:
  groove: { assemble: { parts: [{ from: m, thickness: 0.5 }] } }
  made: { difference: [cup, groove] }
",
    );
    // None of the grooves is a tunnel, and nothing stands in one but what is inside of an R.
    let counts = ["components", "genus"].map(|name| made[name].as_u64().unwrap());
    assert_eq!(counts, [1, 0], "{made}");
}

#[test]
fn an_open_surface_becomes_a_body_by_its_thickness() {
    let sections = "curves: { bow: { arc: { radius: 30, from: 0, to: 300 } } }
surfaces: { wall: { extrude: { profile: bow, height: 20 } } }
solids:
  made: { assemble: { parts: [{ from: wall, thickness: 2, side: inside }] } }
";
    let made = measured(sections);
    check(
        &made,
        (1, 0),
        std::f64::consts::PI * (900.0 - 784.0) * 20.0 * 5.0 / 6.0,
    );
    let bare = sections.replace(", thickness: 2, side: inside", "");
    let project = Project::of(&format!(
        "fretwork: 1\n{bare}artifacts:\n  made.stl: {{ from: made }}\n"
    ));
    let told = project.run(&["build"]).stderr;
    assert!(told.contains("by a `thickness` beside `from`"), "{told}");
    let file = "fretwork: 1
curves: { bow: { arc: { radius: 30, from: 0, to: 300 } } }
surfaces: { wall: { extrude: { profile: bow, height: 20 } } }
artifacts: { wall.stl: { from: wall, thickness: 2 } }
";
    Project::of(file).succeed(&["build", "--deny", "warnings"]);
}
