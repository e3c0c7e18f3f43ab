//! Mechanisms: parts of a body that can move without strain. An iteration that meets one ends with
//! plausible numbers, so they are sought beforehand.
//!
//! After [`Parts`] has merged what is joined for certain, few bodies have anything left but the ground.
//! What is left is judged exactly: rigid parts that share nodes move together there, and whatever
//! motion these equations leave is a motion without strain, of the elastic body too.

use std::collections::BTreeMap;

use fretwork_geometry::numeric::UnionFind;
use nalgebra::{DMatrix, SymmetricEigen};

use super::error::Hold;
use super::mesh::{Mesh, Node};
use super::parts::{Parts, Span};

/// A part that can move.
pub(super) struct Loose {
    /// Where it hangs, or the middle of one of its voxels, in pitches of the lattice.
    pub(super) at: [f64; 3],
    pub(super) hold: Hold,
    pub(super) voxels: usize,
}

/// More parts in one linkage are not judged: each of them counts as loose. A matrix of six rows a
/// part takes the third power of this in time.
const JUDGED: usize = 64;

/// Eigenvalues below this part of the largest belong to motions that no joint resists. Lengths are
/// measured by the extent of the joints, so that others stay far above it.
const FREE: f64 = 1e-11;

/// The parts that can move, in the order of their first voxels.
pub(super) fn loose_parts(mesh: &Mesh) -> Vec<Loose> {
    let parts = Parts::new(mesh);
    let mut sizes: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
    for (element, part) in parts.of_element.iter().enumerate() {
        if *part != parts.ground {
            sizes.entry(*part).or_insert((element, 0)).1 += 1;
        }
    }
    let mut found: Vec<(usize, Loose)> = linkages(&parts, sizes.keys().copied())
        .iter()
        .flat_map(|linkage| linkage.loose(mesh, &parts, &sizes))
        .collect();
    found.sort_by_key(|(first, _)| *first);
    found.into_iter().map(|(_, loose)| loose).collect()
}

/// Parts that hang together without the ground.
struct Linkage {
    /// Ascending.
    parts: Vec<u32>,
    /// Nodes that they share with one another and with the ground.
    joints: Vec<(Node, Vec<u32>)>,
}

fn linkages(parts: &Parts, left: impl Iterator<Item = u32>) -> Vec<Linkage> {
    let left: Vec<u32> = left.collect();
    let number = |part: u32| left.binary_search(&part).ok();
    let mut sets = UnionFind::new(left.len());
    for (_, sharing) in &parts.joints {
        let numbers: Vec<usize> = sharing.iter().filter_map(|part| number(*part)).collect();
        for pair in numbers.windows(2) {
            sets.unite(pair[0] as u32, pair[1] as u32);
        }
    }
    let labels = sets.labels();
    let empty = || Linkage {
        parts: Vec::new(),
        joints: Vec::new(),
    };
    let mut linkages: Vec<Linkage> = (0..sets.count()).map(|_| empty()).collect();
    for (part, label) in left.iter().zip(&labels) {
        linkages[*label as usize].parts.push(*part);
    }
    for joint in &parts.joints {
        // All parts of a joint but the ground are in one linkage.
        if let Some(number) = joint.1.iter().find_map(|part| number(*part)) {
            linkages[labels[number] as usize].joints.push(joint.clone());
        }
    }
    linkages
}

impl Linkage {
    /// Its parts that move, with their first elements.
    fn loose(
        &self,
        mesh: &Mesh,
        parts: &Parts,
        sizes: &BTreeMap<u32, (usize, usize)>,
    ) -> Vec<(usize, Loose)> {
        let is_held = self.joints.iter().any(|(_, of)| of.contains(&parts.ground));
        if !is_held {
            let sizes = || self.parts.iter().map(|part| sizes[part]);
            let first = sizes().map(|(first, _)| first).min().unwrap_or(0);
            let voxels = sizes().map(|(_, size)| size).sum();
            let (hold, at) = (Hold::Nothing, middle(mesh, first));
            return vec![(first, Loose { at, hold, voxels })];
        }
        let moves = match self.parts.len() <= JUDGED {
            true => self.moves(parts.ground),
            false => vec![true; self.parts.len()],
        };
        let moving = self.parts.iter().zip(moves).filter(|(_, moves)| *moves);
        moving
            .map(|(part, _)| {
                let (first, voxels) = sizes[part];
                let (hold, at) = self
                    .hold(*part)
                    .unwrap_or((Hold::Nothing, middle(mesh, first)));
                (first, Loose { at, hold, voxels })
            })
            .collect()
    }

