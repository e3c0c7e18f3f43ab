//! The engines compared, cell for cell (rule E5), on random partitions, mappers, merges and regions; and mappers that must
//! not be taken for regular ones.

use std::collections::BTreeMap;
use std::sync::Arc;

mod merges;

use crate::cells::{Cell, location_at};
use crate::function::{Arrangement, Manner};
use crate::script::argument::Argument;
use crate::script::program::Script;
use crate::script::tests::{Memory, compile};
use crate::tiled::place::{AtPlace, Engine};
use fretwork_geometry::planar_map::{PlanarMap, resolution};
use fretwork_geometry::{Bounds, Curves, Field, Point, Polygon, Region, Seed};

/// The arrangement that `entry()` of a script gives.
fn arrangement(text: &str) -> Arrangement {
    with_arguments(text, &[])
}

fn with_arguments(text: &str, arguments: &[(Arc<str>, Argument)]) -> Arrangement {
    let script = Script::compile(&"test.star".into(), text, Arc::new(Memory::default()));
    let script = script.unwrap_or_else(|errors| panic!("{text}\n{errors:?}"));
    let made = script
        .arrangement("entry", arguments, Seed::root(3))
        .unwrap();
    made.into()
}

/// A cell: where it is, what is said of it, and numbers that are the same but for rounding.
type Told = (Point, String, Vec<f64>);

/// What is told of cells, by their kinds.
fn cells(curves: &Curves, region: &Region) -> BTreeMap<String, Vec<Told>> {
    let map = PlanarMap::build(curves, resolution(region.bounds().longer_side())).unwrap();
    let mut all: BTreeMap<String, Vec<Told>> = BTreeMap::new();
    let mut add = |kind: &str, at: Point, cell: Cell, (says, numbers): (String, Vec<f64>)| {
        let says = format!("{says} {}", cell.is_boundary(&map));
        let told = (at, says, numbers);
        all.entry(kind.to_owned()).or_default().push(told);
    };
    for v in map.vertices() {
        let says = format!("{:?} {}", map.vertex_labels(v), map.outgoing(v).count());
        add("vertex", map.location(v), Cell::Vertex(v), (says, vec![]));
    }
    for e in map.edges() {
        let labels = map.labels(e);
        let mut sides = [labels.left, labels.right].map(|l| format!("{l:?}"));
        sides.sort();
        let ends = Bounds::of([map.source(e), map.target(e)].map(|v| map.location(v)));
        let ends = vec![ends.min.x, ends.min.y, ends.max.x, ends.max.y];
        let says = format!("{:?} {sides:?}", labels.edge);
        add(
            "edge",
            location_at(&map, e, 0.5),
            Cell::Edge(e),
            (says, ends),
        );
    }
    for f in map.bounded_faces() {
        let around = map.outer_boundary(f).count();
        let says = format!("{:?} {around}", map.face_labels(f));
        let told = (says, vec![map.face_area(f)]);
        add("face", map.centroid(f), Cell::Face(f), told);
    }
    all
}

/// Fails unless both have the same cells.
#[track_caller]
fn assert_same(general: &Curves, tiled: &Curves, region: &Region, name: &str) {
    let tolerance = 200.0 * resolution(region.bounds().longer_side());
    let (a, b) = (cells(general, region), cells(tiled, region));
    let count = |all: &BTreeMap<String, Vec<_>>| -> Vec<(String, usize)> {
        all.iter().map(|(k, v)| (k.clone(), v.len())).collect()
    };
    assert_eq!(count(&a), count(&b), "{name}");
    for (kind, of_a) in &a {
        let mut of_b = b[kind].clone();
        of_b.sort_by(|x, y| x.0.x.total_cmp(&y.0.x));
        for (at, says, numbers) in of_a {
            let is_same = |other: &Told| {
                let mut pairs = numbers.iter().zip(&other.2);
                other.1 == *says && pairs.all(|(x, y)| (x - y).abs() < 50.0 * tolerance)
            };
            let from = of_b.partition_point(|x| x.0.x < at.x - tolerance);
            let found = of_b[from..]
                .iter()
                .take_while(|x| x.0.x <= at.x + tolerance)
                .any(|x| x.0.distance(*at) <= tolerance && is_same(x));
            assert!(found, "{name}: {kind} at {at:?}: {says} {numbers:?}");
        }
    }
}

