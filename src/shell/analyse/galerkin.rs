//! The matrix of the coarse space: how the smoothed rigid motions of patches strain one another.

use rayon::prelude::*;

use super::block::{Diagonal, times};
use super::element::{Quad, Stiffness};
use super::mesh::{Mesh, NONE, corners};
use super::patches::Patches;
use super::rigid::{Motion, RigidBasis};

/// A block of the coarse matrix: `block[k][j]` couples motion k of the row's patch and j of the column's.
pub(super) type CoarseBlock = [Motion; 6];

/// What the product is made of.
pub(super) struct Galerkin<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) stiffness: &'a Stiffness<f64>,
    pub(super) diagonal: &'a Diagonal,
    pub(super) patches: &'a Patches,
    pub(super) bases: &'a [RigidBasis],
    /// The step of the smoothing.
    pub(super) omega: f64,
}

/// Six vectors at a node.
type Six = [Quad<f64>; 6];

impl Galerkin<'_> {
    /// The lower half of Rᵀ S A Sᵀ R with S = 1 - ω A D⁻¹, by columns of blocks: for each patch the patches
    /// not before it that it touches, ascending (smoothed aggregation; Vaněk, Mandel, Brezina 1996).
    ///
    /// Each patch is worked out by itself on the elements within three rings around it, since each of
    /// the three products reaches one ring farther.
    pub(super) fn columns(&self) -> Vec<Vec<(u32, CoarseBlock)>> {
        let (nodes, elements) = (self.mesh.nodes.len(), self.mesh.elements.len());
        let scratch = || (vec![NONE; nodes], vec![false; elements]);
        (0..self.patches.len())
            .into_par_iter()
            .map_init(scratch, |(numbers, taken), patch| {
                let rings = Rings::new(self.mesh, self.patches.nodes(patch), numbers, taken);
                let column = self.column(patch, &rings, numbers);
                rings.nodes.iter().for_each(|n| numbers[*n as usize] = NONE);
                rings
                    .elements
                    .iter()
                    .for_each(|e| taken[*e as usize] = false);
                column
            })
            .collect()
    }

    fn column(&self, patch: usize, rings: &Rings, numbers: &[u32]) -> Vec<(u32, CoarseBlock)> {
        let own = self.patches.nodes(patch).iter();
        let motions: Vec<Six> = own
            .map(|node| self.bases[patch].at(self.mesh.nodes[*node as usize]))
            .collect();
        let smoothed = self.less(
            &motions,
            self.divided(self.apply(&motions, 0, rings, numbers), rings),
        );
        let forces = self.apply(&smoothed, 1, rings, numbers);
        let scaled = self.divided(forces.clone(), rings);
        let smoothed = self.less(&forces, self.apply(&scaled, 2, rings, numbers));
        self.restricted(patch, &smoothed, rings)
    }

    /// The stiffness matrix times vectors on the nodes of ring `ring`, on those of the next.
    fn apply(&self, x: &[Six], ring: usize, rings: &Rings, numbers: &[u32]) -> Vec<Six> {
        let (elements, nodes) = rings.ends[ring];
        let mut y = vec![[[0.0; 4]; 6]; nodes];
        pulp::Arch::new().dispatch(SixSum {
            mesh: self.mesh,
            stiffness: *self.stiffness,
            elements: &rings.elements[..elements],
            numbers,
            x,
            out: &mut y,
        });
        for (six, node) in y.iter_mut().zip(&rings.nodes) {
            if self.mesh.is_clamped[*node as usize] {
                *six = [[0.0; 4]; 6];
            }
        }
        y
    }

    /// The inverse diagonal times vectors.
    fn divided(&self, mut x: Vec<Six>, rings: &Rings) -> Vec<Six> {
        for (six, node) in x.iter_mut().zip(&rings.nodes) {
            let pattern = self.mesh.patterns[*node as usize];
            let light = f64::from(self.mesh.lightness[*node as usize]);
            let inverse = &self.diagonal.inverse[pattern as usize];
            *six = six.map(|v| times(inverse, v).map(|part| part * light));
        }
        x
    }

    /// `a - ω·b`, where `a` is zero beyond its end.
    fn less(&self, a: &[Six], mut b: Vec<Six>) -> Vec<Six> {
        for (i, six) in b.iter_mut().enumerate() {
            let from = a.get(i).copied().unwrap_or_default();
            for j in 0..6 {
                for k in 0..3 {
                    six[j][k] = from[j][k] - self.omega * six[j][k];
                }
            }
        }
        b
    }

    /// The products of vectors with the motions of every patch not before `patch`.
    fn restricted(&self, patch: usize, x: &[Six], rings: &Rings) -> Vec<(u32, CoarseBlock)> {
        let of_node = |i: usize| self.patches.of_node[rings.nodes[i] as usize];
        let reached = (0..x.len()).filter(|i| of_node(*i) != NONE && of_node(*i) as usize >= patch);
        let mut order: Vec<usize> = reached.collect();
        order.sort_by_key(|i| of_node(*i));
        let rows = order.chunk_by(|a, b| of_node(*a) == of_node(*b));
        rows.map(|nodes| {
            let row = of_node(nodes[0]);
            let basis = &self.bases[row as usize];
            // By columns, as the basis takes them; transposed in the end.
            let mut products = [[0.0; 6]; 6];
            for i in nodes {
                let node = self.mesh.nodes[rings.nodes[*i] as usize];
                for (sums, v) in products.iter_mut().zip(x[*i]) {
                    basis.add_products(node, v, sums);
                }
            }
            let columns = products.map(|sums| basis.of_plain(&sums));
            let block = std::array::from_fn(|k| std::array::from_fn(|j| columns[j][k]));
            (row, block)
        })
        .collect()
    }
}

