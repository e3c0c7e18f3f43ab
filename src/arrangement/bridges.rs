//! The shortest bridges that join pieces: a minimum spanning tree over the exact distances of their
//! outlines (Borůvka 1926), as far as bridges stay inside a region.

use super::buckets::Buckets;
use super::distance::{Segment, nearest};
use crate::geometry::{Bounds, Point, Polygon, Region};

/// Straight ways between pieces of least total length that leave `count` pieces, at least 1, as far as there
/// are ways inside `region`; ascending by length.
pub(super) fn bridges(pieces: &[Polygon], region: &Region, count: usize) -> Vec<Segment> {
    let mut tree = Outlines::new(pieces, region).spanning_tree();
    tree.truncate(pieces.len().saturating_sub(count.max(1)));
    tree
}

struct Outlines<'a> {
    region: &'a Region,
    /// All sides of all pieces, and the piece of each.
    sides: Vec<(Segment, u32)>,
    near: Buckets,
    border: Vec<Segment>,
    near_border: Buckets,
    bounds: Bounds,
    /// The width of a bucket.
    step: f64,
    pieces: usize,
}

/// A way to another piece: its length, the sides it ends on, the points.
type Way = (f64, usize, usize, Segment);

impl<'a> Outlines<'a> {
    fn new(pieces: &[Polygon], region: &'a Region) -> Outlines<'a> {
        let sides: Vec<(Segment, u32)> =
            (0..).zip(pieces).flat_map(|(n, piece)| sides(piece).map(move |side| (side, n))).collect();
        let bounds = pieces.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let step = (bounds.width() * bounds.height() / (1.0 + sides.len() as f64)).sqrt();
        let step = step.max(1e-6 * bounds.longer_side());
        let mut near = Buckets::over(&bounds, step);
        for (n, (side, _)) in (0..).zip(&sides) {
            near.insert(n, &Bounds::of(*side));
        }
        let border: Vec<Segment> = region.area.iter().flat_map(self::sides).collect();
        let mut near_border = Buckets::over(&region.bounds(), step);
        for (n, side) in (0..).zip(&border) {
            near_border.insert(n, &Bounds::of(*side));
        }
        Outlines { region, sides, near, border, near_border, bounds, step, pieces: pieces.len() }
    }

    fn spanning_tree(&self) -> Vec<Segment> {
        let mut groups: Vec<u32> = (0..self.pieces as u32).collect();
        let mut tree: Vec<Way> = Vec::new();
        loop {
            let mut joined = false;
            for way in self.shortest_ways(&groups) {
                let [a, b] = [way.1, way.2].map(|side| groups[self.sides[side].1 as usize]);
                if a != b {
                    groups.iter_mut().filter(|g| **g == a.max(b)).for_each(|g| *g = a.min(b));
                    tree.push(way);
                    joined = true;
                }
            }
            if !joined {
                break;
            }
        }
        tree.sort_by(compare);
        tree.into_iter().map(|way| way.3).collect()
    }

    /// The shortest way out of every group, ascending.
    fn shortest_ways(&self, groups: &[u32]) -> Vec<Way> {
        let mut best: Vec<Option<Way>> = vec![None; self.pieces];
        for side in 0..self.sides.len() {
            let group = groups[self.sides[side].1 as usize] as usize;
            let limit = best[group].map_or(f64::INFINITY, |way| way.0);
            if let Some(way) = self.way_from(side, groups, limit)
                && best[group].is_none_or(|known| compare(&way, &known).is_lt())
            {
                best[group] = Some(way);
            }
        }
        let mut ways: Vec<Way> = best.into_iter().flatten().collect();
        ways.sort_by(compare);
        ways
    }

    /// The shortest way from a side to another group, if it is not longer than `limit`.
    fn way_from(&self, side: usize, groups: &[u32], limit: f64) -> Option<Way> {
        let (from, piece) = self.sides[side];
        let group = groups[piece as usize];
        let farthest = 2.0 * (self.bounds.width() + self.bounds.height());
        let mut reach = self.step.min(limit);
        loop {
            let mut best: Option<Way> = None;
            for other in self.near.near(&Bounds::of(from).grown(reach)) {
                let (to, piece) = self.sides[other as usize];
                if groups[piece as usize] == group {
                    continue;
                }
                let ends = nearest(from, to);
                let (low, high) = (side.min(other as usize), side.max(other as usize));
                let way = (ends[0].distance(ends[1]), low, high, ends);
                let is_better = best.is_none_or(|known| compare(&way, &known).is_lt());
                if way.0 <= limit && is_better && self.is_inside(ends) {
                    best = Some(way);
                }
            }
            if best.is_some_and(|way| way.0 <= reach) || reach >= limit.min(farthest) {
                return best;
            }
            reach = (2.0 * reach).min(limit).min(farthest);
        }
    }

    /// Whether a way stays inside the region.
    fn is_inside(&self, [a, b]: Segment) -> bool {
        let middle = a.lerp(b, 0.5);
        if a != b && !self.region.area.iter().any(|polygon| polygon.contains(middle)) {
            return false;
        }
        let side = |p: Point, q: Point, r: Point| (q - p).cross(r - p);
        let leaves = |n: u32| {
            let [c, d] = self.border[n as usize];
            side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
        };
        !self.near_border.near(&Bounds::of([a, b])).into_iter().any(leaves)
    }
}

fn sides(polygon: &Polygon) -> impl Iterator<Item = Segment> + '_ {
    polygon.rings().flat_map(|ring| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]))
}

