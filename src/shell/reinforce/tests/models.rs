//! The model of a pattern beside slower or fuller ones.

use fretwork_geometry::{Point3, Seed};
use nalgebra::{DMatrix, DVector};

use super::super::discretize::Detail;
use super::super::geodesic::shorten;
use super::super::profile::{Load, Profile};
use super::super::select::Selection;
use super::super::system::{FIXED, Member, System, assemble};
use super::case::{case, standing};
use super::elements::PLASTIC;
use crate::connect::tests::shapes::{dots, plane, sphere, surface, torus};
use crate::connect::{AbstractGraph, SurfaceGraph, sample};

/// Members on random unknowns, some of them held.
fn members(count: usize, unknowns: u64, seed: Seed) -> Vec<Member> {
    let member = |m: usize| {
        let draw = |n: u64| seed.number(m as i64).unit(n);
        let unknown = |n: u64| match (draw(n) * (unknowns + 3) as f64) as u64 {
            u if u < unknowns => u as u32,
            _ => FIXED,
        };
        let mut own: Vec<u32> = (0..6).map(unknown).collect();
        own.sort_unstable();
        own.dedup();
        let root = DMatrix::from_fn(own.len(), own.len(), |i, j| {
            draw(100 + (6 * i + j) as u64) - 0.5
        });
        Member {
            unknowns: own,
            stiffness: &root * root.transpose(),
        }
    };
    (0..count).map(member).collect()
}

#[test]
fn a_refill_is_an_assembly_from_triplets() {
    let stay = members(70, 40, Seed::root(1));
    let change = members(50, 40, Seed::root(2));
    let mut system = System::new(40, &stay, &change).unwrap();
    for round in 0..3 {
        let factors: Vec<f64> = (0..50).map(|n| Seed::root(9 + round).unit(n)).collect();
        system.refill(&factors);
        let all = stay
            .iter()
            .map(|m| (m, 1.0))
            .chain(change.iter().zip(factors));
        let slow = assemble(40, all);
        assert_eq!(slow.row_indices(), system.matrix().row_indices());
        for (a, b) in slow.values().iter().zip(system.matrix().values()) {
            assert!((a - b).abs() < 1e-12);
        }
        let load = DVector::from_fn(40, |i, _| 1.0 + i as f64);
        let lower = DMatrix::from(&slow);
        let dense = &lower + lower.transpose() - DMatrix::from_diagonal(&lower.diagonal());
        let exact = dense.cholesky().unwrap().solve(&load);
        assert!((system.solve(&load).unwrap() - &exact).norm() < 1e-9 * exact.norm());
    }
}

#[test]
fn the_unknown_that_nothing_holds_is_named() {
    let stiffness = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
    let spring = |a: u32, b: u32| Member {
        unknowns: vec![a, b],
        stiffness: stiffness.clone(),
    };
    let stay = [spring(0, FIXED), spring(0, 1), spring(2, 3)];
    let mut system = System::new(4, &stay, &[]).unwrap();
    system.refill(&[]);
    let loose = system.solve(&DVector::from_element(4, 1.0)).unwrap_err();
    assert!([2, 3].contains(&loose.unknown), "{loose:?}");
}

/// The rank correlation of two lists (Spearman 1904).
pub(super) fn rank_correlation(a: &[f64], b: &[f64]) -> f64 {
    let ranks = |list: &[f64]| {
        let mut order: Vec<usize> = (0..list.len()).collect();
        order.sort_by(|&i, &j| list[i].total_cmp(&list[j]));
        let mut ranks = vec![0.0; list.len()];
        (0..)
            .zip(order)
            .for_each(|(rank, i)| ranks[i] = f64::from(rank));
        ranks
    };
    let (a, b, n) = (ranks(a), ranks(b), a.len() as f64);
    let squares: f64 = a.iter().zip(&b).map(|(a, b)| (a - b) * (a - b)).sum();
    1.0 - 6.0 * squares / (n * (n * n - 1.0))
}

#[test]
fn rigid_pads_rank_edges_as_the_full_model_does() {
    for (surface, seed) in [(sphere(24.0), 1), (torus(20.0, 8.0), 2)] {
        let solid = dots(&surface, 150, 4.0, Seed::root(seed));
        let profile = standing(8.0);
        let case = case(&surface, &solid, 200, &profile);
        let quick = case.scores(&profile, Detail::Rigid);
        let full = case.scores(&profile, Detail::Full);
        assert!(full.iter().all(|s| s.is_finite()));
        let correlation = rank_correlation(&quick, &full);
        assert!(correlation > 0.9, "{correlation}");
    }
}

/// How the stresses along a bar 120 mm long and 20 mm wide compare to `exact` at their places, on average.
fn along_a_bar(profile: &Profile, detail: Detail, exact: impl Fn(f64) -> f64) -> f64 {
    let surface = plane(120, 20);
    let case = case(&surface, &vec![true; surface.voxels.len()], 150, profile);
    let scores = case.scores(profile, detail);
    let mut ratios = Vec::new();
    for (edge, score) in case.abstracted.edges.iter().zip(scores) {
        let cell = |v: u32| surface.voxels.cells[v as usize];
        let [a, b] = [edge.path[0], edge.path[edge.path.len() - 1]].map(cell);
        let middle = f64::from(a[0] + b[0] + 1) / 2.0;
        let is_along = a[0].abs_diff(b[0]) > 3 * a[1].abs_diff(b[1]);
        if is_along && (20.0..100.0).contains(&middle) {
            ratios.push(score / exact(middle));
        }
    }
    ratios.iter().sum::<f64>() / ratios.len() as f64
}

