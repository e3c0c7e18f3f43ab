//! Carved and embossed bodies against what is known of them.

use std::sync::Arc;

use super::*;
use crate::carve::{Carved, carve as carve_all};
use crate::carving::Keep;
use crate::shell;
use fretwork_geometry::mesh::{Surface, revolve};
use fretwork_geometry::{Across, Point3, Polygon, Ribbon, Side, SpaceCurve};

fn surface(mesh: &Mesh) -> SurfaceMesh {
    mesh.clone().into()
}

fn carve(mesh: &Mesh, cutout: &Cutout, thickness: f64, side: Side) -> Result<Carved, SolidError> {
    let carving = Carving {
        keep: Keep::Ground,
        thickness,
        side,
        depth: None,
    };
    carve_all(&surface(mesh), &[cutout], &carving).map_err(|failed| failed.error)
}

/// A tube about the z axis, open at both ends.
fn tube(radius: f64) -> Mesh {
    revolve(
        &[Point::new(radius, 0.0), Point::new(radius, 30.0)],
        false,
        240,
    )
    .unwrap()
}

/// Two windows on the way round a tube, on a strip that stands upright on it, at this height.
fn windows(radius: f64, height: f64) -> Cutout {
    let circle = SpaceCurve::circle(radius)
        .unwrap()
        .mapped(|p| p + Point3::new(0.0, 0.0, height))
        .unwrap();
    let ribbon = Ribbon::new(circle, Across::Normal, false).unwrap();
    let joints = ribbon.joints().to_vec();
    let window = |from: usize, to: usize| {
        let side = |v: f64| {
            joints[from..=to]
                .iter()
                .map(|&u| Point::new(u, v))
                .collect::<Vec<_>>()
        };
        Polygon {
            outer: side(-5.0)
                .into_iter()
                .chain(side(5.0).into_iter().rev())
                .collect(),
            holes: vec![],
        }
    };
    let polygons = vec![window(10, 100), window(300, 380)];
    Cutout {
        carrier: Carrier::Strip(Arc::new(ribbon)),
        ..Cutout::planar(polygons).unwrap()
    }
}

#[test]
fn windows_are_cut_through_a_tube() {
    let carved = carve(&tube(20.0), &windows(20.0, 15.0), 2.0, Side::Inside).unwrap();
    let (mesh, fold) = (carved.mesh, carved.overlap);
    let topology = mesh.check_closed().unwrap();
    assert_eq!(
        (topology.components, topology.genus, fold),
        (1, Some(3), None)
    );
    let whole = shell(&tube(20.0), 2.0, Side::Inside).unwrap().volume();
    let turns = 170.0 / 720.0 * std::f64::consts::TAU;
    let taken = turns * 10.0 * (20.0 * 20.0 - 18.0 * 18.0) / 2.0;
    assert!((whole - mesh.volume()) / taken > 0.98 && (whole - mesh.volume()) / taken < 1.02);
}

#[test]
fn what_is_carved_goes_through_on_whichever_side_the_thickness_is() {
    for side in [Side::Inside, Side::Center, Side::Outside] {
        let carved = carve(&tube(20.0), &windows(20.0, 15.0), 2.0, side).unwrap();
        let mesh = carved.mesh;
        let topology = mesh.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(3)));
        let wide = mesh.bounds().size().x;
        let [_, out] = between(2.0, side);
        assert!((wide - 2.0 * (20.0 + out)).abs() < 0.01, "{side:?} {wide}");
    }
}

#[test]
fn what_was_carved_twice_meets_in_one_body_without_exact_arithmetic() {
    // The faces of the two lie on one another all over the tube, but for the rounding of the cuts.
    let carved = |height: f64| {
        carve(&tube(20.0), &windows(20.0, height), 2.0, Side::Inside)
            .unwrap()
            .mesh
    };
    let (low, high) = (carved(7.5), carved(22.5));
    for mesh in [&low, &high] {
        let depth = 1e-9 * mesh.bounds().longest_side();
        assert!(!Surface::new(mesh).overlaps_itself(depth));
    }
    let both = combine(Operation::Intersection, &[low.clone(), high.clone()]).unwrap();
    let topology = both.check_closed().unwrap();
    assert_eq!((topology.components, topology.genus), (1, Some(5)));
    let whole = shell(&tube(20.0), 2.0, Side::Inside).unwrap().volume();
    let expected = low.volume() + high.volume() - whole;
    assert!((both.volume() / expected - 1.0).abs() < 1e-9);
}