/// A polygon of random corners around the middle of a square, or the square.
fn random_region(seed: Seed, side: f64) -> Region {
    if seed.unit(0) < 0.3 {
        return Region::rectangle(Point::new(-3.0, 7.0), Point::new(side, 0.7 * side));
    }
    let count = 3 + (seed.unit(1) * 9.0) as u64;
    let corner = |k: u64| {
        let angle = k as f64 / count as f64 * std::f64::consts::TAU;
        Point::new(500.0, -200.0) + Point::unit(angle) * seed.range(10 + k, 0.3 * side, 0.6 * side)
    };
    let mut area = Polygon {
        outer: (0..count).map(corner).collect(),
        holes: vec![],
    };
    if seed.unit(2) < 0.3 {
        let hole = (0..5u64).rev().map(|k| {
            let angle = k as f64 / 5.0 * std::f64::consts::TAU;
            Point::new(500.0, -200.0) + Point::unit(angle) * (0.1 * side)
        });
        area.holes.push(hole.collect());
    }
    Region::of_area(vec![area])
}

fn pick<'a>(seed: Seed, n: u64, of: &[&'a str]) -> &'a str {
    of[(seed.unit(n) * of.len() as f64) as usize]
}

/// A regular partition as a script writes it.
fn random_grid(seed: Seed) -> String {
    let angle = pick(seed, 0, &["0", "0", "0.3", "pi / 4", "1.2"]);
    let turn = pick(seed, 1, &["pi / 2", "pi / 2", "pi / 3", "2"]);
    let first = pick(seed, 2, &["9", "9, 6", "5, 7, 9"]);
    let second = pick(seed, 3, &["10", "8, 4", "12"]);
    let border = pick(
        seed,
        4,
        &["CROP", "CROP_ADD_BOUNDARY", "KEEP_INSIDE", "KEEP_OUTSIDE"],
    );
    let labels = pick(
        seed,
        5,
        &[
            "",
            "  set_face_labels(a, 'odd', 'even')\n",
            "  set_edge_labels(b, 'x', 'y')\n  set_face_labels(a, 'p', 'q', 'r')\n",
        ],
    );
    format!(
        "  a = stripes_properties({angle}, {first})\n  b = stripes_properties({angle} + {turn}, {second})\n{labels}  g = grid_partition(a, b, {border})\n"
    )
}

/// Mappers that commute with translations, by the cells that they are for.
const MAPPERS: [(&str, &str); 9] = [
    ("faces", "scale(contour(c), 0.8)"),
    ("faces", "rotate(scale(contour(c), 0.5), 0.4)"),
    ("faces", "nothing() if has_label(c, 'odd') else contour(c)"),
    (
        "edges",
        "nothing() if has_label(left_face(c), 'odd') and not is_boundary(c) else to_curve(c)",
    ),
    ("edges", "scale(to_curve(c), 0.7)"),
    (
        "edges",
        "match_points(import_svg('segment.svg'), point(0, 0), point(100, 0), location(source_vertex(c)), location_at(c, 0.9))",
    ),
    (
        "vertices",
        "match_point(scale(import_svg('square.svg'), 0.2), point(5, 5), location(c))",
    ),
    (
        "vertices",
        "union_of([to_curve(e) for e in incident_edges(c)][:1])",
    ),
    (
        "faces",
        "translate(scale(contour(c), 0.6), (location(incident_vertices(c)[0]) - centroid(c)) * 0.3)",
    ),
];

fn random_script(seed: Seed) -> String {
    let mut text = String::from(
        "def union_of(all):\n  out = nothing()\n  for c in all:\n    out = append(out, c)\n  return out\n",
    );
    let (one, other) = (
        MAPPERS[(seed.unit(100) * 9.0) as usize],
        MAPPERS[(seed.unit(101) * 9.0) as usize],
    );
    let grid = random_grid(seed.name("grid"));
    text += &format!("def entry():\n{grid}");
    text += &format!("  m = map_to_{}(lambda c: {}, g)\n", one.0, one.1);
    text += match (seed.unit(102) * 4.0) as u32 {
        0 => "  return m\n",
        1 => "  return union(m, g)\n",
        2 => "  return outside(g, m, CROP)\n",
        _ => return text + &format!("  return map_to_{}(lambda c: {}, m)\n", other.0, other.1),
    };
    text
}

