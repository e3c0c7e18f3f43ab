//! Edits of a small spec: its text, names and parameters, and what it includes.

use super::*;

const SMALL: &str = r#"fretwork: 1
params: { size: 40, gap: 5 }
regions:
  page: { rectangle: { width: "${size}", height: 40 } }
  hole: { circle: { radius: 8, at: [20, 20] } }
  plate: { difference: [page, hole] }
partitions:
  rows: { stripes: { spacing: "${gap}" } }
artifacts:
  plate.svg: { from: plate }
  rows.svg: { from: rows, region: page }
"#;

#[test]
fn a_comment_runs_the_parse_alone() {
    check_edit(
        SMALL,
        &SMALL.replace("regions:", "# A comment.\n\nregions:  # another"),
        expect!["parse"],
    );
}

#[test]
fn other_ways_to_write_the_same_run_no_stage() {
    check_value_edit(
        SMALL,
        &SMALL
            .replace("height: 40", "height: 40mm")
            .replace("[20, 20]", "[2e1, 20.0]"),
        expect![[r#"
            entry 6
            read 2"#]],
    );
}

#[test]
fn the_order_of_entries_means_nothing() {
    let after = SMALL.replace("  hole: { circle: { radius: 8, at: [20, 20] } }\n", "");
    let after = after.replace(
        "partitions:",
        "  hole: { circle: { radius: 8, at: [20, 20] } }\npartitions:",
    );
    check_edit(
        SMALL,
        &after,
        expect![[r#"
        parse
        program"#]],
    );
}

#[test]
fn an_edit_of_a_node_runs_it_and_what_depends_on_it() {
    check_value_edit(
        SMALL,
        &SMALL.replace("radius: 8", "radius: 9"),
        expect![[r#"
        entry 6
        read
        definition
        evaluated 3
        -> regions.hole
        -> regions.plate
        -> artifacts.plate.svg"#]],
    );
}

#[test]
fn an_edit_of_an_artifact_runs_it_alone() {
    check_value_edit(
        SMALL,
        &SMALL.replace("{ from: plate }", "{ from: plate, draw: filled }"),
        expect![[r#"
            entry 6
            read
            definition
            evaluated
            format
            name
            -> artifacts.plate.svg"#]],
    );
}

#[test]
fn an_edit_of_an_unused_parameter_runs_no_stage() {
    let before = SMALL.replace("gap: 5", "gap: 5, unused: 1");
    check_value_edit(
        &before,
        &before.replace("unused: 1", "unused: 2"),
        expect![[r#"
            entry 6
            read 6
            format 2
            name 2"#]],
    );
}

#[test]
fn a_value_that_comes_out_the_same_stops_the_rebuild() {
    // The hole reaches into the page no further than before.
    let before = SMALL.replace("at: [20, 20]", "at: [-20, 20]");
    check_value_edit(
        &before,
        &before.replace("radius: 8", "radius: 9"),
        expect![[r#"
        entry 6
        read
        definition
        evaluated 2
        -> regions.hole
        -> regions.plate"#]],
    );
}

#[test]
fn a_documented_parameter_is_the_same_parameter() {
    check_value_edit(
        SMALL,
        &SMALL.replace("gap: 5", "gap: { default: 5, doc: \"distance\" }"),
        expect![[r#"
        entry 6"#]],
    );
}

#[test]
fn a_new_node_that_nobody_uses_runs_no_stage() {
    check_value_edit(
        SMALL,
        &SMALL.replace(
            "partitions:",
            "  more: { circle: { radius: 3 } }\npartitions:",
        ),
        expect![[r#"
            entry 7
            read
            definition 6"#]],
    );
}

#[test]
fn the_seed_runs_random_nodes_again() {
    let before = SMALL.replace(
        "stripes: { spacing: \"${gap}\" }",
        "uniform: { cell_size: \"${gap}\" }",
    );
    check_value_edit(
        &before,
        &before.replace("params:", "seed: 5\nparams:"),
        expect![[r#"
            entry 6
            read 6
            definition 6
            is_tiled
            evaluated 2
            -> partitions.rows
            -> artifacts.rows.svg"#]],
    );
}

#[test]
fn equal_texts_start_no_revision() {
    let mut bench = Bench::new(SMALL);
    bench.build(&[]);
    bench.compiler.database.take_executed();
    bench.edit(SPEC, SMALL);
    bench.edit("specs/zig.svg", "nobody asks for it");
    assert_eq!(bench.compiler.refresh(), []);
    let report = bench.build(&[]);
    expect![""].assert_eq(&summary(&bench.compiler, &report));
}

#[test]
fn an_edit_of_an_included_file_parses_that_file_alone() {
    let mut bench = Bench::new(&SMALL.replace("params:", "include: [a.yaml, b.yaml]\nparams:"));
    bench.files.write(
        "specs/a.yaml",
        "fretwork: 1\nregions:\n  a: { circle: { radius: 1 } }\n",
    );
    bench.files.write(
        "specs/b.yaml",
        "fretwork: 1\nregions:\n  b: { circle: { radius: 1 } }\n",
    );
    bench.build(&[]);
    bench.compiler.database.take_executed();
    bench.edit(
        "specs/a.yaml",
        "# A comment.\nfretwork: 1\nregions:\n  a: { circle: { radius: 1 } }\n",
    );
    let report = bench.build(&[]);
    expect![[r#"
        program
        parse"#]]
    .assert_eq(&summary(&bench.compiler, &report));
    bench.edit(
        "specs/b.yaml",
        "fretwork: 1\nregions:\n  b: { circle: { radius: 2 } }\n",
    );
    let report = bench.build(&[]);
    expect![[r#"
        program
        parse
        check
        scope
        basis
        linked
        entry 8
        read"#]]
    .assert_eq(&summary(&bench.compiler, &report));
}

#[test]
fn set_parses_nothing() {
    let bench = Bench::new(SMALL);
    bench.build(&[]);
    bench.compiler.database.take_executed();
    let report = bench.build(&[("gap", "6")]);
    expect![[r#"
        check
        scope
        basis
        linked
        read 6
        definition 6
        is_tiled
        evaluated 7
        format 2
        name 2
        -> regions.hole
        -> regions.page
        -> regions.plate
        -> partitions.rows
        -> artifacts.plate.svg
        -> artifacts.rows.svg"#]]
    .assert_eq(&summary(&bench.compiler, &report));
    let report = bench.build(&[("gap", "6")]);
    expect![""].assert_eq(&summary(&bench.compiler, &report));
}

#[test]
fn an_error_that_is_mended_gives_the_old_values() {
    let mut bench = Bench::new(SMALL);
    let first = digests(&bench.build(&[]));
    bench.edit(SPEC, &SMALL.replace("radius: 8", "radius: -8"));
    assert_eq!(bench.report(&[]).diagnostics.len(), 1);
    bench.edit(SPEC, SMALL);
    assert_eq!(digests(&bench.build(&[])), first);
}
