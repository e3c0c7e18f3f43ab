//! Labels of cells, gathered from those of the curves. Equal label tuples of edges are stored once.

use std::collections::HashMap;

use crate::planar_map::build::chains::Chains;
use crate::planar_map::build::stars::Stars;
use crate::planar_map::noding::routes::{CurveEnds, Routes};
use crate::{CurveLabels, Curves, LabelSet};

/// The labels of all cells.
#[derive(Debug, Default)]
pub(in crate::planar_map) struct Labels {
    /// The different tuples that edges carry.
    pub tuples: Vec<CurveLabels>,
    /// The tuple of every edge.
    pub edges: Vec<u32>,
    /// Of the nodes; shorter than these where the rest has none.
    pub vertices: Vec<LabelSet>,
    /// Of the faces, that of the unbounded one, which has none, at 0; shorter where the rest has none.
    pub faces: Vec<LabelSet>,
}

/// The ends of the curves that have labels there.
pub(in crate::planar_map) fn labelled(curves: &Curves, routes: &Routes) -> Vec<CurveEnds> {
    let labelled = |l: CurveLabels| !l.start.is_empty() || !l.end.is_empty();
    if curves.iter().any(|c| labelled(c.labels)) {
        routes.curve_ends(|curve| labelled(curves.get(curve as usize).labels))
    } else {
        Vec::new()
    }
}

/// The curves with the half-edges that leave their first and their last vertex along them.
pub(in crate::planar_map) fn leaving(
    curve_ends: Vec<CurveEnds>,
    stars: &Stars,
    chains: &Chains,
) -> Vec<(u32, [u32; 2])> {
    let leaving = |step: [u32; 2]| chains.half_edges[stars.slot(step[0], step[1])];
    curve_ends
        .into_iter()
        .map(|w| (w.curve, [leaving(w.first), leaving(w.last)]))
        .collect()
}

/// Unites the labels of the curves along, beside and, for those of `ends`, at the ends of edges.
pub(in crate::planar_map) fn gather(
    curves: &Curves,
    chains: &Chains,
    ends: &[(u32, [u32; 2])],
    face_of: &[u32],
) -> Labels {
    let mut tuples = Tuples::default();
    let mut labels = Labels::default();
    let bare = |l: CurveLabels| CurveLabels {
        start: LabelSet::EMPTY,
        end: LabelSet::EMPTY,
        ..l
    };
    let of_curve: Vec<u32> = curves
        .iter()
        .map(|c| tuples.number(bare(c.labels)))
        .collect();
    labels.edges = if tuples.list.len() == 1 {
        vec![0; chains.first.len()]
    } else {
        chains
            .first
            .iter()
            .map(|curve| of_curve[*curve as usize])
            .collect()
    };
    for &(edge, source) in &chains.more {
        let along = bare(curves.get(source as usize / 2).labels);
        let along = if source % 2 == 1 {
            along.reversed()
        } else {
            along
        };
        tuples.add(&mut labels.edges[edge as usize], along);
    }
    for &(curve, [first, last]) in ends {
        let carried = curves.get(curve as usize).labels;
        labels.mark(&mut tuples, chains, first, carried.start);
        labels.mark(&mut tuples, chains, last, carried.end);
    }
    labels.tuples = tuples.list;
    labels.label_faces(face_of);
    labels
}

impl Labels {
    /// Puts `label` where the half-edge `h` begins: on that end of the edge and on the vertex.
    fn mark(&mut self, tuples: &mut Tuples, chains: &Chains, h: u32, label: LabelSet) {
        if label.is_empty() {
            return;
        }
        let (edge, end) = (h as usize / 2, h as usize % 2);
        let mut carried = CurveLabels::default();
        *(if end == 0 {
            &mut carried.start
        } else {
            &mut carried.end
        }) = label;
        tuples.add(&mut self.edges[edge], carried);
        unite(&mut self.vertices, chains.ends[edge][end], label);
    }

    /// Gives each face the union of what the sides that face it carry.
    fn label_faces(&mut self, face_of: &[u32]) {
        if self
            .tuples
            .iter()
            .all(|t| t.left.is_empty() && t.right.is_empty())
        {
            return;
        }
        for (&tuple, faces) in self.edges.iter().zip(face_of.chunks_exact(2)) {
            let carried = self.tuples[tuple as usize];
            for (label, face) in [(carried.left, faces[0]), (carried.right, faces[1])] {
                if face != 0 && !label.is_empty() {
                    unite(&mut self.faces, face, label);
                }
            }
        }
    }
}

/// Adds a label to that of a cell.
pub(in crate::planar_map) fn unite(labels: &mut Vec<LabelSet>, cell: u32, label: LabelSet) {
    let cell = cell as usize;
    if labels.len() <= cell {
        labels.resize(cell + 1, LabelSet::EMPTY);
    }
    labels[cell] = labels[cell].union(label);
}

/// Numbers for tuples of labels.
#[derive(Default)]
struct Tuples {
    list: Vec<CurveLabels>,
    numbers: HashMap<CurveLabels, u32>,
    /// The last one asked for, and its number.
    last: Option<(CurveLabels, u32)>,
    /// The last tuple that something was added to, what it was, and the number of the sum.
    sum: Option<(u32, CurveLabels, u32)>,
}

impl Tuples {
    fn number(&mut self, tuple: CurveLabels) -> u32 {
        if let Some((_, number)) = self.last.filter(|l| l.0 == tuple) {
            return number;
        }
        let number = *self.numbers.entry(tuple).or_insert_with(|| {
            self.list.push(tuple);
            self.list.len() as u32 - 1
        });
        self.last = Some((tuple, number));
        number
    }

    /// Replaces a tuple by its union with another.
    fn add(&mut self, number: &mut u32, other: CurveLabels) {
        if let Some((_, _, sum)) = self.sum.filter(|s| s.0 == *number && s.1 == other) {
            *number = sum;
            return;
        }
        let t = self.list[*number as usize];
        let sum = self.number(CurveLabels {
            edge: t.edge.union(other.edge),
            left: t.left.union(other.left),
            right: t.right.union(other.right),
            start: t.start.union(other.start),
            end: t.end.union(other.end),
        });
        self.sum = Some((*number, other, sum));
        *number = sum;
    }
}
