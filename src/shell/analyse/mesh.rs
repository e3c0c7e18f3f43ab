//! The elements of a body of voxels, its nodes, and which nodes the supports hold. Stiffness and
//! displacements are not known here.

use fretwork_geometry::voxel::Voxel;
use rayon::prelude::*;

/// No node, no element, no patch.
pub(super) const NONE: u32 = u32::MAX;

/// A node by its place in the lattice: the least corner of the voxel with the same numbers.
pub(super) type Node = [u32; 3];

/// The elements and nodes of a body.
pub(super) struct Mesh {
    /// For each voxel the nodes at (x, y), (x, y + 1), (x + 1, y), (x + 1, y + 1) with its lower z. The
    /// nodes above them follow each in the order of nodes.
    pub(super) elements: Vec<[u32; 4]>,
    /// Ascending: by x, then y, then z.
    pub(super) nodes: Vec<Node>,
    /// The elements around each node, [`NONE`] where there is none. The slot is the corner of the
    /// element that the node is.
    pub(super) around: Vec<[u32; 8]>,
    /// Which slots of `around` are taken, as bits.
    pub(super) patterns: Vec<u8>,
    /// How much of itself each element stands for: its stiffness and its mass are multiplied by that.
    pub(super) weights: Vec<f32>,
    /// The greatest weight of the elements around each node, inverted.
    pub(super) lightness: Vec<f32>,
    /// Whether the supports hold a node.
    pub(super) is_clamped: Vec<bool>,
    /// The nodes that they hold.
    pub(super) clamped: Vec<u32>,
    /// Where the body is cut for threads.
    pub(super) slabs: Vec<Slab>,
}

/// Whole layers of elements along x, with the nodes that they touch.
///
/// A slab shares nodes only with the one before and the one after it. Every second slab can therefore be
/// summed into the nodes at the same time. Slabs follow from the body, never from the threads.
pub(super) struct Slab {
    /// The first element, and the one after the last.
    pub(super) elements: (usize, usize),
    /// The first node, and the one after the last.
    pub(super) nodes: (usize, usize),
}

/// About how many slabs there are: enough for the threads of a desktop, and few enough to be large.
const SLABS: usize = 48;

impl Mesh {
    /// The mesh of voxels in ascending order, without repeats; `is_supported` tells which nodes are held.
    pub(super) fn new(cells: &[Voxel], is_supported: impl Fn(Node) -> bool) -> Mesh {
        let nodes = nodes_of(cells);
        let elements = elements_of(cells, &nodes);
        let mut around = vec![[NONE; 8]; nodes.len()];
        for (number, element) in elements.iter().enumerate() {
            for (corner, node) in corners(element).into_iter().enumerate() {
                around[node][corner] = number as u32;
            }
        }
        let bits = |slots: &[u32; 8]| (0..8).map(|c| u8::from(slots[c] != NONE) << c).sum();
        let is_clamped: Vec<bool> = nodes.iter().map(|node| is_supported(*node)).collect();
        Mesh {
            slabs: slabs_of(cells, &nodes),
            patterns: around.iter().map(bits).collect(),
            clamped: (0..nodes.len() as u32)
                .filter(|i| is_clamped[*i as usize])
                .collect(),
            is_clamped,
            around,
            weights: vec![1.0; elements.len()],
            lightness: vec![1.0; nodes.len()],
            elements,
            nodes,
        }
    }

    /// Gives each element a weight, positive.
    pub(super) fn weigh(&mut self, weights: &[f32]) {
        self.weights.copy_from_slice(weights);
        for node in 0..self.nodes.len() {
            let around = self.elements_around(node).map(|e| weights[e]);
            self.lightness[node] = 1.0 / around.fold(0.0, f32::max);
        }
    }

    /// Gives back the memory of `around`, when all that looks for neighbours has been done. Nothing is around a
    /// node afterwards.
    pub(super) fn forget_neighbors(&mut self) {
        self.around = Vec::new();
    }

    /// The elements around a node.
    #[inline]
    pub(super) fn elements_around(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        let there = self.around[node].iter().filter(|element| **element != NONE);
        there.map(|element| *element as usize)
    }

    /// The elements that share a face with an element, in the order -x, +x, -y, +y, -z, +z.
    pub(super) fn face_neighbors(&self, element: usize) -> impl Iterator<Item = usize> + '_ {
        let all = corners(&self.elements[element]);
        let (low, high) = (&self.around[all[0]], &self.around[all[7]]);
        let slots = [low[4], high[3], low[2], high[5], low[1], high[6]];
        let there = slots.into_iter().filter(|element| *element != NONE);
        there.map(|element| element as usize)
    }
}

/// The nodes at the corners `4x + 2y + z` of an element.
#[inline(always)]
pub(super) fn corners(element: &[u32; 4]) -> [usize; 8] {
    std::array::from_fn(|corner| element[corner >> 1] as usize + (corner & 1))
}

fn nodes_of(cells: &[Voxel]) -> Vec<Node> {
    let corner = |[x, y, z]: Voxel, c: u32| {
        [
            u32::from(x) + (c >> 2),
            u32::from(y) + (c >> 1 & 1),
            u32::from(z) + (c & 1),
        ]
    };
    let corners = cells
        .iter()
        .flat_map(|cell| (0..8).map(move |c| corner(*cell, c)));
    let mut nodes: Vec<Node> = corners.collect();
    nodes.par_sort_unstable();
    nodes.dedup();
    nodes.shrink_to_fit();
    nodes
}

fn elements_of(cells: &[Voxel], nodes: &[Node]) -> Vec<[u32; 4]> {
    let find = |node: Node| {
        nodes
            .binary_search(&node)
            .expect("the corners of all voxels are nodes") as u32
    };
    cells
        .par_iter()
        .map(|cell| {
            let [x, y, z] = cell.map(u32::from);
            [[x, y, z], [x, y + 1, z], [x + 1, y, z], [x + 1, y + 1, z]].map(find)
        })
        .collect()
}

fn slabs_of(cells: &[Voxel], nodes: &[Node]) -> Vec<Slab> {
    let first = |x: u32| nodes.partition_point(|node| node[0] < x);
    let (mut slabs, mut begin) = (Vec::new(), 0);
    while begin < cells.len() {
        let mut end = (begin + cells.len() / SLABS + 1).min(cells.len());
        while end < cells.len() && cells[end][0] == cells[end - 1][0] {
            end += 1;
        }
        let (low, high) = (u32::from(cells[begin][0]), u32::from(cells[end - 1][0]));
        slabs.push(Slab {
            elements: (begin, end),
            nodes: (first(low), first(high + 2)),
        });
        begin = end;
    }
    slabs
}