/// A bar that is pulled at its end has the stress of the force over its section, and one that hangs that of
/// the weight below; what crosses the bar takes some of it from what goes along.
#[test]
fn bars_that_are_pulled_and_that_hang_have_the_stresses_of_bars() {
    let held = || Profile {
        gravity: Point3::ORIGIN,
        supports: vec![Box::new(|p| p.x < 4.0)],
        ..standing(0.0)
    };
    let pull = Load {
        zone: Box::new(|p| p.x > 116.0),
        force: Point3::new(100.0, 0.0, 0.0),
    };
    let pulled = Profile {
        loads: vec![pull],
        ..held()
    };
    let hanging = Profile {
        gravity: Point3::new(9.81, 0.0, 0.0),
        ..held()
    };
    for detail in [Detail::Rigid, Detail::Full] {
        let ratio = along_a_bar(&pulled, detail, |_| 100.0 / (20e-3 * 2e-3));
        assert!((0.7..1.4).contains(&ratio), "{detail:?}: {ratio}");
        let weight = |x: f64| PLASTIC.density * 9.81 * (120.0 - x) * 1e-3;
        let ratio = along_a_bar(&hanging, detail, weight);
        assert!((0.7..1.4).contains(&ratio), "{detail:?}: {ratio}");
    }
}

/// What is short enough after the worst case, beside all ways at once (Floyd 1962).
#[test]
fn no_way_round_is_too_long_after_the_worst_case() {
    let surface = plane(64, 64);
    let solid = super::loops::spiral(&surface);
    let graph = SurfaceGraph::new(&surface);
    let samples = sample(&graph, &solid, 150, Seed::root(0));
    let abstracted = AbstractGraph::new(&graph, &solid, samples);
    let mut selection = Selection::new(&graph, &abstracted);
    let limit = 1.5 * graph.extent();
    let longest = |solid: &[bool]| {
        let n = abstracted.samples.len();
        let mut ways = DMatrix::from_element(n, n, f64::INFINITY);
        ways.fill_diagonal(0.0);
        for (edge, _) in abstracted
            .edges
            .iter()
            .zip(solid)
            .filter(|(_, solid)| **solid)
        {
            let [a, b] = edge.ends.map(|end| end as usize);
            ways[(a, b)] = edge.length;
            ways[(b, a)] = edge.length;
        }
        for k in 0..n {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                ways[(i, j)] = ways[(i, j)].min(ways[(i, k)] + ways[(k, j)]);
            }
        }
        let empty = abstracted
            .edges
            .iter()
            .zip(solid)
            .filter(|(_, solid)| !**solid);
        let way = |edge: [u32; 2]| ways[(edge[0] as usize, edge[1] as usize)];
        empty.map(|(edge, _)| way(edge.ends)).fold(0.0, f64::max)
    };
    let before = longest(&selection.solid);
    assert!(before > 2.0 * limit, "{before}");
    shorten(&abstracted, &mut selection, limit);
    assert!(longest(&selection.solid) <= limit);
    let added = selection.added.clone();
    assert!((1..30).contains(&added.len()), "{added:?}");
    let last = added[added.len() - 1];
    selection.solid[last] = false;
    assert!(
        longest(&selection.solid) > limit,
        "the last bridge was needed"
    );
}

/// A box has edges between whose pads beams are bent square, and a thick shell turns bricks inside out; a
/// sheet whose normals point to both sides has pads upside down.
#[test]
fn sharp_edges_thick_shells_and_turned_normals_stay_sound() {
    let side = |c: u16| {
        if c == 0 {
            -1.0
        } else {
            f64::from(u16::from(c == 29))
        }
    };
    let cells = (0..27000u16).map(|n| [n / 900, n / 30 % 30, n % 30]);
    let cells = cells.filter(|c| c.iter().any(|c| *c == 0 || *c == 29));
    let normal = |c: [u16; 3]| Point3::from(c.map(side)).unit().unwrap();
    let cube = surface(cells.map(|c| (c, normal(c))).collect());
    let mut sheet = plane(50, 30);
    let turn = |v: usize| if v.is_multiple_of(3) { -1.0 } else { 1.0 };
    (0..1500).for_each(|v| sheet.normals[v] = [0.0, 0.0, turn(v)]);
    let profile = Profile {
        supports: vec![Box::new(|p| p.x < 4.0)],
        ..standing(0.0)
    };
    for (body, name) in [(cube, "cube"), (sheet, "sheet")] {
        let solid = dots(&body, 120, 3.0, Seed::root(2));
        for thickness in [0.5e-3, 2e-3, 20e-3] {
            let mut case = case(&body, &solid, 120, &profile);
            case.thicken(&body, thickness);
            for detail in [Detail::Rigid, Detail::Full] {
                let scores = case.scores(&profile, detail);
                let is_sound = scores.iter().all(|s| s.is_finite() && *s >= 0.0);
                assert!(is_sound, "{name}, {thickness}, {detail:?}");
                assert!(scores.iter().any(|s| *s > 0.0));
            }
        }
    }
}
