//! The scores of the loop beside the full analysis of the finished body: its edges are to be ranked as the stress in
//! them is, since the loop adds what is strained most.

use fretwork_geometry::voxel::Voxels;
use fretwork_geometry::{Mesh, Point3, Seed, Side};

use super::super::discretize::Detail;
use super::super::structure::structure;
use super::super::{Profile, Settings};
use super::case::{Case, case, standing};
use super::elements::PLASTIC;
use super::models::rank_correlation;
use crate::analyse::{self, Body, Load};
use crate::connect::SurfaceGraph;
use crate::connect::tests::shapes::dots;
use crate::finish::{Thickness, finish};
use crate::voxelize::tests::shapes;
use crate::voxelize::voxelize;

/// How far from the middle of an edge the stress belongs to it, in millimetres: as far as the body is thick.
const NEAR: f64 = 2.0;

/// The mean of |σ1| + |σ2| + |σ3| in the body near the middle of each solid edge, and the edge's score.
fn beside(mesh: &Mesh, profile: &Profile, seed: u64) -> Vec<[f64; 2]> {
    let surface = voxelize(mesh, 1.0).unwrap();
    let graph = SurfaceGraph::new(&surface);
    let solid = dots(&surface, 150, 4.0, Seed::root(seed));
    let settings = Settings::new(3.0, 2.0, 1.0);
    let kept = vec![false; graph.len()];
    let again = |forced: &[bool]| (0..forced.len()).map(|v| solid[v] || forced[v]).collect();
    let start = (solid.clone(), &kept[..]);
    let solid = structure(&graph, start, &settings, |_| {}, again)
        .unwrap()
        .solid;
    let thickness = Thickness {
        thickness: 2.0,
        side: Side::Center,
    };
    let body = finish(mesh, &surface, &solid, thickness).unwrap().voxels;
    let sums = full(&body, profile);
    let case = case(&surface, &solid, 200, profile);
    let scores = case.scores(profile, Detail::Full);
    let pairs = middles(&case, &graph).zip(scores).filter_map(|(p, score)| {
        let stress = near(&body, &sums, p?)?;
        Some([stress, score])
    });
    pairs.collect()
}

/// The middle of each edge of the pattern; none of empty ones.
fn middles<'a>(
    case: &'a Case,
    graph: &'a SurfaceGraph<'a>,
) -> impl Iterator<Item = Option<Point3>> + 'a {
    let middle = |path: &[u32]| graph.center(path[path.len() / 2]);
    let edges = case.abstracted.edges.iter();
    edges.map(move |edge| edge.is_solid.then(|| middle(&edge.path)))
}

/// The sums of the principal stresses of the body's voxels, by the full analysis.
fn full(voxels: &Voxels, profile: &Profile) -> Vec<f64> {
    let body = Body {
        voxels,
        metres_per_unit: 1e-3,
    };
    let held = |p: Point3| profile.supports.iter().any(|zone| zone(p));
    let load = |load: &super::super::Load| Load {
        at: &|_| false,
        force: [load.force.x, load.force.y, load.force.z],
    };
    let mut loads: Vec<Load> = profile.loads.iter().map(load).collect();
    for (of, load) in profile.loads.iter().zip(&mut loads) {
        load.at = &*of.zone;
    }
    let gravity = [profile.gravity.x, profile.gravity.y, profile.gravity.z];
    let case = analyse::Case { gravity, loads };
    let found = analyse::analyse(&body, &PLASTIC, &held, &[case]).unwrap();
    found.into_iter().next().unwrap().stress_sums
}

/// The mean of `sums` about a place; none where there is no voxel.
fn near(body: &Voxels, sums: &[f64], p: Point3) -> Option<f64> {
    let at = |cell: &_| body.lattice.center(*cell);
    let cells = body.cells.iter().zip(sums);
    let (sum, count) = cells
        .filter(|(cell, _)| at(cell).distance(p) < NEAR)
        .fold((0.0, 0), |(sum, count), (_, s)| (sum + s, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[test]
fn edges_are_ranked_as_the_full_analysis_ranks_them() {
    let sphere = shapes::sphere(20.0, 48);
    let torus = shapes::torus(20.0, 8.0, 48);
    for (name, mesh) in [("sphere", &sphere), ("torus", &torus)] {
        let low = mesh.bounds().min.z + 3.0;
        for seed in 1..=3 {
            let profile = standing(low);
            let pairs = beside(mesh, &profile, seed);
            let [full, scores] = [0, 1].map(|k| pairs.iter().map(|p| p[k]).collect::<Vec<f64>>());
            let correlation = rank_correlation(&full, &scores);
            println!("{name} {seed}: {correlation:.3} over {} edges", full.len());
            assert!(correlation > 0.5, "{name} {seed}: {correlation}");
        }
    }
}
