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
                "143.993 wide and the way around the surface 125.664",
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
                "31.4159 (4 around) or 25.1327 (5 around)",
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
