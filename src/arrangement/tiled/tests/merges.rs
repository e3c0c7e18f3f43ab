//! The engines compared on what is made of two regular partitions whose periods differ: of unions, of one inside or outside of
//! the other, and of variations of them.

use std::sync::Arc;

use super::{Engine, arrangement, assert_same, pick, random_region};
use crate::function::Manner;
use crate::script::mapping::Items;
use crate::script::program::{Mapper, Task};
use crate::script::tests::compile;
use crate::tiled::varied::Varied;
use fretwork_geometry::planar_map::{PlanarMap, resolution};
use fretwork_geometry::{Region, Seed};
use fretwork_script::CellKind;

/// Two grids `g` and `h` as a script writes them: with other spacings along the same directions, turned by an eighth, or of
/// triangles' directions, always with a common period.
fn random_pair(seed: Seed) -> String {
    let angle = pick(seed, 0, &["0", "0.3", "1.2"]);
    let borders = ["CROP", "CROP_ADD_BOUNDARY", "KEEP_INSIDE", "KEEP_OUTSIDE"];
    let border = |n: u64| pick(seed, n, &borders);
    let pairs = [
        // The turns from the first family to the second, how far the second grid is turned, and the spacings.
        ("pi / 2", "0", ["9, 6", "10", "5", "4"]),
        ("pi / 2", "0", ["9", "10", "7.5, 6", "15"]),
        ("pi / 2", "0", ["8", "12", "12", "8"]),
        ("pi / 2", "pi / 4", ["9", "9", "9 * sqrt(2)", "9 * sqrt(2)"]),
        (
            "pi / 2",
            "pi / 4",
            ["12", "12", "6 / sqrt(2)", "12 / sqrt(2)"],
        ),
        ("pi / 3", "pi / 3", ["9", "9", "9", "9"]),
        ("pi / 3", "0", ["9", "12", "6", "18"]),
    ];
    let (turn, second, [a, b, c, d]) = pairs[(seed.unit(1) * pairs.len() as f64) as usize];
    let labels = pick(seed, 2, &["", "  set_face_labels(c, 'odd', 'even')\n"]);
    format!(
        "  a = stripes_properties({angle}, {a})\n  b = stripes_properties({angle} + {turn}, {b})\n  c = stripes_properties({angle} + {second}, {c})\n  d = stripes_properties({angle} + {second} + {turn}, {d})\n{labels}  g = grid_partition(a, b, {})\n  h = grid_partition(c, d, {})\n",
        border(3),
        border(4)
    )
}

/// What is made of two grids. No shape has sides along lines of the other grid: whether such sides are one is a matter of
/// rounding, of which each engine has its own.
const MERGES: [&str; 6] = [
    "union(map_to_faces(lambda c: scale(contour(c), 0.79), g), h)",
    "inside(h, map_to_faces(lambda c: scale(contour(c), 0.71), g), CROP)",
    "inside(map_to_faces(lambda c: rotate(scale(contour(c), 0.6), 0.4), h), g, CROP_ADD_BOUNDARY)",
    "outside(h, map_to_faces(lambda c: scale(contour(c), 0.71), g), CROP)",
    "map_to_faces(lambda c: scale(contour(c), 0.91), union(g, h))",
    "map_to_edges(lambda c: scale(to_curve(c), 0.7), union(h, map_to_faces(contour, g)))",
];

fn random_merge(seed: Seed) -> String {
    let pair = random_pair(seed.name("pair"));
    let merge = pick(seed, 5, &MERGES);
    format!("def entry():\n{pair}  return {merge}\n")
}

/// A random region that is no larger than general engines take in a moment.
fn region_of(seed: Seed) -> Region {
    random_region(seed.name("region"), 1200.0)
}

