//! Differences against slow, obvious ones: areas and volumes by counting points, lines by walking along them.

use proptest::prelude::*;

use super::areas::compare_areas;
use super::lines::compare_lines;
use super::*;
use fretwork_fabricate::{Role, Style};
use fretwork_geometry::{Affine3, Point3, Region};
use fretwork_solid::cuboid;

fn rectangle([x, y, w, h]: [f64; 4]) -> Vec<Polygon> {
    Region::rectangle(Point::new(x, y), Point::new(x + w, y + h)).area
}

/// The area of the part of a square of side 20 for which `holds`, by points in the middle of cells.
fn counted(holds: impl Fn(Point) -> bool) -> f64 {
    let middles = (0..400u32).flat_map(|i| (0..400u32).map(move |j| (i, j)));
    let points =
        middles.map(|(i, j)| Point::new(f64::from(i) * 0.05 + 0.025, f64::from(j) * 0.05 + 0.025));
    points.filter(|p| holds(*p)).count() as f64 * 0.0025
}

fn rectangles() -> impl Strategy<Value = Vec<Polygon>> {
    // In steps of the cells that are counted, so that the oracle is exact.
    let step = |most: u32| (1..most).prop_map(|v| f64::from(v) * 0.5);
    let one =
        (step(20), step(20), step(18), step(18)).prop_map(|(x, y, w, h)| rectangle([x, y, w, h]));
    prop::collection::vec(one, 0..5).prop_map(|all| all.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn areas_are_those_that_counting_gives(
        before in rectangles(), after in rectangles(), same in rectangles(),
    ) {
        let (before, after) = ([before, same.clone()].concat(), [after, same].concat());
        let found = compare_areas(&before, &after).unwrap();
        let inside = |areas: &[Polygon], p| areas.iter().any(|area| area.contains(p));
        let amounts = found.amounts("mm");
        let expected = [
            counted(|p| inside(&after, p) && !inside(&before, p)),
            counted(|p| inside(&before, p) && !inside(&after, p)),
            counted(|p| inside(&before, p) && inside(&after, p)),
        ];
        for (is, wanted) in [amounts.added, amounts.removed, amounts.common].into_iter().zip(expected) {
            prop_assert!((is - wanted).abs() < 1e-6, "{is} {wanted}");
        }
    }

    #[test]
    fn lines_are_those_that_walking_gives(
        before in lines_of_a_lattice(), after in lines_of_a_lattice(),
    ) {
        let found = compare_lines(&before, &after).amounts("mm");
        let walked = |lines: &[Vec<Point>], other: &[Vec<Point>]| -> f64 {
            let segments = lines.iter().flat_map(|line| line.windows(2));
            segments.map(|ends| {
                let length = (ends[1] - ends[0]).length();
                let steps = (0..400).map(|i| ends[0] + (ends[1] - ends[0]) * ((f64::from(i) + 0.5) / 400.0));
                let off = steps.filter(|p| !runs(other, *p, ends[1] - ends[0])).count();
                length * off as f64 / 400.0
            }).sum()
        };
        let expected = [walked(&after, &before), walked(&before, &after)];
        for (is, wanted) in [found.added, found.removed].into_iter().zip(expected) {
            prop_assert!((is - wanted).abs() < 0.2, "{is} {wanted}");
        }
    }
}

/// Polylines whose corners are whole: many run along one another.
fn lines_of_a_lattice() -> impl Strategy<Value = Vec<Vec<Point>>> {
    let corner = (0..5u32, 0..5u32).prop_map(|(x, y)| Point::new(f64::from(x), f64::from(y)));
    prop::collection::vec(prop::collection::vec(corner, 2..4), 0..6)
}

/// Whether one of `lines` runs through `p` in this direction.
fn runs(lines: &[Vec<Point>], p: Point, direction: Point) -> bool {
    lines.iter().flat_map(|line| line.windows(2)).any(|ends| {
        let along = ends[1] - ends[0];
        let length = along.length();
        if length == 0.0 || along.cross(direction).abs() > 1e-9 {
            return false;
        }
        let at = (p - ends[0]).dot(along) / length;
        (p - ends[0]).cross(along).abs() / length < 1e-9 && (0.0..=length).contains(&at)
    })
}

fn drawing(layers: Vec<(&str, Role, Vec<Item>)>) -> Shape {
    let layer = |(name, role, items): (&str, Role, Vec<Item>)| Layer {
        name: name.into(),
        role,
        style: Style::outline(0.1),
        items,
    };
    Shape::Drawing(Drawing {
        page: Bounds {
            min: Point::ORIGIN,
            max: Point::new(20.0, 20.0),
        },
        layers: layers.into_iter().map(layer).collect(),
        unit: "mm",
    })
}

fn areas(all: [f64; 4]) -> Vec<Item> {
    rectangle(all).into_iter().map(Item::Area).collect()
}

fn line(points: &[[f64; 2]]) -> Vec<Item> {
    vec![Item::Line(points.iter().map(|p| Point::from(*p)).collect())]
}

#[test]
fn what_lies_on_something_else_is_seen_to_change() {
    let wall = || ("wall", Role::Draw, areas([0.0, 0.0, 20.0, 20.0]));
    let window = |x: f64| ("window", Role::Draw, areas([x, 2.0, 4.0, 4.0]));
    let (before, after) = (
        drawing(vec![wall(), window(2.0)]),
        drawing(vec![wall(), window(3.0)]),
    );
    let found = compare(Some(&before), Some(&after));
    let amounts = found.amounts.unwrap();
    assert_eq!(
        (amounts.added, amounts.removed, amounts.common),
        (4.0, 4.0, 412.0)
    );
    assert!(!found.is_same);
}

#[test]
fn where_areas_stay_lines_are_told() {
    let plate = || ("plate", Role::Cut, areas([0.0, 0.0, 20.0, 20.0]));
    let text = |y: f64| ("text", Role::Engrave, line(&[[2.0, y], [8.0, y]]));
    let [before, after] = [3.0, 4.0].map(|y| drawing(vec![plate(), text(y)]));
    let amounts = compare(Some(&before), Some(&after)).amounts.unwrap();
    assert_eq!(
        (amounts.added, amounts.removed, amounts.unit),
        (6.0, 6.0, "mm")
    );
    let same = compare(Some(&before), Some(&before));
    let amounts = same.amounts.unwrap();
    assert!(same.is_same && (amounts.common, amounts.unit) == (400.0, "mm2"));
    let alone = compare(None, Some(&before)).amounts.unwrap();
    assert_eq!(
        (alone.added, alone.removed, alone.common),
        (400.0, 0.0, 0.0)
    );
}

/// A line that is divided elsewhere, and rounded there, is the same line; one that was moved is not.
#[test]
fn lines_that_are_divided_elsewhere_are_the_same() {
    let before = line(&[[0.0, 0.0], [10.0, 3.3333]]);
    let after = line(&[[10.0, 3.3333], [6.0, 2.0], [3.0, 1.0], [0.0, 0.0]]);
    let of = |items: &Vec<Item>| drawing(vec![("a", Role::Draw, items.clone())]);
    assert!(compare(Some(&of(&before)), Some(&of(&after))).is_same);
    let moved = line(&[[0.0, 0.01], [10.0, 3.3433]]);
    assert!(!compare(Some(&of(&before)), Some(&of(&moved))).is_same);
    let crossing = line(&[[0.0, 3.3333], [10.0, 0.0]]);
    let amounts = compare(Some(&of(&before)), Some(&of(&crossing)))
        .amounts
        .unwrap();
    assert_eq!(amounts.common, 0.0);
}

fn body(size: f64, places: &[f64]) -> Shape {
    let cube = cuboid(Point3::new(size, 2.0, 2.0)).unwrap();
    let mut model = Model::of("a", cube);
    model.parts.clear();
    for x in places {
        model.place("a", 0, Affine3::translation(Point3::new(*x, 0.0, 0.0)));
    }
    Shape::Body(model)
}

#[test]
fn bodies_are_compared_by_their_volumes() {
    for (before, after, added, removed, common) in [
        (body(2.0, &[0.0]), body(2.0, &[0.5]), 2.0, 2.0, 6.0),
        (
            body(2.0, &[0.0, 9.0]),
            body(2.0, &[0.0, 9.5]),
            2.0,
            2.0,
            14.0,
        ),
        (body(2.0, &[0.0]), body(3.0, &[0.0]), 4.0, 0.0, 8.0),
        (body(2.0, &[0.0, 1.0]), body(2.0, &[0.0]), 0.0, 4.0, 8.0),
        (body(2.0, &[0.0]), body(2.0, &[5.0]), 8.0, 8.0, 0.0),
    ] {
        let found = compare(Some(&before), Some(&after));
        let amounts = found.amounts.unwrap();
        let is = [amounts.added, amounts.removed, amounts.common];
        for (is, wanted) in is.into_iter().zip([added, removed, common]) {
            assert!((is - wanted).abs() < 1e-6, "{is} {wanted}");
        }
        assert_eq!((amounts.unit, found.is_same), ("mm3", false));
        let Some(Overlay::Body(model)) = found.overlay else {
            panic!("bodies are shown as bodies");
        };
        let drawn: Vec<&str> = model.parts.iter().map(|part| &*part.name).collect();
        let named = [("common", common), ("removed", removed), ("added", added)];
        let expected = named.into_iter().filter(|(_, amount)| *amount > 0.0);
        assert_eq!(drawn, expected.map(|(name, _)| name).collect::<Vec<_>>());
    }
    let same = compare(Some(&body(2.0, &[0.0, 1.0])), Some(&body(2.0, &[1.0, 0.0])));
    assert!(same.is_same);
}

/// What another division of a round face leaves is counted, and hides nothing that is common.
#[test]
fn pieces_that_are_too_thin_to_be_made_are_not_shown() {
    let found = compare(Some(&body(2.0, &[0.0])), Some(&body(2.004, &[0.0])));
    let Some(Overlay::Body(model)) = found.overlay else {
        panic!("bodies are shown as bodies");
    };
    let drawn: Vec<&str> = model.parts.iter().map(|part| &*part.name).collect();
    assert_eq!(drawn, ["common"]);
    let added = found.amounts.unwrap().added;
    assert!((added - 0.016).abs() < 1e-6 && !found.is_same, "{added}");
}

#[test]
fn an_open_body_has_no_amounts() {
    let Shape::Body(mut model) = body(2.0, &[0.0]) else {
        unreachable!("it is a body")
    };
    let mut mesh = model.mesh(&model.parts[0]);
    mesh.triangles.pop();
    model = Model::of("a", mesh);
    let (open, closed) = (Shape::Body(model), body(2.0, &[0.0]));
    let found = compare(Some(&open), Some(&closed));
    assert!(found.amounts.is_none() && found.overlay.is_none() && !found.is_same);
    assert!(compare(Some(&open), Some(&open)).is_same);
}

#[test]
fn pictures_have_the_colours_of_their_legend() {
    let before = drawing(vec![("a", Role::Cut, areas([0.0, 0.0, 9.0, 9.0]))]);
    let after = drawing(vec![("a", Role::Cut, areas([2.0, 0.0, 9.0, 9.0]))]);
    let overlay = compare(Some(&before), Some(&after)).overlay.unwrap();
    let files = picture::files(&overlay).unwrap();
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert_eq!((files.len(), files[0].0), (1, "svg"));
    for said in [
        "#9a9a9a",
        "#c1121f",
        "#0a9396",
        "id=\"hatch\"",
        "id=\"removed\"",
        "id=\"added\"",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    let overlay = compare(Some(&body(2.0, &[0.0])), Some(&body(2.0, &[1.0])))
        .overlay
        .unwrap();
    let files = picture::files(&overlay).unwrap();
    assert_eq!(
        files.iter().map(|file| file.0).collect::<Vec<_>>(),
        ["glb", "png"]
    );
}
