//! Laws and cases of the planar map.

mod laws;
mod oracle;

use super::*;
use crate::{CurveLabels, Curves, LabelSet, Point};

fn polylines(lines: &[&[(f64, f64)]]) -> Curves {
    let mut curves = Curves::new();
    for line in lines {
        curves.push(
            line.iter().map(|p| Point::new(p.0, p.1)),
            CurveLabels::default(),
        );
    }
    curves
}

fn built(curves: &Curves) -> PlanarMap {
    let map = PlanarMap::build(curves, resolution(1.0)).unwrap();
    map.check().unwrap();
    map
}

/// V, E, F, C.
fn counts(map: &PlanarMap) -> [usize; 4] {
    [
        map.vertex_count(),
        map.edge_count(),
        map.face_count(),
        map.component_count(),
    ]
}

#[test]
fn resolutions_are_powers_of_two_below_the_tolerance() {
    assert_eq!(resolution(2000.0), 2f64.powi(-20));
    assert_eq!(resolution(1.0), 2f64.powi(-31));
    assert_eq!(resolution(f64::NAN), resolution(1.0));
    assert_eq!(resolution(0.0), resolution(1.0));
}

#[test]
fn nothing_gives_a_map_without_cells() {
    assert_eq!(counts(&built(&Curves::new())), [0, 0, 0, 0]);
    let points = polylines(&[
        &[(0.5, 0.5), (0.5, 0.5)],
        &[(0.1, 0.1), (0.1, 0.1 + 1e-14), (0.1, 0.1)],
    ]);
    assert_eq!(counts(&built(&points)), [0, 0, 0, 0]);
}

#[test]
fn a_cross_a_t_and_a_closed_curve() {
    assert_eq!(
        counts(&built(&polylines(&[
            &[(0.0, 0.5), (1.0, 0.5)],
            &[(0.5, 0.0), (0.5, 1.0)]
        ]))),
        [5, 4, 0, 1]
    );
    assert_eq!(
        counts(&built(&polylines(&[
            &[(0.0, 0.5), (1.0, 0.5)],
            &[(0.5, 0.5), (0.5, 1.0)]
        ]))),
        [4, 3, 0, 1]
    );
    let square = built(&polylines(&[&[
        (0.0, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 1.0),
        (0.0, 0.0),
    ]]));
    assert_eq!(counts(&square), [1, 1, 1, 1]);
    assert_eq!((square.area(), square.length()), (1.0, 4.0));
    let v = square.vertices().next().unwrap();
    assert_eq!(
        square.outgoing(v).count(),
        2,
        "a loop leaves its vertex twice"
    );
}

#[test]
fn labels_of_coincident_pieces_are_united_under_the_first_orientation() {
    let set = LabelSet::one;
    let labels = |e, l, r| CurveLabels {
        edge: set(e),
        left: set(l),
        right: set(r),
        start: set("s"),
        end: set("t"),
    };
    let mut curves = Curves::new();
    curves.push(
        [Point::new(0.0, 0.0), Point::new(2.0, 0.0)],
        labels("a", "la", "ra"),
    );
    curves.push(
        [Point::new(3.0, 0.0), Point::new(1.0, 0.0)],
        labels("b", "lb", "rb"),
    );
    let map = built(&curves);
    assert_eq!(counts(&map), [4, 3, 0, 1]);
    let both = map.edges().find(|e| map.sources(*e).count() == 2).unwrap();
    let got = map.labels(both);
    assert_eq!(
        (got.edge, got.left, got.right),
        (
            LabelSet::of(["a", "b"]),
            LabelSet::of(["la", "rb"]),
            LabelSet::of(["ra", "lb"])
        )
    );
    assert_eq!(
        (got.start, got.end),
        (set("t"), set("t")),
        "the second ends where the edge begins, the first where it ends"
    );
    assert_eq!(map.location(map.source(both)), Point::new(1.0, 0.0));
    assert!(map.sources(both).eq([
        Source {
            curve: 0,
            reversed: false
        },
        Source {
            curve: 1,
            reversed: true
        }
    ]));
}

