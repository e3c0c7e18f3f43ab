//! Local syntheses, and voxels that must be solid.

use super::*;
use crate::synthesize::region;

/// Every fortieth of the voxels that are empty.
fn bridges(pattern: &Pattern) -> Vec<bool> {
    let mut count = 0;
    let chosen = |solid: &bool| {
        count += usize::from(!solid);
        !solid && count % 40 == 0
    };
    pattern.solid.iter().map(chosen).collect()
}

#[test]
fn forced_voxels_become_solid_and_the_rest_stays() {
    let levels = sphere();
    for exemplar in [exemplars::hooks(), exemplars::dots(), exemplars::keys()] {
        let options = Options::default();
        let synthesizer = Synthesizer::new(&levels, &exemplar, &options).unwrap();
        let first = synthesizer.synthesize();
        let forced = bridges(&first);
        let next = synthesizer.resynthesize(&first, &forced).unwrap();
        let problem = synthesizer.problem(0, &forced);
        let region = &region::below(&levels, &forced, synthesizer.back)[0];
        let mut changed = 0;
        for voxel in 0..forced.len() {
            assert!(!forced[voxel] || next.solid[voxel]);
            assert!(
                problem.allows(voxel, next.labels[0][voxel]),
                "solid by force alone"
            );
            let is_same = first.labels[0][voxel] == next.labels[0][voxel]
                && first.solid[voxel] == next.solid[voxel]
                && first.colors[voxel] == next.colors[voxel];
            assert!(region[voxel] || is_same);
            changed += usize::from(!is_same);
        }
        let forced_count = forced.iter().filter(|f| **f).count();
        assert!(changed > forced_count, "{changed} {forced_count}");
    }
}

#[test]
fn what_is_solid_already_changes_nothing() {
    let levels = sphere();
    let exemplar = exemplars::stripes();
    let options = Options::default();
    let synthesizer = Synthesizer::new(&levels, &exemplar, &options).unwrap();
    let first = synthesizer.synthesize();
    assert_eq!(
        synthesizer.resynthesize(&first, &first.solid).unwrap(),
        first
    );
    let forced = bridges(&first);
    let next = synthesizer.resynthesize(&first, &forced).unwrap();
    assert_eq!(synthesizer.resynthesize(&next, &forced).unwrap(), next);
}

#[test]
fn kept_voxels_are_solid_and_remain_so() {
    let levels = sphere();
    let cells = &levels[0].surface.voxels.cells;
    let lowest = cells.iter().map(|cell| cell[2]).min().unwrap();
    let keep: Vec<bool> = cells.iter().map(|cell| cell[2] < lowest + 6).collect();
    let options = Options {
        keep: keep.clone(),
        ..Options::default()
    };
    let exemplar = exemplars::hooks();
    let synthesizer = Synthesizer::new(&levels, &exemplar, &options).unwrap();
    let first = synthesizer.synthesize();
    let next = synthesizer.resynthesize(&first, &bridges(&first)).unwrap();
    for pattern in [&first, &next] {
        assert!((0..keep.len()).all(|v| !keep[v] || pattern.solid[v]));
    }
    let rest = (0..keep.len()).filter(|&v| !keep[v]);
    let solid = rest.clone().filter(|&v| first.solid[v]).count() as f64;
    let fraction = solid / rest.count() as f64;
    assert!(
        (fraction - exemplar.solid_fraction()).abs() < 0.1,
        "{fraction}"
    );
}

#[test]
fn local_syntheses_go_back_as_far_as_features_are_wide() {
    assert_eq!(region::levels_back(0.0, 5), 1);
    assert_eq!(region::levels_back(4.0, 5), 2);
    assert_eq!(region::levels_back(7.0, 5), 3);
    assert_eq!(region::levels_back(500.0, 5), 4);
    assert_eq!(region::levels_back(4.0, 1), 0);
}