#[test]
fn cuts_of_one_whole_are_made_at_once_and_as_they_are_one_by_one() {
    let carved =
        |height: f64| carve(&tube(20.0), &windows(20.0, height), 2.0, Side::Inside).unwrap();
    let [low, high] = [7.5, 22.5].map(carved);
    let (mesh, cut) = intersect_cuts(&[low.cut.as_ref().unwrap(), high.cut.as_ref().unwrap()])
        .unwrap()
        .unwrap();
    let slow = combine(Operation::Intersection, &[low.mesh, high.mesh.clone()]).unwrap();
    assert_eq!(mesh.topology().genus, slow.topology().genus);
    assert!((mesh.volume() / slow.volume() - 1.0).abs() < 1e-9);
    // A cut of cuts is one again, and that of another whole is not.
    assert_eq!(cut.taken.len(), 2);
    let again = intersect_cuts(&[&cut, high.cut.as_ref().unwrap()])
        .unwrap()
        .unwrap()
        .0;
    assert!((again.volume() / mesh.volume() - 1.0).abs() < 1e-9);
    let other = carve(&tube(21.0), &windows(21.0, 15.0), 2.0, Side::Inside).unwrap();
    assert!(intersect_cuts(&[low.cut.as_ref().unwrap(), other.cut.as_ref().unwrap()]).is_none());
}

/// The windows on a strip of which the outer side is the inner one of the tube.
fn turned(radius: f64, height: f64) -> Cutout {
    let of = windows(radius, height);
    let Carrier::Strip(ribbon) = &of.carrier else {
        unreachable!("windows lie on a strip")
    };
    let ribbon = Ribbon::new(ribbon.curve().clone(), Across::Normal, true).unwrap();
    Cutout {
        carrier: Carrier::Strip(Arc::new(ribbon)),
        ..of
    }
}

/// What is left of a tube of radius 20, 2 thick inside, with these cutouts.
fn left(cutouts: &[&Cutout], keep: Keep, depth: Option<f64>) -> Result<Mesh, AtCutout> {
    let carving = Carving {
        keep,
        thickness: 2.0,
        side: Side::Inside,
        depth,
    };
    carve_all(&surface(&tube(20.0)), cutouts, &carving).map(|made| made.mesh)
}

/// The volume of a part of a tube, as a part of the turn, between two radii.
fn volume(turn: f64, height: f64, [from, to]: [f64; 2]) -> f64 {
    turn * std::f64::consts::PI * (to * to - from * from) * height
}

#[track_caller]
fn check_volume(mesh: &Mesh, expected: f64) {
    assert!(
        (mesh.volume() / expected - 1.0).abs() < 2e-3,
        "{} {expected}",
        mesh.volume()
    );
}

const TURN: f64 = 170.0 / 720.0;

#[test]
fn a_cutout_is_engraved_from_outside_whichever_way_it_is_turned() {
    let whole = volume(1.0, 30.0, [18.0, 20.0]);
    for cutout in [windows(20.0, 15.0), turned(20.0, 15.0)] {
        let mesh = left(&[&cutout], Keep::Ground, Some(0.8)).unwrap();
        assert_eq!(mesh.topology().genus, Some(1));
        check_volume(&mesh, whole - volume(TURN, 10.0, [19.2, 20.0]));
        let through = left(&[&cutout], Keep::Ground, None).unwrap();
        check_volume(&through, whole - volume(TURN, 10.0, [18.0, 20.0]));
        let kept = left(&[&cutout], Keep::Pattern { frame: 0.0 }, Some(0.8)).unwrap();
        check_volume(
            &kept,
            whole - volume(1.0, 30.0, [19.2, 20.0]) + volume(TURN, 10.0, [19.2, 20.0]),
        );
    }
}