#[test]
fn faces_gather_labels_from_holes_and_dangling_edges() {
    let mut curves = Curves::new();
    let ring = |curves: &mut Curves, a: f64, b: f64, left: &str, right: &str| {
        let labels = CurveLabels {
            left: LabelSet::one(left),
            right: LabelSet::one(right),
            ..CurveLabels::default()
        };
        curves.push(
            [(a, a), (b, a), (b, b), (a, b), (a, a)].map(|p| Point::new(p.0, p.1)),
            labels,
        );
    };
    ring(&mut curves, 0.0, 1.0, "in", "out");
    ring(&mut curves, 0.4, 0.6, "core", "around");
    let dangling = CurveLabels {
        left: LabelSet::one("d"),
        ..CurveLabels::default()
    };
    curves.push([Point::new(0.1, 0.1), Point::new(0.2, 0.15)], dangling);
    let map = built(&curves);
    assert_eq!(counts(&map), [4, 3, 2, 3]);
    let around = map.face_at(Point::new(0.3, 0.5));
    assert_eq!(map.face_labels(around), LabelSet::of(["in", "around", "d"]));
    assert_eq!(map.inner_boundaries(around).count(), 2);
    assert!((map.face_area(around) - 0.96).abs() < 1e-12);
    assert_eq!(
        map.face_labels(map.face_at(Point::new(0.5, 0.5))),
        LabelSet::one("core")
    );
    assert_eq!(map.face_at(Point::new(1.5, 0.5)), FaceId::UNBOUNDED);
    assert!(map.centroid(around).distance(Point::new(0.5, 0.5)) < 1e-9);
}

/// `count` segments through a point, all of one length.
fn star(count: usize, center: Point) -> Curves {
    let mut curves = Curves::new();
    for k in 0..count {
        let arm = Point::unit(k as f64 * std::f64::consts::PI / count as f64) * 0.5;
        curves.push([center - arm, center + arm], CurveLabels::default());
    }
    curves
}

#[test]
fn a_thousand_lines_through_a_point_make_one_vertex() {
    let map = built(&star(1000, Point::new(0.37, 0.61)));
    assert_eq!(counts(&map), [2001, 2000, 0, 1]);
}

#[test]
fn a_thousand_spokes_of_a_wheel_share_its_hub() {
    let mut curves = Curves::new();
    let rim = |k: usize| Point::unit(k as f64 * std::f64::consts::TAU / 1000.0);
    for k in 0..1000 {
        curves.push([Point::ORIGIN, rim(k)], CurveLabels::default());
        curves.push([rim(k), rim((k + 1) % 1000)], CurveLabels::default());
    }
    let map = built(&curves);
    assert_eq!(counts(&map), [1001, 2000, 1000, 1]);
    let hub = map
        .vertices()
        .find(|v| map.outgoing(*v).count() == 1000)
        .unwrap();
    assert_eq!(map.location(hub), Point::ORIGIN);
}

#[test]
fn copies_of_a_segment_are_one_edge_with_many_sources() {
    let mut curves = Curves::new();
    for k in 0..1000 {
        let (a, b) = (Point::new(0.1, 0.2), Point::new(0.8, 0.9));
        curves.push(
            if k % 2 == 0 { [a, b] } else { [b, a] },
            CurveLabels::default(),
        );
    }
    curves.push(
        [Point::new(0.8, 0.2), Point::new(0.1, 0.9)],
        CurveLabels::default(),
    );
    let map = built(&curves);
    assert_eq!(counts(&map), [5, 4, 0, 1]);
    assert_eq!(
        map.edges().map(|e| map.sources(e).count()).sum::<usize>(),
        2002
    );
    assert!(map.edges().all(|e| {
        map.sources(e)
            .all(|s| s.reversed == (s.curve % 2 == 1) || s.curve == 1000)
    }));
}

#[test]
fn collinear_overlaps_are_cut_at_all_ends() {
    let mut curves = Curves::new();
    for k in 0..100 {
        let x = f64::from(k) * 0.002;
        curves.push(
            [Point::new(x, 0.25), Point::new(x + 0.5, 0.35)],
            CurveLabels::default(),
        );
        curves.push(
            [Point::new(x, 0.5), Point::new(x + 0.5, 0.5)],
            CurveLabels::default(),
        );
    }
    let map = built(&curves);
    // The parallel slanted ones stay apart, the level ones have 200 ends in a row.
    assert_eq!(counts(&map), [400, 299, 0, 101]);
}

