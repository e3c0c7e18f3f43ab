//! Parts of a body that are rigid for certain, and where they touch.

use std::collections::BTreeMap;

use fretwork_geometry::numeric::UnionFind;

use super::mesh::{Mesh, NONE, Node};

/// Elements in parts that have no motion without strain but the six of a rigid body.
pub(super) struct Parts {
    /// The part of each element: the least number of its set. The ground is a part without elements,
    /// that of the last number.
    pub(super) of_element: Vec<u32>,
    pub(super) ground: u32,
    /// Nodes that several parts share, the supports being the ground's, and these parts, ascending.
    pub(super) joints: Vec<(Node, Vec<u32>)>,
}

impl Parts {
    /// The parts of a mesh.
    ///
    /// Elements that share a face are one part, as the face has four nodes. Parts that share three nodes
    /// not on a line are merged, until there are none: each has strain with the other moved.
    pub(super) fn new(mesh: &Mesh) -> Parts {
        let (mut of_element, count) = joined_by_faces(mesh);
        let mut sets = UnionFind::new(count as usize + 1);
        let mut joints = joints_of(mesh, &of_element, count);
        while merge(&joints, &mut sets) {
            for (_, parts) in &mut joints {
                parts.iter_mut().for_each(|part| *part = sets.find(*part));
                parts.sort_unstable();
                parts.dedup();
            }
            joints.retain(|(_, parts)| parts.len() > 1);
        }
        of_element
            .iter_mut()
            .for_each(|part| *part = sets.find(*part));
        Parts {
            of_element,
            ground: sets.find(count),
            joints,
        }
    }
}

/// The part of each element by faces, and how many parts there are.
fn joined_by_faces(mesh: &Mesh) -> (Vec<u32>, u32) {
    let mut parts = vec![NONE; mesh.elements.len()];
    let (mut count, mut open) = (0, Vec::new());
    for first in 0..parts.len() {
        if parts[first] != NONE {
            continue;
        }
        parts[first] = count;
        open.push(first);
        while let Some(element) = open.pop() {
            for next in mesh.face_neighbors(element) {
                if parts[next] == NONE {
                    parts[next] = count;
                    open.push(next);
                }
            }
        }
        count += 1;
    }
    (parts, count)
}

fn joints_of(mesh: &Mesh, of_element: &[u32], ground: u32) -> Vec<(Node, Vec<u32>)> {
    let at = |node: usize| {
        let mut parts: Vec<u32> = mesh
            .elements_around(node)
            .map(|element| of_element[element])
            .chain(mesh.is_clamped[node].then_some(ground))
            .collect();
        parts.sort_unstable();
        parts.dedup();
        (parts.len() > 1).then(|| (mesh.nodes[node], parts))
    };
    (0..mesh.nodes.len()).filter_map(at).collect()
}

/// Unites every two parts that share three nodes not on a line, and tells whether there were any.
fn merge(joints: &[(Node, Vec<u32>)], sets: &mut UnionFind) -> bool {
    let mut shared: BTreeMap<(u32, u32), Span> = BTreeMap::new();
    for (node, parts) in joints {
        for (i, a) in parts.iter().enumerate() {
            for b in &parts[i + 1..] {
                shared.entry((*a, *b)).or_default().add(*node);
            }
        }
    }
    let mut has_merged = false;
    for ((a, b), span) in shared {
        if span == Span::Plane {
            has_merged |= sets.unite(a, b);
        }
    }
    has_merged
}

/// What some nodes span.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Span {
    /// There are none.
    #[default]
    Nothing,
    /// They are one.
    Point(Node),
    /// They lie on the line through these two.
    Line(Node, Node),
    /// They lie on no line.
    Plane,
}

impl Span {
    /// Adds a node.
    pub(super) fn add(&mut self, node: Node) {
        *self = match *self {
            Span::Nothing => Span::Point(node),
            Span::Point(a) if a != node => Span::Line(a, node),
            Span::Line(a, b) if cross(a, b, node) != [0; 3] => Span::Plane,
            same => same,
        };
    }
}

/// The vector product of `b - a` and `c - a`.
fn cross(a: Node, b: Node, c: Node) -> [i64; 3] {
    let from_a = |p: Node| [0, 1, 2].map(|k| i64::from(p[k]) - i64::from(a[k]));
    let (u, v) = (from_a(b), from_a(c));
    [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])
}
