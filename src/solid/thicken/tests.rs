//! Tests of bodies made of cutouts.

use std::sync::Arc;

use super::*;
use fretwork_geometry::cutout::{Measures, roll};
use fretwork_geometry::{Across, Point, Polygon, Ring, SpaceCurve, topology};

fn cutout(polygons: Vec<Polygon>, carrier: Carrier, around: usize) -> Cutout {
    let counts = topology::count(&polygons).unwrap();
    Cutout {
        components: counts.components,
        holes: counts.holes - around,
        around,
        side: Side::Center,
        carrier,
        polygons,
        developed: Vec::new(),
        is_strip: false,
        measures: Measures::default(),
    }
}

/// A ladder whose long sides are divided at the joints.
fn ladder(joints: &[f64]) -> Polygon {
    let length = joints[joints.len() - 1];
    let along = |from: f64, to: f64, v: f64| {
        let mut side = vec![from];
        side.extend(joints.iter().copied().filter(|j| *j > from && *j < to));
        side.push(to);
        side.into_iter()
            .map(move |u| Point::new(u, v))
            .collect::<Vec<_>>()
    };
    let frame = |a: f64, b: f64, low: f64, high: f64| -> Ring {
        along(a, b, low)
            .into_iter()
            .chain(along(a, b, high).into_iter().rev())
            .collect()
    };
    let hole = |k: usize| -> Ring {
        let step = length / 5.0;
        frame(step * (k as f64 + 0.1), step * (k as f64 + 0.9), -3.0, 3.0)
            .into_iter()
            .rev()
            .collect()
    };
    Polygon {
        outer: frame(0.0, length, -4.0, 4.0),
        holes: (0..5).map(hole).collect(),
    }
}

#[test]
fn a_strip_along_an_arc_has_its_holes_and_its_volume() {
    let arc = SpaceCurve::arc(30.0, 0.5, 5.5).unwrap();
    for across in [Across::Normal, Across::Plane] {
        let ribbon = Arc::new(Ribbon::new(arc.clone(), across, false).unwrap());
        let polygon = ladder(ribbon.joints());
        let area = polygon.area();
        let (mesh, fold) = thicken(
            &cutout(vec![polygon], Carrier::Strip(ribbon), 0),
            2.0,
            Side::Center,
        )
        .unwrap();
        assert_eq!(fold, None);
        assert_eq!(mesh.check_closed().unwrap().genus, Some(5));
        assert!(
            (mesh.volume() / (2.0 * area) - 1.0).abs() < 1e-3,
            "{across:?} {}",
            mesh.volume() / area
        );
    }
}

#[test]
fn a_solid_area_follows_the_curve() {
    let circle = SpaceCurve::arc(30.0, 0.0, 3.0).unwrap();
    let ribbon = Arc::new(Ribbon::new(circle, Across::Normal, false).unwrap());
    let joints = ribbon.joints().to_vec();
    let side = |v: f64| joints.iter().map(|&u| Point::new(u, v)).collect::<Vec<_>>();
    let outer: Ring = side(-20.0)
        .into_iter()
        .chain(side(20.0).into_iter().rev())
        .collect();
    let (mesh, _) = thicken(
        &cutout(
            vec![Polygon {
                outer,
                holes: vec![],
            }],
            Carrier::Strip(ribbon),
            0,
        ),
        1.0,
        Side::Center,
    )
    .unwrap();
    for triangle in &mesh.triangles {
        let [a, b, c] = mesh.corners(*triangle);
        let middle = (a + b + c) * (1.0 / 3.0);
        let radius = (middle.x * middle.x + middle.y * middle.y).sqrt();
        assert!((29.4..30.6).contains(&radius), "{radius}");
    }
}

