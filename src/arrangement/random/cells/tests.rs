//! Statistics, windows, tiles, borders and labels of irregular partitions.

use super::*;
use crate::random::properties::{Density, Weighted};
use fretwork_geometry::planar_map::{PlanarMap, resolution};
use fretwork_geometry::polygon::signed_area;
use fretwork_geometry::{Field, Polygon};
use std::f64::consts::PI;

type Partition =
    fn(&IrregularProperties, Border, &Region, Seed, f64) -> Result<Curves, ArrangementError>;
const BOTH: [Partition; 2] = [uniform, random];
const BORDERS: [Border; 4] = [
    Border::Crop,
    Border::CropAddBoundary,
    Border::KeepInside,
    Border::KeepOutside,
];

fn square(x: f64, y: f64, side: f64) -> Region {
    Region::rectangle(Point::new(x, y), Point::new(x + side, y + side))
}

fn constant(d: f64) -> IrregularProperties {
    IrregularProperties::new(Density::Constant(d))
}

fn map(curves: &Curves, side: f64) -> PlanarMap {
    PlanarMap::build(curves, resolution(side)).unwrap()
}

fn length(curves: &Curves) -> f64 {
    curves
        .iter()
        .flat_map(|c| c.points.windows(2))
        .map(|w| w[0].distance(w[1]))
        .sum()
}

/// A star around (50, 50) with a hole.
fn star(seed: Seed) -> Region {
    let ring = |k: f64, turn: f64| -> Vec<Point> {
        let corner =
            |i: u64| Point::unit(turn * i as f64 * PI / 10.0) * (k * seed.range(i, 0.5, 1.0));
        (0..20)
            .map(|i| corner(i) + Point::new(50.0, 50.0))
            .collect()
    };
    Region::of_area(vec![Polygon {
        outer: ring(50.0, 1.0),
        holes: vec![ring(20.0, -1.0)],
    }])
}

#[test]
fn counts_and_lengths_are_those_of_voronoi_cells() {
    // Cells that meet a convex window: d·area + side length per area·perimeter/π + 1 (Santaló); the
    // sides of Poisson cells are 2√d long per area.
    for (partition, per_area) in [(uniform as Partition, 1.93), (random, 2.0)] {
        let (mut faces, mut lengths) = (0.0, 0.0);
        for seed in 0..30 {
            let at = |border| {
                partition(
                    &constant(50.0 / 4e6),
                    border,
                    &square(0.0, 0.0, 2000.0),
                    Seed::root(seed),
                    resolution(2000.0),
                )
                .unwrap()
            };
            let kept = map(&at(Border::KeepOutside), 2000.0);
            assert_eq!(kept.component_count(), 1);
            faces += kept.face_count() as f64 / 30.0;
            lengths += length(&at(Border::Crop)) / 30.0;
        }
        let expected = 50.0 + per_area * 50f64.sqrt() * 4.0 / PI + 1.0;
        assert!(
            (faces / expected - 1.0).abs() < 0.05,
            "{faces} for {expected}"
        );
        let expected = per_area * (50.0 / 4e6_f64).sqrt() * 4e6;
        assert!(
            (lengths / expected - 1.0).abs() < 0.04,
            "{lengths} for {expected}"
        );
    }
}

#[test]
fn overlapping_regions_have_the_same_cells_where_both_show_them_whole() {
    let wavy = Density::Field(Field::new([7; 32], |p| 1.5 + libm::sin(p.x / 7.0)));
    for (partition, density) in BOTH
        .iter()
        .flat_map(|p| [(p, Density::Constant(1.0)), (p, wavy.clone())])
    {
        let mut properties = IrregularProperties::new(density);
        let labels = |names: &[&str]| {
            Weighted::new(names.iter().map(|n| (LabelSet::one(n), 1.0)).collect()).unwrap()
        };
        properties.face_labels = labels(&["f", "g", "h"]);
        properties.edge_labels = labels(&["e", "k"]);
        properties.vertex_labels = labels(&["v", "w"]);
        let shown = |region: &Region, border| {
            partition(&properties, border, region, Seed::root(1), resolution(40.0)).unwrap()
        };
        // Sides well inside both, with all their labels, bit by bit.
        let common = Bounds {
            min: Point::new(18.0, 8.0),
            max: Point::new(29.0, 22.0),
        };
        let inside = |curves: &Curves| -> Vec<String> {
            let whole = curves
                .iter()
                .filter(|c| c.points.iter().all(|p| common.contains(*p)) && c.points.len() == 2);
            let mut sides: Vec<String> = whole.map(|c| format!("{c:?}")).collect();
            sides.sort();
            sides
        };
        let first = inside(&shown(&square(0.0, 0.0, 30.0), Border::KeepOutside));
        assert!(first.len() > 200, "{}", first.len());
        assert_eq!(
            first,
            inside(&shown(&square(16.0, 5.0, 40.0), Border::KeepOutside))
        );
        assert_eq!(
            first,
            inside(&shown(&square(17.0, 7.0, 17.0), Border::Crop))
        );
    }
}

