//! Which steps of a shell run again after an edit of what they read.

use expect_test::expect;

use super::check_value_edit;

/// A small tube with an exemplar that is drawn in the spec.
const TUBE: &str = r##"fretwork: 1
seed: 1
regions:
  tile: { rectangle: { width: 8, height: 8, periodic: true } }
  hole: { circle: { radius: 2.4, at: [4, 4] } }
  ground: { difference: [tile, hole] }
exemplars:
  net: { rasterize: { from: ground, region: tile, pixel_size: 0.5, feature_radius: 1.5 } }
surfaces:
  tube: { revolve: { profile: [[8, 0], [8, 20]], segments: 24 } }
force_profiles:
  standing: { material: pla, supports: [ { lowest: 10% } ], max_stress: "8MPa" }
shells:
  net: { surface: tube, exemplar: exemplars.net, voxel: 1, thickness: 2, force_profile: standing, max_iterations: 3 }
artifacts: { net.json: { from: shells.net } }
"##;

#[test]
fn an_edit_of_the_limit_runs_no_synthesis() {
    check_value_edit(
        TUBE,
        &TUBE.replace("8MPa", "7MPa"),
        expect![[r#"
            entry 8
            read
            definition
            evaluated 3
            -> shells.net
            -> shells.net.structure"#]],
    );
}

#[test]
fn an_edit_of_what_must_hold_runs_no_synthesis_of_a_pattern_along_the_stress() {
    let along = TUBE.replace(
        "thickness: 2,",
        "thickness: 2, orientation: { stress: standing },",
    );
    check_value_edit(
        &along,
        &along.replace(
            "8MPa\"",
            "7MPa\", limits: { safety_factor: 2 }, sweep: gravity",
        ),
        expect![[r#"
            entry 8
            read
            definition
            evaluated 4
            read_forces
            -> shells.net
            -> shells.net.structure
            -> artifacts.net.json"#]],
    );
}

#[test]
fn an_edit_of_the_thickness_runs_no_synthesis() {
    check_value_edit(
        TUBE,
        &TUBE.replace("thickness: 2", "thickness: 2.5"),
        expect![[r#"
            entry 8
            read
            definition 4
            evaluated 3
            -> shells.net
            -> shells.net.structure
            -> artifacts.net.json"#]],
    );
}

#[test]
fn an_edit_of_the_load_voxelizes_nothing() {
    check_value_edit(
        TUBE,
        &TUBE.replace(
            "max_stress",
            "loads: [ { highest: 10%, force: [1, 0, 0] } ], max_stress",
        ),
        expect![[r#"
            entry 8
            read
            definition
            evaluated 4
            -> shells.net
            -> shells.net.structure
            -> artifacts.net.json"#]],
    );
}

#[test]
fn an_edit_of_the_exemplar_reads_no_surface() {
    check_value_edit(
        TUBE,
        &TUBE.replace("radius: 2.4", "radius: 2.2"),
        expect![[r#"
        entry 8
        read
        definition
        evaluated 7
        -> exemplars.net
        -> regions.ground
        -> regions.hole
        -> shells.net
        -> shells.net.pattern
        -> shells.net.structure
        -> artifacts.net.json"#]],
    );
}

#[test]
fn an_edit_of_the_resolution_runs_every_step() {
    check_value_edit(
        TUBE,
        &TUBE.replace("voxel: 1,", "voxel: 0.9,"),
        expect![[r#"
        entry 8
        read
        definition 4
        evaluated 5
        -> shells.net
        -> shells.net.pattern
        -> shells.net.structure
        -> shells.net.voxels
        -> artifacts.net.json"#]],
    );
}

#[test]
fn an_edit_of_the_least_feature_runs_the_end_alone() {
    check_value_edit(
        TUBE,
        &TUBE.replace("max_iterations", "min_feature: 2, max_iterations"),
        expect![[r#"
            entry 8
            read
            definition 4
            evaluated
            -> shells.net"#]],
    );
}
