//! Shortest paths from many voxels at once (Dijkstra 1959). Where the voxels come from, and what is
//! made of the paths, is not known here.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::surface_graph::{SurfaceGraph, Touch, UNIT};

/// The owner of a voxel that no path reaches, and the parent of a root.
pub const NOBODY: u32 = u32::MAX;

/// For each voxel the nearest root and the way to it.
#[derive(Clone, Debug)]
pub struct Forest {
    /// The number of the root whose tree a voxel belongs to, in the order in which roots were given.
    pub owners: Vec<u32>,
    /// The distance to that root, in [`UNIT`]s; the greatest number where there is none.
    pub distances: Vec<u32>,
    /// The next voxel on the way to the root; [`NOBODY`] for roots and for what is not reached.
    pub parents: Vec<u32>,
    queue: BinaryHeap<Reverse<u64>>,
}

/// A voxel at a distance, in the order of distances and then of voxels: one number, which is compared at once.
fn queued(distance: u32, v: u32) -> Reverse<u64> {
    Reverse(u64::from(distance) << 32 | u64::from(v))
}

impl Forest {
    /// A forest without trees over `len` voxels.
    pub fn new(len: usize) -> Forest {
        Forest {
            owners: vec![NOBODY; len],
            distances: vec![u32::MAX; len],
            parents: vec![NOBODY; len],
            queue: BinaryHeap::new(),
        }
    }

    /// Makes `v` a root, or a part of a tree, at no distance; where paths to it were known they are forgotten.
    pub fn plant(&mut self, v: u32, owner: u32) {
        self.plant_at(v, owner, 0);
    }

    /// Makes `v` a part of a tree at some distance from its root, which is not a voxel itself.
    pub fn plant_at(&mut self, v: u32, owner: u32, distance: u32) {
        self.owners[v as usize] = owner;
        self.distances[v as usize] = distance;
        self.parents[v as usize] = NOBODY;
        self.queue.push(queued(distance, v));
    }

    /// Lets all that is reached be a start again, so that the trees can grow into more voxels.
    pub fn wake(&mut self) {
        let reached = (0u32..)
            .zip(&self.distances)
            .filter(|(_, d)| **d != u32::MAX);
        self.queue.extend(reached.map(|(v, d)| queued(*d, v)));
    }

    /// Grows all trees, through voxels that touch so closely and that `enter` allows, up to the distance
    /// `limit`. Between two roots at the same distance the one found first keeps the voxel; the order
    /// is that of distances and then of voxels.
    pub fn grow(
        &mut self,
        graph: &SurfaceGraph,
        touch: Touch,
        limit: u32,
        enter: impl Fn(u32) -> bool,
    ) {
        while let Some(Reverse(key)) = self.queue.pop() {
            let (distance, v) = ((key >> 32) as u32, key as u32);
            if distance > self.distances[v as usize] {
                continue;
            }
            for &w in graph.neighbours(v) {
                let step = graph.step(v, w);
                let there = distance.saturating_add(step);
                let is_shorter = there < self.distances[w as usize] && there <= limit;
                let touches = touch == Touch::Corner || step == UNIT;
                if is_shorter && touches && enter(w) {
                    self.distances[w as usize] = there;
                    self.owners[w as usize] = self.owners[v as usize];
                    self.parents[w as usize] = v;
                    self.queue.push(queued(there, w));
                }
            }
        }
    }

    /// The voxels from `v` to its root, both included.
    pub fn way(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        let next = |v: &u32| Some(self.parents[*v as usize]).filter(|p| *p != NOBODY);
        std::iter::successors(Some(v), next)
    }
}
