//! Points that can be taken out: which of those left is nearest.

use std::cmp::Ordering;

/// A balanced kd-tree of numbered points (Bentley 1975) from which points can be removed, as a tour that always goes on to
/// the nearest place left needs it.
///
/// The median of each stretch of the order is the node of that stretch, and levels split by one coordinate after the other, so
/// that the tree needs no pointers. Construction takes O(n log n), a removal O(log n), a look-up O(log n) on
/// average where points are spread out.
///
/// ```
/// use fretwork_geometry::index::KdTree;
/// let mut tree = KdTree::new(vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]]);
/// assert_eq!(tree.nearest([2.0, 0.0]), Some(1));
/// tree.remove(1);
/// assert_eq!(tree.nearest([2.0, 0.0]), Some(2));
/// ```
#[derive(Clone, Debug)]
pub struct KdTree<const N: usize> {
    points: Vec<[f64; N]>,
    order: Vec<u32>,
    /// Where each point stands in the order.
    places: Vec<u32>,
    /// How many points are left in the stretch whose median is here.
    left: Vec<u32>,
    is_removed: Vec<bool>,
}

impl<const N: usize> KdTree<N> {
    /// The tree of `points`, which must be finite.
    pub fn new(points: Vec<[f64; N]>) -> KdTree<N> {
        let n = points.len();
        let mut order: Vec<u32> = (0..n as u32).collect();
        let mut left = vec![0; n];
        let mut stretches = vec![(0, n, 0)];
        while let Some((low, high, axis)) = stretches.pop() {
            if low == high {
                continue;
            }
            let middle = (low + high) / 2;
            order[low..high]
                .select_nth_unstable_by(middle - low, |&a, &b| compare(&points, axis, a, b));
            left[middle] = (high - low) as u32;
            let axis = (axis + 1) % N;
            stretches.extend([(low, middle, axis), (middle + 1, high, axis)]);
        }
        let mut places = vec![0; n];
        for (place, &i) in (0..).zip(&order) {
            places[i as usize] = place;
        }
        KdTree {
            points,
            order,
            places,
            left,
            is_removed: vec![false; n],
        }
    }

    /// How many points are left.
    pub fn len(&self) -> usize {
        let root = self.order.len() / 2;
        self.left.get(root).map_or(0, |left| *left as usize)
    }

    /// Whether no point is left.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Takes out a point, which must be one of the numbers given; a second time changes nothing.
    pub fn remove(&mut self, point: usize) {
        if std::mem::replace(&mut self.is_removed[point], true) {
            return;
        }
        let place = self.places[point] as usize;
        let (mut low, mut high) = (0, self.order.len());
        loop {
            let middle = (low + high) / 2;
            self.left[middle] -= 1;
            match place.cmp(&middle) {
                Ordering::Less => high = middle,
                Ordering::Equal => return,
                Ordering::Greater => low = middle + 1,
            }
        }
    }

    /// The number of the point nearest to `at` among those left; of several the least.
    pub fn nearest(&self, at: [f64; N]) -> Option<usize> {
        let mut best = (f64::INFINITY, usize::MAX);
        self.search(at, (0, self.order.len()), 0, &mut best);
        (best.1 != usize::MAX).then_some(best.1)
    }

    fn search(
        &self,
        at: [f64; N],
        (low, high): (usize, usize),
        axis: usize,
        best: &mut (f64, usize),
    ) {
        let middle = (low + high) / 2;
        if low == high || self.left[middle] == 0 {
            return;
        }
        let i = self.order[middle] as usize;
        let point = &self.points[i];
        let here = (squared_distance(&at, point), i);
        if !self.is_removed[i] && here < *best {
            *best = here;
        }
        let beyond = at[axis] - point[axis];
        let mut sides = [(low, middle), (middle + 1, high)];
        if beyond >= 0.0 {
            sides.swap(0, 1);
        }
        let axis = (axis + 1) % N;
        self.search(at, sides[0], axis, best);
        if beyond * beyond <= best.0 {
            self.search(at, sides[1], axis, best);
        }
    }
}

/// The order by one coordinate, then the ones after it in a circle, then the number.
fn compare<const N: usize>(points: &[[f64; N]], axis: usize, a: u32, b: u32) -> Ordering {
    let (p, q) = (&points[a as usize], &points[b as usize]);
    (0..N)
        .map(|k| (axis + k) % N)
        .fold(Ordering::Equal, |order, k| {
            order.then_with(|| p[k].total_cmp(&q[k]))
        })
        .then(a.cmp(&b))
}

fn squared_distance<const N: usize>(p: &[f64; N], q: &[f64; N]) -> f64 {
    (0..N).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    fn check<const N: usize>(seed: Seed) {
        // Whole numbers of a small range, so that many distances are equal.
        let at =
            |i: u64| std::array::from_fn(|k| (seed.unit(N as u64 * i + k as u64) * 20.0).floor());
        let points: Vec<[f64; N]> = (0..300).map(at).collect();
        let mut tree = KdTree::new(points.clone());
        let mut left: Vec<usize> = (0..300).collect();
        for k in 0..300 {
            let q = at(1000 + k);
            let order = |i: usize| (squared_distance(&q, &points[i]), i);
            let slow = left.iter().copied().min_by(|&i, &j| {
                let (a, b) = (order(i), order(j));
                a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
            });
            let found = tree.nearest(q);
            assert_eq!(found, slow);
            tree.remove(found.unwrap());
            left.retain(|&i| Some(i) != found);
            assert_eq!(tree.len(), left.len());
        }
        assert_eq!(tree.nearest(at(0)), None);
    }

    #[test]
    fn the_nearest_agrees_with_looking_at_every_point() {
        check::<2>(Seed::root(5));
        check::<3>(Seed::root(6));
    }
}
