//! Drawings wrapped around bodies: what is told of them, what carving and embossing make of them, and that nothing of it
//! depends on threads.

use serde_json::Value;

use super::project::Project;

const SPEC: &str = "fretwork: 1
seed: 4
regions:
  tile: { rectangle: { width: \"${2 * pi * 20 / 4}\", height: 24, periodic: true } }
  badge: { circle: { radius: 6 } }
  hole: { circle: { radius: 3 } }
  ring: { difference: [badge, hole] }
curves:
  plan: { polyline: { points: [[0, 0, 0], [40, 0, 0], [40, 30, 0], [0, 30, 0]], closed: true } }
surfaces:
  tube: { revolve: { profile: [[20, 0], [20, 40]], segments: 96 } }
  wall: { extrude: { profile: plan, height: 20 } }
partitions:
  cells: { uniform: { cell_size: 6 } }
arrangements:
  net: { connect: { input: cells, region: tile, width: 1, components: any } }
  lace: { wrap: { from: cells, onto: tube, region: tile, width: 1 } }
  sheet: { wrap: { from: net, onto: tube, region: tile } }
  corner: { wrap: { from: ring, onto: wall, at: [40, 0, 10] } }
  rings: { wrap: { from: ring, onto: tube, repeat: 5 } }
solids:
  lantern: { carve: { surface: tube, cutout: rings, thickness: 1 } }
  kept: { carve: { surface: tube, cutout: rings, thickness: 1, invert: true, frame: 15 } }
  raised: { emboss: { surface: tube, cutout: rings, height: 0.5 } }
artifacts:
  lace.stl: { from: lace, thickness: 1 }
  kept.stl: { from: kept }
  raised.stl: { from: raised }
  lace.svg: { from: lace }
";

/// The measures of `node`.
fn measures(project: &Project, node: &str) -> Value {
    let json = project.succeed(&["inspect", "specs/spec.yaml", node, "--format", "json"]);
    serde_json::from_str(&json).unwrap()
}

fn number(measures: &Value, name: &str) -> f64 {
    measures[name]
        .as_f64()
        .unwrap_or_else(|| panic!("no {name}: {measures}"))
}

#[test]
fn a_periodic_region_closes_around_a_body() {
    let project = Project::of(SPEC);
    for node in ["lace", "sheet"] {
        let lace = measures(&project, node);
        assert_eq!(
            (&lace["copies"], &lace["around"]),
            (&4.into(), &1.into()),
            "{lace}"
        );
        assert_eq!(lace["components"], 1, "{lace}");
        // What is cut open to be drawn flat has its holes at the cut open too.
        let flat = lace["flat"]["holes"].as_u64().unwrap();
        assert!(lace["holes"].as_u64().unwrap() > flat, "{lace}");
        assert!((number(&lace, "surface_area") / number(&lace, "area") - 1.0).abs() < 1e-3);
    }
}

#[test]
fn what_is_wrapped_is_carved_kept_and_raised() {
    let project = Project::of(SPEC);
    let whole = std::f64::consts::PI * (20.0f64.powi(2) - 19.0f64.powi(2)) * 40.0;
    let ring = std::f64::consts::PI * (36.0 - 9.0);
    // Walls stand along the normals, so that a ring is a little narrower inside.
    let taken = 5.0 * ring * 1.0 * (19.5 / 20.0);
    let carved = measures(&project, "lantern");
    // Five tunnels through the wall, and that of the tube itself.
    assert_eq!(carved["genus"], 6, "{carved}");
    assert_eq!(
        carved["components"], 6,
        "the middles of the rings are loose"
    );
    assert!(
        (number(&carved, "volume") / (whole - taken) - 1.0).abs() < 3e-3,
        "{carved}"
    );
    let kept = measures(&project, "kept");
    assert_eq!(kept["components"], 1, "{kept}");
    let raised = measures(&project, "raised");
    assert_eq!(
        (&raised["components"], &raised["genus"]),
        (&1.into(), &0.into()),
        "{raised}"
    );
    let out = 5.0 * ring * 0.5 * (20.25 / 20.0);
    let full = std::f64::consts::PI * 400.0 * 40.0;
    assert!(
        (number(&raised, "volume") / (full + out) - 1.0).abs() < 2e-3,
        "{raised}"
    );
    let corner = measures(&project, "corner");
    assert!((number(&corner, "surface_area") / number(&corner, "area") - 1.0).abs() < 1e-6);
}

#[test]
fn wraps_do_not_depend_on_threads() {
    let project = Project::of(SPEC);
    project.succeed(&["build", "--no-cache", "--jobs", "1"]);
    let files = project.files("out");
    assert_eq!(files.len(), 4);
    project.succeed(&["build", "--no-cache", "--jobs", "4", "--out", "again"]);
    assert_eq!(project.files("again"), files);
}

#[test]
fn what_cannot_be_wrapped_is_told_at_its_place() {
    let cases: [(&str, &str, &[&str]); 8] = [
        (
            "repeat: 5",
            "repeat: 12",
            &[
                "143.993 wide and the way around the surface 125.641",
                "specs/spec.yaml:20:3",
            ],
        ),
        (
            "repeat: 5",
            "scale: 4",
            &["over the upper rim", "specs/spec.yaml:20:3"],
        ),
        (
            "* 20 / 4",
            "* 20 / 4.5",
            &[
                "the seam does not close",
                "31.4103 (4 around) or 25.1283 (5 around)",
            ],
        ),
        (
            "from: cells, onto: tube, region: tile, width: 1",
            "from: cells, onto: tube, width: 1",
            &["`cells` is drawn on no region", "add `region:`"],
        ),
        (
            "onto: tube, region: tile, width: 1",
            "onto: tube, region: tile",
            &["the lines of `cells` have no width"],
        ),
        (
            "from: ring, onto: tube, repeat: 5",
            "from: ring, onto: tube, repeat: 5, width: 2",
            &["`ring` has an area already", "specs/spec.yaml:20:55"],
        ),
        (
            "thickness: 1, invert: true, frame: 15",
            "thickness: 1, frame: 15",
            &["a frame holds what is kept", "specs/spec.yaml:23"],
        ),
        (
            "surface: tube, cutout: rings, height: 0.5",
            "surface: wall, cutout: rings, height: 0.5",
            &["the cutout lies on another surface"],
        ),
    ];
    for (from, to, said) in cases {
        let project = Project::of(SPEC);
        project.edit("specs/spec.yaml", from, to);
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(1), "{to}: {}", run.stderr);
        for words in said {
            assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
        }
    }
}

#[test]
fn a_mesh_is_wrapped_around_a_place() {
    let project = Project::of(
        "fretwork: 1
solids:
  stone: { sphere: { radius: 20, segments: 48 } }
artifacts:
  stone.stl: { from: stone }
",
    );
    project.succeed(&["build"]);
    let bytes = project.files("out").into_values().next().unwrap();
    project.write("specs/stone.stl", bytes);
    project.write(
        "specs/spec.yaml",
        "fretwork: 1
regions:
  badge: { circle: { radius: 6 } }
surfaces:
  stone: { mesh: { file: stone.stl } }
arrangements:
  mark: { wrap: { from: badge, onto: stone, at: [12, 12, 12] } }
  lost: { wrap: { from: badge, onto: stone } }
solids:
  marked: { emboss: { surface: stone, cutout: mark, height: 1 } }
artifacts:
  marked.stl: { from: marked, expect: { components: 1, genus: 0 } }
",
    );
    project.succeed(&["build"]);
    let mark = measures(&project, "mark");
    let stretch = &mark["stretch"];
    assert!(
        number(stretch, "min") > 0.95 && number(stretch, "max") < 1.05,
        "{mark}"
    );
    assert!((number(stretch, "mean") - 1.0).abs() < 0.02, "{mark}");
    let lost = project.run(&["inspect", "specs/spec.yaml", "lost"]);
    assert!(
        lost.stderr.contains("it is not said where on the surface"),
        "{}",
        lost.stderr
    );
}

/// Two blocks beside each other, each of side 20.
fn blocks() -> String {
    let mut text = String::new();
    for (number, x) in [(0, 0.0), (1, 100.0)] {
        for i in 0..8 {
            let bit = |k: u32| f64::from(i >> k & 1) * 20.0;
            text += &format!("v {} {} {}\n", x + bit(0), bit(1), bit(2));
        }
        let quads = [
            [1, 3, 4, 2],
            [5, 6, 8, 7],
            [1, 2, 6, 5],
            [3, 7, 8, 4],
            [1, 5, 7, 3],
            [2, 4, 8, 6],
        ];
        for quad in quads {
            let [a, b, c, d] = quad.map(|corner| corner + 8 * number);
            text += &format!("f {a} {b} {c} {d}\n");
        }
    }
    text
}

#[test]
fn a_mesh_of_two_bodies_is_wrapped_on_the_one_that_is_meant() {
    let project = Project::of(
        "fretwork: 1
regions:
  badge: { circle: { radius: 4 } }
surfaces:
  blocks: { mesh: { file: blocks.obj } }
arrangements:
  mark: { wrap: { from: badge, onto: blocks, at: [10, 10, 20] } }
solids:
  marked: { emboss: { surface: blocks, cutout: mark, height: 1 } }
artifacts:
  marked.stl: { from: marked, expect: { components: 2, genus: 0 } }
",
    );
    project.write("specs/blocks.obj", blocks());
    project.succeed(&["build"]);
    let mark = measures(&project, "mark");
    assert!(
        (number(&mark, "surface_area") - number(&mark, "area")).abs() < 1e-6,
        "{mark}"
    );
}

/// A ball as a mesh, with a disc of some radius on it.
fn disc_on_a_ball(radius: f64) -> Project {
    let project = Project::of(
        "fretwork: 1
solids:
  ball: { sphere: { radius: 30, segments: 48 } }
artifacts:
  ball.stl: { from: ball }
",
    );
    project.succeed(&["build"]);
    let bytes = project.files("out").into_values().next().unwrap();
    project.write("specs/ball.stl", bytes);
    project.write(
        "specs/spec.yaml",
        format!(
            "fretwork: 1
regions:
  disc: {{ circle: {{ radius: {radius} }} }}
surfaces:
  ball: {{ mesh: {{ file: ball.stl }} }}
arrangements:
  mark: {{ wrap: {{ from: disc, onto: ball, at: [21, 0, 21] }} }}
artifacts:
  mark.json: {{ from: mark }}
"
        ),
    );
    project
}

#[test]
fn a_drawing_that_is_larger_than_a_mesh_is_told_by_how_much() {
    let run = disc_on_a_ball(93.0).run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let said = "the drawing is larger than the surface around the place: it reaches ";
    assert!(run.stderr.contains(said), "{}", run.stderr);
    let scale = run.stderr.split("with a `scale` of ").nth(1).unwrap();
    let scale = scale.split(',').next().unwrap();
    let scale: f64 = scale.parse().unwrap();
    let fitting = disc_on_a_ball(93.0 * scale * 0.8).run(&["build"]);
    assert_eq!(fitting.code, Some(0), "{}", fitting.stderr);
    let small = disc_on_a_ball(8.0).run(&["build", "--deny", "warnings"]);
    assert_eq!(small.code, Some(0), "{}", small.stderr);
    let large = disc_on_a_ball(36.0).run(&["build"]);
    assert!(
        large.stderr.contains("lengths of `disc` become 0."),
        "{}",
        large.stderr
    );
    let project = disc_on_a_ball(8.0);
    project.edit("specs/spec.yaml", "[21, 0, 21]", "[300, 0, 0]");
    let run = project.run(&["build"]);
    assert!(
        run.stderr.contains("270 away from the surface"),
        "{}",
        run.stderr
    );
}

#[test]
fn the_stretch_of_a_drawing_is_that_of_the_places_it_covers() {
    let project = Project::of(
        "fretwork: 1
regions:
  patch: { rectangle: { width: 20, height: 10 } }
surfaces:
  coarse: { revolve: { profile: [[20, 0], [35, 40], [18, 90]] } }
  fine: { revolve: { profile: [[20, 0], [27.5, 20], [35, 40], [31.6, 50], [28.2, 60], [24.8, 70], [18, 90]] } }
arrangements:
  a: { wrap: { from: patch, onto: coarse, at: [26.5, 0, 65] } }
  b: { wrap: { from: patch, onto: fine, at: [26.5, 0, 65] } }
",
    );
    let [a, b] = ["a", "b"].map(|node| measures(&project, node)["stretch"].clone());
    for name in ["min", "mean", "max"] {
        assert!(
            (number(&a, name) - number(&b, name)).abs() < 1e-4,
            "{name}: {a} {b}"
        );
    }
    // Five along the profile to either side change the radius by 1.6 of 26.5.
    let part = 5.0 * 17.0 / f64::hypot(17.0, 50.0) / 26.5;
    assert!((number(&a, "max") - 1.0 - part).abs() < 1e-3, "{a}");
    assert!((number(&a, "min") - 1.0 + part).abs() < 1e-3, "{a}");
}

#[test]
fn a_tile_as_high_as_the_surface_fits() {
    let project = Project::of(
        "fretwork: 1
regions:
  tile: { rectangle: { width: \"${2 * pi * 30 / 6}\", height: 60, periodic: true } }
  tall: { rectangle: { width: 10, height: 60.001 } }
partitions: { cells: { uniform: { cell_size: 11 } } }
surfaces:
  tube: { revolve: { profile: [[30, 0], [30, 60]] } }
  cone: { revolve: { profile: [[30, 0], [20, 40]] } }
arrangements:
  lace: { wrap: { from: cells, region: tile, onto: tube, width: 1.6 } }
  over: { wrap: { from: tall, onto: tube } }
solids:
  net: { carve: { surface: tube, cutout: lace, thickness: 2, invert: true, frame: 3 } }
artifacts:
  net.stl: { from: net, expect: { components: 1 } }
",
    );
    project.succeed(&["build"]);
    let run = project.run(&["inspect", "specs/spec.yaml", "over"]);
    assert!(run.stderr.contains("over the upper rim"), "{}", run.stderr);
}

#[test]
fn what_is_unrolled_apart_is_not_combined_in_one_plane() {
    let project = Project::of(SPEC);
    project.edit(
        "specs/spec.yaml",
        "  ring: {",
        "  both: { union: [sheet, corner] }\n  one: { union: [corner, badge] }\n  ring: {",
    );
    let run = project.run(&["inspect", "specs/spec.yaml", "both"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for said in [
        "`sheet` and `corner` are each unrolled",
        "and `wrap` the result",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    project.succeed(&["inspect", "specs/spec.yaml", "one"]);
}

#[test]
fn a_cutout_that_touches_a_rim_is_told() {
    let spec = |at: u32| {
        format!(
            "fretwork: 1
regions:
  disc: {{ circle: {{ radius: 5 }} }}
surfaces:
  tube: {{ revolve: {{ profile: [[30, 0], [30, 60]] }} }}
arrangements:
  mark: {{ wrap: {{ from: disc, onto: tube, at: [30, 0, {at}] }} }}
solids:
  cut: {{ carve: {{ surface: tube, cutout: mark, thickness: 2 }} }}
artifacts:
  cut.stl: {{ from: cut }}
"
        )
    };
    let run = Project::of(&spec(55)).run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stderr.contains("`mark` comes within 0.000"),
        "{}",
        run.stderr
    );
    let run = Project::of(&spec(54)).run(&["build", "--deny", "warnings"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn a_thickness_that_would_do_is_told() {
    let spec = |thickness: &str| {
        format!(
            "fretwork: 1
regions:
  disc: {{ circle: {{ radius: 1 }} }}
surfaces:
  thin: {{ revolve: {{ profile: [[3, 0], [3, 60]] }} }}
arrangements:
  mark: {{ wrap: {{ from: disc, onto: thin }} }}
solids:
  cut: {{ carve: {{ surface: thin, cutout: mark, thickness: {thickness} }} }}
artifacts:
  cut.stl: {{ from: cut }}
"
        )
    };
    let run = Project::of(&spec("5")).run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let most = run
        .stderr
        .split("a thickness of ")
        .nth(1)
        .expect(&run.stderr);
    let most = most.split(' ').next().unwrap();
    assert!(most.parse::<f64>().unwrap() > 2.0, "{most}");
    Project::of(&spec(most)).succeed(&["build"]);
}

#[test]
fn a_frame_that_does_not_reach_the_pattern_is_told_how_far_that_is() {
    let project = Project::of(SPEC);
    project.edit(
        "specs/spec.yaml",
        "invert: true, frame: 15",
        "invert: true, frame: 3",
    );
    let run = project.run(&["build", "--only", "kept.stl"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stderr.contains("`rings` is up to 14.0"),
        "{}",
        run.stderr
    );
}

/// A tube of 64 flat pieces of full height, as programs write it: text STL.
fn tall_tube() -> String {
    let corner = |i: u32, z: f64| {
        let angle = std::f64::consts::TAU * f64::from(i) / 64.0;
        format!("vertex {} {} {z}\n", 20.0 * angle.cos(), 20.0 * angle.sin())
    };
    let mut text = "solid tube\n".to_owned();
    for i in 0..64 {
        let j = (i + 1) % 64;
        let (a, b, c, d) = (
            corner(i, 0.0),
            corner(j, 0.0),
            corner(j, 50.0),
            corner(i, 50.0),
        );
        for [p, q, r] in [[&a, &b, &c], [&a, &c, &d]] {
            text += &format!("facet normal 0 0 0\nouter loop\n{p}{q}{r}endloop\nendfacet\n");
        }
    }
    text + "endsolid tube\n"
}

#[test]
fn a_mesh_of_tall_triangles_is_wrapped_on() {
    let spec = "fretwork: 1
regions: { plate: { rectangle: { width: 30, height: 9.5 } } }
surfaces: { tube: { mesh: { file: tube.stl } } }
arrangements: { mark: { wrap: { from: plate, onto: tube, at: [0, -20, 20] } } }
artifacts: { mark.stl: { from: mark, thickness: 1 } }
";
    let project = Project::of(spec);
    project.write("specs/tube.stl", tall_tube());
    let mark = measures(&project, "mark");
    for end in ["min", "mean", "max"] {
        let stretch = number(&mark["stretch"], end);
        assert!((stretch - 1.0).abs() < 1e-3, "{mark}");
    }
    assert!(
        (number(&mark, "surface_area") / 285.0 - 1.0).abs() < 1e-3,
        "{mark}"
    );
    // Around and a half is too much, and the scale that is proposed fits.
    project.edit("specs/spec.yaml", "width: 30,", "width: 180,");
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let scale = run
        .stderr
        .split("with a `scale` of ")
        .nth(1)
        .expect(&run.stderr);
    let scale = scale.split(',').next().unwrap().to_owned();
    project.edit(
        "specs/spec.yaml",
        "onto: tube,",
        &format!("onto: tube, scale: {scale},"),
    );
    project.succeed(&["build"]);
}

#[test]
fn a_surface_that_turns_back_on_itself_is_told() {
    let spec = |surface: &str, at: &str, width: u32| {
        Project::of(&format!(
            "fretwork: 1
curves:
  eight: {{ polyline: {{ points: [[0, 0, 0], [40, 40, 0], [40, 0, 0], [0, 40, 0]], closed: true }} }}
regions: {{ plate: {{ rectangle: {{ width: {width}, height: 60 }} }} }}
surfaces: {{ s: {{ {surface} }} }}
arrangements: {{ mark: {{ wrap: {{ from: plate, onto: s, at: {at} }} }} }}
artifacts: {{ mark.stl: {{ from: mark, thickness: 1 }} }}
"
        ))
    };
    let wall = "extrude: { profile: eight, height: 80 }";
    let turned = "revolve: { profile: [[20, 0], [40, 20], [20, 40], [45, 5]] }";
    for (surface, at, width) in [(wall, "[20, 20, 40]", 150), (turned, "[28, 0, 32]", 10)] {
        let run = spec(surface, at, width).run(&["build"]);
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        assert!(
            run.stderr.contains("turns back on itself"),
            "{}",
            run.stderr
        );
        assert!(
            run.stderr.contains("the profile meets itself at"),
            "{}",
            run.stderr
        );
    }
    // On a part of the wall that does not meet itself there is room.
    let run = spec(wall, "[40, 20, 40]", 30).run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn lengths_around_a_body_of_few_flat_pieces_are_kept() {
    let spec = "fretwork: 1
regions:
  square: { rectangle: { width: 20, height: 20 } }
  tile: { rectangle: { width: 30, height: 20, periodic: true } }
  girth: { rectangle: { width: \"${2 * pi * 40}\", height: 5 } }
partitions: { cells: { uniform: { cell_size: 6 } } }
surfaces: { hexagon: { revolve: { profile: [[40, 0], [40, 60]], segments: 6 } } }
arrangements:
  mark: { wrap: { from: square, onto: hexagon, at: [40, 0, 30] } }
  net: { wrap: { from: cells, onto: hexagon, region: tile, width: 1 } }
  belt: { wrap: { from: girth, onto: hexagon } }
artifacts:
  mark.stl: { from: mark, thickness: 1 }
  net.stl: { from: net, thickness: 1 }
  belt.svg: { from: belt }
";
    let project = Project::of(spec);
    let mark = measures(&project, "mark");
    assert!(
        (number(&mark, "surface_area") - 400.0).abs() < 1e-6,
        "{mark}"
    );
    // Eight tiles of 30 are the way around six sides of 40.
    let net = measures(&project, "net");
    assert_eq!(net["copies"], 8, "{net}");
    assert!((number(&net["stretch"], "max") - 1.0).abs() < 1e-9, "{net}");
    // What fits the true circle is pressed together.
    let belt = measures(&project, "belt");
    let pressed = 240.0 / (80.0 * std::f64::consts::PI);
    assert!(
        (number(&belt["stretch"], "min") - pressed).abs() < 1e-9,
        "{belt}"
    );
}
