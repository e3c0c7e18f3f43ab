//! Files that are written and read again.

use std::sync::Arc;

use fretwork::fabricate::{self, Item, Layer, Role, Sheet, Style};
use fretwork::geometry::polygon::canonical;
use fretwork::geometry::{Drawing, Point, Polygon};
use fretwork::source::svg::{SvgOptions, read};
use proptest::prelude::*;

fn read_back(sheet: &Sheet) -> Drawing {
    let text = String::from_utf8(fabricate::format::svg::write(
        sheet,
        fabricate::format::FileUnit::Millimetre,
        None,
    ))
    .unwrap();
    let file: Arc<str> = "out.svg".into();
    let (drawing, warnings) = read(
        &text,
        &file,
        &SvgOptions {
            tolerance: 0.01,
            unit_mm: sheet.unit_mm,
        },
    )
    .unwrap();
    assert_eq!(warnings, []);
    drawing
}

fn layer(name: &str, style: Style, items: Vec<Item>) -> Layer {
    Layer {
        name: name.into(),
        role: Role::Cut,
        style,
        items,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn lines_read_back_as_they_were_written(
        lines in prop::collection::vec(prop::collection::vec((-500..500i32, -500..500i32), 2..8), 1..6),
        unit_mm in prop::sample::select(vec![1.0, 10.0, 25.4]),
        name: String,
    ) {
        let point = |&(x, y): &(i32, i32)| Point::new(f64::from(x) / 8.0, f64::from(y) / 8.0);
        let items: Vec<Item> = lines.iter().map(|l| Item::Line(l.iter().map(point).collect())).collect();
        let sheet = Sheet { page: None, unit_mm, layers: vec![layer(&name, Style::outline(0.2), items)] };
        let distinct = |line: &Vec<(i32, i32)>| {
            let mut points: Vec<Point> = line.iter().map(point).collect();
            points.dedup();
            points
        };
        let expected: Vec<_> = lines.iter().map(distinct).filter(|l| l.len() > 1).collect();
        prop_assume!(!expected.is_empty());
        let drawing = read_back(&sheet);
        prop_assert_eq!(drawing.shapes.len(), expected.len());
        for (shape, line) in drawing.shapes.iter().zip(&expected) {
            let path = &shape.paths[0];
            prop_assert_eq!(path.len(), line.len());
            for (p, original) in path.iter().zip(line) {
                prop_assert!(p.distance(*original) * unit_mm < 1e-4);
            }
        }
    }
}

#[test]
fn areas_read_back_with_their_holes() {
    let square = |a: f64, b: f64| [[a, a], [b, a], [b, b], [a, b]].map(Point::from).to_vec();
    let mut hole = square(1.0, 2.0);
    hole.reverse();
    let area = Polygon {
        outer: square(0.0, 4.0),
        holes: vec![hole],
    };
    let sheet = Sheet {
        page: None,
        unit_mm: 10.0,
        layers: vec![layer(
            "a",
            Style::filled("tan".parse().unwrap()),
            vec![Item::Area(area.clone())],
        )],
    };
    assert_eq!(
        read_back(&sheet).areas(0.01).unwrap(),
        canonical(vec![area])
    );
}

#[test]
fn the_colours_of_an_obj_reach_the_glb_of_a_facade() {
    let spec = "fretwork: 1
symbols: { A: { size: 1, opaque: true } }
patterns: { body: A }
layers: { wall: { x: body, y: body } }
facades:
  house:
    canvas: { width: 3, height: 3 }
    layers: [wall]
    shapes: { \"*\": { mesh: window.obj } }
artifacts:
  house.glb: { from: house }
";
    let project = super::project::Project::of(spec);
    let mut text = "mtllib window.mtl\n".to_owned();
    for i in 0..8 {
        text += &format!("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2);
    }
    text += "usemtl red\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nusemtl blue\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    project.write("specs/window.obj", text);
    project.write(
        "specs/window.mtl",
        "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n",
    );
    project.succeed(&["build", "--deny", "warnings"]);
    let bytes = project.files("out")["spec/house.glb"].clone();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    let colors: Vec<String> = json["materials"]
        .as_array()
        .unwrap()
        .iter()
        .map(|material| material["pbrMetallicRoughness"]["baseColorFactor"].to_string())
        .collect();
    for color in ["[1.0,0.0,0.0,1.0]", "[0.0,0.0,1.0,1.0]"] {
        assert!(colors.iter().any(|found| found == color), "{colors:?}");
    }
}
