//! Labels of cells, gathered from those of the curves. Equal label tuples of edges are stored once.

use std::collections::HashMap;

use super::super::{CurveLabels, Curves, LabelSet};
use super::chains::Chains;

/// The labels of all cells.
#[derive(Debug)]
pub(super) struct Labels {
    /// The different tuples that edges carry.
    pub tuples: Vec<CurveLabels>,
    /// The tuple of every edge.
    pub edges: Vec<u32>,
    /// Of the vertices; shorter than these where the rest has none.
    pub vertices: Vec<LabelSet>,
    /// Of the faces, that of the unbounded one, which has none, at 0; shorter where the rest has none.
    pub faces: Vec<LabelSet>,
}

/// Unites the labels of the curves along, beside and at the ends of edges.
pub(super) fn gather(curves: &Curves, chains: &Chains, face_of: &[u32]) -> Labels {
    let mut carried: Vec<CurveLabels> = Vec::with_capacity(chains.ends.len());
    for &curve in &chains.first {
        let labels = curves.get(curve as usize).labels;
        carried.push(CurveLabels { start: LabelSet::EMPTY, end: LabelSet::EMPTY, ..labels });
    }
    for &(edge, source) in &chains.more {
        let mut labels = curves.get(source as usize / 2).labels;
        if source % 2 == 1 {
            labels = labels.reversed();
        }
        let united = &mut carried[edge as usize];
        united.edge = united.edge.union(labels.edge);
        united.left = united.left.union(labels.left);
        united.right = united.right.union(labels.right);
    }
    let mut vertices = Vec::new();
    for &(curve, [first, last]) in &chains.curves {
        let labels = curves.get(curve as usize).labels;
        mark(&mut carried, &mut vertices, chains, first, labels.start);
        mark(&mut carried, &mut vertices, chains, last ^ 1, labels.end);
    }
    let faces = face_labels(&carried, face_of);
    let mut labels = Labels { tuples: Vec::new(), edges: Vec::with_capacity(carried.len()), vertices, faces };
    let mut numbers: HashMap<CurveLabels, u32> = HashMap::new();
    let mut last: Option<(CurveLabels, u32)> = None;
    for tuple in carried {
        let number = match last {
            Some((same, number)) if same == tuple => number,
            _ => *numbers.entry(tuple).or_insert_with(|| {
                labels.tuples.push(tuple);
                labels.tuples.len() as u32 - 1
            }),
        };
        last = Some((tuple, number));
        labels.edges.push(number);
    }
    labels
}

/// Puts `label` where the half-edge `h` begins: on that end of the edge and on the vertex.
fn mark(carried: &mut [CurveLabels], vertices: &mut Vec<LabelSet>, chains: &Chains, h: u32, label: LabelSet) {
    if label.is_empty() {
        return;
    }
    let (edge, end) = (h as usize / 2, h as usize % 2);
    let labels = &mut carried[edge];
    let slot = if end == 0 { &mut labels.start } else { &mut labels.end };
    *slot = slot.union(label);
    let vertex = chains.ends[edge][end] as usize;
    if vertices.len() <= vertex {
        vertices.resize(vertex + 1, LabelSet::EMPTY);
    }
    vertices[vertex] = vertices[vertex].union(label);
}

/// The union of what the sides that face a face carry.
fn face_labels(carried: &[CurveLabels], face_of: &[u32]) -> Vec<LabelSet> {
    let mut faces = Vec::new();
    for (edge, labels) in carried.iter().enumerate() {
        for (label, face) in [(labels.left, face_of[2 * edge]), (labels.right, face_of[2 * edge + 1])] {
            if face == 0 || label.is_empty() {
                continue;
            }
            let face = face as usize;
            if faces.len() <= face {
                faces.resize(face + 1, LabelSet::EMPTY);
            }
            faces[face] = faces[face].union(label);
        }
    }
    faces
}