#[test]
fn a_cutout_of_a_strip_is_kept_with_rims_that_are_apart_from_it_or_hold_it() {
    let cutout = windows(20.0, 15.0);
    let alone = left(&[&cutout], Keep::Pattern { frame: 0.0 }, None).unwrap();
    assert_eq!(alone.topology().components, 2);
    check_volume(&alone, volume(TURN, 10.0, [18.0, 20.0]));
    // The windows are 10 away from each rim.
    let apart = left(&[&cutout], Keep::Pattern { frame: 4.0 }, None).unwrap();
    assert_eq!(apart.topology().components, 4);
    let held = left(&[&cutout], Keep::Pattern { frame: 12.0 }, None).unwrap();
    let topology = held.topology();
    assert_eq!((topology.components, topology.genus), (1, Some(3)));
    check_volume(
        &held,
        volume(1.0, 24.0, [18.0, 20.0]) + volume(TURN, 6.0, [18.0, 20.0]),
    );
    // A frame that is all of the surface leaves all of it.
    let whole = left(&[&cutout], Keep::Pattern { frame: 16.0 }, None).unwrap();
    check_volume(&whole, volume(1.0, 30.0, [18.0, 20.0]));
}

#[test]
fn several_cutouts_are_taken_away_together_and_the_one_that_fails_is_told() {
    let (low, high) = (windows(20.0, 7.5), windows(20.0, 22.5));
    let mesh = left(&[&low, &high], Keep::Ground, None).unwrap();
    assert_eq!(mesh.topology().genus, Some(5));
    check_volume(
        &mesh,
        volume(1.0, 30.0, [18.0, 20.0]) - volume(2.0 * TURN, 10.0, [18.0, 20.0]),
    );
    let raised = emboss(&surface(&tube(20.0)), &[&low, &high], 1.5)
        .unwrap()
        .0;
    check_volume(
        &raised,
        volume(1.0, 30.0, [0.0, 20.0]) + volume(2.0 * TURN, 10.0, [20.0, 21.5]),
    );
    let off = windows(60.0, 15.0);
    let failed = left(&[&low, &off], Keep::Ground, None).unwrap_err();
    assert_eq!(failed.cutout, Some(1));
    let failed = emboss(&surface(&tube(20.0)), &[&off, &low], 1.5).unwrap_err();
    assert_eq!(failed.cutout, Some(0));
}

#[test]
fn a_depth_that_reaches_through_is_told_by_how_much() {
    let failed = left(&[&windows(20.0, 15.0)], Keep::Ground, Some(2.5)).unwrap_err();
    assert!(
        failed.error.to_string().ends_with("by 0.500"),
        "{}",
        failed.error
    );
    // The strip lies 1.5 off the tube, so that 0.8 of it reach through.
    let failed = left(&[&windows(21.5, 15.0)], Keep::Ground, Some(0.8)).unwrap_err();
    assert!(
        matches!(failed.error, SolidError::Through { .. }),
        "{}",
        failed.error
    );
    assert_eq!(failed.cutout, Some(0));
}

#[test]
fn windows_stand_out_of_a_filled_tube() {
    let (mesh, _) = emboss(&surface(&tube(20.0)), &[&windows(20.0, 15.0)], 1.5).unwrap();
    let topology = mesh.check_closed().unwrap();
    assert_eq!((topology.components, topology.genus), (1, Some(0)));
    let radius = mesh
        .positions
        .iter()
        .map(|p| (p.x * p.x + p.y * p.y).sqrt())
        .fold(0.0, f64::max);
    assert!((21.4..21.6).contains(&radius), "{radius}");
}

#[test]
fn what_lies_off_the_surface_is_refused() {
    assert!(matches!(
        carve(&tube(20.0), &windows(60.0, 15.0), 2.0, Side::Inside),
        Err(SolidError::OffSurface { .. })
    ));
}