#[test]
fn tiled_and_general_results_are_equal_cell_for_cell() {
    let (mut tiled, mut copied) = (0, 0);
    for n in 0..24 {
        let seed = Seed::root(n).name("engines");
        let text = random_script(seed);
        let made = arrangement(&text);
        let region = random_region(seed.name("region"), 700.0);
        let resolution = resolution(region.bounds().longer_side());
        let is_tiled = matches!(
            made.engine(region.bounds(), resolution),
            Engine::Tiled { .. }
        );
        tiled += u32::from(is_tiled);
        let general = made.apply(&region, resolution);
        let drawn = made.draw_copying(&region, resolution, 0.0);
        let (Ok(general), Ok(drawn)) = (general, drawn) else {
            panic!("{text} fails");
        };
        copied += u32::from(*general != *drawn);
        assert_same(&general, &drawn, &region, &format!("{n}: {text}"));
    }
    assert!(
        tiled > 10 && copied > 5,
        "{tiled} are tiled, {copied} copied"
    );
}

#[test]
fn windows_of_tiled_results_are_parts_of_the_whole() {
    let mut checked = 0;
    for n in 0..8 {
        let seed = Seed::root(n).name("windows");
        let made = arrangement(&random_script(seed));
        let region = random_region(seed.name("region"), 700.0);
        let resolution = resolution(region.bounds().longer_side());
        let whole = made.draw_copying(&region, resolution, 0.0).unwrap();
        let bounds = region.bounds();
        for k in 0..2 {
            let at = bounds.min
                + Point::new(
                    seed.range(10 + k, 0.0, bounds.width()),
                    seed.range(20 + k, 0.0, bounds.height()),
                );
            let window = Bounds::of([at, at + Point::new(60.0, 40.0)]);
            let part = made
                .draw_in_copying(&region, resolution, &window, 0.0)
                .unwrap();
            let inside = |curves: &Curves| {
                let reaching = crate::near::locality::reaching(curves, &window);
                let mut all: Vec<String> = reaching
                    .iter()
                    .map(|c| format!("{:.4?} {:?}", c.points, c.labels))
                    .collect();
                all.sort();
                all
            };
            assert_eq!(inside(&whole), inside(&part), "{n} {window:?}");
            checked += inside(&part).len();
        }
    }
    assert!(checked > 100, "{checked}");
}

/// What is said of the engine for a mapper over a grid.
fn engine_of(mapper: &str) -> Engine {
    let text = format!(
        "def mapper(c):\n  {mapper}\ndef entry(f = None):\n  a = stripes_properties(0, 9)\n  b = stripes_properties(pi / 2, 9)\n  return map_to_faces(mapper, grid_partition(a, b, KEEP_INSIDE))\n"
    );
    let page = Bounds::of([Point::ORIGIN, Point::new(1000.0, 1000.0)]);
    arrangement(&text).engine(page, resolution(1000.0))
}

#[test]
fn a_mapper_that_looks_at_its_place_or_draws_at_random_is_never_tiled() {
    let asking = "it asks where a place lies";
    for (mapper, why) in [
        (
            "return scale(contour(c), random(c, 0.1, 1, 0))",
            "random value",
        ),
        ("return scale(contour(c), random(0.1, 1))", "random value"),
        (
            "return contour(c) if centroid(c).x > 100 else nothing()",
            asking,
        ),
        ("return scale(contour(c), centroid(c).y / 1000)", asking),
        (
            "return scale(contour(c), centroid(c).length() / 1000)",
            asking,
        ),
        (
            "return scale(contour(c), bbox_center(c).dot(point(1, 0)) / 1000)",
            asking,
        ),
        (
            "return contour(c) if centroid(c) == point(1, 1) else nothing()",
            asking,
        ),
        (
            "return contour(c) if {centroid(c): 1} else nothing()",
            asking,
        ),
        (
            "return contour(c) if len(str(centroid(c))) > 12 else nothing()",
            "as text",
        ),
        (
            "return contour(c) if '%s' % c == '<face 3>' else nothing()",
            "as text",
        ),
        ("return import_svg('square.svg')", "do not go with"),
        (
            "return translate(contour(c), centroid(c))",
            "do not go with",
        ),
        (
            "return translate(contour(c), centroid(c) * 0.5)",
            "do not go with",
        ),
        (
            "return append(contour(c), import_svg('square.svg'))",
            "beside",
        ),
        (
            "return uniform_partition(irregular_properties(0.1))(c)",
            "random",
        ),
    ] {
        match engine_of(mapper) {
            Engine::General(reason) => assert!(reason.text.contains(why), "{mapper}: {reason:?}"),
            engine => panic!("{mapper}: {engine:?}"),
        }
    }
    for mapper in [
        "return translate(contour(c), point(3, (centroid(c) - location(incident_vertices(c)[0])).x))",
        "return match_face(import_svg('square.svg'), c)",
        "m = (centroid(c) + bbox_center(c)) / 2\n  return match_point(import_svg('square.svg'), point(0, 0), m)",
        "return grid_partition(stripes_properties(0, 2), stripes_properties(1, 2))(c)",
        "return contour(c) if centroid(c) == bbox_center(c) else nothing()",
    ] {
        let engine = engine_of(mapper);
        assert!(
            matches!(engine, Engine::Tiled { .. }),
            "{mapper}: {engine:?}"
        );
    }
}

