//! Parts of edges joined to lines.

use std::collections::BTreeMap;

use super::features::Edge;
use super::occlusion::Occluders;
use super::{Line, LineKind, Stretch};
use crate::Point;

/// Where lines meet: at a corner of the mesh, for lines of one kind.
type Joint = (LineKind, bool, u32);

/// The lines that `stretches` are. Two that meet at a corner and are of one kind are one line, if no third one of their kind
/// meets them there.
pub(super) fn join(edges: &[Edge], stretches: &[Stretch], drawn: &Occluders<'_>) -> Vec<Line> {
    let chains = Chains::new(edges, stretches);
    let mut used = vec![false; stretches.len()];
    let mut lines = Vec::new();
    for first in 0..stretches.len() {
        if used[first] {
            continue;
        }
        // Forward from its end, then backward from its beginning.
        used[first] = true;
        let mut way = vec![(first, true)];
        chains.follow(&mut way, &mut used);
        let mut back = vec![(first, false)];
        chains.follow(&mut back, &mut used);
        let before = back.split_off(1).into_iter().rev();
        let whole: Vec<(usize, bool)> = before
            .map(|(s, forward)| (s, !forward))
            .chain(way)
            .collect();
        let edge = &edges[stretches[first].edge as usize];
        lines.push(Line {
            points: points(edges, stretches, &whole, drawn),
            kind: edge.kind,
            is_visible: stretches[first].is_visible,
        });
    }
    lines
}

struct Chains<'a> {
    edges: &'a [Edge],
    stretches: &'a [Stretch],
    /// The stretches that end at each joint.
    at: BTreeMap<Joint, Vec<usize>>,
}

impl<'a> Chains<'a> {
    fn new(edges: &'a [Edge], stretches: &'a [Stretch]) -> Chains<'a> {
        let mut chains = Chains {
            edges,
            stretches,
            at: BTreeMap::new(),
        };
        for number in 0..stretches.len() {
            for at_end in [false, true] {
                if let Some(joint) = chains.joint(number, at_end) {
                    chains.at.entry(joint).or_default().push(number);
                }
            }
        }
        chains
    }

    /// The joint at the beginning or the end of a stretch; none where it ends between corners.
    fn joint(&self, number: usize, at_end: bool) -> Option<Joint> {
        let stretch = &self.stretches[number];
        let edge = &self.edges[stretch.edge as usize];
        let corner = match at_end {
            false if stretch.from == 0.0 => edge.corners[0],
            true if stretch.to == 1.0 => edge.corners[1],
            _ => return None,
        };
        Some((edge.kind, stretch.is_visible, corner))
    }

    /// Goes on from the last stretch of `way`, as far as there is one way to go.
    fn follow(&self, way: &mut Vec<(usize, bool)>, used: &mut [bool]) {
        while let Some(&(number, forward)) = way.last() {
            let Some(joint) = self.joint(number, forward) else {
                return;
            };
            let [a, b] = self.at[&joint][..] else {
                return;
            };
            let next = if a == number { b } else { a };
            if std::mem::replace(&mut used[next], true) {
                return;
            }
            way.push((next, self.joint(next, false) == Some(joint)));
        }
    }
}

/// The points of a way over stretches, each forward or backward.
fn points(
    edges: &[Edge],
    stretches: &[Stretch],
    way: &[(usize, bool)],
    drawn: &Occluders<'_>,
) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for &(number, forward) in way {
        let stretch = &stretches[number];
        let [a, b] = edges[stretch.edge as usize].corners.map(|c| drawn.at(c));
        // The ends are the corners themselves, so that lines that meet have one point there.
        let at = |t: f64| match t {
            0.0 => a,
            1.0 => b,
            t => a.lerp(b, t),
        };
        let mut ends = [at(stretch.from), at(stretch.to)];
        if !forward {
            ends.reverse();
        }
        for p in ends {
            if points.last() != Some(&p) {
                points.push(p);
            }
        }
    }
    points
}
