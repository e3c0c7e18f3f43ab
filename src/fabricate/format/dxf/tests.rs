//! DXF files: their entities, records and layers.

use std::collections::BTreeSet;

use super::layers::file_layers;
use super::write;
use crate::format::FileUnit;
use crate::{Item, Layer, Role, Sheet, Style};
use expect_test::expect;
use fretwork_geometry::{Point, Polygon};

fn sheet() -> Sheet {
    let square = |a: f64, b: f64| {
        vec![
            Point::new(a, a),
            Point::new(b, a),
            Point::new(b, b),
            Point::new(a, b),
        ]
    };
    let area = Item::Area(Polygon {
        outer: square(0.0, 4.0),
        holes: vec![square(1.0, 2.0)],
    });
    let open = Item::Line(vec![Point::new(0.0, 0.0), Point::new(1.0, -0.25)]);
    let layer = |name: &str, role, items| Layer {
        name: name.into(),
        role,
        style: Style::outline(0.1),
        items,
    };
    let layers = vec![
        layer("plate: höhe", Role::Cut, vec![area]),
        layer("Plate\u{4e00} höhe", Role::Engrave, vec![open]),
    ];
    Sheet {
        page: None,
        unit_mm: 10.0,
        layers,
    }
}

#[test]
fn polylines_have_these_bytes() {
    let text: String = write(&sheet(), FileUnit::Millimetre, None)
        .into_iter()
        .map(char::from)
        .collect();
    let entities = text
        .split("2\nENTITIES\n")
        .nth(1)
        .unwrap()
        .split("0\nENDSEC")
        .next()
        .unwrap();
    let brief: Vec<&str> = entities.lines().collect();
    let pairs: Vec<String> = brief
        .chunks(2)
        .map(|p| format!("{}={}", p[0], p[1]))
        .collect();
    expect![[r#"
        0=LWPOLYLINE 5=32 330=1F 100=AcDbEntity 8=plate_ höhe 100=AcDbPolyline 90=4 70=1 10=10 20=-10 10=20 20=-10 10=20 20=-20 10=10 20=-20
        0=LWPOLYLINE 5=33 330=1F 100=AcDbEntity 8=plate_ höhe 100=AcDbPolyline 90=4 70=1 10=0 20=0 10=40 20=0 10=40 20=-40 10=0 20=-40
        0=LWPOLYLINE 5=34 330=1F 100=AcDbEntity 8=Plate_ höhe engrave 100=AcDbPolyline 90=2 70=0 10=0 20=0 10=10 20=2.5
    "#]]
    .assert_eq(&(pairs.join(" ").replace(" 0=", "\n0=") + "\n"));
}

#[test]
fn records_are_pairs_and_handles_are_distinct() {
    let text: String = write(&sheet(), FileUnit::Millimetre, None)
        .into_iter()
        .map(char::from)
        .collect();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    let pairs: Vec<(u16, &str)> = lines
        .chunks(2)
        .map(|p| (p[0].parse().unwrap(), p[1]))
        .collect();
    assert_eq!(pairs.last(), Some(&(0, "EOF")));
    let header_end = pairs.iter().position(|p| *p == (0, "ENDSEC")).unwrap();
    let handles: Vec<&str> = pairs[header_end..]
        .iter()
        .filter(|p| p.0 == 5)
        .map(|p| p.1)
        .collect();
    assert_eq!(handles.iter().collect::<BTreeSet<_>>().len(), handles.len());
    let count = |pair| pairs.iter().filter(|p| **p == pair).count();
    assert_eq!(count((0, "SECTION")), count((0, "ENDSEC")));
    assert_eq!(count((0, "TABLE")), count((0, "ENDTAB")));
    assert!(text.contains("$INSUNITS\n70\n4\n"));
}

fn entities(sheet: &Sheet) -> String {
    let text: String = write(sheet, FileUnit::Millimetre, None)
        .into_iter()
        .map(char::from)
        .collect();
    let entities = text.split("2\nENTITIES\n").nth(1).unwrap();
    entities
        .split("0\nENDSEC")
        .next()
        .unwrap()
        .replace('\n', " ")
}

fn one_line(line: Vec<Point>) -> Sheet {
    let mut sheet = sheet();
    sheet.unit_mm = 1.0;
    sheet.layers.truncate(1);
    sheet.layers[0].items = vec![Item::Line(line)];
    sheet
}

#[test]
fn a_hole_is_a_circle_and_a_slot_has_arcs() {
    let step = std::f64::consts::TAU / 80.0;
    let at = |x: f64, i: usize| {
        let angle = i as f64 * step;
        Point::new(x + 1.6 * libm::cos(angle), 7.0 + 1.6 * libm::sin(angle))
    };
    let mut hole: Vec<Point> = (0..80).map(|i| at(7.0, i)).collect();
    hole.push(hole[0]);
    assert!(entities(&one_line(hole)).ends_with("AcDbCircle 10 7 20 -7 30 0 40 1.6 "));
    let mut slot: Vec<Point> = (0..=80)
        .map(|i| at(if i < 41 { 7.0 } else { 3.0 }, i))
        .collect();
    slot[80] = at(3.0, 80);
    slot.push(slot[0]);
    let text = entities(&one_line(slot));
    assert!(text.matches(" 42 ").count() <= 8, "{text}");
}

#[test]
fn layers_of_one_name_and_role_are_one() {
    let mut twice = sheet();
    twice.layers.push(twice.layers[0].clone());
    assert_eq!(file_layers(&twice).1, [0, 1, 0]);
}
