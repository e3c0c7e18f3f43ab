//! Which facades run again after an edit of what they are made of.

use expect_test::expect;

use super::check_value_edit;

/// A facade with parts of every section that it reads.
const HOUSE: &str = r##"fretwork: 1
symbols: { A: { size: 1, opaque: true }, B: { size: 2, opaque: true }, C: { size: 1 }, P: { size: 3, opaque: true } }
patterns: { body: "A(BA)^k", floors: P, corners: { control: "cec", content: { c: C } } }
layers: { walls: { x: body, y: floors }, columns: { x: corners, y: floors } }
partitions: { rows: { stripes: { angle: 0, spacing: 0.5 } } }
facades:
  house:
    canvas: { width: 10, height: 3 }
    layers: [walls, columns]
    shapes: { "*": { box: { depth: 0.2 } }, B*: { box: { depth: 0.1 }, fill: rows } }
artifacts: { house.svg: { from: house }, house.json: { from: house } }
"##;

#[test]
fn an_edit_of_a_symbol_runs_the_facades() {
    check_value_edit(
        HOUSE,
        &HOUSE.replace("B: { size: 2,", "B: { size: 2.5,"),
        expect![[r#"
        entry 13
        read
        definition
        evaluated 4
        -> facades.house
        -> artifacts.house.json
        -> artifacts.house.svg"#]],
    );
}

#[test]
fn an_edit_of_a_pattern_runs_the_facades_that_use_it() {
    check_value_edit(
        HOUSE,
        &HOUSE.replace("A(BA)^k", "A(BBA)^k"),
        expect![[r#"
        entry 13
        read
        definition
        evaluated 5
        -> facades.house
        -> artifacts.house.json
        -> artifacts.house.svg"#]],
    );
}

#[test]
fn an_edit_of_a_layer_runs_its_facades() {
    check_value_edit(
        HOUSE,
        &HOUSE.replace(
            "columns: { x: corners, y: floors }",
            "columns: { x: corners, y: floors, visible: { x: [] } }",
        ),
        expect![[r#"
            entry 13
            read
            definition
            evaluated 4
            -> facades.house
            -> artifacts.house.json
            -> artifacts.house.svg"#]],
    );
}

#[test]
fn an_edit_of_a_fill_runs_the_facades_that_have_it() {
    check_value_edit(
        HOUSE,
        &HOUSE.replace("spacing: 0.5", "spacing: 0.25"),
        expect![[r#"
        entry 13
        read
        definition
        evaluated 4
        -> facades.house
        -> artifacts.house.json
        -> artifacts.house.svg"#]],
    );
}
