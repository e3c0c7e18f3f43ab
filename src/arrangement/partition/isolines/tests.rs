//! Isolines of cones, saddles and waves, across gaps, tiles and blocks.

use super::{blocks::SIDE, *};
use crate::limit::LIMIT;
use fretwork_geometry::planar_map::{PlanarMap, resolution};
use fretwork_geometry::{Affine, Lattice, Raster, Samples};
use std::f64::consts::PI;
use std::sync::Arc;

fn page(side: f64) -> Region {
    Region::rectangle(Point::ORIGIN, Point::new(side, side))
}

fn lines(field: &Field, every: f64, side: f64) -> Curves {
    isolines(field, every, &page(side), resolution(side)).unwrap()
}

#[test]
fn a_cone_has_circles_with_what_is_higher_on_their_left() {
    let middle = Point::new(50.0, 50.0);
    let curves = lines(
        &Field::new([1; 32], move |p| 33.0 - p.distance(middle)),
        10.0,
        100.0,
    );
    // Those of 30 to -10 are whole; -20 and -30 are four arcs each.
    let closed = curves
        .iter()
        .filter(|c| c.points.first() == c.points.last());
    for circle in closed.clone() {
        let value: f64 = circle.labels.edge.names()[0].parse().unwrap();
        let length: f64 = circle.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        assert!((length / (2.0 * PI * (33.0 - value)) - 1.0).abs() < 1e-2);
        assert!(fretwork_geometry::polygon::signed_area(circle.points) > 0.0);
    }
    assert_eq!((closed.count(), curves.len()), (5, 13));
}

#[test]
fn saddles_are_decided_by_the_surface_and_values_on_samples_join() {
    let raster = |values: [f64; 4]| {
        Field::raster(
            Arc::new(Raster {
                origin: Point::ORIGIN,
                step: Point::new(1.0, 1.0),
                width: 2,
                values: values.to_vec(),
            }),
            true,
        )
    };
    for (values, labels) in [
        ([3.0, 0.0, 0.0, 4.0], 2),
        ([1.2, 0.0, 0.0, 1.2], 2),
        ([1.0, 1.0, 1.0, 1.0], 0),
    ] {
        let field = raster(values);
        let curves = lines(&field, 1.0, 2.0);
        let map = PlanarMap::build(&curves, resolution(2.0)).unwrap();
        let at_one = curves
            .iter()
            .filter(|c| c.labels.edge.contains("1"))
            .count();
        assert!(at_one <= labels, "{values:?}");
        for curve in curves.iter() {
            let value: f64 = curve.labels.edge.names()[0].parse().unwrap();
            for w in curve.points.windows(2) {
                let left = w[0].lerp(w[1], 0.5) + (w[1] - w[0]).left() * 1e-3;
                let off = field.value(left) - value;
                // A chord of a hyperbola lies on one side of it.
                assert!(off > -0.15, "{values:?} {off}");
            }
        }
        assert_eq!(map.face_count(), 0);
    }
}

#[test]
fn labels_are_round_and_gaps_have_no_lines() {
    let field = Field::new([2; 32], |p| if p.x < 5.0 { p.x } else { f64::NAN });
    let curves = lines(&field, 0.1, 10.0);
    let labels: Vec<String> = curves
        .iter()
        .map(|c| c.labels.edge.names()[0].to_string())
        .collect();
    assert!(
        labels.contains(&"0.3".to_owned()) && labels.contains(&"4.9".to_owned()),
        "{labels:?}"
    );
    assert!(
        curves.bounds().max.x < 5.0
            && labels.len() == 49 + usize::from(labels.contains(&"0".to_owned()))
    );
    assert_eq!(
        (
            round_value(-3, 0.1),
            round_value(0, 20.0),
            round_value(7, 2.5e9)
        ),
        ("-0.3".into(), "0".into(), "17500000000".into())
    );
}

/// Samples of 4 × 4 pixels of the side 1 from the origin on.
struct Table([f64; 16]);

impl Samples for Table {
    fn size(&self) -> [usize; 2] {
        [4, 4]
    }

    fn sample(&self, column: usize, row: usize) -> f64 {
        self.0[4 * row + column]
    }
}

fn pixels(value: impl Fn(usize, usize) -> f64) -> Field {
    let values = std::array::from_fn(|i| value(i % 4, i / 4));
    let lattice = Lattice::new(Arc::new(Table(values)), Affine::IDENTITY, None);
    Field::lattice(Arc::new(lattice.unwrap()), [9; 32], true)
}

#[test]
fn lines_of_samples_go_on_to_the_edge_of_their_pixels() {
    let slope = pixels(|x, _| x as f64);
    let curves = lines(&slope, 1.0, 4.0);
    for curve in curves.iter().filter(|c| !c.labels.edge.contains("0")) {
        let value: f64 = curve.labels.edge.names()[0].parse().unwrap();
        let mut heights = [curve.points[0].y, curve.points[curve.points.len() - 1].y];
        heights.sort_by(f64::total_cmp);
        assert_eq!(heights, [0.0, 4.0]);
        assert!(
            curve
                .points
                .iter()
                .all(|p| (p.x - value - 0.5).abs() < 1e-9)
        );
    }
    assert!(curves.iter().any(|c| c.labels.edge.contains("2")));
}

