//! A tree of boxes: a bounding volume hierarchy.

use std::ops::Range;

use rayon::prelude::*;

use super::Extent;
use crate::budget;

/// Steps for a pair of boxes, which also bound how many are held.
const PAIR: u64 = 20;

/// Boxes in a leaf, at most. With fewer the tree has more nodes than boxes and a search reads more memory; with more, a
/// search looks at boxes that a node would have spared it. Between 2 and 8 the time hardly changes.
const LEAF: usize = 4;

/// The nodes of a level are made in parallel where there are so many boxes: with fewer that takes longer than it spares.
const PARALLEL: usize = 1 << 14;

/// Waiting nodes of a search. A node has at most half of its parent's boxes, and for each level one sibling
/// waits: 32 levels hold all boxes that 32-bit numbers can name.
const WAITING: usize = 64;

/// A balanced tree of boxes that are numbered from 0: a bounding volume hierarchy, split at the median along the axis on
/// which the middles are spread most (Ericson, Real-Time Collision Detection, 2005, section 6.2).
///
/// Construction takes O(n log n). A search for what meets a box takes O(log n + k) for k answers where boxes are small
/// beside their distances, and O(n) where all overlap. The tree depends on nothing but the boxes and their order.
///
/// ```
/// use fretwork_geometry::index::{BoxTree, Extent};
/// let boxes: Vec<Extent<2>> = (0..9).map(|i| Extent::from([f64::from(i), 0.0])).collect();
/// let tree = BoxTree::new(&boxes);
/// let view = Extent { min: [2.5, -1.0], max: [4.0, 1.0] };
/// assert_eq!(tree.meeting(&view), [3, 4]);
/// // The nearest to a point: no box is opened that is farther away than what was found.
/// let (at, mut best) = (Extent::from([6.2, 3.0]), (f64::INFINITY, 0));
/// tree.nearest_first(|node, _| Some(node.distance(&at)), f64::INFINITY, |number| {
///     let distance = boxes[number as usize].distance(&at);
///     if distance < best.0 {
///         best = (distance, number);
///     }
///     best.0
/// });
/// assert_eq!(best.1, 6);
/// ```
#[derive(Clone, Debug)]
pub struct BoxTree<const N: usize> {
    boxes: Vec<Extent<N>>,
    /// The numbers of the boxes; those below a node are neighbours.
    order: Vec<u32>,
    /// The root first, children after their parents.
    nodes: Vec<Node<N>>,
}

#[derive(Clone, Debug)]
struct Node<const N: usize> {
    extent: Extent<N>,
    /// The range of the order below it.
    from: u32,
    to: u32,
    /// The first of its two children, which lie side by side; 0 for a leaf.
    first_child: u32,
}

impl<const N: usize> BoxTree<N> {
    /// The tree of `boxes`. They must be finite; empty ones are found by nobody.
    pub fn new(boxes: &[Extent<N>]) -> BoxTree<N> {
        BoxTree::of(boxes.to_vec())
    }

    /// [`BoxTree::new`] of boxes that nobody else needs.
    pub fn of(boxes: Vec<Extent<N>>) -> BoxTree<N> {
        let root = Node {
            extent: Extent::EMPTY,
            from: 0,
            to: boxes.len() as u32,
            first_child: 0,
        };
        let mut tree = BoxTree {
            order: (0..boxes.len() as u32).collect(),
            boxes,
            nodes: vec![root],
        };
        let mut level = 0..1;
        while !level.is_empty() {
            tree.grow(level.clone());
            level = level.end..tree.nodes.len();
        }
        tree
    }

    /// Gives the nodes of a level their boxes, and children where they have many boxes.
    fn grow(&mut self, level: Range<usize>) {
        let boxes = &self.boxes;
        let extents: Vec<Extent<N>> = {
            let mut parts = parts(&mut self.order, &self.nodes[level.clone()]);
            if boxes.len() >= PARALLEL {
                let parts = parts.par_iter_mut();
                parts.map(|below| arrange(boxes, below)).collect()
            } else {
                let parts = parts.iter_mut();
                parts.map(|below| arrange(boxes, below)).collect()
            }
        };
        for (node, extent) in level.zip(extents) {
            let (from, to) = (self.nodes[node].from, self.nodes[node].to);
            self.nodes[node].extent = extent;
            let count = (to - from) as usize;
            if count <= LEAF {
                continue;
            }
            let middle = from + (count / 2) as u32;
            self.nodes[node].first_child = self.nodes.len() as u32;
            for (from, to) in [(from, middle), (middle, to)] {
                self.nodes.push(Node {
                    extent: Extent::EMPTY,
                    from,
                    to,
                    first_child: 0,
                });
            }
        }
    }

