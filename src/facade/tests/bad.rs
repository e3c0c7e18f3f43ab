//! Bad input: an error that says what is wrong and where, in a bounded number of steps.

use std::collections::BTreeMap;

use super::{Sketch, pattern};
use crate::layout::{check, lay_out};
use crate::problem::{Part, PatternPart};

fn wall(width: f64) -> Sketch {
    Sketch::new(width).symbols(&["A 1 opaque", "B 2 opaque", "C 1"])
}

#[test]
fn patterns() {
    let message = wall(6.0).layer("wall", "A(B").complain();
    assert!(
        message.contains("bytes: 1..2") && message.contains("unbalanced group"),
        "{message}"
    );
    let message = wall(6.0).layer("wall", "AXB").complain();
    assert!(
        message.contains("bytes: 1..") && message.contains("unknown symbol `X`"),
        "{message}"
    );
    let message = wall(6.0).symbol("e").layer("wall", "AeB").complain();
    assert!(message.contains("symbol `e` has no size"), "{message}");
    let message = wall(6.0)
        .layer("wall", "AB")
        .layer("top", "e; c = C")
        .complain();
    assert!(
        message.contains("content for `c`, which its control pattern lacks"),
        "{message}"
    );
    let message = wall(6.0)
        .layer(
            "wall",
            &format!("{}A{}", "(".repeat(10_000), ")".repeat(10_000)),
        )
        .complain();
    assert!(message.contains("nested deeper than 200"), "{message}");
    let message = wall(6.0).layer("wall", "A^99999999999").complain();
    assert!(message.contains("exponent is above"), "{message}");
    let message = wall(6.0)
        .layer("wall", "A(B")
        .layer("top", "A||C")
        .complain();
    assert_eq!(message.lines().count(), 2, "{message}");
}

#[test]
fn each_pattern_is_reported_once() {
    let message = wall(6.0)
        .layer("wall", "A(B")
        .layer("more", "A(B")
        .complain();
    assert_eq!(message.lines().count(), 1, "{message}");
}

#[test]
fn values() {
    let message = wall(-1.0).layer("wall", "A").complain();
    assert!(message.contains("Canvas(\"width\")"), "{message}");
    assert!(
        wall(f64::NAN)
            .layer("wall", "A")
            .complain()
            .contains("Canvas")
    );
    assert!(
        wall(6.0)
            .symbol("A 0 opaque")
            .layer("wall", "A")
            .complain()
            .contains("Symbol('A', Some(\"size\"))")
    );
    assert!(
        wall(6.0)
            .symbol("A -2 opaque")
            .layer("wall", "A")
            .complain()
            .contains("must be above 0")
    );
    assert!(
        wall(6.0)
            .counter('k', 3, 1)
            .layer("wall", "A^k")
            .complain()
            .contains("range of counter `k` is empty")
    );
    assert!(wall(6.0).complain().contains("no layers"));
    assert!(
        wall(6.0)
            .layer("wall", "C^k")
            .complain()
            .contains("is opaque")
    );
    assert!(
        wall(6.0)
            .symbol("A 1 fixed 0.5")
            .layer("wall", "A")
            .complain()
            .contains("contradicts itself")
    );
    let mut wild = wall(6.0);
    wild.0.symbols.entry('e').or_default().opaque = true;
    assert!(
        wild.layer("wall", "AB")
            .layer("top", "ec; c = C")
            .complain()
            .contains("`e` contradicts itself")
    );
}

#[test]
fn a_canvas_that_nothing_fits_names_the_layer_and_the_excess() {
    let message = wall(2.0)
        .layer("wall", "AB")
        .layer("top", "A B B")
        .complain();
    assert!(
        message.contains("layer `top`") && message.contains("5.0000 long, 3.0000 more"),
        "{message}"
    );
    assert!(!message.contains("layer `wall`"), "{message}");
    let message = wall(6.0).layer("wall", "A^0").complain();
    assert!(message.contains("no word that is not empty"), "{message}");
}