#[test]
fn lines_of_samples_end_at_the_edge_of_a_gap() {
    let gap = pixels(|x, y| {
        if (x, y) == (1, 2) {
            f64::NAN
        } else {
            y as f64 + 0.5 * x as f64
        }
    });
    let curves = lines(&gap, 0.4, 4.0);
    let inside = |p: &Point| p.x > 1.0 && p.x < 2.0 && p.y > 2.0 && p.y < 3.0;
    assert!(!curves.points().iter().any(inside));
    for curve in curves.iter() {
        let value: f64 = curve.labels.edge.names()[0].parse().unwrap();
        for &p in [curve.points.first(), curve.points.last()]
            .into_iter()
            .flatten()
        {
            let on_hole = (1.0..=2.0).contains(&p.x) && (2.0..=3.0).contains(&p.y);
            let on_border = [p.x, p.y]
                .iter()
                .any(|v| v.abs() < 1e-9 || (v - 4.0).abs() < 1e-9);
            assert!(on_hole || on_border, "{value} ends at {p:?}");
        }
    }
    let ends_at_gap = |c: &fretwork_geometry::Curve<'_>| {
        c.points
            .iter()
            .any(|p| (1.0..=2.0).contains(&p.x) && (2.0..=3.0).contains(&p.y))
    };
    assert!(curves.iter().filter(ends_at_gap).count() > 1);
}

#[test]
fn lines_continue_across_the_sides_of_a_tile() {
    let mut tile = Region::rectangle(Point::new(3.0, 1.0), Point::new(33.0, 21.0));
    tile.period = Some(Point::new(30.0, 20.0));
    let wave = |p: Point| libm::sin(2.0 * PI * p.x / 30.0) + libm::cos(2.0 * PI * p.y / 20.0 + 1.0);
    let curves = isolines(&Field::new([4; 32], wave), 0.3, &tile, resolution(30.0)).unwrap();
    let ends: Vec<Point> = curves
        .iter()
        .flat_map(|c| [c.points[0], c.points[c.points.len() - 1]])
        .collect();
    for at in ends.iter().filter(|p| (p.x - 3.0).abs() < 1e-6) {
        assert!(
            ends.iter()
                .any(|q| q.distance(*at + Point::new(30.0, 0.0)) < 1e-6),
            "{at:?}"
        );
    }
    assert!(
        ends.iter().any(|p| (p.x - 3.0).abs() < 1e-6)
            && ends.iter().any(|p| (p.y - 1.0).abs() < 1e-6)
    );
    let slope = isolines(&Field::new([5; 32], |p| p.x), 1.0, &tile, resolution(30.0));
    assert!(matches!(slope, Err(ArrangementError::FieldPeriod { .. })));
}

#[test]
fn refusals() {
    let field = Field::new([3; 32], |p| 1e6 * p.x);
    for every in [0.0, -1.0, f64::NAN] {
        assert!(isolines(&field, every, &page(1.0), resolution(1.0)).is_err());
    }
    assert!(matches!(
        isolines(&field, 1e-6, &page(1.0), resolution(1.0)),
        Err(ArrangementError::TooMany { .. })
    ));
    assert!(isolines(&field, 1e-300, &page(1.0), resolution(1.0)).is_err());
    let told = isolines(&field, 1e-6, &page(1.0), resolution(1.0)).unwrap_err();
    assert!(
        matches!(told, ArrangementError::TooMany { count, .. } if count > LIMIT as f64),
        "{told}"
    );
    assert!(
        isolines(&Field::constant(5.0), 5.0, &page(1.0), resolution(1.0))
            .unwrap()
            .is_empty()
    );
}

#[test]
fn lines_are_the_same_in_blocks_and_block_by_block() {
    let middle = Point::new(37.0, 41.0);
    let raster = Field::raster(
        Arc::new(Raster {
            origin: Point::new(-20.0, -20.0),
            step: Point::new(1.0, 1.0),
            width: 140,
            values: (0..140 * 140)
                .map(|i| {
                    let p = Point::new(f64::from(i % 140) - 20.0, f64::from(i / 140) - 20.0);
                    let hollow = libm::sin(p.x / 5.0) + libm::cos(p.y / 7.0);
                    40.0 - p.distance(middle) + 3.0 * hollow
                })
                .collect(),
        }),
        true,
    );
    let region = page(100.0);
    let on = (&region, resolution(100.0));
    let of = |side| Isolines::new(&raster, 4.0, on, side).unwrap().unwrap();
    let length = |curves: &Curves| -> f64 {
        let of_curve = |c: fretwork_geometry::Curve<'_>| -> f64 {
            c.points.windows(2).map(|w| w[0].distance(w[1])).sum()
        };
        curves.iter().map(of_curve).sum()
    };
    let (whole, divided) = (of(SIDE).drawn(None).unwrap(), of(16).drawn(None).unwrap());
    assert!(divided.len() > whole.len());
    assert!((length(&divided) / length(&whole) - 1.0).abs() < 1e-12);
    // Divided lines are the whole ones; what the border cuts is rounded to its grid.
    let places = |curves: &Curves| {
        let rounded = |v: f64| (v * 1e6).round() as i64;
        let of_point = |p: &Point| (rounded(p.x), rounded(p.y));
        let all = curves.points().iter().map(of_point);
        all.collect::<std::collections::BTreeSet<_>>()
    };
    assert!(places(&whole) == places(&divided));
    let room = Bounds {
        min: Point::new(21.0, 30.0),
        max: Point::new(44.5, 52.0),
    };
    let near = of(16).near(&room).unwrap().unwrap();
    assert!(near.len() < divided.len() / 2);
    let shown = |curves: &Curves| {
        let meets = |c: &fretwork_geometry::Curve<'_>| {
            Bounds::of(c.points.iter().copied()).intersects(&room)
        };
        let all = curves.iter().filter(meets);
        all.map(|c| (c.points.to_vec(), c.labels))
            .collect::<Vec<_>>()
    };
    assert!(shown(&near) == shown(&divided));
    assert!(of(SIDE).near(&room).unwrap().is_none());
}
