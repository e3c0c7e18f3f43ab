//! Shells that once came out wrong, or of which something was not said: each as small as shows it.

use serde_json::Value as Json;

use super::project::{Project, Run};

/// Mortar of a wall of bricks, half a voxel wide and more, on a surface.
fn bricks(surface: &str, voxel: f64, more: &str) -> String {
    format!(
        r##"fretwork: 1
seed: 3
regions:
  tile: {{ rectangle: {{ width: 12, height: 12, periodic: true }} }}
  one: {{ rectangle: {{ width: 10.8, height: 4.8, at: [0.6, 0.6] }} }}
  left: {{ rectangle: {{ width: 5.4, height: 4.8, at: [0, 6.6] }} }}
  right: {{ rectangle: {{ width: 5.4, height: 4.8, at: [6.6, 6.6] }} }}
  mortar: {{ difference: [tile, one, left, right] }}
exemplars:
  bricks: {{ rasterize: {{ from: mortar, region: tile, pixel_size: 0.3, feature_radius: 0.6 }} }}
surfaces:
  body: {surface}
force_profiles:
  standing: {{ material: pla, supports: [ {{ lowest: 10% }} ] }}
shells:
  wall: {{ surface: body, exemplar: bricks, voxel: {voxel}, thickness: 2.5{more} }}
artifacts:
  wall.json: {{ from: wall }}
"##
    )
}

const BALL: &str = "{ revolve: { profile: [[0, -20], [7.7, -18.5], [14.1, -14.1], [18.5, -7.7], [20, 0], [18.5, 7.7], [14.1, 14.1], [7.7, 18.5], [0, 20]], segments: 48 } }";
const PLATE: &str = "{ revolve: { profile: [[0, 0], [24, 0]], segments: 48 } }";
const BOWL: &str = "{ revolve: { profile: [[0, -20], [7.7, -18.5], [14.1, -14.1], [18.5, -7.7], [20, 0]], segments: 48 } }";

fn built(spec: &str) -> (Project, Run) {
    let project = Project::of(spec);
    let run = project.run(&["build", "specs/spec.yaml"]);
    (project, run)
}

