//! Tests of the graphs, each beside a slow way to the same result.

pub(crate) mod shapes;

use fretwork_geometry::{Point3, Seed};

use super::forest::{Forest, NOBODY};
use super::*;
use shapes::{count, dots, plane, sphere, torus};

/// All pairs of shortest paths by relaxing everything until nothing changes.
fn distances(graph: &SurfaceGraph, starts: &[u32], enter: impl Fn(u32) -> bool) -> Vec<u32> {
    let mut distances = vec![u32::MAX; graph.len()];
    starts.iter().for_each(|v| distances[*v as usize] = 0);
    let mut has_changed = true;
    while has_changed {
        has_changed = false;
        for v in 0..graph.len() as u32 {
            for &w in graph.neighbours(v) {
                let there = distances[v as usize].saturating_add(graph.step(v, w));
                if enter(w) && there < distances[w as usize] {
                    distances[w as usize] = there;
                    has_changed = true;
                }
            }
        }
    }
    distances
}

#[test]
fn neighbours_are_the_voxels_that_touch() {
    let cells = (0..400u64).map(|n| {
        let axis = |k| (Seed::root(5).unit(3 * n + k) * 9.0) as u16;
        ([axis(0), axis(1), axis(2)], Point3::new(0.0, 0.0, 1.0))
    });
    let mut cells: Vec<_> = cells.collect();
    cells.sort_by_key(|(cell, _)| *cell);
    cells.dedup_by_key(|(cell, _)| *cell);
    let surface = shapes::surface(cells);
    let graph = SurfaceGraph::new(&surface);
    for v in 0..graph.len() as u32 {
        let apart = |w: u32, k: usize| graph.cell(v)[k].abs_diff(graph.cell(w)[k]);
        let touches = |w: &u32| *w != v && (0..3).all(|k| apart(*w, k) <= 1);
        let near: Vec<u32> = (0..graph.len() as u32).filter(touches).collect();
        assert_eq!(graph.neighbours(v), near);
        for w in near {
            let exact = graph.center(v).distance(graph.center(w));
            let step = f64::from(graph.step(v, w)) / f64::from(UNIT);
            assert!((step - exact).abs() <= 0.5 / f64::from(UNIT));
            let is_face = graph.touching(v, Touch::Face).any(|face| face == w);
            assert_eq!(is_face, exact < 1.1);
        }
    }
}

#[test]
fn areas_of_voxels_add_up_to_the_surface() {
    let surface = sphere(20.0);
    let graph = SurfaceGraph::new(&surface);
    let area: f64 = (0..graph.len() as u32).map(|v| graph.area(v)).sum();
    let exact = 4.0 * std::f64::consts::PI * 400.0;
    assert!((area / exact - 1.0).abs() < 0.02, "{area} for {exact}");
}

#[test]
fn trees_hold_shortest_paths() {
    let surface = plane(24, 17);
    let graph = SurfaceGraph::new(&surface);
    let solid = dots(&surface, 22, 2.6, Seed::root(3));
    let samples = sample(&graph, &solid, 14, Seed::root(0));
    let mut forest = Forest::new(graph.len());
    for (owner, v) in (0..).zip(&samples) {
        forest.plant(*v, owner);
    }
    forest.grow(&graph, Touch::Corner, u32::MAX, |w| solid[w as usize]);
    assert_eq!(
        forest.distances,
        distances(&graph, &samples, |w| solid[w as usize])
    );
    for v in 0..graph.len() as u32 {
        let way: Vec<u32> = forest.way(v).collect();
        let length: u32 = way.windows(2).map(|w| graph.step(w[0], w[1])).sum();
        let root = way[way.len() - 1];
        if forest.owners[v as usize] == NOBODY {
            assert!(!solid[v as usize]);
        } else {
            assert_eq!(length, forest.distances[v as usize]);
            assert_eq!(samples[forest.owners[v as usize] as usize], root);
        }
    }
}

#[test]
fn samples_keep_their_distance_and_leave_no_voxel_out() {
    let surface = torus(13.0, 6.0);
    let graph = SurfaceGraph::new(&surface);
    let solid = dots(&surface, 60, 3.5, Seed::root(8));
    let order: Vec<u32> = (0..graph.len() as u32)
        .filter(|v| solid[*v as usize])
        .collect();
    let radius = 5 * UNIT;
    let samples = sample_at(&graph, &solid, &order, radius, usize::MAX);
    for (k, v) in samples.iter().enumerate() {
        let far = distances(&graph, &[*v], |w| solid[w as usize]);
        let others = samples.iter().enumerate().filter(|(other, _)| *other != k);
        others.for_each(|(_, w)| assert!(far[*w as usize] > radius));
    }
    let nearest = distances(&graph, &samples, |w| solid[w as usize]);
    order
        .iter()
        .for_each(|v| assert!(nearest[*v as usize] <= radius));
}

