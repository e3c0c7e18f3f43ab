//! What a second build does, and that its artifacts do not depend on how it came to them.

use std::collections::BTreeMap;
use std::fs;
use std::time::SystemTime;

use super::project::{Project, SPEC, ZIG};

/// The artifacts of [`SPEC`].
fn reference() -> BTreeMap<String, Vec<u8>> {
    let project = Project::small();
    project.succeed(&["build", "--no-cache", "--jobs", "1"]);
    let files = project.files("out");
    assert_eq!(files.len(), 5);
    files
}

#[test]
fn artifacts_depend_neither_on_threads_nor_on_the_cache_nor_on_the_place() {
    let expected = reference();
    for jobs in ["1", "2", "5"] {
        let project = Project::small();
        project.succeed(&["build", "--jobs", jobs]);
        assert_eq!(project.files("out"), expected, "cold, {jobs} jobs");
        fs::remove_dir_all(project.path("out")).unwrap();
        project.succeed(&["build", "--jobs", jobs]);
        assert_eq!(project.files("out"), expected, "warm, {jobs} jobs");
        project.succeed(&["build", "--jobs", jobs, "--no-cache", "--out", "elsewhere"]);
        assert_eq!(
            project.files("elsewhere"),
            expected,
            "without a cache, {jobs} jobs"
        );
    }
    let deep = Project::empty();
    deep.write("a long/way/to/fretwork.toml", "");
    deep.write("a long/way/to/specs/spec.yaml", SPEC);
    deep.write("a long/way/to/specs/assets/zig.svg", ZIG);
    deep.succeed(&["build", "a long/way/to/specs/spec.yaml"]);
    assert_eq!(deep.files("a long/way/to/out"), expected);
    for bytes in expected.values() {
        let text = String::from_utf8_lossy(bytes);
        assert!(
            !text.contains(&*deep.path("").to_string_lossy()),
            "an artifact holds a path of the machine"
        );
    }
}

#[test]
fn a_cache_moves_with_its_project_and_between_projects() {
    let first = Project::small();
    first.succeed(&["build"]);
    let cache = first.path(".fretwork").display().to_string();
    let second = Project::small();
    let report = second.build(&["--cache-dir", &cache]);
    assert_eq!(report.nodes("evaluated"), [""; 0]);
    assert_eq!(second.files("out"), first.files("out"));
}

#[test]
fn a_second_build_evaluates_and_writes_nothing() {
    let project = Project::small();
    let first = project.build(&[]);
    assert_eq!(first.artifacts("written").len(), 5);
    assert!(first.nodes("cached").is_empty());
    let stamps = stamps(&project);
    for jobs in ["1", "2"] {
        let second = project.build(&["--jobs", jobs]);
        assert_eq!(second.nodes("evaluated"), [""; 0]);
        assert_eq!(second.artifacts("unchanged").len(), 5);
    }
    assert_eq!(self::stamps(&project), stamps);
}

/// When the artifacts were written.
fn stamps(project: &Project) -> Vec<SystemTime> {
    let files = project.files("out").into_keys();
    files
        .map(|f| {
            fs::metadata(project.path(&format!("out/{f}")))
                .unwrap()
                .modified()
                .unwrap()
        })
        .collect()
}

#[test]
fn edits_without_meaning_evaluate_and_write_nothing() {
    let project = Project::small();
    project.build(&[]);
    let stamps = stamps(&project);
    let same_meaning = [
        ("fretwork: 1\n", "# A comment.\nfretwork: 1  # another\n\n"),
        ("size: 60", "size: 60.0"),
        (
            "{ circle: { radius: 10, at: [\"${half}\", \"${half}\"] } }",
            "\n    circle:\n      at: [30, '${half}']\n      radius: 10mm",
        ),
        ("seed: 3\n", "units: mm\nseed: 3\n"),
    ];
    for (from, to) in same_meaning {
        project.edit("specs/spec.yaml", from, to);
        let report = project.build(&[]);
        assert_eq!(report.nodes("evaluated"), [""; 0], "{to}");
        assert_eq!(report.artifacts("unchanged").len(), 5, "{to}");
    }
    assert_eq!(self::stamps(&project), stamps);
}

#[test]
fn an_edit_evaluates_what_depends_on_it() {
    let project = Project::small();
    project.build(&[]);
    project.edit("specs/spec.yaml", "cell_size: 9", "cell_size: 8");
    let report = project.build(&[]);
    assert_eq!(
        report.nodes("evaluated"),
        [
            "partitions.cells",
            "artifacts.cells.dxf",
            "artifacts.cells.json"
        ]
    );
    assert_eq!(
        report.artifacts("written"),
        ["spec/cells.dxf", "spec/cells.json"]
    );
    project.edit("specs/spec.yaml", "stroke: 0.4", "stroke: 0.5");
    let report = project.build(&[]);
    assert_eq!(report.nodes("evaluated"), ["artifacts.rows.svg"]);
    project.edit("specs/spec.yaml", "cell_size: 8", "cell_size: 9");
    project.edit("specs/spec.yaml", "stroke: 0.5", "stroke: 0.4");
    let report = project.build(&[]);
    assert_eq!(
        report.nodes("evaluated"),
        [""; 0],
        "the old values are still known"
    );
    assert_eq!(report.artifacts("written").len(), 3);
    assert_eq!(project.files("out"), reference());
}

