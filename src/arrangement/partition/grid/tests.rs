//! Grids against clipping every cell by hand.

use super::*;
use fretwork_geometry::polygon::signed_area;
use fretwork_geometry::{Polygon, Seed};
use std::f64::consts::{FRAC_PI_2, PI};

fn square(side: f64) -> Region {
    Region::rectangle(Point::ORIGIN, Point::new(side, side))
}

fn length(curves: &Curves) -> f64 {
    curves
        .iter()
        .flat_map(|c| c.points.windows(2))
        .map(|w| w[0].distance(w[1]))
        .sum()
}

/// Distinct end points, exactly as they are.
fn vertices(curves: &Curves) -> usize {
    let mut ends: Vec<Point> = curves
        .iter()
        .flat_map(|c| [c.points[0], c.points[c.points.len() - 1]])
        .collect();
    ends.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    ends.dedup();
    ends.len()
}

#[test]
fn kept_cells_are_whole_and_share_their_sides() {
    let (across, along) = (
        StripesProperties::new(0.0, vec![200.0, 80.0]),
        StripesProperties::new(FRAC_PI_2, vec![250.0]),
    );
    let curves = grid(&across, &along, Border::KeepOutside, &square(2000.0), 1e-6).unwrap();
    assert_eq!(
        (curves.len(), vertices(&curves), length(&curves)),
        (294, 160, 57600.0)
    );
    let inside = grid(&across, &along, Border::KeepInside, &square(2000.0), 1e-6).unwrap();
    assert!(
        inside.bounds().min.x > 0.0
            && inside.bounds().max.x < 2000.0
            && inside.len() < curves.len()
    );
}

#[test]
fn cropped_pieces_meet_the_contour_in_the_same_bits() {
    let (across, along) = (
        StripesProperties::new(PI / 6.0, vec![110.0]),
        StripesProperties::new(5.0 * PI / 6.0, vec![200.0]),
    );
    let curves = grid(
        &across,
        &along,
        Border::CropAddBoundary,
        &square(2000.0),
        1e-6,
    )
    .unwrap();
    assert_eq!((curves.len(), vertices(&curves)), (437, 240));
    assert!((length(&curves) - 64369.504172281515).abs() < 1e-6);
    let cropped = grid(&across, &along, Border::Crop, &square(2000.0), 1e-6).unwrap();
    assert!((length(&cropped) + 8000.0 - length(&curves)).abs() < 1e-6);
}

#[test]
fn sides_run_along_their_lines_with_their_cells_on_either_hand() {
    for (turn, border) in [
        (FRAC_PI_2, Border::KeepOutside),
        (-1.1, Border::KeepOutside),
        (2.0, Border::Crop),
    ] {
        let label = |c: char| {
            (0..3)
                .map(|i| LabelSet::one(&format!("{c}{i}")))
                .collect::<Vec<_>>()
        };
        let mut across = StripesProperties::new(0.4, vec![3.0, 1.0]);
        let mut along = StripesProperties::new(0.4 + turn, vec![2.0]);
        (across.face_labels, along.face_labels) = (label('a'), label('b'));
        (across.edge_labels, along.edge_labels) = (label('a'), label('b'));
        let curves = grid(&across, &along, border, &square(20.0), 1e-9).unwrap();
        let lines = [&across, &along].map(|p| Lines::new(p, Point::ORIGIN, 0.0).unwrap());
        for curve in curves.iter() {
            let (from, to) = (curve.points[0], curve.points[1]);
            let family = usize::from(!curve.labels.edge.names()[0].starts_with('a'));
            let ahead = (to - from) * (1.0 / from.distance(to));
            assert!(ahead.distance(lines[family].direction) < 1e-6);
            for (side, labels) in [(1.0, curve.labels.left), (-1.0, curve.labels.right)] {
                let p = from.lerp(to, 0.5) + ahead.left() * (side * 1e-6);
                let cell =
                    [0, 1].map(|f| lines[f].face_label(lines[f].stripe(lines[f].distance(p))));
                assert!(labels.is_empty() || labels == cell[0].union(cell[1]));
            }
            assert!(!curve.labels.left.is_empty() || !curve.labels.right.is_empty());
        }
    }
}