#[test]
fn about_as_many_samples_as_asked_for_and_one_for_each_piece() {
    let surface = sphere(32.0);
    let graph = SurfaceGraph::new(&surface);
    let all = vec![true; graph.len()];
    let samples = sample(&graph, &all, 500, Seed::root(0)).len();
    assert!((450..=550).contains(&samples), "{samples}");
    let tiny = shapes::islands(&surface, 5.0);
    let pieces = Pieces::of(&graph, Touch::Corner, |v| tiny[v as usize]);
    assert!(pieces.len() > 200);
    let mut hit = vec![0; pieces.len()];
    for v in sample(&graph, &tiny, 50, Seed::root(0)) {
        hit[pieces.of[v as usize] as usize] += 1;
    }
    assert!(hit.iter().all(|n| *n >= 1));
    assert!(sample(&graph, &vec![false; graph.len()], 50, Seed::root(0)).is_empty());
}

#[test]
fn solid_edges_hold_together_what_the_pattern_does() {
    let surface = sphere(16.0);
    let graph = SurfaceGraph::new(&surface);
    for case in 0..6 {
        let solid = dots(&surface, 40 + 20 * case, 3.0, Seed::root(case as u64));
        let samples = sample(&graph, &solid, 80, Seed::root(0));
        let abstracted = AbstractGraph::new(&graph, &solid, samples.clone());
        let mut sets = fretwork_geometry::numeric::UnionFind::new(samples.len());
        let is_solid = |edge: &&AbstractEdge| edge.is_solid;
        for edge in abstracted.edges.iter().filter(is_solid) {
            sets.unite(edge.ends[0], edge.ends[1]);
        }
        assert_eq!(sets.count(), count(&graph, &solid, Touch::Corner));
        for edge in abstracted.edges.iter().filter(|edge| !edge.is_solid) {
            sets.unite(edge.ends[0], edge.ends[1]);
        }
        assert_eq!(sets.count(), 1);
        check_paths(&graph, &solid, &abstracted);
    }
}

/// Paths lead from end to end, through empty voxels just where an edge is empty.
fn check_paths(graph: &SurfaceGraph, solid: &[bool], abstracted: &AbstractGraph) {
    for edge in &abstracted.edges {
        let ends = edge.ends.map(|end| abstracted.samples[end as usize]);
        assert_eq!([edge.path[0], edge.path[edge.path.len() - 1]], ends);
        let length: u32 = edge.path.windows(2).map(|w| graph.step(w[0], w[1])).sum();
        assert_eq!(f64::from(length) / f64::from(UNIT), edge.length);
        assert!(
            edge.path
                .windows(2)
                .all(|w| graph.neighbours(w[0]).contains(&w[1]))
        );
        assert_eq!(edge.path.iter().all(|v| solid[*v as usize]), edge.is_solid);
    }
}

#[test]
fn a_bridge_is_as_wide_as_a_feature_and_no_longer_than_its_gap() {
    let surface = plane(40, 21);
    let graph = SurfaceGraph::new(&surface);
    let solid = shapes::pattern(&surface, |p| !(15.0..25.0).contains(&p.x));
    let path: Vec<u32> = (5..35)
        .map(|x| graph.surface.voxels.find([x, 10, 3]).unwrap() as u32)
        .collect();
    let wide = widen(&graph, &solid, &[path], 3.0);
    let at = |x: u16, y: u16| wide[graph.surface.voxels.find([x, y, 3]).unwrap()];
    assert!((15..25).all(|x| at(x, 7) && at(x, 13) && !at(x, 6) && !at(x, 14)));
    assert!(at(11, 10) && !at(10, 10) && !at(30, 10));
}

#[test]
fn corners_are_filled_by_the_fewest_voxels() {
    let surface = plane(9, 9);
    let graph = SurfaceGraph::new(&surface);
    let solid = shapes::pattern(&surface, |p| (p.x < 4.0) == (p.y < 4.0));
    assert_eq!(count(&graph, &solid, Touch::Corner), 1);
    assert!(join_through_corners(&graph, &solid).is_empty());
    let paths = join_through_faces(&graph, &solid);
    let filled: Vec<&u32> = paths
        .iter()
        .flatten()
        .filter(|v| !solid[**v as usize])
        .collect();
    assert_eq!(filled.len(), 1);
}

#[test]
fn specks_are_small_unwanted_and_not_all_there_is() {
    let surface = plane(30, 10);
    let graph = SurfaceGraph::new(&surface);
    let solid = shapes::pattern(&surface, |p| {
        p.x < 4.0 || [9.5, 19.5].contains(&p.x) && p.y < 2.0
    });
    let all = Pieces::of(&graph, Touch::Corner, |_| true);
    let count = |kept: &[bool], least| {
        let specks = specks(&graph, &all, &solid, kept, least);
        specks.into_iter().filter(|speck| *speck).count()
    };
    let none = vec![false; graph.len()];
    assert_eq!(count(&none, 3), 4);
    assert_eq!(count(&none, 2), 0);
    assert_eq!(count(&none, 1000), 4);
    let kept = shapes::pattern(&surface, |p| p.x == 9.5);
    assert_eq!(count(&kept, 3), 2);
}
