//! Hidden lines with a visible line in the same place of the drawing: whoever draws both would draw the visible one as
//! hidden.

use rayon::prelude::*;

use super::Stretch;
use super::features::Edge;
use super::occlusion::Occluders;
use crate::budget::Meter;
use crate::index::{BoxTree, Extent};
use crate::{Bounds, Point};

/// Lines are in one place where they are nearer than this part of the drawing.
const SAME: f64 = 1e-7;

/// The stretches without what is hidden and lies under one that is seen, in the same order. O(n log n) where few lie in one
/// place.
pub(super) fn uncovered(
    edges: &[Edge],
    stretches: Vec<Stretch>,
    drawn: &Occluders<'_>,
) -> Vec<Stretch> {
    let ends = |stretch: &Stretch| {
        let [a, b] = edges[stretch.edge as usize].corners.map(|c| drawn.at(c));
        [a.lerp(b, stretch.from), a.lerp(b, stretch.to)]
    };
    let seen: Vec<[Point; 2]> = stretches
        .iter()
        .filter(|stretch| stretch.is_visible)
        .map(ends)
        .collect();
    let extents: Vec<Extent<2>> = seen.iter().map(|s| Bounds::of(*s).into()).collect();
    let whole = Bounds::of(stretches.iter().flat_map(ends));
    let near = SAME * whole.longer_side();
    let tree = BoxTree::new(&extents);
    let meter = Meter::current();
    let kept: Vec<Vec<Stretch>> = stretches
        .par_iter()
        .map(|stretch| {
            if stretch.is_visible {
                return vec![*stretch];
            }
            meter.during(|| {
                let line = ends(stretch);
                let around = Bounds::of(line).grown(near);
                let met = tree.meeting(&around.into()).into_iter();
                let covers = met.filter_map(|n| covered(line, seen[n as usize], near));
                without(stretch, covers.collect())
            })
        })
        .collect();
    kept.concat()
}

/// Which part of a line lies within `near` of another one, as parts of its length.
fn covered([a, b]: [Point; 2], other: [Point; 2], near: f64) -> Option<[f64; 2]> {
    let way = b - a;
    let length = way.length();
    if length <= near {
        return Some([0.0, 1.0]);
    }
    let off = other.map(|p| ((p - a).cross(way) / length).abs());
    if off[0] > near || off[1] > near {
        return None;
    }
    let along = other.map(|p| (p - a).dot(way) / (length * length));
    let slack = near / length;
    let from = along[0].min(along[1]) - slack;
    let to = along[0].max(along[1]) + slack;
    // What meets the line in a point, or goes on where it ends, covers nothing of it.
    (to.min(1.0) - from.max(0.0) > 4.0 * slack).then_some([from, to])
}

/// What is left of a stretch without some parts of it, in order.
fn without(stretch: &Stretch, mut covers: Vec<[f64; 2]>) -> Vec<Stretch> {
    if covers.is_empty() {
        return vec![*stretch];
    }
    covers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    covers.push([1.0, 1.0]);
    let (mut at, mut left) = (0.0f64, Vec::new());
    let place = |t: f64| match t {
        0.0 => stretch.from,
        1.0 => stretch.to,
        t => stretch.from + t * (stretch.to - stretch.from),
    };
    for [from, to] in covers {
        if from.min(1.0) > at {
            left.push(Stretch {
                from: place(at),
                to: place(from.min(1.0)),
                ..*stretch
            });
        }
        at = at.max(to);
    }
    left
}