#[test]
fn kept_cells_are_those_that_clipping_finds() {
    for (case, partition) in (0..6).zip(BOTH.iter().cycle()) {
        let region = star(Seed::root(case));
        let (mut properties, seed) = (constant(0.03), Seed::root(case).name("cells"));
        properties.face_labels = Weighted::new(vec![(LabelSet::one("cell"), 1.0)]).unwrap();
        // The whole plane around, as polygons.
        let whole = partition(
            &properties,
            Border::KeepOutside,
            &square(-60.0, -60.0, 220.0),
            seed,
            resolution(100.0),
        );
        let plane = map(&whole.unwrap(), 100.0);
        for (border, least) in [
            (Border::KeepOutside, 1e-6),
            (Border::KeepInside, 1.0 - 1e-6),
        ] {
            let kept = map(
                &partition(&properties, border, &region, seed, resolution(100.0)).unwrap(),
                100.0,
            );
            // Cells around one that is not kept bound a face too; it has no label.
            let cells = kept
                .bounded_faces()
                .filter(|f| !kept.face_labels(*f).is_empty());
            let mut found: Vec<Point> = cells.map(|f| kept.centroid(f)).collect();
            for face in plane.bounded_faces() {
                let cell: Vec<Point> = plane
                    .outer_boundary(face)
                    .map(|h| plane.location(plane.origin(h)))
                    .collect();
                let inside: f64 = region.area[0].rings().map(|r| clipped_area(r, &cell)).sum();
                if inside > least * signed_area(&cell) {
                    let at = plane.centroid(face);
                    let same = found.iter().position(|p| p.distance(at) < 1e-6);
                    found.remove(same.unwrap_or_else(|| {
                        panic!("case {case} {border:?}: the cell at {at:?} is missing")
                    }));
                }
            }
            assert!(
                found.is_empty(),
                "case {case} {border:?}: {found:?} are too many"
            );
        }
    }
}

/// The area of `ring` inside a convex counter-clockwise polygon.
fn clipped_area(ring: &[Point], convex: &[Point]) -> f64 {
    let mut ring = ring.to_vec();
    for i in 0..convex.len() {
        let (at, along) = (convex[i], convex[(i + 1) % convex.len()] - convex[i]);
        let mut rest = Vec::new();
        for j in 0..ring.len() {
            let (p, q) = (ring[j], ring[(j + 1) % ring.len()]);
            let (dp, dq) = (along.cross(p - at), along.cross(q - at));
            if dp >= 0.0 {
                rest.push(p);
            }
            if (dp >= 0.0) != (dq >= 0.0) {
                rest.push(p.lerp(q, dp / (dp - dq)));
            }
        }
        ring = rest;
    }
    signed_area(&ring)
}

#[test]
fn cropped_cells_keep_their_labels_up_to_the_contour() {
    for (case, partition) in (0..6).zip(BOTH.iter().cycle()) {
        let region = star(Seed::root(case));
        let mut properties = constant(0.02);
        let names = (0..50)
            .map(|i| (LabelSet::one(&format!("f{i}")), 1.0))
            .collect();
        properties.face_labels = Weighted::new(names).unwrap();
        let at = |region: &Region, border| {
            partition(
                &properties,
                border,
                region,
                Seed::root(case),
                resolution(100.0),
            )
            .unwrap()
        };
        let plane = map(
            &at(&square(-60.0, -60.0, 220.0), Border::KeepOutside),
            100.0,
        );
        let cropped = map(&at(&region, Border::CropAddBoundary), 100.0);
        assert!(
            (cropped.area() - region.area[0].area() - signed_area(&region.area[0].holes[0]).abs())
                .abs()
                < 1e-4
        );
        for face in cropped.bounded_faces() {
            let (area, labels) = (cropped.face_area(face), cropped.face_labels(face));
            if labels.is_empty() {
                assert!(
                    (area + signed_area(&region.area[0].holes[0])).abs() < 1e-4,
                    "only the hole has none"
                );
                continue;
            }
            let some = cropped.outer_boundary(face).next().unwrap();
            let points = cropped.half_edge_points(some);
            let inner = points[0].lerp(points[1], 0.5) + (points[1] - points[0]).left() * 1e-5;
            assert_eq!(
                labels,
                plane.face_labels(plane.face_at(inner)),
                "case {case}"
            );
        }
        let lines =
            length(&at(&region, Border::CropAddBoundary)) - length(&at(&region, Border::Crop));
        assert!((lines - length(&region.contour)).abs() < 1e-4);
    }
}

