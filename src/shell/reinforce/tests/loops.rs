//! The loop on patterns made in code.

use std::f64::consts::TAU;

use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Point3, Seed};

use super::super::profile::Profile;
use super::super::{Settings, Structure, round, structure};
use super::case::standing;
use crate::connect::tests::shapes;
use crate::connect::{Pieces, SurfaceGraph, Touch};

/// A band that winds outward with gaps as wide as itself.
pub(super) fn spiral(surface: &VoxelSurface) -> Vec<bool> {
    shapes::pattern(surface, |p| {
        let (x, y) = (p.x - 32.0, p.y - 32.0);
        let turn = libm::atan2(y, x) / TAU;
        ((x * x + y * y).sqrt() / 9.0 - turn).rem_euclid(1.0) < 0.5
    })
}

pub(super) fn settings<'a>() -> Settings<'a> {
    Settings {
        samples: 200,
        ..Settings::new(2.0, 2.0, 1.0)
    }
}

/// The loop with a synthesizer that gives the same pattern whatever it is asked.
pub(super) fn run(surface: &VoxelSurface, solid: &[bool], settings: &Settings) -> Structure {
    let graph = SurfaceGraph::new(surface);
    let kept = vec![false; graph.len()];
    structure(
        &graph,
        (solid.to_vec(), &kept),
        settings,
        |_| (),
        |_| solid.to_vec(),
    )
    .unwrap()
}

/// One piece through faces for each part of the surface, and all that was forced in it.
fn check(surface: &VoxelSurface, found: &Structure, name: &str) {
    let graph = SurfaceGraph::new(surface);
    let parts = Pieces::of(&graph, Touch::Corner, |_| true).len();
    assert_eq!(
        shapes::count(&graph, &found.solid, Touch::Face),
        parts,
        "{name}"
    );
    assert!(found.unjoined.is_empty() && found.bare.is_empty(), "{name}");
    assert!(
        found
            .forced
            .iter()
            .zip(&found.solid)
            .all(|(forced, solid)| *solid || !forced)
    );
}

/// Patterns of three kinds; the last one hangs together nowhere.
fn patterns(surface: &VoxelSurface) -> Vec<(String, Vec<bool>)> {
    let dots = (0..5).map(|case| {
        let seed = Seed::root(case as u64);
        let dots = shapes::dots(surface, 30 + 60 * case, 2.0 + 0.5 * case as f64, seed);
        (format!("dots {case}"), dots)
    });
    let stripes = (0..4).map(|case| {
        let seed = Seed::root(100 + case);
        let normal = [0, 1, 2].map(|k| seed.range(k, -1.0, 1.0));
        let normal = Point3::from(normal).unit().unwrap();
        let stripes = shapes::stripes(surface, normal, 5.0 + 2.0 * case as f64);
        (format!("stripes {case}"), stripes)
    });
    let islands = shapes::islands(surface, 7.0);
    dots.chain(stripes)
        .chain([("islands".to_owned(), islands)])
        .collect()
}

#[test]
fn thirty_patterns_become_one_piece() {
    let surfaces = [
        shapes::plane(90, 60),
        shapes::sphere(18.0),
        shapes::torus(17.0, 7.0),
    ];
    let profile = Profile {
        supports: vec![Box::new(|p| p.z < 5.0)],
        ..standing(0.0)
    };
    for (shape, surface) in surfaces.iter().enumerate() {
        for (case, (name, solid)) in patterns(surface).into_iter().enumerate() {
            let profile = Some(&profile).filter(|_| case % 2 == 0);
            let settings = Settings {
                profile,
                ..settings()
            };
            let found = run(surface, &solid, &settings);
            check(surface, &found, &format!("{shape}, {name}"));
            assert!(found.done, "{shape}, {name}");
            assert_eq!(found.plain, 0, "{shape}, {name}");
        }
    }
}

