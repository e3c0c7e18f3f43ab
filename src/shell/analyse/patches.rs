//! Patches: the nodes of a body in groups that lie close together inside of it.

use std::collections::VecDeque;

use super::mesh::{Mesh, NONE, corners};

/// A division of the free nodes into patches.
pub(super) struct Patches {
    /// The patch of each node, [`NONE`] of a clamped one.
    pub(super) of_node: Vec<u32>,
    /// Where the nodes of each patch begin in `members`, and where the last end.
    starts: Vec<usize>,
    members: Vec<u32>,
}

/// What has been found of a node so far.
#[derive(Clone, Copy)]
struct Nearest {
    /// The squared distance to the nearest seed that has reached it.
    squared_distance: u64,
    seed: u32,
}

impl Patches {
    /// A greedy cover by balls of this `radius` in voxels; each node then belongs to the nearest seed
    /// whose ball has reached it. No patch is empty.
    ///
    /// A ball grows through elements only: struts that merely lie side by side are never in one patch,
    /// where a common rigid motion would say nothing about either. Seeds are taken from the fringe of
    /// the balls before them, so that the cover is about as thin as a surface allows.
    pub(super) fn grow(mesh: &Mesh, radius: f64) -> Patches {
        let mut growth = Growth::new(mesh, (radius * radius) as u64);
        let (mut scanned, mut count) = (0, 0);
        while let Some(seed) = growth.next_seed(&mut scanned) {
            growth.ball(seed, count);
            count += 1;
        }
        let of_node = |(node, nearest): (usize, &Nearest)| match mesh.is_clamped[node] {
            true => NONE,
            false => nearest.seed,
        };
        let of_node = growth.nearest.iter().enumerate().map(of_node).collect();
        Patches::new(of_node, count as usize)
    }

    fn new(of_node: Vec<u32>, count: usize) -> Patches {
        let mut starts = vec![0; count + 1];
        let placed = || (0..).zip(&of_node).filter(|(_, patch)| **patch != NONE);
        placed().for_each(|(_, patch)| starts[*patch as usize + 1] += 1);
        for patch in 0..count {
            starts[patch + 1] += starts[patch];
        }
        let mut next = starts.clone();
        let mut members = vec![0; starts[count]];
        for (node, patch) in placed() {
            members[next[*patch as usize]] = node;
            next[*patch as usize] += 1;
        }
        Patches {
            starts,
            members,
            of_node,
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The nodes of a patch, ascending.
    pub(super) fn nodes(&self, patch: usize) -> &[u32] {
        &self.members[self.starts[patch]..self.starts[patch + 1]]
    }
}

/// Balls that grow one after the other.
struct Growth<'a> {
    mesh: &'a Mesh,
    squared_radius: u64,
    nearest: Vec<Nearest>,
    /// The last ball that has come to a node.
    visited: Vec<u32>,
    /// Nodes just outside of a ball, when no ball had them yet.
    fringe: VecDeque<u32>,
    /// The nodes that the ball has come to.
    ball: Vec<u32>,
}

impl Growth<'_> {
    fn new(mesh: &Mesh, squared_radius: u64) -> Growth<'_> {
        let unreached = Nearest {
            squared_distance: u64::MAX,
            seed: NONE,
        };
        Growth {
            mesh,
            squared_radius,
            nearest: vec![unreached; mesh.nodes.len()],
            visited: vec![NONE; mesh.nodes.len()],
            fringe: VecDeque::new(),
            ball: Vec::new(),
        }
    }

    /// A free node that no ball has reached: from the fringe, or else the first of all.
    fn next_seed(&mut self, scanned: &mut usize) -> Option<usize> {
        let is_open = |node: usize| self.nearest[node].seed == NONE && !self.mesh.is_clamped[node];
        while let Some(node) = self.fringe.pop_front() {
            if is_open(node as usize) {
                return Some(node as usize);
            }
        }
        let found = (*scanned..self.nearest.len()).find(|node| is_open(*node));
        *scanned = found.unwrap_or(self.nearest.len());
        found
    }

    /// Grows the ball numbered `number` about a node.
    fn ball(&mut self, seed: usize, number: u32) {
        let center = self.mesh.nodes[seed];
        self.ball.clear();
        self.ball.push(seed as u32);
        self.visited[seed] = number;
        let mut next = 0;
        while next < self.ball.len() {
            let node = self.ball[next] as usize;
            next += 1;
            let place = self.mesh.nodes[node];
            let along = |k: usize| u64::from(place[k].abs_diff(center[k])).pow(2);
            let squared_distance = along(0) + along(1) + along(2);
            let nearest = &mut self.nearest[node];
            if squared_distance > self.squared_radius {
                if nearest.seed == NONE {
                    self.fringe.push_back(node as u32);
                }
                continue;
            }
            if squared_distance < nearest.squared_distance {
                *nearest = Nearest {
                    squared_distance,
                    seed: number,
                };
            }
            for element in self.mesh.elements_around(node) {
                for other in corners(&self.mesh.elements[element]) {
                    if self.visited[other] != number {
                        self.visited[other] = number;
                        self.ball.push(other as u32);
                    }
                }
            }
        }
    }
}