    /// The boxes, by their numbers.
    pub fn boxes(&self) -> &[Extent<N>] {
        &self.boxes
    }

    /// How many boxes there are.
    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    /// Whether there are no boxes.
    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// The box around all.
    pub fn extent(&self) -> &Extent<N> {
        &self.nodes[0].extent
    }

    /// The numbers of the boxes that have a point in common with `view`, ascending.
    pub fn meeting(&self, view: &Extent<N>) -> Vec<u32> {
        let mut found = Vec::new();
        self.for_meeting(view, |number| found.push(number));
        found.sort_unstable();
        found
    }

    /// Shows `visit` the numbers of the boxes that have a point in common with `view`, in the tree's own order.
    #[inline]
    pub fn for_meeting(&self, view: &Extent<N>, mut visit: impl FnMut(u32)) {
        let mut waiting = [0u32; WAITING];
        let mut count = usize::from(self.nodes[0].extent.meets(view));
        while count > 0 {
            count -= 1;
            let node = &self.nodes[waiting[count] as usize];
            if node.first_child == 0 {
                let below = &self.order[node.from as usize..node.to as usize];
                let meeting = below
                    .iter()
                    .filter(|&&i| self.boxes[i as usize].meets(view));
                meeting.for_each(|&i| visit(i));
                continue;
            }
            for child in [node.first_child + 1, node.first_child] {
                if self.nodes[child as usize].extent.meets(view) {
                    waiting[count] = child;
                    count += 1;
                }
            }
        }
    }

    /// All pairs of boxes that have a point in common, each once with the lower number first, ascending.
    pub fn meeting_pairs(&self) -> Vec<[u32; 2]> {
        let above = |i: u32| {
            let meeting = self.meeting(&self.boxes[i as usize]);
            budget::spend("boxes that meet", PAIR * (1 + meeting.len() as u64));
            let meeting = meeting.into_iter();
            meeting.filter(move |&j| j > i).map(move |j| [i, j])
        };
        (0..self.len() as u32).flat_map(above).collect()
    }

    /// Shows `visit` the numbers of boxes, those in nearer nodes first as a rule.
    ///
    /// `bound` gives what nothing in a node is nearer than, from its box and its number (see
    /// [`BoxTree::node_count`]), or none to pass by the node. `visit` answers with the distance beyond which nothing is
    /// wanted any more; before its first answer that is `reach`. It must look at the box itself: leaves are shown whole.
    #[inline]
    pub fn nearest_first(
        &self,
        bound: impl Fn(&Extent<N>, usize) -> Option<f64>,
        reach: f64,
        mut visit: impl FnMut(u32) -> f64,
    ) {
        let mut reach = reach;
        let mut waiting = [(0.0, 0u32); WAITING];
        let mut count = 0;
        if let Some(distance) = bound(&self.nodes[0].extent, 0) {
            waiting[0] = (distance, 0);
            count = 1;
        }
        while count > 0 {
            count -= 1;
            let (distance, n) = waiting[count];
            if distance > reach {
                continue;
            }
            let node = &self.nodes[n as usize];
            if node.first_child == 0 {
                for &number in &self.order[node.from as usize..node.to as usize] {
                    reach = visit(number);
                }
                continue;
            }
            let child = |n: u32| Some((bound(&self.nodes[n as usize].extent, n as usize)?, n));
            let mut children = [child(node.first_child), child(node.first_child + 1)];
            // What is pushed last comes first.
            if let [Some(a), Some(b)] = children
                && a.0 <= b.0
            {
                children.swap(0, 1);
            }
            for child in children.into_iter().flatten() {
                waiting[count] = child;
                count += 1;
            }
        }
    }

    /// How many nodes the tree has; they are numbered from 0, the root, and a node comes before its children.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The numbers of a node's two children; none for a leaf.
    pub fn children(&self, node: usize) -> Option<[usize; 2]> {
        let first = self.nodes[node].first_child as usize;
        (first > 0).then_some([first, first + 1])
    }

    /// The numbers of the boxes below a node.
    pub fn below(&self, node: usize) -> &[u32] {
        &self.order[self.nodes[node].from as usize..self.nodes[node].to as usize]
    }
}

/// What lies below each of the nodes of one level, which come in the order of what they hold.
fn parts<'a, const N: usize>(order: &'a mut [u32], nodes: &[Node<N>]) -> Vec<&'a mut [u32]> {
    let (mut rest, mut begin) = (order, 0);
    let below = |node: &Node<N>| {
        let after = &mut std::mem::take(&mut rest)[(node.from - begin) as usize..];
        let (own, after) = after.split_at_mut((node.to - node.from) as usize);
        (rest, begin) = (after, node.to);
        own
    };
    nodes.iter().map(below).collect()
}

