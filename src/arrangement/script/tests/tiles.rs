//! Seamless tiles: what a periodic region gives, laid side by side, has no cut and no doubled element.

use super::*;
use crate::border::Border;
use crate::random::cells::uniform;
use crate::random::properties::{Density, IrregularProperties};
use fretwork_geometry::Field;

const WIDTH: f64 = 100.0;
const HEIGHT: f64 = 60.0;

fn tile() -> Region {
    Region {
        period: Some(Point::new(WIDTH, HEIGHT)),
        ..Region::rectangle(Point::ORIGIN, Point::new(WIDTH, HEIGHT))
    }
}

/// Whether every element whose middle lies outside of the tile is there once more, inside of it.
#[track_caller]
fn assert_seamless(name: &str, curves: &Curves) {
    let outlines: Vec<(Point, Vec<Point>)> = curves
        .iter()
        .map(|c| {
            (
                c.points.iter().fold(Point::ORIGIN, |sum, p| sum + *p)
                    * (1.0 / c.points.len() as f64),
                c.points.to_vec(),
            )
        })
        .collect();
    let folded = |x: f64, period: f64| period * (x / period).floor();
    let mut outside = 0;
    for (middle, points) in &outlines {
        let shift = Point::new(folded(middle.x, WIDTH), folded(middle.y, HEIGHT));
        let is_copy = |other: &Vec<Point>| {
            other.len() == points.len()
                && other
                    .iter()
                    .zip(points)
                    .all(|(a, b)| a.distance(*b - shift) < 1e-3)
        };
        if shift != Point::ORIGIN {
            outside += 1;
            assert!(
                outlines.iter().any(|(_, other)| is_copy(other)),
                "{name}: {points:?} has no copy"
            );
        }
    }
    assert!(outside > 2, "{name}: nothing is outside of the tile");
}

fn drawn(partition: &str, mapping: &str) -> Curves {
    let text = format!("def entry():\n  g = {partition}\n  return {mapping}\n");
    let script = Script::compile(&"tile.star".into(), &text, Arc::new(Memory::default())).unwrap();
    let arrangement = script.arrangement("entry", &[], Seed::root(5)).unwrap();
    (*arrangement.evaluate(&tile(), resolution(WIDTH)).unwrap()).clone()
}

#[test]
fn random_values_of_all_cells_agree_across_the_sides() {
    let partitions = [
        "grid_partition(stripes_properties(0, 10), stripes_properties(pi / 2, 12.5), KEEP_OUTSIDE)",
        "uniform_partition(irregular_properties(0.02), KEEP_OUTSIDE)",
        "random_partition(irregular_properties(0.02), KEEP_OUTSIDE)",
    ];
    let mappings = [
        "map_to_faces(lambda f: scale(rotate(contour(f), random(f, 0, pi)), 0.05), g)",
        "map_to_edges(lambda e: scale(rotate(to_curve(e), random(e, 0, pi)), 0.05), g)",
        "map_to_vertices(lambda v: match_point(rotate(scale(import_svg('square.svg'), 0.05), random(v, 0, pi)), point(5, 5), location(v)), g)",
    ];
    for partition in partitions {
        for mapping in mappings {
            assert_seamless(
                &format!("{mapping} of {partition}"),
                &drawn(partition, mapping),
            );
        }
    }
}

#[test]
fn partitions_inside_faces_agree_across_the_sides() {
    let cells =
        "grid_partition(stripes_properties(0, 20), stripes_properties(pi / 2, 25), KEEP_OUTSIDE)";
    for inner in [
        "uniform_partition(irregular_properties(0.1), CROP)",
        "random_partition(irregular_properties(0.1), KEEP_OUTSIDE)",
        "stripes_partition(stripes_properties(random(f, 0, pi), 3))",
    ] {
        let mapping = format!("map_to_faces(lambda f: {inner}(f), g)");
        assert_seamless(&mapping, &drawn(cells, &mapping));
    }
}

#[test]
fn fields_are_read_at_the_same_place_on_either_side() {
    // A density that is no function of the tile: it is folded into it.
    let mut face = Region::rectangle(Point::new(-8.0, 10.0), Point::new(12.0, 25.0));
    face.within = tile().tile();
    let density = Field::new([9; 32], |p| 0.05 + 0.002 * p.x.abs());
    let properties = IrregularProperties::new(Density::Field(density));
    let at = |region: &Region| {
        uniform(
            &properties,
            Border::KeepOutside,
            region,
            Seed::root(3),
            resolution(WIDTH),
        )
        .unwrap()
    };
    let mut copy = Region::rectangle(
        Point::new(WIDTH - 8.0, 10.0),
        Point::new(WIDTH + 12.0, 25.0),
    );
    copy.within = tile().tile();
    let (here, there) = (at(&face), at(&copy));
    assert!(here.len() > 20 && here.len() == there.len());
    for (a, b) in here.points().iter().zip(there.points()) {
        assert!(
            b.distance(*a + Point::new(WIDTH, 0.0)) < 1e-6,
            "{a:?} {b:?}"
        );
    }
}