#[test]
fn a_mapper_that_asks_a_field_is_never_tiled() {
    let text = "def entry(f):\n  a = stripes_properties(0, 9)\n  b = stripes_properties(pi / 2, 9)\n  return map_to_faces(lambda c: scale(contour(c), f(c)), grid_partition(a, b, KEEP_INSIDE))\n";
    let made = with_arguments(text, &[("f".into(), Argument::Field(Field::constant(0.5)))]);
    let page = Bounds::of([Point::ORIGIN, Point::new(1000.0, 1000.0)]);
    match made.engine(page, resolution(1000.0)) {
        Engine::General(reason) => {
            assert!(reason.text.contains("value of a field"), "{reason:?}");
            assert!(reason.span.is_some());
        }
        engine => panic!("{engine:?}"),
    }
}

#[test]
fn what_depends_on_the_region_is_never_tiled() {
    let lines = "  a = stripes_properties(0, 9)\n  b = stripes_properties(pi / 2, 9)\n";
    for entry in [
        "return map_to_edges(lambda e: scale(to_curve(e), 0.1), stripes_partition(a))",
        "return map_to_edges(lambda e: match_point(import_svg('square.svg'), point(0, 0), location_at(e, 0.1)), stripes_partition(a))",
        "return map_to_edges(lambda e: nothing() if is_boundary(e) else to_curve(e), map_to_faces(lambda c: scale(contour(c), 0.8), grid_partition(a, b)))",
        "return map_to_faces(lambda c: translate(contour(c), point(5000, 0)), grid_partition(a, b, KEEP_INSIDE))",
        "return union(lambda r: contour(r), grid_partition(a, b))",
        "return map_to_faces(contour, union(grid_partition(a, b), grid_partition(stripes_properties(0.1, 9), b)))",
    ] {
        let made = arrangement(&format!("def entry():\n{lines}  {entry}\n"));
        let page = Bounds::of([Point::ORIGIN, Point::new(1000.0, 1000.0)]);
        let engine = made.engine(page, resolution(1000.0));
        assert!(matches!(engine, Engine::General(_)), "{entry}: {engine:?}");
        let region = Region::rectangle(Point::ORIGIN, Point::new(400.0, 300.0));
        let general = made.apply(&region, resolution(400.0)).unwrap();
        let drawn = made.draw_copying(&region, resolution(400.0), 0.0).unwrap();
        assert_eq!(*general, *drawn, "{entry}");
    }
}

#[test]
fn places_are_found_in_a_region_that_nobody_could_draw() {
    let text = "def entry():\n  a = stripes_properties(0, 5)\n  set_face_labels(a, 'odd', 'even')\n  b = stripes_properties(pi / 2, 10)\n  return map_to_faces(lambda c: scale(contour(c), 0.8), grid_partition(a, b, KEEP_INSIDE))\n";
    let made = arrangement(text);
    let region = Region::rectangle(Point::ORIGIN, Point::new(2e6, 2e6));
    let resolution = resolution(2e6);
    let found = made
        .at(&region, resolution, Point::new(1_000_000.0, 1_000_001.0))
        .unwrap();
    let (labels, area, centroid) = found.face.expect("a face");
    assert!(labels.contains("odd"), "{found:?}");
    assert!((area - 32.0).abs() < 1e-2 && centroid.distance(Point::new(1e6, 1e6)) < 1e-2);
    assert!((found.distance.unwrap() - 1.0).abs() < 1e-2);
    let between = made
        .at(&region, resolution, Point::new(1_000_005.0, 1_000_000.0))
        .unwrap();
    assert_eq!(between.face, None);
    assert!(
        (between.distance.unwrap() - 1.0).abs() < 1e-2,
        "{between:?}"
    );
    let window = Bounds::of([Point::new(1e6, 1e6), Point::new(1e6 + 100.0, 1e6 + 50.0)]);
    assert!(made.draw_in(&region, resolution, &window).unwrap().len() < 1000);
}