fn json(project: &Project, path: &str) -> Json {
    let path = project.path(&format!("out/spec/{path}"));
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// What is a single voxel wide vanishes under the smooth border of the body, or hangs by a corner: it is joined again.
#[test]
fn patterns_as_fine_as_their_voxels_become_one_piece() {
    for surface in [PLATE, BALL, BOWL] {
        for voxel in [0.7, 1.0, 1.5] {
            let (project, run) = built(&bricks(surface, voxel, ""));
            assert_eq!(run.code, Some(0), "{surface}, {voxel}: {}", run.stderr);
            let found = json(&project, "wall.json");
            assert_eq!(found["components"], 1, "{surface}, {voxel}");
            assert_eq!(found["watertight"], true);
        }
    }
}

/// A step of a shell tells its place by the entry of its own shell, not by the first of the section.
#[test]
fn steps_are_told_where_their_shell_stands() {
    let spec = bricks(BALL, 1.0, "").replace(
        "shells:\n",
        "shells:\n  first: { surface: body, exemplar: bricks, voxel: 1, thickness: 2.5 }\n",
    );
    let spec = spec.replace(
        "voxel: 1, thickness: 2.5 }\nartifacts",
        "voxel: 0.0004, thickness: 2.5 }\nartifacts",
    );
    let (_, run) = built(&spec);
    assert_eq!(run.code, Some(1));
    let line = spec.lines().position(|l| l.contains("  wall: {")).unwrap() + 1;
    let place = format!("specs/spec.yaml:{line}:");
    assert!(run.stderr.contains(&place), "{place}\n{}", run.stderr);
}

/// The safety factor and the displacement that count are those of the worst direction of a sweep.
#[test]
fn a_sweep_counts_in_every_limit() {
    let spec = |limits: &str| {
        format!(
            r##"fretwork: 1
solids: {{ bar: {{ box: {{ size: [40, 4, 4] }} }} }}
force_profiles:
  swept: {{ material: abs, gravity: [1, 0, 0], sweep: gravity, supports: [ {{ box: [[-1, -30, -30], [2, 30, 30]] }} ], limits: {limits} }}
analyses:
  bar: {{ of: bar, force_profile: swept, voxel: 1 }}
artifacts: {{ bar.json: {{ from: analyses.bar }} }}
"##
        )
    };
    let (project, run) = built(&spec("{ safety_factor: 1 }"));
    assert!(!run.stderr.contains('⚠'), "{}", run.stderr);
    let found = json(&project, "bar.json");
    let worst = &found["worst_gravity"];
    let [along, across] =
        [&found["max_displacement"], &worst["max_displacement"]].map(|v| v.as_f64().unwrap());
    assert!(across > 20.0 * along, "{found}");
    let [safe, least] = [
        &found["safety_factor"]["max"],
        &worst["safety_factor"]["max"],
    ]
    .map(|v| v.as_f64().unwrap());
    assert!(least < 0.5 * safe, "{found}");
    // Both limits hold along gravity, and neither of them across it.
    let limits = format!(
        "{{ safety_factor: {}, max_displacement: {} }}",
        (safe * least).sqrt(),
        (along * across).sqrt()
    );
    let (_, run) = built(&spec(&limits));
    assert!(
        run.stderr.contains("the safety factor is") && run.stderr.contains("a point moves by"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains(" mm was allowed"), "{}", run.stderr);
}

/// Gravity as the profile has it is one of the directions that are tried.
#[test]
fn the_gravity_of_a_profile_counts_in_its_sweep() {
    let spec = |sweep: &str| {
        format!(
            r##"fretwork: 1
solids: {{ bar: {{ box: {{ size: [40, 4, 4] }} }} }}
force_profiles:
  held: {{ material: abs, gravity: [0, 1, 1]{sweep}, supports: [ {{ box: [[-1, -30, -30], [1, 30, 30]] }} ] }}
analyses:
  bar: {{ of: bar, force_profile: held, voxel: 1 }}
artifacts:
  bar.json:
    from: analyses.bar
    expect: {{ worst_gravity.safety_factor.max: {{ min: 1 }}, worst_gravity.p99: {{ max: 1MPa }} }}
"##
        )
    };
    let (project, run) = built(&spec(", sweep: gravity"));
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let swept = json(&project, "bar.json");
    let (project, run) = built(&spec("").replace("    expect", "    # expect"));
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let alone = json(&project, "bar.json");
    let worst = &swept["worst_gravity"];
    assert_eq!(worst["safety_factor"], alone["safety_factor"]);
    assert_eq!(worst["max_displacement"], alone["max_displacement"]);
    assert!(worst["p99"].as_f64() >= alone["stress"]["p99"].as_f64());
}

/// An orientation that is none is told with all that it may be.
#[test]
fn an_unknown_orientation_is_told_with_the_choices() {
    for orientation in ["{ flow: swirl }", "[0, 0, 1]", "3"] {
        let more = format!(", orientation: {orientation}");
        let (_, run) = built(&bricks(BALL, 1.0, &more));
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        for said in [
            "`{ up: [0, 0, 1] }`",
            "`{ stress: PROFILE }`",
            "vector field",
        ] {
            assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        }
    }
}

/// Limits that must hold are not left out of a build without a word.
#[test]
fn a_requirement_without_an_analysis_is_told() {
    let spec = bricks(PLATE, 1.5, ", force_profile: standing, analysis: false");
    let (_, run) = built(&spec);
    assert!(!run.stderr.contains("requires limits"), "{}", run.stderr);
    let (_, run) = built(&spec.replace("material: pla,", "material: pla, require: true,"));
    assert!(
        run.stderr.contains("`standing` requires limits") && run.stderr.contains("analysis: false"),
        "{}",
        run.stderr
    );
}

/// What has no effect, or another one than was meant, is said.
#[test]
fn what_says_nothing_is_told() {
    let cases = [
        (bricks(PLATE, 1.0, ""), "most of the surface is level"),
        (bricks(PLATE, 1.0, ", orientation: { up: [0, 1, 0] }"), ""),
        (
            bricks(
                BALL,
                1.0,
                ", keep_solid: [ { box: [[90, 90, 90], [91, 91, 91]] } ]",
            ),
            "`keep_solid` holds nothing",
        ),
        (
            bricks(BALL, 1.0, ", min_feature: 9"),
            "the pattern is filled",
        ),
    ];
    for (spec, words) in cases {
        let (_, run) = built(&spec);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let is_quiet = !run.stderr.contains('⚠');
        assert!(
            run.stderr.contains(words) && is_quiet == words.is_empty(),
            "{words}: {}",
            run.stderr
        );
    }
}

/// A feature that is narrower than asked, as the surface itself is, is told with its place on the surface.
#[test]
fn narrow_places_are_told_with_where_they_are() {
    let ring = "{ revolve: { profile: [[9, 0], [9, 3]], segments: 48 } }";
    let (_, run) = built(&bricks(ring, 0.7, ", min_feature: 4"));
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let said = "the narrowest feature is about 3.0";
    assert!(run.stderr.contains(said), "{}", run.stderr);
    let words: Vec<&str> = run.stderr.split_whitespace().collect();
    let near = words.iter().position(|word| *word == "near").unwrap();
    let place = [1, 2, 3].map(|i| -> f64 {
        let number = words[near + i].trim_matches(['(', ')', ',', ':']);
        number.parse().unwrap()
    });
    assert!((place[0].hypot(place[1]) - 9.0).abs() < 0.1, "{place:?}");
    assert!((0.0..=3.0).contains(&place[2]), "{place:?}");
    assert!(run.stderr.contains("4 was asked for"), "{}", run.stderr);
}

/// A pattern of which most openings are gone is told before all of them are.
#[test]
fn openings_that_vanish_are_told() {
    let (project, run) = built(&bricks(BALL, 1.0, ", min_feature: 3.2"));
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let fraction = &json(&project, "wall.json")["solid_fraction"];
    let part = |name: &str| fraction[name].as_f64().unwrap();
    assert!(
        part("after") - part("before") > 0.25 && part("after") < 0.98,
        "{fraction}"
    );
    let said = format!(
        "the pattern is much fuller than its picture: {:.0} % of the surface is solid",
        100.0 * part("after")
    );
    assert!(run.stderr.contains(&said), "{said}: {}", run.stderr);
}

/// What is expected of a surface with a thickness is measured on the body that is written.
#[test]
fn a_surface_with_a_thickness_is_measured_as_its_body() {
    let spec = "fretwork: 1
surfaces:
  tube: { revolve: { profile: [[10, 0], [10, 20]], segments: 96 } }
artifacts:
  tube.stl: { from: tube, thickness: 2, expect: { volume: [2240, 2280], watertight: true } }
";
    let (project, run) = built(spec);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    project.edit("specs/spec.yaml", "[2240, 2280]", "[0, 1]");
    let run = project.run(&["build"]);
    assert!(run.stderr.contains("`volume` is 22"), "{}", run.stderr);
}

/// Stress that was never computed is not shown as grey.
#[test]
fn stress_without_an_analysis_is_an_error() {
    for (more, code) in [
        ("", 1),
        (", force_profile: standing, analysis: false", 1),
        (
            ", force_profile: standing, keep_solid: [ { lowest: \"6mm\" } ]",
            0,
        ),
    ] {
        let spec = bricks(BALL, 1.0, more).replace(
            "wall.json: { from: wall }",
            "wall.png: { from: wall, width: 60, show: stress }",
        );
        let (_, run) = built(&spec);
        assert_eq!(run.code, Some(code), "{more}: {}", run.stderr);
        assert_eq!(
            run.stderr
                .contains("nothing that is shown has been analysed"),
            code == 1
        );
    }
}

#[test]
fn voxels_too_coarse_for_a_body_are_told() {
    let spec = |voxel: &str| {
        format!(
            r##"fretwork: 1
solids: {{ bar: {{ box: {{ size: [40, 4, 4] }} }} }}
force_profiles:
  held: {{ material: abs, supports: [ {{ box: [[-1, -30, -30], [5, 30, 30]] }} ] }}
analyses:
  bar: {{ of: bar, force_profile: held, voxel: {voxel} }}
artifacts: {{ bar.json: {{ from: analyses.bar }} }}
"##
        )
    };
    let (_, run) = built(&spec("1"));
    assert!(
        run.code == Some(0) && !run.stderr.contains('⚠'),
        "{}",
        run.stderr
    );
    let (_, run) = built(&spec("3"));
    assert!(
        run.code == Some(0) && run.stderr.contains("thinner than three of them"),
        "{}",
        run.stderr
    );
    let required = spec("3").replace("material: abs", "material: abs, require: true");
    let (_, run) = built(&required);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
}

/// A load over a hole of the pattern is an error that says what helps; beside a hole there is none.
#[test]
fn a_load_over_a_hole_is_told_with_advice() {
    let around = [
        [1.0, 0.0],
        [0.96, 0.28],
        [0.8, 0.6],
        [0.6, 0.8],
        [0.28, 0.96],
        [0.0, 1.0],
    ];
    let codes: Vec<Option<i32>> = around
        .into_iter()
        .map(|[x, y]: [f64; 2]| {
            let at = [18.5 * x, 18.5 * y, 7.7];
            let load = format!(
                "supports: [ {{ lowest: 10% }} ], max_stress: \"1GPa\", \
                 loads: [ {{ sphere: {{ center: {at:?}, radius: 1.2 }}, force: [1, 0, 0] }} ]"
            );
            let more = ", force_profile: standing, keep_solid: [ { lowest: \"6mm\" } ]";
            let spec = bricks(BALL, 1.0, more).replace("supports: [ { lowest: 10% } ]", &load);
            let (_, run) = built(&spec);
            let is_told = run.stderr.contains("load 1 catches no part of the body")
                && run.stderr.contains("`keep_solid`");
            assert_eq!(is_told, run.code == Some(1), "{}", run.stderr);
            run.code
        })
        .collect();
    assert!(
        codes.contains(&Some(0)) && codes.contains(&Some(1)),
        "{codes:?}"
    );
}

/// A limit that no bridge reaches is no success.
#[test]
fn a_limit_that_bridges_cannot_reach_is_told() {
    let spec = bricks(
        BALL,
        1.0,
        ", force_profile: standing, keep_solid: [ { lowest: \"6mm\" } ]",
    )
    .replace(
        "supports: [ { lowest: 10% } ]",
        "supports: [ { lowest: 10% } ], max_stress: \"1Pa\"",
    );
    let (project, run) = built(&spec);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stderr.contains("max_stress"), "{}", run.stderr);
    assert_eq!(json(&project, "wall.json")["done"], false);
}

/// Strength is tested by what is expected of an analysis, also of the figures that stand in a table.
#[test]
fn figures_of_an_analysis_can_be_expected() {
    let spec = "fretwork: 1
solids:
  bar: { box: { size: [20, 4, 4] } }
force_profiles:
  held: { material: pla, supports: [ { box: [[-1, -1, -1], [1, 5, 5]] } ] }
analyses:
  bar_held: { of: bar, force_profile: held, voxel: 1 }
artifacts:
  bar.json:
    from: bar_held
    expect: { safety_factor.p99: { min: 2 }, von_mises.max: [null, 50MPa], stress.p99: { max: 50MPa } }
";
    let (project, run) = built(spec);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    project.edit(
        "specs/spec.yaml",
        "von_mises.max: [null, 50MPa]",
        "von_mises.max: [null, 1Pa]",
    );
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for said in [
        "`von_mises.max` is",
        "at most 1 Pa is expected",
        "specs/spec.yaml:11:",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    project.edit("specs/spec.yaml", "von_mises.max", "von_mises.maxi");
    let run = project.run(&["check"]);
    assert!(
        run.stderr.contains("did you mean `von_mises.max`?"),
        "{}",
        run.stderr
    );
}

/// A plate of 2 mm bends as one of 2 mm, whatever the voxels of its shell are: within a tenth of the strip of the closed form.
#[test]
fn thin_walls_bend_as_they_are_made() {
    let spec = |thickness: f64, side: &str| {
        format!(
            r##"fretwork: 1
surfaces: {{ plate: {{ mesh: {{ file: plate.obj }} }} }}
regions: {{ tile: {{ rectangle: {{ width: 10, height: 10, periodic: true }} }}, dot: {{ circle: {{ radius: 3, at: [5, 5] }} }} }}
exemplars: {{ dots: {{ rasterize: {{ from: dot, region: tile, pixel_size: 0.5 }} }} }}
force_profiles:
  pushed: {{ material: pla, gravity: ["0m/s2", "0m/s2", "0m/s2"], supports: [ {{ lowest: 1mm }} ], loads: [ {{ highest: 1mm, force: ["0N", "1N", "0N"] }} ], max_stress: 1GPa }}
shells:
  wall: {{ surface: plate, exemplar: dots, voxel: 1, thickness: {thickness}, side: {side}, keep_solid: [ {{ lowest: "100mm" }} ], force_profile: pushed }}
artifacts: {{ wall.json: {{ from: wall }} }}
"##
        )
    };
    let plate = "v 0 0 0\nv 40 0 0\nv 40 0 40\nv 0 0 40\nf 1 2 3\nf 1 3 4\n";
    for (thickness, side) in [
        (1.6, "center"),
        (2.0, "inside"),
        (2.4, "center"),
        (2.6, "outside"),
    ] {
        let project = Project::of(&spec(thickness, side));
        project.write("specs/plate.obj", plate);
        let run = project.run(&["build", "specs/spec.yaml"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let found = json(&project, "wall.json");
        let of = |name: &str| found[name].as_f64().unwrap();
        // Held up to a height of 1 mm, loaded about 0.5 mm below the upper end.
        let inertia = 40.0 * thickness.powi(3) / 12.0;
        let expected = 38.5f64.powi(3) / (3.0 * 3500.0 * inertia);
        let ratio = of("max_displacement") / expected;
        assert!((0.85..1.1).contains(&ratio), "{thickness} {side}: {ratio}");
        let mass = of("mass") / (of("volume") * 1.24e-6);
        assert!((mass - 1.0).abs() < 0.01, "{thickness} {side}: {mass}");
    }
}

/// A bar whose sides are no multiples of the voxels bends as it is made, and its stress can be shown.
#[test]
fn bars_between_voxels_bend_as_they_are_made_and_show_their_stress() {
    for side in [4.0f64, 4.4, 4.6] {
        let spec = format!(
            r##"fretwork: 1
solids: {{ bar: {{ box: {{ size: [40, {side}, {side}] }} }} }}
force_profiles:
  held: {{ material: pla, gravity: ["0m/s2", "0m/s2", "0m/s2"], supports: [ {{ box: [[-1, -1, -1], [0.1, 9, 9]] }} ], loads: [ {{ box: [[39.4, -1, -1], [41, 9, 9]], force: ["0N", "0N", "-5N"] }} ] }}
analyses:
  bar: {{ of: bar, force_profile: held, voxel: 1 }}
artifacts:
  bar.json: {{ from: analyses.bar }}
  bar.glb: {{ from: analyses.bar }}
  bar.png: {{ from: analyses.bar, width: 200, show: stress }}
  plain.png: {{ from: analyses.bar, width: 200 }}
"##
        );
        let project = Project::of(&spec);
        let run = project.run(&["build", "specs/spec.yaml"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let found = json(&project, "bar.json");
        let expected = 5.0 * 40f64.powi(3) / (3.0 * 3500.0 * side.powi(4) / 12.0);
        let ratio = found["max_displacement"].as_f64().unwrap() / expected;
        assert!((0.93..1.02).contains(&ratio), "{side}: {ratio}");
        let read = |name: &str| std::fs::read(project.path(&format!("out/spec/{name}"))).unwrap();
        assert_ne!(read("bar.png"), read("plain.png"));
        let glb = String::from_utf8_lossy(&read("bar.glb")).into_owned();
        assert!(glb.contains("COLOR_0") && glb.contains("sum of the absolute principal stresses"));
    }
}

/// Figures far apart appear on a curved surface as often as in the exemplar, or nearly.
#[test]
fn single_figures_do_not_vanish() {
    let spec = bricks(BALL, 1.0, "")
        .replace("from: mortar", "from: dot")
        .replace(
            "  one:",
            "  dot: { circle: { radius: 2, at: [6, 6] } }\n  one:",
        );
    let (project, run) = built(&spec);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let found = json(&project, "wall.json");
    let fraction = &found["solid_fraction"];
    let part = fraction["before"].as_f64().unwrap() / fraction["exemplar"].as_f64().unwrap();
    assert!((0.7..1.3).contains(&part), "{fraction}");
}

/// A load on what is held, and a wall for which there is no room, are told.
#[test]
fn what_does_nothing_and_what_has_no_room_is_told() {
    let held = "supports: [ { lowest: 10% } ], loads: [ { lowest: 5%, force: [1, 0, 0] } ]";
    let spec = bricks(BALL, 1.0, ", force_profile: standing")
        .replace("supports: [ { lowest: 10% } ]", held);
    let (_, run) = built(&spec);
    assert!(run.stderr.contains("load 1 does nothing"), "{}", run.stderr);
    let thick = bricks(BALL, 1.0, "").replace("thickness: 2.5", "thickness: 50");
    let (_, run) = built(&thick);
    assert!(
        run.stderr.contains("thicker than there is room for"),
        "{}",
        run.stderr
    );
}

/// A bar that hangs is as much weaker as its layers hold together less well, where they are stacked along it.
#[test]
fn printed_parts_are_weaker_across_their_layers() {
    let safety = |material: &str| {
        let spec = format!(
            r##"fretwork: 1
solids: {{ bar: {{ box: {{ size: [4, 4, 40] }} }} }}
force_profiles:
  hung: {{ material: {material}, supports: [ {{ highest: "0mm" }} ] }}
analyses: {{ bar: {{ of: bar, force_profile: hung, voxel: 1 }} }}
artifacts: {{ bar.json: {{ from: analyses.bar }} }}
"##
        );
        let (project, run) = built(&spec);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        json(&project, "bar.json")["safety_factor"]["p99"]
            .as_f64()
            .unwrap()
    };
    let whole = safety("abs");
    assert_eq!(safety("{ of: abs }"), whole);
    let weak = safety("{ of: abs, across_layers: 0.5 }");
    assert!((weak / whole - 0.5).abs() < 0.05, "{weak} of {whole}");
    let values =
        "youngs_modulus: 2.3GPa, poisson_ratio: 0.35, density: 1040, yield_strength: 40MPa";
    assert_eq!(safety(&format!("{{ {values}, across_layers: 50% }}")), weak);
    let aside = "{ of: abs, across_layers: 0.5, build_direction: [1, 0, 0] }";
    assert!(safety(aside) > 0.9 * whole);
}