#[test]
fn tiles_join() {
    for partition in BOTH {
        let mut tile = square(3.0, 4.0, 20.0);
        tile.period = Some(Point::new(20.0, 20.0));
        let at = |region: &Region| {
            partition(
                &constant(0.4),
                Border::Crop,
                region,
                Seed::root(4),
                resolution(20.0),
            )
            .unwrap()
        };
        let cropped = at(&tile);
        let mut four = Curves::new();
        for (i, j) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            four.append(&crate::place::similarity::translate(
                &cropped,
                Point::new(20.0 * i, 20.0 * j),
            ));
        }
        let mut larger = square(3.0, 4.0, 40.0);
        larger.period = tile.period;
        let larger = at(&larger);
        assert!((length(&four) - length(&larger)).abs() < 1e-6);
        four.append(&larger);
        // Nothing of one lies beside the other: every point of the seams is a vertex of degree 2.
        assert!((map(&four, 20.0).length() - length(&larger)).abs() < 1e-6);
    }
}

#[test]
fn labels_are_drawn_by_weight_for_every_kind_of_cell() {
    let mut properties = constant(1.0);
    let two = |a: &str, b: &str, w| {
        Weighted::new(vec![(LabelSet::one(a), 1.0), (LabelSet::one(b), w)]).unwrap()
    };
    properties.vertex_labels = two("v0", "v1", 3.0);
    properties.edge_labels = two("e0", "e1", 1.0);
    properties.face_labels = two("f0", "f1", 4.0);
    let curves = uniform(
        &properties,
        Border::KeepOutside,
        &square(0.0, 0.0, 60.0),
        Seed::root(8),
        resolution(60.0),
    )
    .unwrap();
    let map = map(&curves, 60.0);
    let part = |of: usize, all: usize| of as f64 / all as f64;
    let vertices = map
        .vertices()
        .filter(|v| map.vertex_labels(*v).contains("v1"))
        .count();
    assert!((part(vertices, map.vertex_count()) - 0.75).abs() < 0.02);
    assert!(
        map.vertices()
            .all(|v| map.vertex_labels(v).names().len() == 1)
    );
    let edges = map
        .edges()
        .filter(|e| map.labels(*e).edge.contains("e1"))
        .count();
    assert!((part(edges, map.edge_count()) - 0.5).abs() < 0.02);
    let faces = map
        .bounded_faces()
        .filter(|f| map.face_labels(*f).contains("f1"))
        .count();
    assert!((part(faces, map.face_count()) - 0.8).abs() < 0.02);
    assert!(
        map.bounded_faces()
            .all(|f| map.face_labels(f).names().len() == 1)
    );
}

#[test]
fn few_sites_many_sites_and_no_region() {
    for (partition, border) in BOTH.iter().flat_map(|p| BORDERS.map(|b| (p, b))) {
        let at = |d: f64, region: &Region| {
            partition(
                &constant(d),
                border,
                region,
                Seed::root(3),
                resolution(10.0),
            )
        };
        assert_eq!(at(1.0, &Region::of_area(vec![])).unwrap(), Curves::new());
        // One cell holds it all.
        let curves = at(1e-6, &square(0.0, 0.0, 10.0)).unwrap();
        let whole = match border {
            Border::Crop | Border::KeepInside => 0,
            Border::CropAddBoundary => 1,
            Border::KeepOutside => map(&curves, 10.0).face_count().max(1),
        };
        assert_eq!(map(&curves, 10.0).face_count(), whole, "{border:?}");
        assert!(at(1e9, &square(0.0, 0.0, 10.0)).is_err());
        assert!(
            at(
                1.0,
                &Region::rectangle(Point::ORIGIN, Point::new(f64::INFINITY, 1.0))
            )
            .is_err()
        );
        let mut narrow = square(0.0, 0.0, 1.0);
        narrow.period = Some(Point::new(1.0, 1.0));
        assert!(
            uniform(
                &constant(1.0),
                border,
                &narrow,
                Seed::root(1),
                resolution(1.0)
            )
            .is_err()
        );
        assert!(
            random(
                &constant(0.1),
                border,
                &narrow,
                Seed::root(1),
                resolution(1.0)
            )
            .is_ok()
        );
    }
}
