//! Where a thickness goes, measured on the meshes in the files.

use std::path::Path;

use super::project::{Project, copy};

/// The corners in a binary STL file.
fn corners(stl: &[u8]) -> Vec<[f64; 3]> {
    let number = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().unwrap()));
    let triangles = stl[84..].chunks_exact(50);
    let corners = triangles.flat_map(|t| t[12..48].chunks_exact(12).collect::<Vec<_>>());
    corners
        .map(|c| [number(&c[..4]), number(&c[4..8]), number(&c[8..])])
        .collect()
}

/// The least and the greatest distance of a file's corners from the z axis.
fn radii(stl: &[u8]) -> [f64; 2] {
    let radii = corners(stl).into_iter().map(|[x, y, _]| x.hypot(y));
    radii.fold([f64::MAX, 0.0], |[low, high], r| [low.min(r), high.max(r)])
}

/// The least and the greatest height of a file's corners.
fn heights(stl: &[u8]) -> [f64; 2] {
    let heights = corners(stl).into_iter().map(|[_, _, z]| z);
    heights.fold([f64::MAX, f64::MIN], |[low, high], z| {
        [low.min(z), high.max(z)]
    })
}

#[track_caller]
fn assert_near(found: [f64; 2], wanted: [f64; 2], what: &str) {
    let off = (found[0] - wanted[0])
        .abs()
        .max((found[1] - wanted[1]).abs());
    assert!(off < 0.02, "{what}: {found:?}, not {wanted:?}");
}

const SPEC: &str = r"fretwork: 1
exemplars:
  bar: { vector: { file: bar.svg } }
curves:
  round: { circle: { radius: 20, at: [0, 0, 10] } }
surfaces:
  tube: { revolve: { profile: [[20, 0], [20, 20]], segments: 360 } }
regions:
  page: { rectangle: { width: 30, height: 20 } }
partitions:
  rows: { stripes: { spacing: 4 } }
arrangements:
  net: { connect: { input: rows, region: page, width: 2, components: any, side: inside } }
bands:
  ring: { exemplar: bar, curve: round, height: 4, across: normal }
  around: { exemplar: bar, curve: round, height: 4, across: normal, side: outside }
solids:
  inner: { assemble: { parts: [{ from: ring, thickness: 2, side: inside }] } }
  own: { assemble: { parts: [{ from: around, thickness: 2 }] } }
  cut_in: { carve: { surface: tube, cutout: ring, thickness: 2 } }
  cut_out: { carve: { surface: tube, cutout: ring, thickness: 2, side: outside } }
  cut_mid: { carve: { surface: tube, cutout: ring, thickness: 2, side: center } }
artifacts:
  inner.stl: { from: inner }
  own.stl: { from: own }
  cut_in.stl: { from: cut_in }
  cut_out.stl: { from: cut_out }
  cut_mid.stl: { from: cut_mid }
  center.stl: { from: ring, thickness: 2 }
  outside.stl: { from: ring, thickness: 2, side: outside }
  overruled.stl: { from: around, thickness: 2, side: inside }
  part.stl: { side: inside, thickness: 2, parts: [{ from: ring, side: outside }] }
  parts.stl: { side: inside, parts: [{ from: ring, thickness: 2 }] }
  net.stl: { from: net, thickness: 2 }
  net_center.stl: { from: net, thickness: 2, side: center }
";

const BAR: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="24mm" height="3mm" viewBox="0 0 24 3">
  <path fill-rule="evenodd" d="M0 0H24V3H0Z M4 1h6v1H4Z M14 1h5v1H14Z"/>
</svg>"#;

#[test]
fn the_thickness_goes_where_any_of_the_words_side_says() {
    let project = Project::of(SPEC);
    project.write("specs/bar.svg", BAR);
    project.succeed(&["build"]);
    let files = project.files("out");
    for (file, wanted) in [
        ("inner", [18.0, 20.0]),
        ("own", [20.0, 22.0]),
        ("cut_in", [18.0, 20.0]),
        ("cut_out", [20.0, 22.0]),
        ("cut_mid", [19.0, 21.0]),
        ("center", [19.0, 21.0]),
        ("outside", [20.0, 22.0]),
        ("overruled", [18.0, 20.0]),
        ("part", [20.0, 22.0]),
        ("parts", [18.0, 20.0]),
    ] {
        assert_near(radii(&files[&format!("spec/{file}.stl")]), wanted, file);
    }
    assert_near(heights(&files["spec/net.stl"]), [-2.0, 0.0], "net");
    assert_near(
        heights(&files["spec/net_center.stl"]),
        [-1.0, 1.0],
        "net_center",
    );
}

#[test]
fn a_side_of_what_has_none_is_told() {
    let project = Project::of(
        "fretwork: 1\nregions:\n  page: { rectangle: { width: 3, height: 2 } }\nsolids:\n  base: { extrude: { region: page, height: 1 } }\nartifacts:\n  base.stl: { from: base, side: inside }\n  page.svg: { from: page, side: inside }\n",
    );
    let told = project.run(&["check"]).stderr;
    for file in ["spec/base.stl", "spec/page.svg"] {
        let said = format!("`side` has no effect in `{file}`");
        assert!(told.contains(&said), "{said}: {told}");
    }
}

#[test]
fn the_bracelet_has_the_wrists_size_inside() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs");
    let project = Project::empty();
    copy(&home.join("bands"), &project.path("specs/bands"));
    copy(&home.join("assets"), &project.path("specs/assets"));
    for wrist in [165.0, 190.0] {
        let set = format!("wrist={wrist}");
        let spec = "specs/bands/bracelet.yaml";
        project.succeed(&["build", spec, "--only", "cuff.stl", "--set", &set]);
        let [inside, outside] = radii(&project.files("out")["bands/bracelet/cuff.stl"]);
        let round = inside * std::f64::consts::TAU;
        assert!(
            (round - wrist).abs() < 0.1,
            "{round} round the inside for {wrist}"
        );
        assert!(
            (outside - inside - 2.4).abs() < 0.02,
            "{}",
            outside - inside
        );
    }
}