/// Area of `ring` inside a convex polygon given by half-planes (point, inward normal).
fn clipped_area(ring: &[Point], planes: &[(Point, Point)]) -> f64 {
    let mut ring = ring.to_vec();
    for (at, inward) in planes {
        let mut rest = Vec::new();
        for i in 0..ring.len() {
            let (p, q) = (ring[i], ring[(i + 1) % ring.len()]);
            let (dp, dq) = ((p - *at).dot(*inward), (q - *at).dot(*inward));
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

/// A star around (50, 50) with a hole, and as many corners as `n`.
fn star(seed: Seed, n: u64) -> Region {
    let ring = |k: f64, turn: f64| -> Vec<Point> {
        let corner =
            |i| Point::unit(turn * i as f64 * 2.0 * PI / n as f64) * (k * seed.range(i, 0.4, 1.0));
        (0..n).map(|i| corner(i) + Point::new(50.0, 50.0)).collect()
    };
    Region::of_area(vec![Polygon {
        outer: ring(50.0, 1.0),
        holes: vec![ring(18.0, -1.0)],
    }])
}

#[test]
fn kept_cells_agree_with_clipping_every_cell() {
    for case in 0..12 {
        let seed = Seed::root(case);
        let region = star(seed.name("star"), 5 + 3 * case);
        let across = StripesProperties::new(
            seed.range(0, 0.0, 6.0),
            vec![seed.range(1, 3.0, 9.0), seed.range(2, 3.0, 9.0)],
        );
        let along = StripesProperties::new(
            across.angle + seed.range(3, 0.5, 2.5),
            vec![seed.range(4, 3.0, 9.0)],
        );
        let [a, b] = [&across, &along].map(|p| Lines::new(p, region.bounds().min, 0.0).unwrap());
        for (outside, threshold) in [(true, 1e-6), (false, 1.0 - 1e-6)] {
            let keep = |part: f64, whole: f64| part > threshold * whole;
            let (columns, rows) = (&(i64::MIN..=i64::MAX), &(i64::MIN..=i64::MAX));
            let all = Wanted { columns, rows };
            let rows = covered(&region, [&a, &b], all, keep).unwrap();
            for (i, j) in (-60..60).flat_map(|i| (-60..60).map(move |j| (i, j))) {
                let plane = |l: &Lines, k: i64, sign: f64| {
                    (l.anchor + l.normal * l.offset(k), l.normal * sign)
                };
                let cell = [
                    plane(&a, i, 1.0),
                    plane(&a, i + 1, -1.0),
                    plane(&b, j, 1.0),
                    plane(&b, j + 1, -1.0),
                ];
                let part: f64 = region.area[0].rings().map(|r| clipped_area(r, &cell)).sum();
                let whole = (a.offset(i + 1) - a.offset(i)) * (b.offset(j + 1) - b.offset(j))
                    / a.direction.cross(b.direction).abs();
                let row = rows.iter().find(|r| r.row == j);
                let kept = row.is_some_and(|r| r.runs.iter().any(|run| run.0 <= i && i < run.1));
                assert_eq!(
                    kept,
                    keep(part, whole),
                    "case {case} cell {i} {j} {outside}: {part} of {whole}"
                );
            }
        }
    }
}

#[test]
fn what_is_no_grid_is_an_error() {
    let at = |angle, spacing, border| {
        let across = StripesProperties::new(0.3, vec![1.0]);
        grid(
            &across,
            &StripesProperties::new(angle, vec![spacing]),
            border,
            &square(100.0),
            1e-9,
        )
    };
    assert!(matches!(
        at(0.3 + PI, 1.0, Border::Crop),
        Err(ArrangementError::Parallel(..))
    ));
    assert!(matches!(
        at(1.3, f64::NAN, Border::Crop),
        Err(ArrangementError::Spacing { .. })
    ));
    for border in [
        Border::Crop,
        Border::CropAddBoundary,
        Border::KeepInside,
        Border::KeepOutside,
    ] {
        assert!(
            matches!(at(1.3, 4e-4, border), Err(ArrangementError::TooMany { .. })),
            "{border:?}"
        );
    }
    let unbounded = Region::rectangle(Point::ORIGIN, Point::new(f64::INFINITY, 1.0));
    let p = [
        StripesProperties::new(0.3, vec![1.0]),
        StripesProperties::new(1.3, vec![1.0]),
    ];
    assert!(grid(&p[0], &p[1], Border::Crop, &unbounded, 1e-9).is_err());
}

/// By hand: `cargo test --release --lib a_million_cells -- --ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn a_million_cells_take_time_in_proportion() {
    for side in [250.0, 500.0, 1000.0] {
        for border in [Border::KeepOutside, Border::CropAddBoundary] {
            let (across, along) = (
                StripesProperties::new(0.0, vec![1.0]),
                StripesProperties::new(FRAC_PI_2, vec![1.0]),
            );
            let start = std::time::Instant::now();
            let curves = grid(&across, &along, border, &square(side), 1e-6).unwrap();
            let per_cell = start.elapsed().as_secs_f64() / (side * side);
            println!(
                "{side} {border:?}: {} curves, {:.3} µs a cell",
                curves.len(),
                1e6 * per_cell
            );
        }
    }
}
