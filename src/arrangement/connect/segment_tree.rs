//! A tree of boxes around segments that belong to groups: which segment of another group is nearest.
//! Whole subtrees of one's own group are passed by, so that the inside of a large group costs nothing.

use crate::distance::Segment;
use fretwork_geometry::{Bounds, Point};

/// Segments under a leaf.
const LEAF: usize = 4;

/// What a branch knows of the groups below it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Groups {
    One(u32),
    Many,
}

struct Branch {
    bounds: Bounds,
    /// The segments below it, as a range of the order.
    from: usize,
    to: usize,
    /// The first of its two children, which lie side by side; none below a leaf.
    children: Option<usize>,
    groups: Groups,
}

/// The tree. Building it takes n log² n steps, a look-up about log n where segments are spread out.
pub(crate) struct SegmentTree {
    /// The numbers of the segments.
    order: Vec<u32>,
    /// The root first, children after their parents.
    branches: Vec<Branch>,
}

impl SegmentTree {
    /// The tree of `sides`, which are all of one group until [`SegmentTree::regroup`] says otherwise.
    pub fn new(sides: &[Segment]) -> SegmentTree {
        let order = (0..sides.len() as u32).collect();
        let root = Branch {
            bounds: Bounds::EMPTY,
            from: 0,
            to: sides.len(),
            children: None,
            groups: Groups::One(0),
        };
        let mut tree = SegmentTree {
            order,
            branches: vec![root],
        };
        let mut next = 0;
        while next < tree.branches.len() {
            tree.grow(next, sides);
            next += 1;
        }
        tree
    }

    /// Gives a branch its box, and children where it has many segments.
    fn grow(&mut self, branch: usize, sides: &[Segment]) {
        let (from, to) = (self.branches[branch].from, self.branches[branch].to);
        let below = &mut self.order[from..to];
        let bounds = below
            .iter()
            .flat_map(|n| sides[*n as usize])
            .fold(Bounds::EMPTY, Bounds::with);
        self.branches[branch].bounds = bounds;
        if to - from <= LEAF {
            return;
        }
        let is_wide = bounds.width() > bounds.height();
        let along = |n: &u32| {
            let [a, b] = sides[*n as usize];
            if is_wide { a.x + b.x } else { a.y + b.y }
        };
        below.sort_unstable_by(|a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
        let middle = (from + to) / 2;
        self.branches[branch].children = Some(self.branches.len());
        for (from, to) in [(from, middle), (middle, to)] {
            self.branches.push(Branch {
                bounds,
                from,
                to,
                children: None,
                groups: Groups::One(0),
            });
        }
    }

    /// Takes note of the group of each segment.
    pub fn regroup(&mut self, group: impl Fn(usize) -> u32) {
        for n in (0..self.branches.len()).rev() {
            let groups = match self.branches[n].children {
                Some(first) => {
                    let [a, b] = [self.branches[first].groups, self.branches[first + 1].groups];
                    if a == b { a } else { Groups::Many }
                }
                None => {
                    let mut below = self.order[self.branches[n].from..self.branches[n].to]
                        .iter()
                        .map(|s| group(*s as usize));
                    match below.next() {
                        Some(first) if below.all(|other| other == first) => Groups::One(first),
                        Some(_) => Groups::Many,
                        None => Groups::One(0),
                    }
                }
            };
            self.branches[n].groups = groups;
        }
    }

    /// Shows `visit` the segments near `side` but those in subtrees wholly of the group `own`, nearer boxes
    /// first as a rule, and none in boxes farther away than the last answer of `visit`, which is
    /// `reach` before the first one.
    pub fn search(&self, side: Segment, own: u32, reach: f64, mut visit: impl FnMut(usize) -> f64) {
        let bounds = Bounds::of(side);
        let mut reach = reach;
        let mut waiting = vec![(gap(&bounds, &self.branches[0].bounds), 0)];
        while let Some((distance, n)) = waiting.pop() {
            let branch = &self.branches[n];
            if distance > reach || branch.groups == Groups::One(own) {
                continue;
            }
            let Some(first) = branch.children else {
                for number in &self.order[branch.from..branch.to] {
                    reach = visit(*number as usize);
                }
                continue;
            };
            let mut children =
                [first, first + 1].map(|child| (gap(&bounds, &self.branches[child].bounds), child));
            if children[0].0 < children[1].0 {
                children.swap(0, 1);
            }
            waiting.extend(children);
        }
    }
}

/// The distance of two boxes.
fn gap(a: &Bounds, b: &Bounds) -> f64 {
    let apart = |low: f64, high: f64| (low - high).max(0.0);
    let x = apart(a.min.x, b.max.x).max(apart(b.min.x, a.max.x));
    let y = apart(a.min.y, b.max.y).max(apart(b.min.y, a.max.y));
    Point::new(x, y).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::nearest;
    use fretwork_geometry::Seed;

    #[test]
    fn the_nearest_of_another_group_agrees_with_looking_at_all() {
        for case in 0..20u64 {
            let seed = Seed::root(case);
            let side = |i: u64| {
                let from = Point::new(
                    seed.range(4 * i, 0.0, 50.0),
                    seed.range(4 * i + 1, 0.0, 50.0),
                );
                [
                    from,
                    from + Point::new(
                        seed.range(4 * i + 2, -2.0, 2.0),
                        seed.range(4 * i + 3, -2.0, 2.0),
                    ),
                ]
            };
            let sides: Vec<Segment> = (0..1 + 7 * case).map(side).collect();
            let group = |n: usize| (n as u32 / 5) % 3;
            let mut tree = SegmentTree::new(&sides);
            tree.regroup(group);
            let distance = |a: usize, b: usize| {
                let [p, q] = nearest(sides[a], sides[b]);
                p.distance(q)
            };
            for one in 0..sides.len() {
                let others = (0..sides.len()).filter(|n| group(*n) != group(one));
                let least = others
                    .map(|other| distance(one, other))
                    .fold(f64::INFINITY, f64::min);
                let mut found = f64::INFINITY;
                tree.search(sides[one], group(one), f64::INFINITY, |other| {
                    if group(other) != group(one) {
                        found = found.min(distance(one, other));
                    }
                    found
                });
                assert_eq!(found, least, "case {case} side {one}");
            }
        }
    }
}