/// The sum over some elements of the forces for six vectors at their nodes, which have numbers of their own; nodes without
/// vectors are at rest. It is compiled once more for AVX2, with the same bits.
struct SixSum<'a> {
    mesh: &'a Mesh,
    stiffness: Stiffness<f64>,
    elements: &'a [u32],
    numbers: &'a [u32],
    x: &'a [Six],
    out: &'a mut [Six],
}

impl pulp::NullaryFnOnce for SixSum<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for element in self.elements {
            let at = corners(&self.mesh.elements[*element as usize]);
            let at = at.map(|node| self.numbers[node] as usize);
            let weight = f64::from(self.mesh.weights[*element as usize]);
            for j in 0..6 {
                let mut moved = [[0.0; 4]; 8];
                for (moved, i) in moved.iter_mut().zip(at) {
                    if let Some(six) = self.x.get(i) {
                        *moved = six[j];
                    }
                }
                let forces = self.stiffness.forces(moved);
                for (i, force) in at.into_iter().zip(forces) {
                    let sum = &mut self.out[i][j];
                    for k in 0..4 {
                        sum[k] += weight * force[k];
                    }
                }
            }
        }
    }
}

/// The surroundings of a patch, ring by ring.
struct Rings {
    /// The nodes of the patch, then those of each ring.
    nodes: Vec<u32>,
    elements: Vec<u32>,
    /// How many elements and nodes there are up to each of the three rings.
    ends: [(usize, usize); 3],
}

impl Rings {
    /// Numbers the nodes from zero in `numbers`, and marks the elements in `taken`; both are to be wiped
    /// afterwards.
    fn new(mesh: &Mesh, patch: &[u32], numbers: &mut [u32], taken: &mut [bool]) -> Rings {
        let (mut nodes, mut elements) = (patch.to_vec(), Vec::new());
        for (number, node) in nodes.iter().enumerate() {
            numbers[*node as usize] = number as u32;
        }
        let (mut nodes_done, mut elements_done) = (0, 0);
        let ends = std::array::from_fn(|_| {
            for node in &nodes[nodes_done..] {
                for element in mesh.elements_around(*node as usize) {
                    if !std::mem::replace(&mut taken[element], true) {
                        elements.push(element as u32);
                    }
                }
            }
            nodes_done = nodes.len();
            for element in &elements[elements_done..] {
                for node in corners(&mesh.elements[*element as usize]) {
                    if numbers[node] == NONE {
                        numbers[node] = nodes.len() as u32;
                        nodes.push(node as u32);
                    }
                }
            }
            elements_done = elements.len();
            (elements.len(), nodes.len())
        });
        Rings {
            nodes,
            elements,
            ends,
        }
    }
}