/// Puts the lower half of the boxes of a node before the upper one, or those of a leaf into order. The box around all.
fn arrange<const N: usize>(boxes: &[Extent<N>], below: &mut [u32]) -> Extent<N> {
    let all = below.iter().map(|&i| &boxes[i as usize]);
    let extent = all.fold(Extent::EMPTY, |all, b| all.union(b));
    if below.len() <= LEAF {
        below.sort_unstable();
        return extent;
    }
    let axis = widest_axis(below.iter().map(|&i| &boxes[i as usize]));
    let key = |i: u32| boxes[i as usize].doubled_middle(axis);
    let half = below.len() / 2;
    below.select_nth_unstable_by(half, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    extent
}

/// The axis on which the middles of boxes are spread most; of equal ones the first.
fn widest_axis<'a, const N: usize>(boxes: impl Iterator<Item = &'a Extent<N>>) -> usize {
    let spread = boxes.fold(Extent::EMPTY, |all: Extent<N>, b| {
        let middle: [f64; N] = std::array::from_fn(|axis| b.doubled_middle(axis));
        all.union(&Extent::from(middle))
    });
    let width = |axis: usize| spread.max[axis] - spread.min[axis];
    (1..N).fold(0, |best, axis| {
        if width(axis) > width(best) {
            axis
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    fn boxes(seed: Seed, count: u64) -> Vec<Extent<3>> {
        let number = |i: u64, k: u64| seed.range(10 * i + k, 0.0, 20.0);
        (0..count)
            .map(|i| {
                let at = [number(i, 0), number(i, 1), number(i, 2)];
                let size = [number(i, 3), number(i, 4), number(i, 5)];
                Extent {
                    min: at,
                    max: std::array::from_fn(|k| at[k] + 0.1 * size[k]),
                }
            })
            .collect()
    }

    #[test]
    fn what_meets_a_box_agrees_with_looking_at_all() {
        for case in 0..20 {
            let seed = Seed::root(case);
            let boxes = boxes(seed, 7 * case);
            let tree = BoxTree::new(&boxes);
            for view in self::boxes(seed.number(1), 10) {
                let all = (0..boxes.len() as u32).filter(|&i| boxes[i as usize].meets(&view));
                assert_eq!(tree.meeting(&view), all.collect::<Vec<_>>(), "case {case}");
            }
            let pairs = (0..boxes.len() as u32).flat_map(|i| {
                let after = i + 1..boxes.len() as u32;
                after.map(move |j| [i, j])
            });
            let pairs = pairs.filter(|p| boxes[p[0] as usize].meets(&boxes[p[1] as usize]));
            assert_eq!(
                tree.meeting_pairs(),
                pairs.collect::<Vec<_>>(),
                "case {case}"
            );
        }
    }

    #[test]
    fn the_nearest_agrees_with_looking_at_all() {
        let boxes = boxes(Seed::root(3), 150);
        let tree = BoxTree::new(&boxes);
        for view in self::boxes(Seed::root(4), 50) {
            let slow = boxes.iter().map(|b| b.distance(&view));
            let slow = slow.fold(f64::INFINITY, f64::min);
            let (mut found, mut looked) = (f64::INFINITY, 0);
            let bound = |extent: &Extent<3>, _| Some(extent.distance(&view));
            tree.nearest_first(bound, f64::INFINITY, |number| {
                looked += 1;
                found = found.min(boxes[number as usize].distance(&view));
                found
            });
            assert_eq!(found, slow);
            assert!(looked < 100, "{looked} of 150 boxes were looked at");
        }
    }

    #[test]
    fn many_boxes_are_found_as_few_are() {
        let boxes = boxes(Seed::root(5), PARALLEL as u64 + 7);
        let tree = BoxTree::new(&boxes);
        for view in &boxes[..20] {
            let all = (0..boxes.len() as u32).filter(|&i| boxes[i as usize].meets(view));
            assert_eq!(tree.meeting(view), all.collect::<Vec<_>>());
        }
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let alone = one.expect("a pool of one").install(|| BoxTree::new(&boxes));
        assert_eq!(alone.order, tree.order);
    }

    #[test]
    fn nodes_know_what_is_below_them() {
        let boxes = boxes(Seed::root(3), 50);
        let tree = BoxTree::new(&boxes);
        for node in 0..tree.node_count() {
            if let Some(children) = tree.children(node) {
                let both = children.map(|child| tree.below(child)).concat();
                assert_eq!(both, tree.below(node));
            }
        }
        assert_eq!(BoxTree::<2>::new(&[]).meeting(&Extent::EMPTY), []);
    }
}
