//! Figures by hand: `cargo test --release -- --ignored --nocapture --test-threads 1 speed`.

use std::time::{Duration, Instant};

use fretwork_geometry::Seed;
use nalgebra_sparse::{CooMatrix, CscMatrix};

use super::super::discretize::Detail;
use super::super::model::{Model, Parts};
use super::super::profile::Profile;
use super::super::system::FIXED;
use super::super::{Settings, structure};
use super::case::{case, standing};
use crate::connect::SurfaceGraph;
use crate::connect::tests::shapes;

#[test]
#[ignore = "a measurement"]
fn a_step_takes_at_most_twice_the_assembly() {
    let surface = shapes::sphere(60.0);
    let solid = shapes::dots(&surface, 1500, 4.0, Seed::root(1));
    let profile = standing(14.0);
    let case = case(&surface, &solid, 1000, &profile);
    for detail in [Detail::Rigid, Detail::Full] {
        let parts = || Parts::new(&case.frame, &case.forces, &profile, &case.solid, detail);
        let own = parts();
        let mut model = Model::new(parts()).unwrap();
        let (mut assembly, mut step) = (Duration::MAX, Duration::MAX);
        for _ in 0..8 {
            let begin = Instant::now();
            assert!(triplets(&own).nnz() > own.unknowns());
            assembly = assembly.min(begin.elapsed());
            let begin = Instant::now();
            model.scores(&case.solid).unwrap();
            step = step.min(begin.elapsed());
        }
        let size = [
            case.abstracted.samples.len(),
            case.solid.len(),
            own.unknowns(),
        ];
        eprintln!("{detail:?} {size:?}: assembly {assembly:.1?}, step {step:.1?}");
        assert!(detail == Detail::Rigid || step < 2 * assembly);
    }
}

/// The whole matrix from triplets, as it is assembled where nothing is kept from one solution to the next.
fn triplets(parts: &Parts) -> CscMatrix<f64> {
    let mut triplets = CooMatrix::new(parts.unknowns(), parts.unknowns());
    for member in parts.stay.iter().chain(&parts.change) {
        let moving = member.unknowns.iter().enumerate();
        let moving = moving.filter(|(_, unknown)| **unknown != FIXED);
        for (j, column) in moving.clone() {
            for (i, row) in moving.clone() {
                let value = member.stiffness[(i, j)];
                triplets.push(*row as usize, *column as usize, value);
            }
        }
    }
    CscMatrix::from(&triplets)
}

#[test]
#[ignore = "a measurement"]
fn a_large_surface_takes_a_few_seconds() {
    let surface = shapes::sphere(61.0);
    let dots = shapes::dots(&surface, 1300, 4.0, Seed::root(1));
    for (name, solid) in [("dots", dots), ("islands", shapes::islands(&surface, 9.0))] {
        let profile = Profile {
            max_stress: Some(3e4),
            ..standing(14.0)
        };
        let settings = Settings {
            profile: Some(&profile),
            geodesic_limit: Some(1.5),
            ..Settings::new(2.0, 2.0, 1.0)
        };
        let begin = Instant::now();
        let graph = SurfaceGraph::new(&surface);
        eprintln!(
            "{name}: {} voxels, graph {:.1?}",
            graph.len(),
            begin.elapsed()
        );
        let kept = vec![false; graph.len()];
        let mut last = Instant::now();
        let watch = |round: &super::super::Round| {
            let (size, bridges) = (round.size, round.bridges);
            eprintln!(
                "  {size:?} {bridges:?} {:?} {:.1?}",
                round.max_stress,
                last.elapsed()
            );
            last = Instant::now();
        };
        let again = |_: &[bool]| solid.clone();
        let found = structure(&graph, (solid.clone(), &kept), &settings, watch, again).unwrap();
        eprintln!("  {} iterations, {:.1?}", found.iterations, begin.elapsed());
    }
}
