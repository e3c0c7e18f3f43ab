//! Laws and cases of the planar map.

use super::*;
use crate::geometry::{CurveLabels, LabelSet};

fn polylines(lines: &[&[(f64, f64)]]) -> Curves {
    let mut curves = Curves::new();
    for line in lines {
        curves.push(line.iter().map(|p| Point::new(p.0, p.1)), CurveLabels::default());
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
    [map.vertex_count(), map.edge_count(), map.face_count(), map.component_count()]
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
    let points = polylines(&[&[(0.5, 0.5), (0.5, 0.5)], &[(0.1, 0.1), (0.1, 0.1 + 1e-14), (0.1, 0.1)]]);
    assert_eq!(counts(&built(&points)), [0, 0, 0, 0]);
}

#[test]
fn a_cross_a_t_and_a_closed_curve() {
    assert_eq!(counts(&built(&polylines(&[&[(0.0, 0.5), (1.0, 0.5)], &[(0.5, 0.0), (0.5, 1.0)]]))), [5, 4, 0, 1]);
    assert_eq!(counts(&built(&polylines(&[&[(0.0, 0.5), (1.0, 0.5)], &[(0.5, 0.5), (0.5, 1.0)]]))), [4, 3, 0, 1]);
    let square = built(&polylines(&[&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]]));
    assert_eq!(counts(&square), [1, 1, 1, 1]);
    assert_eq!((square.area(), square.length()), (1.0, 4.0));
    let v = square.vertices().next().unwrap();
    assert_eq!(square.outgoing(v).count(), 2, "a loop leaves its vertex twice");
}

#[test]
fn labels_of_coincident_pieces_are_united_under_the_first_orientation() {
    let set = LabelSet::one;
    let labels = |e, l, r| CurveLabels { edge: set(e), left: set(l), right: set(r), start: set("s"), end: set("t") };
    let mut curves = Curves::new();
    curves.push([Point::new(0.0, 0.0), Point::new(2.0, 0.0)], labels("a", "la", "ra"));
    curves.push([Point::new(3.0, 0.0), Point::new(1.0, 0.0)], labels("b", "lb", "rb"));
    let map = built(&curves);
    assert_eq!(counts(&map), [4, 3, 0, 1]);
    let both = map.edges().find(|e| map.sources(*e).count() == 2).unwrap();
    let got = map.labels(both);
    assert_eq!(
        (got.edge, got.left, got.right),
        (LabelSet::of(["a", "b"]), LabelSet::of(["la", "rb"]), LabelSet::of(["ra", "lb"]))
    );
    assert_eq!(
        (got.start, got.end),
        (set("t"), set("t")),
        "the second ends where the edge begins, the first where it ends"
    );
    assert_eq!(map.location(map.source(both)), Point::new(1.0, 0.0));
    assert!(map.sources(both).eq([Source { curve: 0, reversed: false }, Source { curve: 1, reversed: true }]));
}

#[test]
fn faces_gather_labels_from_holes_and_dangling_edges() {
    let mut curves = Curves::new();
    let ring = |curves: &mut Curves, a: f64, b: f64, left: &str, right: &str| {
        let labels = CurveLabels { left: LabelSet::one(left), right: LabelSet::one(right), ..CurveLabels::default() };
        curves.push([(a, a), (b, a), (b, b), (a, b), (a, a)].map(|p| Point::new(p.0, p.1)), labels);
    };
    ring(&mut curves, 0.0, 1.0, "in", "out");
    ring(&mut curves, 0.4, 0.6, "core", "around");
    let dangling = CurveLabels { left: LabelSet::one("d"), ..CurveLabels::default() };
    curves.push([Point::new(0.1, 0.1), Point::new(0.2, 0.15)], dangling);
    let map = built(&curves);
    assert_eq!(counts(&map), [4, 3, 2, 3]);
    let around = map.face_at(Point::new(0.3, 0.5));
    assert_eq!(map.face_labels(around), LabelSet::of(["in", "around", "d"]));
    assert_eq!(map.inner_boundaries(around).count(), 2);
    assert!((map.face_area(around) - 0.96).abs() < 1e-12);
    assert_eq!(map.face_labels(map.face_at(Point::new(0.5, 0.5))), LabelSet::one("core"));
    assert_eq!(map.face_at(Point::new(1.5, 0.5)), FaceId::UNBOUNDED);
    assert!(map.centroid(around).distance(Point::new(0.5, 0.5)) < 1e-9);
}
