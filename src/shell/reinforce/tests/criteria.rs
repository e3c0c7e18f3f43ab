//! Stress and worst case, each where it must show, and what cannot be computed.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::VoxelSurface;

use super::super::profile::{Load, Profile, ReinforceError};
use super::super::{Settings, round};
use super::case::standing;
use super::loops::{run, settings, spiral};
use crate::connect::SurfaceGraph;
use crate::connect::tests::shapes;

#[test]
fn a_spiral_is_held_across_its_gaps() {
    let surface = shapes::plane(64, 64);
    let solid = spiral(&surface);
    let bridges = [0.75, 1.5, 3.0, 100.0].map(|limit| {
        let settings = Settings {
            geodesic_limit: Some(limit),
            ..settings()
        };
        let found = run(&surface, &solid, &settings);
        assert!(found.done, "{limit}");
        found.bridges.geodesic
    });
    assert!(bridges.is_sorted_by(|a, b| a >= b), "{bridges:?}");
    assert!(bridges[1] > 0 && bridges[3] == 0, "{bridges:?}");
}

/// A strip that is held at its left end and bent by its own weight, with two slots of one shape. Of bending and
/// of shear there is most at the left.
fn cantilever<'a>(max_stress: f64) -> (VoxelSurface, Vec<bool>, Profile<'a>) {
    let surface = shapes::plane(110, 24);
    let is_slot =
        |p: Point3, begin: f64| (begin..begin + 16.0).contains(&p.x) && (8.0..16.0).contains(&p.y);
    let solid = shapes::pattern(&surface, |p| !is_slot(p, 18.0) && !is_slot(p, 70.0));
    let profile = Profile {
        gravity: Point3::new(0.0, -9.81, 0.0),
        supports: vec![Box::new(|p| p.x < 6.0)],
        max_stress: Some(max_stress),
        ..standing(0.0)
    };
    (surface, solid, profile)
}

#[test]
fn a_cantilever_is_reinforced_where_it_is_bent_most() {
    let rest = |limit: f64| {
        let (surface, solid, profile) = cantilever(limit);
        let settings = Settings {
            profile: Some(&profile),
            ..settings()
        };
        let graph = SurfaceGraph::new(&surface);
        let kept = vec![false; graph.len()];
        (round(&graph, &solid, &kept, &settings).unwrap(), surface)
    };
    let greatest = rest(1e12).0.max_stress.unwrap();
    let (found, surface) = rest(0.97 * greatest);
    assert!(found.bridges.stress > 0);
    let places = (0..surface.voxels.len()).filter(|v| found.forced[*v]);
    let places: Vec<u16> = places.map(|v| surface.voxels.cells[v][0]).collect();
    let left = places.iter().filter(|x| **x < 50).count();
    assert!(
        left * 2 > places.len(),
        "{left} of {}: {found:?}",
        places.len()
    );
}

#[test]
fn a_smaller_limit_asks_for_more_bridges() {
    let surface = shapes::sphere(22.0);
    let normal = Point3::new(0.6, 0.0, 0.8);
    let solid = shapes::stripes(&surface, normal, 8.0);
    let bridges = |max_stress: Option<f64>| {
        let profile = Profile {
            max_stress,
            ..standing(7.0)
        };
        let settings = Settings {
            profile: Some(&profile),
            ..settings()
        };
        let graph = SurfaceGraph::new(&surface);
        let kept = vec![false; graph.len()];
        let found = round(&graph, &solid, &kept, &settings).unwrap();
        assert!(max_stress.is_none_or(|limit| found.holds == (found.max_stress.unwrap() <= limit)));
        (
            found.bridges.connection,
            found.bridges.stress,
            found.max_stress,
        )
    };
    let (connection, none, _) = bridges(None);
    assert!(connection > 0 && none == 0);
    let (_, _, loose) = bridges(Some(1e12));
    let loose = loose.unwrap();
    let counts = [1.0, 0.8, 0.6, 0.4].map(|part| bridges(Some(part * loose)).1);
    assert!(
        counts.is_sorted() && counts[0] == 0 && counts[3] > 0,
        "{counts:?}"
    );
}

#[test]
fn what_cannot_be_computed_is_told() {
    let surface = shapes::plane(30, 30);
    let graph = SurfaceGraph::new(&surface);
    let solid = shapes::islands(&surface, 6.0);
    let kept = vec![false; graph.len()];
    let fails = |profile: Profile| {
        let settings = Settings {
            profile: Some(&profile),
            ..settings()
        };
        round(&graph, &solid, &kept, &settings).unwrap_err()
    };
    let error = fails(standing(-1.0));
    assert!(
        matches!(error, ReinforceError::NotSupported { .. }),
        "{error}"
    );
    let far = Load {
        zone: Box::new(|p| p.z > 50.0),
        force: Point3::new(0.0, 0.0, 1.0),
    };
    let error = fails(Profile {
        loads: vec![far],
        ..standing(9.0)
    });
    assert_eq!(error, ReinforceError::LoadOutside { load: 0 });
    let mut stiff = standing(9.0);
    stiff.material.poisson_ratio = 0.5;
    assert!(matches!(
        fails(stiff),
        ReinforceError::Material { value: 0.5, .. }
    ));
    let thin = Settings {
        thickness: f64::NAN,
        ..settings()
    };
    assert!(round(&graph, &solid, &kept, &thin).is_err());
}