#[test]
fn a_loop_has_no_seam() {
    let circle = SpaceCurve::circle(20.0).unwrap();
    let ribbon = Arc::new(Ribbon::new(circle, Across::Normal, false).unwrap());
    let length = ribbon.curve().length();
    let joints = ribbon.joints().to_vec();
    let turn = |v: f64| {
        joints[..joints.len() - 1]
            .iter()
            .map(move |&u| roll(u, v, 20.0, length))
            .collect::<Vec<_>>()
    };
    let outer: Ring = turn(5.0).into_iter().rev().collect();
    let window =
        [[3.0, -1.0], [3.0, 1.0], [8.0, 1.0], [8.0, -1.0]].map(|[u, v]| roll(u, v, 20.0, length));
    let polygon = Polygon {
        outer,
        holes: vec![turn(-5.0), window.to_vec()],
    };
    let carrier = Carrier::Ring {
        ribbon,
        radius: 20.0,
    };
    let (mesh, fold) = thicken(&cutout(vec![polygon], carrier, 1), 1.0, Side::Center).unwrap();
    assert_eq!((mesh.check_closed().unwrap().genus, fold), (Some(2), None));
    assert!((mesh.bounds().size().z - 10.0).abs() < 1e-9);
}

#[test]
fn the_thickness_goes_to_the_side_that_is_asked_for() {
    let circle = SpaceCurve::arc(20.0, 0.0, 5.0).unwrap();
    for flip in [false, true] {
        let ribbon = Ribbon::new(circle.clone(), Across::Normal, flip).unwrap();
        let ribbon = Arc::new(ribbon);
        let polygon = ladder(ribbon.joints());
        let strip = cutout(vec![polygon], Carrier::Strip(ribbon), 0);
        for (side, expected) in [
            (Side::Inside, [18.0, 20.0]),
            (Side::Center, [19.0, 21.0]),
            (Side::Outside, [20.0, 22.0]),
        ] {
            let (mesh, _) = thicken(&strip, 2.0, side).unwrap();
            let radii = mesh
                .positions
                .iter()
                .map(|p| (p.x * p.x + p.y * p.y).sqrt());
            let (low, high) = radii.fold((f64::MAX, 0.0f64), |(low, high), r| {
                (low.min(r), high.max(r))
            });
            let off = (low - expected[0]).abs().max((high - expected[1]).abs());
            assert!(off < 0.01, "{flip} {side:?}: {low} to {high}");
        }
    }
}

#[test]
fn too_thick_a_body_on_a_sharp_bend_is_told() {
    let arc = SpaceCurve::arc(2.0, 0.0, 3.0).unwrap();
    let ribbon = Arc::new(Ribbon::new(arc, Across::Normal, false).unwrap());
    let polygon = ladder(ribbon.joints());
    let strip = cutout(vec![polygon], Carrier::Strip(ribbon), 0);
    assert_eq!(thicken(&strip, 3.9, Side::Center).unwrap().1, None);
    let Some(Overlap::Fold(at)) = thicken(&strip, 4.5, Side::Center).unwrap().1 else {
        panic!("no fold")
    };
    assert!(at.length() < 5.0);
    assert!(
        thicken(&strip, 0.0, Side::Center).is_err()
            && thicken(&strip, f64::NAN, Side::Center).is_err()
    );
}

#[test]
fn parts_of_a_curve_that_pass_through_each_other_are_told() {
    // A figure of eight that rises by less than the strip is high, and by more.
    let eight = |rise: f64| {
        let at = |i: usize| {
            let a = i as f64 * 0.02 - 0.4;
            Point3::new(
                30.0 * libm::sin(a),
                30.0 * libm::sin(2.0 * a),
                rise * i as f64 / 200.0,
            )
        };
        let curve = SpaceCurve::new((0..200).map(at), false).unwrap();
        let ribbon = Arc::new(
            Ribbon::new(curve, Across::Direction(Point3::new(0.0, 0.0, 1.0)), false).unwrap(),
        );
        let polygon = ladder(ribbon.joints());
        thicken(
            &cutout(vec![polygon], Carrier::Strip(ribbon), 0),
            1.0,
            Side::Center,
        )
        .unwrap()
        .1
    };
    assert!(
        matches!(eight(1.0), Some(Overlap::Crossing(at)) if at.length() < 8.0),
        "{:?}",
        eight(1.0)
    );
    assert_eq!(eight(60.0), None);
}