#[test]
fn islands_are_joined_though_no_round_is_left() {
    let surface = shapes::sphere(18.0);
    let solid = shapes::islands(&surface, 6.0);
    let graph = SurfaceGraph::new(&surface);
    let pieces = shapes::count(&graph, &solid, Touch::Corner);
    let settings = Settings {
        max_iterations: 0,
        least_piece: 0,
        ..settings()
    };
    let found = run(&surface, &solid, &settings);
    check(&surface, &found, "islands");
    assert!(!found.done && found.bridges.connection == pieces - 1);
}

/// What a synthesizer takes away again is joined by plain bridges.
#[test]
fn a_stubborn_synthesizer_does_not_break_the_piece() {
    let surface = shapes::plane(60, 60);
    let solid = shapes::islands(&surface, 8.0);
    let graph = SurfaceGraph::new(&surface);
    let kept = vec![false; graph.len()];
    let mut turn = 0;
    let settings = Settings {
        max_iterations: 3,
        ..settings()
    };
    let found = structure(
        &graph,
        (solid, &kept),
        &settings,
        |_| (),
        |_| {
            turn += 1;
            shapes::dots(&surface, 25, 3.0, Seed::root(turn))
        },
    );
    let found = found.unwrap();
    check(&surface, &found, "dots");
    assert!((1..=3).contains(&found.iterations));
}

#[test]
fn parts_of_a_surface_stay_parts() {
    let two = [shapes::plane(30, 30), shapes::plane(30, 30)];
    let mut cells = Vec::new();
    for (part, surface) in two.iter().enumerate() {
        let up = Point3::new(0.0, 0.0, 1.0);
        let moved = |cell: &[u16; 3]| ([cell[0], cell[1], cell[2] + 12 * part as u16], up);
        cells.extend(surface.voxels.cells.iter().map(moved));
    }
    let surface = shapes::surface(cells);
    let solid = shapes::islands(&surface, 6.0);
    check(&surface, &run(&surface, &solid, &settings()), "two planes");
    let lower = shapes::pattern(&surface, |p| p.z < 5.0 && p.x < 20.0);
    let found = run(&surface, &lower, &settings());
    assert_eq!(found.bare, [[0, 0, 15]]);
    assert!(found.done && found.solid == lower);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let surface = shapes::sphere(20.0);
    let solid = shapes::dots(&surface, 90, 3.0, Seed::root(6));
    let profile = Profile {
        max_stress: Some(2e3),
        ..standing(6.0)
    };
    let settings = Settings {
        profile: Some(&profile),
        geodesic_limit: Some(1.0),
        ..settings()
    };
    let found = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| run(&surface, &solid, &settings))
    });
    assert!(found[0].bridges.connection > 0);
    assert!(found[0] == found[1] && found[0] == found[2]);
}

#[test]
fn nothing_at_all_is_no_error() {
    let empty = shapes::surface(Vec::new());
    assert!(run(&empty, &[], &settings()).done);
    let surface = shapes::plane(5, 5);
    let found = run(&surface, &[false; 25], &settings());
    assert!(found.done && found.bare == [[0, 0, 3]]);
    let profile = standing(9.0);
    let held = Settings {
        profile: Some(&profile),
        geodesic_limit: Some(1.0),
        ..settings()
    };
    let mut one = [false; 25];
    one[7] = true;
    let found = run(&surface, &one, &held);
    assert!(found.done && found.solid == one);
    assert!(run(&surface, &[false; 25], &held).done);
    check(&surface, &run(&surface, &[true; 25], &held), "full");
}

/// A small foot that no sample lies in holds the body all the same.
#[test]
fn a_support_smaller_than_a_pad_holds() {
    let surface = shapes::sphere(24.0);
    let graph = SurfaceGraph::new(&surface);
    let foot = graph.center(graph.len() as u32 / 2);
    let supports: Vec<super::super::Zone> = vec![Box::new(move |p| p.distance(foot) < 1.1)];
    let profile = Profile {
        supports,
        max_stress: Some(1e9),
        ..standing(0.0)
    };
    let settings = Settings {
        samples: 60,
        profile: Some(&profile),
        ..settings()
    };
    let all = vec![true; graph.len()];
    let found = round(&graph, &all, &all, &settings).unwrap();
    assert!(found.holds && found.max_stress.unwrap() > 0.0, "{found:?}");
}
