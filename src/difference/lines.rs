//! The lines of drawings compared, layer by layer: the pieces of each that run along no line of the other side.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::Amounts;
use fretwork_fabricate::{Item, Layer};
use fretwork_geometry::Point;
use fretwork_geometry::index::{BoxTree, Extent};

/// Lines nearer than this are one, in the unit of the file: ten steps of what files are exact to. With fewer a line that was
/// divided elsewhere, and rounded there, would be another one; with more a line that was moved would not.
const NEAR: f64 = 1e-3;
/// The sine of the greatest angle between lines that run along one another. Chords of one arc that was flattened in two ways
/// meet at a few degrees; lines that cross must not count as common where they do.
const ALONG: f64 = 0.1;

/// What differs.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    /// What is only after.
    pub added: Vec<Vec<Point>>,
    /// What was only before.
    pub removed: Vec<Vec<Point>>,
    /// The length of what both have.
    pub common: f64,
}

impl Lines {
    /// The lengths, in `unit`.
    pub fn amounts(&self, unit: &'static str) -> Amounts {
        Amounts {
            added: length(&self.added),
            removed: length(&self.removed),
            common: self.common,
            unit,
        }
    }
}

fn length(lines: &[Vec<Point>]) -> f64 {
    let of = |line: &Vec<Point>| line.windows(2).map(|p| (p[1] - p[0]).length()).sum::<f64>();
    lines.iter().map(of).sum()
}

/// The lines of layers of the same name compared.
pub fn compare(before: &[Layer], after: &[Layer]) -> Lines {
    let (before, after) = (by_layer(before), by_layer(after));
    let names: BTreeSet<_> = before.keys().chain(after.keys()).collect();
    let mut all = Lines::default();
    for name in names {
        let of =
            |layers: &BTreeMap<_, Vec<Vec<Point>>>| layers.get(name).cloned().unwrap_or_default();
        let one = compare_lines(&of(&before), &of(&after));
        all.added.extend(one.added);
        all.removed.extend(one.removed);
        all.common += one.common;
    }
    all
}

fn by_layer(layers: &[Layer]) -> BTreeMap<Arc<str>, Vec<Vec<Point>>> {
    let mut all: BTreeMap<_, Vec<Vec<Point>>> = BTreeMap::new();
    for layer in layers {
        let lines = layer.items.iter().filter_map(|item| match item {
            Item::Line(line) => Some(line.clone()),
            Item::Area(_) => None,
        });
        let known = all.entry(layer.name.clone()).or_default();
        known.extend(lines);
    }
    all
}

/// Polylines compared. O((n + k) log n) for n segments of which k pairs lie near one another.
///
/// ```
/// use fretwork_difference::lines::compare_lines;
/// use fretwork_geometry::Point;
/// let line = |a: f64, b: f64| vec![vec![Point::new(a, 1.0), Point::new(b, 1.0)]];
/// let found = compare_lines(&line(0.0, 6.0), &line(8.0, 2.0));
/// assert_eq!(found.removed, line(0.0, 2.0));
/// assert_eq!((found.added, found.common), (line(8.0, 6.0), 4.0));
/// ```
pub fn compare_lines(before: &[Vec<Point>], after: &[Vec<Point>]) -> Lines {
    let removed = less(before, after);
    Lines {
        added: less(after, before),
        common: (length(before) - length(&removed)).max(0.0),
        removed,
    }
}

/// The pieces of `lines` that run along none of `other`.
fn less(lines: &[Vec<Point>], other: &[Vec<Point>]) -> Vec<Vec<Point>> {
    let key = |line: &Vec<Point>| -> Vec<u64> {
        let corners = line.iter().flat_map(|p| [p.x.to_bits(), p.y.to_bits()]);
        corners.collect()
    };
    let known: BTreeSet<Vec<u64>> = other.iter().map(key).collect();
    let mut fresh = lines
        .iter()
        .filter(|line| !known.contains(&key(line)))
        .peekable();
    if fresh.peek().is_none() {
        return Vec::new();
    }
    let segments: Vec<[Point; 2]> = other
        .iter()
        .flat_map(|line| line.windows(2).map(|p| [p[0], p[1]]))
        .collect();
    let extents: Vec<Extent<2>> = segments.iter().map(|s| extent(*s, 0.0)).collect();
    let tree = BoxTree::new(&extents);
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    for line in fresh {
        for ends in line.windows(2) {
            let segment = [ends[0], ends[1]];
            let near = tree.meeting(&extent(segment, NEAR));
            let covers = near.iter().map(|i| segments[*i as usize]);
            for piece in uncovered(segment, covers) {
                push(&mut pieces, piece);
            }
        }
    }
    pieces
}

/// Adds a piece, to the end of the last one if it goes on from there.
fn push(pieces: &mut Vec<Vec<Point>>, [from, to]: [Point; 2]) {
    match pieces.last_mut() {
        Some(last) if last.last() == Some(&from) => last.push(to),
        _ => pieces.push(vec![from, to]),
    }
}

fn extent([a, b]: [Point; 2], more: f64) -> Extent<2> {
    Extent {
        min: [a.x.min(b.x) - more, a.y.min(b.y) - more],
        max: [a.x.max(b.x) + more, a.y.max(b.y) + more],
    }
}

/// The pieces of a segment beside which none of `covers` runs, in order.
fn uncovered(segment: [Point; 2], covers: impl Iterator<Item = [Point; 2]>) -> Vec<[Point; 2]> {
    let whole = segment[1] - segment[0];
    let length = whole.length();
    if length == 0.0 {
        return Vec::new();
    }
    let mut covered: Vec<[f64; 2]> = covers
        .filter_map(|cover| beside(segment, length, cover))
        .collect();
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut pieces = Vec::new();
    let mut at = 0.0;
    let place = |along: f64| {
        if along >= length {
            segment[1]
        } else {
            segment[0] + whole * (along / length)
        }
    };
    for [from, to] in covered.into_iter().chain([[length, length]]) {
        // What is left between two covers by rounding is nothing.
        if from - at > NEAR {
            pieces.push([place(at), place(from)]);
        }
        at = to.max(at);
    }
    pieces
}

/// The part of a segment, from and to in lengths along it, beside which `cover` runs.
fn beside(segment: [Point; 2], length: f64, cover: [Point; 2]) -> Option<[f64; 2]> {
    let unit = (segment[1] - segment[0]) * (1.0 / length);
    let [from, to] = cover.map(|p| p - segment[0]);
    let (along, off) = (
        [from.dot(unit), to.dot(unit)],
        [unit.cross(from), unit.cross(to)],
    );
    let slope = off[1] - off[0];
    if slope.abs() > ALONG * (to - from).length() {
        return None;
    }
    // The share of the cover that is near enough: its distance is linear along it.
    let (mut low, mut high) = (0.0f64, 1.0f64);
    if slope == 0.0 {
        if off[0].abs() > NEAR {
            return None;
        }
    } else {
        let ends = [-NEAR, NEAR].map(|distance| (distance - off[0]) / slope);
        low = low.max(ends[0].min(ends[1]));
        high = high.min(ends[0].max(ends[1]));
    }
    let reach = [low, high].map(|share| along[0] + (along[1] - along[0]) * share);
    let [low_at, high_at] = [
        reach[0].min(reach[1]).max(0.0),
        reach[0].max(reach[1]).min(length),
    ];
    (low <= high && low_at < high_at).then_some([low_at, high_at])
}