#[test]
fn words_that_are_far_too_long_are_told_by_their_length() {
    let message = wall(7.0).layer("wall", "A^100000").complain();
    assert!(
        message.contains("is 100000.0000 long, 99993.0000 more"),
        "{message}"
    );
    let message = wall(7.0)
        .counter('k', 1_000_000_000, i64::MAX)
        .layer("wall", "A(BA)^k")
        .complain();
    assert!(message.contains("is 3000000001.0000 long"), "{message}");
}

#[test]
fn qualifiers_that_leave_no_layout() {
    // C may not stand before A and nothing else is there.
    let sketch = Sketch::new(3.0)
        .symbols(&["A 1 opaque unoccludable", "C 1"])
        .layer("wall", "AAA")
        .layer("top", "CCC");
    assert!(sketch.complain().contains("cannot be aligned along x"));
    let fixed = Sketch::new(7.0)
        .symbols(&["A 2 opaque fixed"])
        .layer("wall", "A^k");
    assert!(fixed.complain().contains("cannot be aligned"));
}

#[test]
fn huge_counters_end() {
    for range in [
        (1, i64::MAX),
        (i64::MIN, i64::MAX),
        (-5, -1),
        (0, 0),
        (i64::MAX, i64::MAX),
    ] {
        let sketch = wall(12.0)
            .counter('k', range.0, range.1)
            .layer("wall", "A(BA)^k")
            .layer("top", "A^k");
        let _ = lay_out(&sketch.0);
    }
    let _ = lay_out(
        &wall(12.0)
            .counter('k', 1, i64::MAX)
            .layer("wall", "A(B^0)^k")
            .0,
    );
    let _ = lay_out(
        &wall(12.0)
            .counter('k', 1, i64::MAX)
            .layer("wall", "A((B|A)^0)^k")
            .0,
    );
}

#[test]
fn a_range_that_begins_far_below_what_fits_is_no_obstacle() {
    let sketch = wall(7.0)
        .counter('k', -1_000_000_000_000, 1_000_000_000_000)
        .layer("wall", "A(BA)^k");
    assert_eq!(sketch.solve().columns(), 5);
}

#[test]
fn a_free_search_ends_with_a_layout_and_a_warning() {
    let sketch = Sketch::new(40.0)
        .symbols(&["A 1 opaque", "B 1 opaque", "C 1.3", "D 0.7 opaque", "E 1.1"])
        .layer("wall", "(A|B)^k(B|A)^l(A|D)^m")
        .layer("middle", "e(c|d)^nfc^of; c = C; d = D|E")
        .layer("top", "g(c|d)^ph(d)^qg; c = C; d = E");
    let (layout, warnings) = lay_out(&sketch.0).expect("a layout");
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}")
    };
    assert!(warning.message.contains("cut short"), "{warning:?}");
    let help = warning.help.clone().unwrap_or_default();
    assert!(
        ["`k`", "`l`", "`m`", "`n`", "`o`", "`p`", "`q`"]
            .iter()
            .all(|c| help.contains(c)),
        "{help}"
    );
    assert!(layout.columns() > 1);
}

#[test]
fn more_shapes_than_can_be_held_are_refused() {
    let mut sketch = Sketch::new(5000.0)
        .symbols(&["A 1 opaque", "B 1 opaque"])
        .grid("wall", "A^k", "B^n");
    sketch.0.canvas[1] = 5000.0;
    assert!(sketch.complain().contains("shapes, more than 4000000"));
}

#[test]
fn counters_that_no_pattern_has_are_told() {
    let mut sketch = wall(2.0).layer("wall", "AB^k");
    let range = crate::Range {
        min: 3,
        max: Some(3),
    };
    sketch.0.counters = BTreeMap::from([('k', range), ('j', range)]);
    let problems = check(&sketch.0);
    assert_eq!(
        problems.iter().map(|p| p.part.clone()).collect::<Vec<_>>(),
        [Part::Counter('j')]
    );
    assert_eq!(problems[0].help.as_deref(), Some("the patterns have `k`"));
}

#[test]
fn checks_need_no_layout() {
    assert_eq!(check(&wall(2.0).layer("wall", "ABBBBBB").0), []);
    let problems = check(&wall(2.0).layer("wall", "AB)").0);
    let name = pattern("AB)").name;
    assert_eq!(
        problems[0].part,
        Part::Pattern {
            name,
            text: PatternPart::Whole,
            bytes: 2..3
        }
    );
}