#[test]
fn a_value_that_comes_out_the_same_stops_the_rebuild_across_processes() {
    let project = Project::small();
    project.build(&[]);
    // The hole is another node, but the same circle.
    let same =
        "disc: { circle: { radius: 10, at: [30, 30] } }\n  plate: { difference: [page, disc] }";
    project.edit(
        "specs/spec.yaml",
        "plate: { difference: [page, hole] }",
        same,
    );
    let report = project.build(&[]);
    assert_eq!(report.nodes("evaluated"), ["regions.disc", "regions.plate"]);
    assert_eq!(report.artifacts("unchanged").len(), 5);
}

#[test]
fn only_the_bytes_of_a_drawing_count() {
    let project = Project::small();
    project.build(&[]);
    let path = project.path("specs/assets/zig.svg");
    fs::File::options()
        .append(true)
        .open(&path)
        .unwrap()
        .set_modified(SystemTime::UNIX_EPOCH)
        .unwrap();
    assert_eq!(project.build(&[]).nodes("evaluated"), [""; 0]);
    project.write("specs/assets/zig.svg", ZIG.replace("L3 0", "L3 1"));
    assert_eq!(
        project.build(&[]).nodes("evaluated"),
        ["exemplars.zig", "artifacts.zig.svg"]
    );
    project.write("specs/assets/zig.svg", ZIG);
    let report = project.build(&[]);
    assert_eq!(report.nodes("evaluated"), [""; 0]);
    assert_eq!(report.artifacts("written"), ["spec/zig.svg"]);
    // Another drawing of the same lines.
    project.write(
        "specs/assets/zig.svg",
        ZIG.replace("<path", "<!-- a zigzag --><path"),
    );
    let report = project.build(&[]);
    assert_eq!(report.nodes("evaluated"), ["exemplars.zig"]);
    assert_eq!(report.artifacts("unchanged").len(), 5);
}

#[test]
fn a_deleted_artifact_is_written_from_the_cache() {
    let project = Project::small();
    project.build(&[]);
    let before = project.files("out");
    fs::remove_file(project.path("out/spec/zig.svg")).unwrap();
    project.write("out/spec/plate.svg", "edited by hand");
    let report = project.build(&[]);
    assert_eq!(report.nodes("evaluated"), [""; 0]);
    assert_eq!(
        report.artifacts("written"),
        ["spec/plate.svg", "spec/zig.svg"]
    );
    assert_eq!(project.files("out"), before);
}

#[test]
fn parameters_that_a_node_does_not_use_do_not_touch_it() {
    let project = Project::small();
    project.build(&[]);
    let report = project.build(&["--set", "spacing=7"]);
    assert_eq!(
        report.nodes("evaluated"),
        ["partitions.rows", "artifacts.rows.svg"]
    );
    let report = project.build(&["--set", "spacing=7"]);
    assert_eq!(report.nodes("evaluated"), [""; 0]);
    let report = project.build(&["--set", "spacing=0.8cm"]);
    assert_eq!(report.nodes("evaluated"), [""; 0], "8 mm is the default");
    assert_eq!(project.files("out"), reference());
}

#[test]
fn artifacts_for_each_value_share_what_does_not_depend_on_it() {
    let project = Project::small();
    let each =
        "  \"rows-${spacing}.svg\": { from: rows, region: plate, each: { spacing: [5, 8] } }\n";
    project.write("specs/spec.yaml", format!("{SPEC}{each}"));
    let report = project.build(&[]);
    assert_eq!(report.artifacts("written").len(), 7);
    let files = project.files("out");
    assert_ne!(files["spec/rows-5.svg"], files["spec/rows-8.svg"]);
    project.write(
        "specs/spec.yaml",
        format!("{SPEC}{each}").replace("[5, 8]", "[5, 6, 8]"),
    );
    let report = project.build(&[]);
    assert_eq!(report.artifacts("written"), ["spec/rows-6.svg"]);
    assert_eq!(
        report.nodes("evaluated"),
        ["partitions.rows", "artifacts.rows-${spacing}.svg"]
    );
}

#[test]
fn the_seed_and_the_name_of_a_random_node_decide() {
    let project = Project::small();
    project.build(&[]);
    project.edit("specs/spec.yaml", "seed: 3", "seed: 4");
    let report = project.build(&[]);
    assert_eq!(
        report.artifacts("written"),
        ["spec/cells.dxf", "spec/cells.json"]
    );
    project.edit(
        "specs/spec.yaml",
        "cells: { uniform: { cell_size: 9 } }",
        "cells: { uniform: { cell_size: 9 }, seed: 11 }",
    );
    assert_eq!(
        project.build(&[]).artifacts("written"),
        ["spec/cells.dxf", "spec/cells.json"]
    );
}

#[test]
fn a_spec_named_through_another_folder_is_the_same_spec() {
    let project = Project::small();
    project.build(&[]);
    let mut command = project.command(&[
        "build",
        "../specs/../specs/spec.yaml",
        "--format",
        "json",
        "specs/assets/../spec.yaml",
    ]);
    command.current_dir(project.path("specs"));
    let run = super::project::finish(command);
    assert_eq!(run.code, Some(2), "the second is not there: {}", run.stderr);
    let report = project.build(&["specs/./assets/../spec.yaml", "specs/spec.yaml"]);
    assert_eq!(report.artifacts("unchanged").len(), 5);
    assert!(report.nodes("evaluated").is_empty());
}