#[test]
fn places_are_those_of_the_whole() {
    for n in 0..5 {
        let seed = Seed::root(n).name("places");
        let made = arrangement(&random_script(seed));
        let region = random_region(seed.name("region"), 900.0);
        let resolution = resolution(region.bounds().longer_side());
        let curves = made.apply(&region, resolution).unwrap();
        for k in 0..15 {
            // The last ones also lie near the border and far outside.
            let bounds = region.bounds();
            let beyond = [0.0, 0.02, 3.0][k as usize / 5];
            let part = |n| seed.range(n, -beyond, 1.0 + beyond);
            let at = bounds.min
                + Point::new(
                    part(2 * k) * bounds.width(),
                    part(2 * k + 1) * bounds.height(),
                );
            let whole = AtPlace::of(&curves, resolution, at).unwrap();
            let here = made.at(&region, resolution, at).unwrap();
            let near = |a: Option<f64>, b: Option<f64>| match (a, b) {
                (Some(a), Some(b)) => (a - b).abs() < 1e-3,
                (a, b) => a == b,
            };
            assert!(
                near(whole.distance, here.distance),
                "{n} {at:?}: {whole:?} {here:?}"
            );
            let (a, b) = (whole.face, here.face);
            assert!(
                near(a.map(|f| f.1), b.map(|f| f.1)),
                "{n} {at:?}: {a:?} {b:?}"
            );
            assert_eq!(a.map(|f| f.0), b.map(|f| f.0));
        }
    }
}

#[test]
fn a_varied_arrangement_is_what_map_gives() {
    use crate::tiled::varied::Varied;
    use fretwork_script::CellKind;
    let grid = "def entry():\n  a = stripes_properties(0.2, 9, 6)\n  set_face_labels(a, 'odd', 'even')\n  b = stripes_properties(0.2 + pi / 2, 10)\n  return map_to_faces(lambda c: scale(contour(c), 0.8), grid_partition(a, b, CROP))\n";
    let input = arrangement(grid);
    let mapper = compile(
        "def mapper(c):\n  if random(c, 0, 1, 2) < 0.2:\n    return nothing()\n  return translate(scale(contour(c), random(c, 0.7, 0.8, 1)), point(random(-1, 1), random(c, -0.4, 0.4)))\n",
    );
    let mapper = mapper.unwrap().inline_mapper(Seed::root(4)).unwrap();
    let mut copied = 0;
    for n in 0..12 {
        let seed = Seed::root(n).name("varied");
        let region = random_region(seed, 900.0);
        let resolution = resolution(region.bounds().longer_side());
        for kind in [CellKind::Face] {
            let varied = Varied {
                kind,
                input: input.clone(),
                mapper: mapper.clone(),
                place: Arc::new(|diagnostics| diagnostics.to_vec()),
            };
            let Some(tiled) = varied.copied(&region, resolution, 0.0) else {
                continue;
            };
            copied += 1;
            let drawn = input.apply_as(&region, resolution, Manner::Free).unwrap();
            let task = crate::script::program::Task {
                kind,
                map: Arc::new(PlanarMap::build(&drawn, resolution).unwrap()),
                items: crate::script::mapping::Items::All,
                watch: None,
                known: None,
            };
            let general = mapper.map_cells(task, &region, resolution).unwrap();
            assert_same(&general, &tiled, &region, &format!("{n}"));
            let at = region.bounds().center() + Point::new(0.1, 0.2) * seed.range(7, 0.0, 700.0);
            let window = Bounds::of([at, at + Point::new(60.0, 40.0)]);
            let part = varied.copied_in(&region, resolution, &window, 0.0).unwrap();
            let whole = crate::near::locality::reaching(&tiled, &window);
            assert_eq!(part.len(), whole.len(), "{n}");
        }
    }
    assert!(copied > 5, "{copied}");
}
