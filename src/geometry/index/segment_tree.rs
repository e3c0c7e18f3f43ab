//! Segments in groups: which segment of another group is nearest.

use super::{BoxTree, Extent};
use crate::{Bounds, Point};

/// What a node knows of the groups below it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Groups {
    One(u32),
    Many,
}

/// A tree of segments that belong to groups, for searches that leave out one's own group. Subtrees wholly of that
/// group are passed by, so that the inside of a large group costs nothing; Borůvka's algorithm for a shortest
/// spanning tree asks for just that.
///
/// Construction takes O(n log n), [`SegmentTree::regroup`] O(n), a search about O(log n) where segments are spread
/// out.
///
/// ```
/// use fretwork_geometry::{Point, index::SegmentTree};
/// let side = |x: f64| [Point::new(x, 0.0), Point::new(x, 1.0)];
/// let sides = [side(0.0), side(1.0), side(5.0)];
/// let mut tree = SegmentTree::new(&sides);
/// tree.regroup(|number| if number < 2 { 0 } else { 1 });
/// let mut found = Vec::new();
/// tree.search(side(0.5), 0, f64::INFINITY, |number| {
///     found.push(number);
///     f64::INFINITY
/// });
/// // Leaves are shown whole, so that one's own may be among them.
/// assert!(found.contains(&2));
/// ```
#[derive(Clone, Debug)]
pub struct SegmentTree {
    tree: BoxTree<2>,
    /// Of every node.
    groups: Vec<Groups>,
}

impl SegmentTree {
    /// The tree of `segments`, which are all of group 0 until [`SegmentTree::regroup`] says otherwise.
    pub fn new(segments: &[[Point; 2]]) -> SegmentTree {
        let boxes: Vec<Extent<2>> = segments
            .iter()
            .map(|segment| Bounds::of(*segment).into())
            .collect();
        let tree = BoxTree::new(&boxes);
        SegmentTree {
            groups: vec![Groups::One(0); tree.node_count()],
            tree,
        }
    }

    /// Takes note of the group of each segment.
    pub fn regroup(&mut self, group: impl Fn(usize) -> u32) {
        // Children come after their parents.
        for node in (0..self.groups.len()).rev() {
            self.groups[node] = match self.tree.children(node) {
                Some([a, b]) if self.groups[a] == self.groups[b] => self.groups[a],
                Some(_) => Groups::Many,
                None => {
                    let mut below = self.tree.below(node).iter().map(|s| group(*s as usize));
                    let first = below.next().unwrap_or(0);
                    if below.all(|other| other == first) {
                        Groups::One(first)
                    } else {
                        Groups::Many
                    }
                }
            };
        }
    }

    /// Shows `visit` the segments near `segment`, nearer boxes first as a rule, but those in subtrees wholly of the group
    /// `own`, and none in boxes farther away than the last answer of `visit`, which is `reach` before the first one.
    pub fn search(
        &self,
        segment: [Point; 2],
        own: u32,
        reach: f64,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let view = Extent::from(Bounds::of(segment));
        let bound = |extent: &Extent<2>, node: usize| {
            (self.groups[node] != Groups::One(own)).then(|| extent.distance(&view))
        };
        self.tree
            .nearest_first(bound, reach, |number| visit(number as usize));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    /// The distance of two segments, from their ends; they do not cross.
    fn distance(s: [Point; 2], t: [Point; 2]) -> f64 {
        let foot = |p: Point, [a, b]: [Point; 2]| {
            let d = b - a;
            let along = ((p - a).dot(d) / d.dot(d)).clamp(0.0, 1.0);
            p.distance(a + d * along)
        };
        let ends = [foot(s[0], t), foot(s[1], t), foot(t[0], s), foot(t[1], s)];
        ends.into_iter().fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_nearest_of_another_group_agrees_with_looking_at_all() {
        for case in 0..20u64 {
            let seed = Seed::root(case);
            let side = |i: u64| {
                let number = |k: u64, low, high| seed.range(4 * i + k, low, high);
                let from = Point::new(number(0, 0.0, 50.0), number(1, 0.0, 50.0));
                [
                    from,
                    from + Point::new(number(2, -2.0, 2.0), number(3, -2.0, 2.0)),
                ]
            };
            let sides: Vec<[Point; 2]> = (0..1 + 7 * case).map(side).collect();
            let group = |n: usize| (n as u32 / 5) % 3;
            let mut tree = SegmentTree::new(&sides);
            tree.regroup(group);
            for one in 0..sides.len() {
                let others = (0..sides.len()).filter(|n| group(*n) != group(one));
                let least = others
                    .map(|other| distance(sides[one], sides[other]))
                    .fold(f64::INFINITY, f64::min);
                let mut found = f64::INFINITY;
                tree.search(sides[one], group(one), f64::INFINITY, |other| {
                    if group(other) != group(one) {
                        found = found.min(distance(sides[one], sides[other]));
                    }
                    found
                });
                assert_eq!(found, least, "case {case} side {one}");
            }
        }
    }
}
