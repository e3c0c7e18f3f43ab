//! The abstract graph of a pattern: samples, and which of them are neighbours through solid voxels or
//! across a gap (Dumas 2015, 5.1, Algorithm 5). Stresses and decisions live in `reinforce`.

use super::forest::{Forest, NOBODY};
use super::surface_graph::{SurfaceGraph, Touch, UNIT};

/// Two samples whose trees touch.
#[derive(Clone, Debug, PartialEq)]
pub struct AbstractEdge {
    /// The numbers of the samples, the smaller one first.
    pub ends: [u32; 2],
    /// Whether the trees touch in solid voxels.
    pub is_solid: bool,
    /// The length of the path between the samples, in pitches.
    pub length: f64,
    /// How many voxels the line has along which the trees touch: the pattern's width there.
    pub width: f64,
    /// The voxels from the first sample to the second, both included.
    pub path: Vec<u32>,
}

/// Samples of the solid voxels and the edges between them.
#[derive(Clone, Debug, PartialEq)]
pub struct AbstractGraph {
    /// The voxels of the samples.
    pub samples: Vec<u32>,
    /// The edges: the solid ones, then the empty ones, each by their ends.
    pub edges: Vec<AbstractEdge>,
    /// The sample whose tree each voxel of the surface belongs to; [`NOBODY`] in parts of the surface
    /// that hold no solid voxel.
    pub owners: Vec<u32>,
}

/// A pair of voxels that touch and belong to two trees.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Crossing {
    ends: [u32; 2],
    length: u32,
    voxels: [u32; 2],
}

impl AbstractGraph {
    /// Connects `samples`, which are solid voxels, at least one in every piece.
    ///
    /// The trees of the solid voxels stay as they are while they grow on into empty ones, as the paper
    /// has it: an empty edge then crosses a gap and does not follow it.
    pub fn new(graph: &SurfaceGraph, solid: &[bool], samples: Vec<u32>) -> AbstractGraph {
        let mut forest = Forest::new(graph.len());
        for (owner, &v) in (0u32..).zip(&samples) {
            forest.plant(v, owner);
        }
        forest.grow(graph, Touch::Corner, u32::MAX, |w| solid[w as usize]);
        let mut edges = edges_between(graph, &forest, true, |_| true);
        forest.wake();
        forest.grow(graph, Touch::Corner, u32::MAX, |w| !solid[w as usize]);
        let joined: Vec<[u32; 2]> = edges.iter().map(|edge| edge.ends).collect();
        let is_new = |ends: [u32; 2]| joined.binary_search(&ends).is_err();
        edges.extend(edges_between(graph, &forest, false, is_new));
        AbstractGraph {
            samples,
            edges,
            owners: forest.owners,
        }
    }
}

/// The edges between trees that touch, for the pairs that `wanted` tells.
fn edges_between(
    graph: &SurfaceGraph,
    forest: &Forest,
    is_solid: bool,
    wanted: impl Fn([u32; 2]) -> bool,
) -> Vec<AbstractEdge> {
    let mut crossings = crossings(graph, forest);
    crossings.retain(|crossing| wanted(crossing.ends));
    crossings.sort_unstable();
    let groups = crossings.chunk_by(|a, b| a.ends == b.ends);
    groups
        .map(|group| {
            let [first, second] = group[0].voxels;
            let mut path: Vec<u32> = forest.way(first).collect();
            path.reverse();
            path.extend(forest.way(second));
            AbstractEdge {
                ends: group[0].ends,
                is_solid,
                length: f64::from(group[0].length) / f64::from(UNIT),
                width: (side(group, 0) + side(group, 1)) / 2.0,
                path,
            }
        })
        .collect()
}

/// Where trees touch: every pair of voxels once, with the length of the path through it.
fn crossings(graph: &SurfaceGraph, forest: &Forest) -> Vec<Crossing> {
    let mut crossings = Vec::new();
    for v in 0..graph.len() as u32 {
        let owner = forest.owners[v as usize];
        let before = graph.neighbours(v).iter().take_while(|w| **w < v);
        for &w in before {
            let other = forest.owners[w as usize];
            if owner == other || owner == NOBODY || other == NOBODY {
                continue;
            }
            let (ends, voxels) = if owner < other {
                ([owner, other], [v, w])
            } else {
                ([other, owner], [w, v])
            };
            let ways = forest.distances[v as usize].saturating_add(forest.distances[w as usize]);
            crossings.push(Crossing {
                ends,
                length: ways.saturating_add(graph.step(v, w)),
                voxels,
            });
        }
    }
    crossings
}

/// How many voxels of one tree touch the other.
fn side(group: &[Crossing], side: usize) -> f64 {
    let mut voxels: Vec<u32> = group.iter().map(|crossing| crossing.voxels[side]).collect();
    voxels.sort_unstable();
    voxels.dedup();
    voxels.len() as f64
}
