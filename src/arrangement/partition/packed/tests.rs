//! What is packed is checked pair by pair.

use super::*;
use fretwork_geometry::CurveLabels;
use std::f64::consts::PI;

fn ring(n: u32, radius: f64) -> Curves {
    let mut curves = Curves::new();
    let corner = |i: u32| Point::unit(2.0 * PI * f64::from(i % n) / f64::from(n)) * radius;
    curves.push((0..=n).map(corner), CurveLabels::default());
    curves
}

fn open() -> Curves {
    let mut curves = Curves::new();
    curves.push(
        [[0.0, 0.0], [2.0, 0.5], [1.0, 2.0]].map(Point::from),
        CurveLabels::default(),
    );
    curves
}

fn properties(elements: Vec<Curves>, gap: f64) -> PackedProperties {
    PackedProperties {
        elements,
        rotate: [0.0, 2.0 * PI],
        scale: [0.5, 1.0],
        gap,
        anchor: None,
    }
}

fn page(side: f64) -> Region {
    Region::rectangle(Point::ORIGIN, Point::new(side, side))
}

/// The copies again, one `Curves` for each, when every element is one curve.
fn copies(curves: &Curves) -> Vec<Curves> {
    (0..curves.len())
        .map(|i| curves.filtered(|j, _| i == j))
        .collect()
}

fn least_distance(a: &Curves, b: &Curves) -> f64 {
    let pairs = segments(a).flat_map(|s| segments(b).map(move |t| nearest(s, t)));
    pairs
        .map(|[p, q]| p.distance(q))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn copies_keep_their_distance_and_stay_inside() {
    for (case, gap) in [(0, 0.0), (1, 0.3)] {
        let elements = vec![ring(5, 1.0), ring(3, 1.5), open()];
        let curves = packed(&properties(elements, gap), &page(20.0), Seed::root(case)).unwrap();
        let copies = copies(&curves);
        assert!(copies.len() > 50, "{}", copies.len());
        for (i, a) in copies.iter().enumerate() {
            assert!(a.points().iter().all(|p| page(20.0).bounds().contains(*p)));
            for b in &copies[..i] {
                assert!(least_distance(a, b) >= gap && least_distance(a, b) > 0.0);
                assert!(!holds(a, b) && !holds(b, a));
            }
        }
    }
}

#[test]
fn discs_are_packed_about_as_densely_as_at_random_possible() {
    let one_size = PackedProperties {
        scale: [1.0, 1.0],
        ..properties(vec![ring(24, 1.0)], 0.0)
    };
    let discs = packed(&one_size, &page(40.0), Seed::root(1)).unwrap().len();
    // Centres lie in a square of side 38; random sequential packing jams at 0.547 of the area.
    let covered = discs as f64 * PI / (38.0 * 38.0);
    assert!((0.52..0.60).contains(&covered), "{covered}");
    let sizes = PackedProperties {
        scale: [0.2, 1.0],
        ..one_size
    };
    let area: f64 = packed(&sizes, &page(30.0), Seed::root(1))
        .unwrap()
        .iter()
        .map(|c| fretwork_geometry::polygon::signed_area(c.points))
        .sum();
    assert!(area > 0.65 * 900.0, "smaller discs fill the gaps: {area}");
}

#[test]
fn tiles_join() {
    let mut tile = page(12.0);
    tile.period = Some(Point::new(12.0, 12.0));
    let curves = packed(&properties(vec![ring(6, 1.2)], 0.1), &tile, Seed::root(3)).unwrap();
    let copies = copies(&curves);
    assert!(copies.iter().any(|c| c.bounds().min.x < 0.0));
    for copy in copies.iter().filter(|c| c.bounds().min.x < 0.0) {
        let beside = copy.transformed(&Affine::translation(Point::new(12.0, 0.0)));
        assert!(
            copies
                .iter()
                .any(|c| c.bounds().center().distance(beside.bounds().center()) < 1e-9)
        );
    }
    for (i, a) in copies.iter().enumerate() {
        assert!(copies[..i].iter().all(|b| least_distance(a, b) >= 0.1));
    }
}

#[test]
fn refusals() {
    let at = |p: PackedProperties| packed(&p, &page(10.0), Seed::root(1));
    let good = properties(vec![ring(5, 1.0)], 0.0);
    assert!(
        at(properties(vec![], 0.0)).is_err() && at(properties(vec![Curves::new()], 0.0)).is_err()
    );
    assert!(
        at(PackedProperties {
            scale: [0.0, 1.0],
            ..good.clone()
        })
        .is_err()
    );
    assert!(
        at(PackedProperties {
            scale: [f64::NAN, 1.0],
            ..good.clone()
        })
        .is_err()
    );
    assert!(
        at(PackedProperties {
            gap: -1.0,
            ..good.clone()
        })
        .is_err()
    );
    assert!(matches!(
        at(PackedProperties {
            scale: [1e-6, 1.0],
            ..good.clone()
        }),
        Err(ArrangementError::TooMany { .. })
    ));
    assert!(
        packed(&good, &Region::of_area(vec![]), Seed::root(1))
            .unwrap()
            .is_empty()
    );
    assert!(
        packed(
            &PackedProperties {
                scale: [100.0, 100.0],
                ..good
            },
            &page(10.0),
            Seed::root(1)
        )
        .unwrap()
        .is_empty()
    );
}

#[test]
fn anchored_copies_are_those_of_one_packing_of_the_plane() {
    let elements = vec![ring(5, 1.0), ring(3, 1.5), open()];
    let properties = PackedProperties {
        anchor: Some(Point::new(0.3, -7.0)),
        scale: [0.8, 1.0],
        ..properties(elements, 0.2)
    };
    let on = |min: [f64; 2], max: [f64; 2]| {
        let region = Region::rectangle(Point::from(min), Point::from(max));
        let curves = packed(&properties, &region, Seed::root(3)).unwrap();
        copies(&curves)
    };
    let whole = on([0.0, 0.0], [40.0, 12.0]);
    let (left, right) = (on([0.0, 0.0], [20.0, 12.0]), on([20.0, 0.0], [40.0, 12.0]));
    assert!(left.len() > 15 && right.len() > 15);
    // Every copy of the whole is one of a part, those on the common border of both.
    let across = |copy: &&Curves| {
        let bounds = copy.bounds();
        bounds.min.x < 20.0 && bounds.max.x > 20.0
    };
    assert!(whole.iter().filter(across).count() > 2);
    for copy in &whole {
        let parts = [left.contains(copy), right.contains(copy)];
        let wanted = [copy.bounds().min.x < 20.0, copy.bounds().max.x > 20.0];
        assert_eq!(parts, wanted);
    }
    let shared = left.iter().filter(|copy| right.contains(copy)).count();
    assert_eq!(left.len() + right.len() - shared, whole.len());
}