#[test]
fn an_end_on_a_slanted_line_is_a_vertex_of_it() {
    // In floating point hardly one of these ends is exactly on its line.
    for k in 1..500 {
        let (a, b) = (
            Point::new(0.1, 0.137),
            Point::new(0.93, 0.61 + f64::from(k) * 1e-4),
        );
        let on = a.lerp(b, f64::from(k) / 500.0);
        let map = built(&polylines(&[
            &[(a.x, a.y), (b.x, b.y)],
            &[(on.x, on.y), (0.2, 0.9)],
        ]));
        assert_eq!(counts(&map), [4, 3, 0, 1], "{k}");
    }
}

#[test]
fn three_lines_through_a_point_make_no_triangle() {
    for k in 1..500 {
        let center = Point::new(0.31, 0.007 * f64::from(k % 100) + 0.1);
        let map = built(&{
            let mut curves = Curves::new();
            for turn in [0.1, 0.9, 2.2] {
                let arm = Point::unit(turn + 0.01 * f64::from(k)) * 0.77;
                curves.push([center - arm, center + arm * 0.7], CurveLabels::default());
            }
            curves
        });
        assert_eq!(counts(&map), [7, 6, 0, 1], "{k}");
    }
}

#[test]
fn noise_far_below_the_resolution_changes_no_count() {
    // As large textures have it: side 2000, noise 2e-8.
    let noise = |k: usize| ((k * 2_654_435_761) % 1000) as f64 * 4e-11 - 2e-8;
    let mut curves = Curves::new();
    let mut n = 0;
    let mut corner = |x: usize, y: usize| {
        n += 2;
        Point::new(
            100.0 * 3f64.sqrt() * x as f64 + noise(n),
            70.0 * 2f64.sqrt() * y as f64 + noise(n + 1),
        )
    };
    for y in 0..10 {
        for x in 0..10 {
            let square = [
                corner(x, y),
                corner(x + 1, y),
                corner(x + 1, y + 1),
                corner(x, y + 1),
            ];
            for i in 0..4 {
                curves.push([square[i], square[(i + 1) % 4]], CurveLabels::default());
            }
        }
    }
    let map = PlanarMap::build(&curves, resolution(2000.0)).unwrap();
    map.check().unwrap();
    assert_eq!(counts(&map), [121, 220, 100, 1]);
}

#[test]
fn nearly_parallel_lines_cross_once() {
    let mut curves = Curves::new();
    for k in 0..50 {
        let tilt = f64::from(k) * 1e-7;
        curves.push(
            [Point::new(0.0, 0.5 - tilt), Point::new(1.0, 0.5 + tilt)],
            CurveLabels::default(),
        );
    }
    let map = built(&curves);
    assert_eq!(counts(&map), [101, 100, 0, 1]);
}

#[test]
fn a_path_back_along_itself_is_one_edge() {
    let spike = built(&polylines(&[&[(0.0, 0.0), (1.0, 0.5), (0.0, 0.0)]]));
    assert_eq!(counts(&spike), [2, 1, 0, 1]);
    // At the tip the degree is 2, and nothing ends there: it is no vertex.
    let on = built(&polylines(&[
        &[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)],
        &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)],
    ]));
    assert_eq!(counts(&on), [2, 1, 0, 1]);
}

#[test]
fn a_curve_that_crosses_itself_has_vertices_there() {
    let eight = built(&polylines(&[&[
        (0.0, 0.0),
        (1.0, 1.0),
        (1.0, 0.0),
        (0.0, 1.0),
        (0.0, 0.0),
    ]]));
    assert_eq!(counts(&eight), [2, 3, 2, 1]);
    let open = built(&polylines(&[&[
        (0.0, 0.0),
        (1.0, 1.0),
        (1.0, 0.0),
        (0.0, 1.0),
    ]]));
    assert_eq!(counts(&open), [3, 3, 1, 1]);
}

