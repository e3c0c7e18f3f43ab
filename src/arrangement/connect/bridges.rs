//! The shortest bridges that join pieces: a minimum spanning tree over the exact distances of their
//! outlines (Borůvka 1926), as far as bridges stay inside a region.

use crate::distance::{Segment, nearest};
use fretwork_geometry::index::{BucketGrid, SegmentTree, Squares};
use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::{Bounds, Point, Polygon, Region};

/// Straight ways between pieces of least total length that leave `count` pieces, at least 1, as far as there
/// are ways inside `region`; ascending by length.
pub(crate) fn bridges(pieces: &[Polygon], region: &Region, count: usize) -> Vec<Segment> {
    let mut tree = Outlines::new(pieces, region).spanning_tree();
    tree.truncate(pieces.len().saturating_sub(count.max(1)));
    tree
}

struct Outlines<'a> {
    region: &'a Region,
    /// All sides of all pieces, and the piece of each.
    sides: Vec<Segment>,
    piece: Vec<u32>,
    tree: SegmentTree,
    border: Vec<Segment>,
    near_border: BucketGrid,
    pieces: usize,
}

/// A way to another piece: its length, the sides it ends on, the points.
type Bridge = (f64, usize, usize, Segment);

impl<'a> Outlines<'a> {
    fn new(pieces: &[Polygon], region: &'a Region) -> Outlines<'a> {
        let (sides, piece): (Vec<Segment>, Vec<u32>) = (0..)
            .zip(pieces)
            .flat_map(|(n, piece)| sides(piece).map(move |side| (side, n)))
            .unzip();
        let border: Vec<Segment> = region.area.iter().flat_map(self::sides).collect();
        let bounds = region.bounds();
        let mut near_border = BucketGrid::empty(Squares::over(
            &bounds,
            bounds.longer_side() / (1.0 + (border.len() as f64).sqrt()),
        ));
        for (n, side) in (0..).zip(&border) {
            near_border.insert(n, &Bounds::of(*side));
        }
        Outlines {
            region,
            tree: SegmentTree::new(&sides),
            sides,
            piece,
            border,
            near_border,
            pieces: pieces.len(),
        }
    }

    fn spanning_tree(&mut self) -> Vec<Segment> {
        let mut sets = UnionFind::new(self.pieces);
        let mut tree: Vec<Bridge> = Vec::new();
        // What no way out of a side is shorter than; it stays true while groups grow.
        let mut least = vec![0.0; self.sides.len()];
        loop {
            let groups: Vec<u32> = (0..self.pieces as u32)
                .map(|piece| sets.find(piece))
                .collect();
            let mut joined = false;
            for way in self.shortest_ways(&groups, &mut least) {
                let [a, b] = [way.1, way.2].map(|side| self.piece[side]);
                if sets.unite(a, b) {
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
    fn shortest_ways(&mut self, groups: &[u32], least: &mut [f64]) -> Vec<Bridge> {
        let (piece, group_of) = (&self.piece, |side: usize| groups[self.piece[side] as usize]);
        self.tree.regroup(|side| groups[piece[side] as usize]);
        let mut best: Vec<Option<Bridge>> = vec![None; self.pieces];
        // Sides that were near to others come first: what they find spares the others a search.
        let mut order: Vec<usize> = (0..self.sides.len()).collect();
        order.sort_by(|a, b| least[*a].total_cmp(&least[*b]).then(a.cmp(b)));
        for side in order {
            let group = group_of(side) as usize;
            let limit = best[group].map_or(f64::INFINITY, |way| way.0);
            if least[side] > limit {
                continue;
            }
            let way = self.way_from(side, groups, limit);
            least[side] = way.map_or(limit, |way| way.0);
            if let Some(way) =
                way.filter(|way| best[group].is_none_or(|known| compare(way, &known).is_lt()))
            {
                best[group] = Some(way);
            }
        }
        let mut ways: Vec<Bridge> = best.into_iter().flatten().collect();
        ways.sort_by(compare);
        ways
    }

    /// The shortest way from a side to another group, if it is not longer than `limit`.
    fn way_from(&self, side: usize, groups: &[u32], limit: f64) -> Option<Bridge> {
        let (from, group) = (self.sides[side], groups[self.piece[side] as usize]);
        let mut best: Option<Bridge> = None;
        self.tree.search(from, group, limit, |other| {
            let reach = best.map_or(limit, |way| way.0);
            if groups[self.piece[other] as usize] == group {
                return reach;
            }
            let ends = nearest(from, self.sides[other]);
            let way = (
                ends[0].distance(ends[1]),
                side.min(other),
                side.max(other),
                ends,
            );
            let is_better =
                way.0 <= limit && best.is_none_or(|known| compare(&way, &known).is_lt());
            if !(is_better && self.is_inside(ends)) {
                return reach;
            }
            best = Some(way);
            way.0
        });
        best
    }

    /// Whether a way stays inside the region.
    fn is_inside(&self, [a, b]: Segment) -> bool {
        let middle = a.lerp(b, 0.5);
        if a != b
            && !self
                .region
                .area
                .iter()
                .any(|polygon| polygon.contains(middle))
        {
            return false;
        }
        let side = |p: Point, q: Point, r: Point| (q - p).cross(r - p);
        let leaves = |n: u32| {
            let [c, d] = self.border[n as usize];
            side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
        };
        !self
            .near_border
            .near(&Bounds::of([a, b]))
            .into_iter()
            .any(leaves)
    }
}

fn sides(polygon: &Polygon) -> impl Iterator<Item = Segment> + '_ {
    polygon
        .rings()
        .flat_map(|ring| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]))
}

fn compare(a: &Bridge, b: &Bridge) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        let corners = [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
        Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: Vec::new(),
        }
    }

    fn length(ways: &[Segment]) -> f64 {
        ways.iter().map(|[a, b]| a.distance(*b)).sum()
    }

    /// Prim's algorithm over all pairs of sides.
    fn oracle(pieces: &[Polygon], count: usize) -> f64 {
        let distance = |a: &Polygon, b: &Polygon| {
            let pairs = sides(a).flat_map(|s| sides(b).map(move |t| nearest(s, t)));
            pairs
                .map(|[p, q]| p.distance(q))
                .fold(f64::INFINITY, f64::min)
        };
        let mut reached = vec![0];
        let mut tree = Vec::new();
        while reached.len() < pieces.len() {
            let ways = reached
                .iter()
                .flat_map(|i| (0..pieces.len()).map(move |j| (*i, j)));
            let new = ways
                .filter(|(_, j)| !reached.contains(j))
                .map(|(i, j)| (distance(&pieces[i], &pieces[j]), j));
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
                assert!(
                    (length(&ways) - oracle(&pieces, count)).abs() < 1e-9,
                    "case {case}"
                );
            }
        }
    }

    #[test]
    fn ways_do_not_leave_the_region() {
        let corners = [
            [0.0, 0.0],
            [10.0, 0.0],
            [10.0, 8.0],
            [6.0, 8.0],
            [6.0, 2.0],
            [4.0, 2.0],
            [4.0, 8.0],
            [0.0, 8.0],
        ];
        let region = Region::of_area(vec![Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: Vec::new(),
        }]);
        // The squares see each other across the notch only.
        assert!(bridges(&[square(3.0, 5.0, 0.9), square(6.1, 5.0, 0.9)], &region, 1).is_empty());
        assert_eq!(
            bridges(&[square(3.0, 0.5, 0.9), square(6.1, 0.5, 0.9)], &region, 1).len(),
            1
        );
        assert!(bridges(&[], &region, 1).is_empty());
    }
}
