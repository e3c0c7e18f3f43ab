//! Figures by hand: `cargo test --release -- --ignored --nocapture --test-threads 1 speed`.

use std::time::Instant;

use fretwork_geometry::Seed;

use super::super::profile::Profile;
use super::super::{Settings, structure};
use super::case::standing;
use crate::connect::SurfaceGraph;
use crate::connect::tests::shapes;

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