    /// How a part hangs, and where.
    fn hold(&self, part: u32) -> Option<(Hold, [f64; 3])> {
        let own = self.joints.iter().filter(|(_, of)| of.contains(&part));
        let nodes: Vec<Node> = own.map(|(node, _)| *node).collect();
        let mut span = Span::Nothing;
        nodes.iter().for_each(|node| span.add(*node));
        let mean = |k: usize| {
            nodes.iter().map(|node| f64::from(node[k])).sum::<f64>() / nodes.len() as f64
        };
        let place = [0, 1, 2].map(|k| if nodes.is_empty() { 0.0 } else { mean(k) });
        match span {
            Span::Nothing => None,
            Span::Point(_) => Some((Hold::Corner, place)),
            Span::Line(..) => Some((Hold::Edge, place)),
            // The middle of several hinges may lie nowhere near the body.
            Span::Plane => Some((Hold::Chain, nodes[0].map(f64::from))),
        }
    }

    /// Which parts take part in a motion that keeps every joint together: the null space of the
    /// equations of the joints.
    fn moves(&self, ground: u32) -> Vec<bool> {
        let matrix = self.equations(ground);
        let SymmetricEigen {
            eigenvalues,
            eigenvectors,
        } = SymmetricEigen::new(matrix.transpose() * matrix);
        let largest = eigenvalues.iter().copied().fold(0.0, f64::max);
        let mut moved = vec![0.0; self.parts.len()];
        for (eigenvalue, vector) in eigenvalues.iter().zip(eigenvectors.column_iter()) {
            if *eigenvalue <= FREE * largest {
                for (sum, own) in moved.iter_mut().zip(vector.as_slice().chunks(6)) {
                    *sum += own.iter().map(|x| x * x).sum::<f64>();
                }
            }
        }
        // A part takes part in full or, up to rounding, not at all.
        moved.into_iter().map(|square| square > 1e-8).collect()
    }

    /// For each joint and each part there but the first: three rows, that both move it alike. The ground
    /// does not move.
    fn equations(&self, ground: u32) -> DMatrix<f64> {
        let count = self.joints.len() as f64;
        let nodes = || self.joints.iter().map(|(node, _)| node.map(f64::from));
        let center = [0, 1, 2].map(|k| nodes().map(|node| node[k]).sum::<f64>() / count);
        let reach = |node: [f64; 3]| {
            (0..3)
                .map(|k| (node[k] - center[k]).abs())
                .fold(0.0, f64::max)
        };
        let extent = nodes().map(reach).fold(1.0, f64::max);
        let rows: usize = self.joints.iter().map(|(_, of)| 3 * (of.len() - 1)).sum();
        let mut matrix = DMatrix::zeros(rows, 6 * self.parts.len());
        let mut row = 0;
        for (node, of) in &self.joints {
            let at = [0, 1, 2].map(|k| (f64::from(node[k]) - center[k]) / extent);
            for other in &of[1..] {
                for (part, sign) in [(of[0], 1.0), (*other, -1.0)] {
                    if part == ground {
                        continue;
                    }
                    let column = self.parts.binary_search(&part);
                    let column = 6 * column.expect("a joint's parts are in its linkage");
                    for k in 0..3 {
                        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
                        matrix[(row + k, column + k)] = sign;
                        // A turn about axis a moves component k by the vector product.
                        matrix[(row + k, column + 3 + next)] = sign * at[last];
                        matrix[(row + k, column + 3 + last)] = -sign * at[next];
                    }
                }
                row += 3;
            }
        }
        matrix
    }
}

fn middle(mesh: &Mesh, element: usize) -> [f64; 3] {
    mesh.nodes[mesh.elements[element][0] as usize].map(|n| f64::from(n) + 0.5)
}