#[test]
fn merges_of_two_periods_are_equal_in_both_engines() {
    let (mut tiled, mut copied) = (0, 0);
    for n in 0..16 {
        let seed = Seed::root(n).name("merges");
        let text = random_merge(seed);
        let made = arrangement(&text);
        let region = region_of(seed);
        let resolution = resolution(region.bounds().longer_side());
        let engine = made.engine(region.bounds(), resolution);
        tiled += u32::from(matches!(engine, Engine::Tiled { .. }));
        let general = made.apply(&region, resolution).expect("it can be applied");
        let drawn = made.draw_copying(&region, resolution, 0.0);
        let drawn = drawn.expect("it can be drawn");
        copied += u32::from(*general != *drawn);
        assert_same(&general, &drawn, &region, &format!("{n}: {text}"));
    }
    assert!(
        tiled > 12 && copied > 6,
        "{tiled} are tiled, {copied} copied"
    );
}

/// What varies cells: random values of the cell, and of no cell.
const VARYING: &str = "def mapper(c):
  if random(c, 0, 1, 2) < 0.2:
    return nothing()
  drawn = CURVES
  return translate(scale(drawn, random(c, 0.7, 0.8, 1)), point(random(-1, 1), random(c, -0.4, 0.4)))
";

/// What `map` gives for the cells of an arrangement.
fn general(varied: &Varied, region: &Region, resolution: f64) -> fretwork_geometry::Curves {
    let drawn = varied.input.apply_as(region, resolution, Manner::Free);
    let map = PlanarMap::build(&drawn.expect("it can be applied"), resolution);
    let task = Task {
        kind: varied.kind,
        map: Arc::new(map.expect("it is a planar map")),
        items: Items::All,
        watch: None,
        known: None,
    };
    let mapped = varied.mapper.map_cells(task, region, resolution);
    mapped.expect("it can be mapped")
}

fn varying(kind: CellKind) -> Mapper {
    let curves = match kind {
        CellKind::Face => "contour(c)",
        CellKind::Edge => "to_curve(c)",
        CellKind::Vertex => "to_curve(incident_edges(c)[0])",
    };
    let script = compile(&VARYING.replace("CURVES", curves)).expect("it is a script");
    script.inline_mapper(Seed::root(4)).expect("it is a mapper")
}

#[test]
fn variations_of_any_cells_are_what_map_gives() {
    let mut copied = 0;
    for n in 0..12 {
        let seed = Seed::root(n).name("variations");
        let kinds = [CellKind::Face, CellKind::Edge];
        let kind = kinds[(n % 2) as usize];
        let varied = Varied {
            kind,
            input: arrangement(&random_merge(seed)),
            mapper: varying(kind),
            place: Arc::new(|diagnostics| diagnostics.to_vec()),
        };
        let region = region_of(seed);
        let resolution = resolution(region.bounds().longer_side());
        let Some(tiled) = varied.copied(&region, resolution, 0.0) else {
            continue;
        };
        copied += 1;
        let general = general(&varied, &region, resolution);
        assert_same(&general, &tiled, &region, &format!("{n}"));
    }
    assert!(copied > 4, "{copied}");
}

/// Bug: between triangles a period was turned to one side and back for ever, and a build of them never ended.
#[test]
fn lattices_of_triangles_are_reduced() {
    use crate::tiled::lattice::Lattice;
    use fretwork_geometry::Point;
    for n in 0..100 {
        let angle = f64::from(n) * 0.063;
        let of = |turn: f64| Point::unit(angle + turn) * 9.0;
        let third = std::f64::consts::FRAC_PI_3;
        for (v, w) in [
            (of(0.0), of(third)),
            (of(0.0), of(third) + of(0.0) * 7.0),
            (of(0.0) * 3.0 + of(third), of(0.0) * 2.0 + of(third)),
        ] {
            let lattice = Lattice::of([v, w]).expect("it has an area");
            let reduced = lattice.reduced();
            assert!((reduced.area() - lattice.area()).abs() < 1e-9 * lattice.area());
            let lengths = reduced.periods.map(|period| period.length());
            assert!(
                lengths.iter().all(|length| (length - 9.0).abs() < 1e-6),
                "{lengths:?}"
            );
        }
    }
}