#[test]
fn rings_within_rings_alternate_with_their_faces() {
    let mut curves = Curves::new();
    for k in 0..40 {
        let r = f64::from(k + 1) / 100.0;
        let ring = [(-r, -r), (r, -r), (r, r), (-r, r), (-r, -r)]
            .map(|p| Point::new(0.5 + p.0, 0.5 + p.1));
        curves.push(
            ring,
            CurveLabels {
                left: LabelSet::one(&k.to_string()),
                ..CurveLabels::default()
            },
        );
    }
    let map = built(&curves);
    assert_eq!(counts(&map), [40, 40, 40, 40]);
    for k in 0..40 {
        let face = map.face_at(Point::new(0.5 + (f64::from(k) + 0.5) / 100.0, 0.5));
        assert_eq!(map.face_labels(face), LabelSet::one(&k.to_string()));
        assert_eq!(map.inner_boundaries(face).count(), usize::from(k > 0));
    }
    assert_eq!(
        map.face_at(Point::new(f64::MAX, f64::NAN)),
        FaceId::UNBOUNDED
    );
}

#[test]
fn coordinates_beyond_the_grid_are_errors() {
    let build = |x: f64| PlanarMap::build(&polylines(&[&[(0.0, 0.0), (x, 1.0)]]), 2f64.powi(-10));
    assert!(matches!(
        build(f64::NAN),
        Err(PlanarMapError::NotFinite { curve: 0, .. })
    ));
    assert!(matches!(
        build(f64::NEG_INFINITY),
        Err(PlanarMapError::NotFinite { .. })
    ));
    assert!(matches!(
        build(1e300),
        Err(PlanarMapError::OutOfRange { curve: 0, .. })
    ));
    // 2^46 resolutions are the largest extent, where the resolution is eight times as coarse.
    for side in [2f64.powi(33), 2f64.powi(33) + 1.0, 2f64.powi(36) - 1.0] {
        assert!(build(side).is_ok_and(|m| m.check().is_ok()), "{side}");
    }
    assert!(matches!(
        build(2f64.powi(36) + 1.0),
        Err(PlanarMapError::OutOfRange { .. })
    ));
    for bad in [0.0, -1.0, 0.3, f64::NAN, f64::INFINITY, 2f64.powi(-1000)] {
        assert!(matches!(
            PlanarMap::build(&Curves::new(), bad),
            Err(PlanarMapError::Resolution(_))
        ));
    }
}

#[test]
fn a_map_far_from_the_origin_keeps_its_cells() {
    let far = Point::new(2f64.powi(11), -2f64.powi(11));
    let curves = star(7, far + Point::new(0.25, 0.5));
    assert_eq!(counts(&built(&curves)), [15, 14, 0, 1]);
}

#[test]
fn crossing_lines_on_the_largest_extent_are_exact() {
    let side = 2f64.powi(33);
    let lines = polylines(&[
        &[(0.0, 0.0), (side, side)],
        &[(0.0, side), (side, 0.0)],
        &[(0.0, 0.0), (side, side - 1.0)],
    ]);
    let map = PlanarMap::build(&lines, 2f64.powi(-10)).unwrap();
    map.check().unwrap();
    assert_eq!(counts(&map), [7, 7, 1, 1]);
}

#[test]
fn a_diamond_of_two_resolutions_comes_to_rest() {
    // Once the level segment was led through both other corners at once, then back, and so on.
    let r = resolution(1.0);
    let map = built(&polylines(&[
        &[(0.0, r), (2.0 * r, r)],
        &[(r, 2.0 * r), (2.0 * r, r)],
        &[(0.0, r), (r, r)],
        &[(0.0, 2.0 * r), (r, r)],
        &[(r, 0.0), (2.0 * r, 0.0)],
    ]));
    assert!(map.vertex_count() > 0);
}

#[test]
fn a_thicket_near_the_resolution_comes_to_rest() {
    let mut curves = Curves::new();
    let seed = crate::Seed::root(3);
    let scale = 300.0 * resolution(1.0);
    for n in 0..300 {
        let p = |k| Point::new(seed.number(n).unit(k), seed.number(n).unit(k + 1)) * scale;
        curves.push([p(0), p(2)], CurveLabels::default());
    }
    let map = built(&curves);
    assert!(map.face_count() > 1000);
}