fn compare(a: &Way, b: &Way) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Seed;

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        let corners = [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
        Polygon { outer: corners.map(Point::from).to_vec(), holes: Vec::new() }
    }

    fn length(ways: &[Segment]) -> f64 {
        ways.iter().map(|[a, b]| a.distance(*b)).sum()
    }

    /// Prim's algorithm over all pairs of sides.
    fn oracle(pieces: &[Polygon], count: usize) -> f64 {
        let distance = |a: &Polygon, b: &Polygon| {
            let pairs = sides(a).flat_map(|s| sides(b).map(move |t| nearest(s, t)));
            pairs.map(|[p, q]| p.distance(q)).fold(f64::INFINITY, f64::min)
        };
        let mut reached = vec![0];
        let mut tree = Vec::new();
        while reached.len() < pieces.len() {
            let ways = reached.iter().flat_map(|i| (0..pieces.len()).map(move |j| (*i, j)));
            let new = ways.filter(|(_, j)| !reached.contains(j)).map(|(i, j)| (distance(&pieces[i], &pieces[j]), j));
            let (way, piece) = new.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            reached.push(piece);
            tree.push(way);
        }
        tree.sort_by(f64::total_cmp);
        tree[..pieces.len() - count].iter().sum()
    }

    #[test]
    fn trees_are_as_short_as_the_oracle_finds() {
        let page = Region::rectangle(Point::ORIGIN, Point::new(100.0, 100.0));
        for case in 0..10 {
            let seed = Seed::root(case);
            let pieces: Vec<Polygon> = (0..5 + 3 * case)
                .map(|i| {
                    square(
                        10.0 * (i % 6) as f64 + seed.range(3 * i, 0.0, 5.0),
                        10.0 * (i / 6) as f64 + seed.range(3 * i + 1, 0.0, 5.0),
                        seed.range(3 * i + 2, 0.5, 4.0),
                    )
                })
                .collect();
            for count in [1, 3] {
                let ways = bridges(&pieces, &page, count);
                assert_eq!(ways.len(), pieces.len() - count);
                assert!((length(&ways) - oracle(&pieces, count)).abs() < 1e-9, "case {case}");
            }
        }
    }

    #[test]
    fn ways_do_not_leave_the_region() {
        let corners =
            [[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [6.0, 8.0], [6.0, 2.0], [4.0, 2.0], [4.0, 8.0], [0.0, 8.0]];
        let region = Region::of_area(vec![Polygon { outer: corners.map(Point::from).to_vec(), holes: Vec::new() }]);
        // The squares see each other across the notch only.
        assert!(bridges(&[square(3.0, 5.0, 0.9), square(6.1, 5.0, 0.9)], &region, 1).is_empty());
        assert_eq!(bridges(&[square(3.0, 0.5, 0.9), square(6.1, 0.5, 0.9)], &region, 1).len(), 1);
        assert!(bridges(&[], &region, 1).is_empty());
    }
}
