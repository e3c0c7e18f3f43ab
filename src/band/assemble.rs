//! The outlines of placed pieces are linked to closed contours, and contours to polygons with holes
//! (Zhou 2014, section 4.3). What comes out is counted in `synthesize`.

use crate::geometry::polygon::signed_area;
use crate::geometry::{Point, Polygon, Ring};

use super::piece::{Port, Side};
use super::stitch::Placed;

/// The polygons of pieces that follow one another, in the coordinates of the strip; with `closed` the last is joined to
/// the first, else every open portal is closed by a straight edge. Points are moved by `map`, which keeps the interior on
/// the left, and edges are divided before where `divide` says so.
pub fn assemble(
    placed: &[Placed],
    closed: bool,
    divide: &dyn Fn(Point, Point, &mut Vec<Point>),
    map: &dyn Fn(Point) -> Point,
) -> Vec<Polygon> {
    let index = Index::new(placed);
    let image = |points: Vec<Point>| -> Ring {
        let n = points.len();
        let mut ring = Vec::with_capacity(n);
        for i in 0..n {
            ring.push(points[i]);
            divide(points[i], points[(i + 1) % n], &mut ring);
        }
        let mut ring: Ring = ring.into_iter().map(map).collect();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    };
    let mut ring_of = vec![usize::MAX; index.len()];
    let mut rings: Vec<Ring> = Vec::new();
    for start in 0..index.len() {
        if ring_of[start] != usize::MAX {
            continue;
        }
        let mut points = Vec::new();
        let mut at = start;
        while ring_of[at] == usize::MAX {
            ring_of[at] = rings.len();
            let (k, c) = index.outline(at);
            let (next, joined) = index.after(placed, at, closed);
            // Where two outlines meet their common point is taken once, and across a closed portal both.
            let chain = &placed[k].chains[c].points;
            points.extend_from_slice(&chain[..chain.len() - usize::from(joined)]);
            at = next;
        }
        rings.push(image(points));
    }
    let mut sets: Vec<usize> = (0..rings.len()).collect();
    for (a, b) in index.portals(placed) {
        join(&mut sets, ring_of[a], ring_of[b]);
    }
    let components: Vec<usize> = (0..rings.len()).map(|i| root(&sets, i)).collect();
    let loose = placed.iter().flat_map(|p| &p.rings).map(|r| image(r.clone())).collect();
    group(rings, &components, loose)
}

/// Which chain begins where.
struct Index {
    /// The number of the first chain of each piece.
    base: Vec<usize>,
    /// For each piece, the chains by the ports where they begin, in order.
    starts: Vec<Vec<(Port, usize)>>,
}

impl Index {
    fn new(placed: &[Placed]) -> Index {
        let mut base = vec![0];
        let mut starts = Vec::with_capacity(placed.len());
        for piece in placed {
            base.push(base[base.len() - 1] + piece.chains.len());
            let mut list: Vec<(Port, usize)> = piece.chains.iter().enumerate().map(|(i, c)| (c.from, i)).collect();
            list.sort_unstable();
            starts.push(list);
        }
        Index { base, starts }
    }

    fn len(&self) -> usize {
        self.base[self.base.len() - 1]
    }

    /// The piece and the chain with this number.
    fn outline(&self, number: usize) -> (usize, usize) {
        let k = self.base.partition_point(|&b| b <= number) - 1;
        (k, number - self.base[k])
    }

    /// The number of the chain that begins at a port of piece `k`.
    fn starting(&self, k: usize, port: Port) -> Option<usize> {
        let list = &self.starts[k];
        let i = list.binary_search_by_key(&port, |s| s.0).ok()?;
        Some(self.base[k] + list[i].1)
    }

    /// The chain after this one, and whether it begins where this one ends.
    fn after(&self, placed: &[Placed], number: usize, closed: bool) -> (usize, bool) {
        let (k, c) = self.outline(number);
        let n = placed.len();
        let (side, end) = placed[k].chains[c].to;
        let across = match side {
            Side::Right if k + 1 < n || closed => self.starting((k + 1) % n, (Side::Left, end)),
            Side::Left if k > 0 || closed => self.starting((k + n - 1) % n, (Side::Right, end)),
            _ => None,
        };
        match across {
            Some(next) => (next, true),
            // The other end of the same portal.
            None => (self.starting(k, (side, end ^ 1)).unwrap_or(number), false),
        }
    }

    /// The chains at the lower and upper end of every portal: they bound the same component.
    fn portals(&self, placed: &[Placed]) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for (k, piece) in placed.iter().enumerate() {
            for (c, chain) in piece.chains.iter().enumerate() {
                // The chain that ends in a port bounds what the chain that begins at the portal's other end does.
                if let Some(other) = self.starting(k, (chain.to.0, chain.to.1 ^ 1)) {
                    pairs.push((self.base[k] + c, other));
                }
            }
        }
        pairs
    }
}

fn root(sets: &[usize], mut i: usize) -> usize {
    while sets[i] != i {
        i = sets[i];
    }
    i
}

fn join(sets: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(sets, a), root(sets, b));
    sets[a.max(b)] = a.min(b);
}

/// Polygons of linked `rings`, whose components are known, and of `loose` rings that lie within one piece: an outer ring is a
/// polygon of its own, a hole belongs to the smallest polygon round it.
fn group(rings: Vec<Ring>, components: &[usize], loose: Vec<Ring>) -> Vec<Polygon> {
    let mut polygons: Vec<Polygon> = vec![Polygon::default(); rings.len()];
    for (ring, &component) in rings.into_iter().zip(components) {
        if signed_area(&ring) > 0.0 {
            polygons[component].outer = ring;
        } else {
            polygons[component].holes.push(ring);
        }
    }
    polygons.retain(|p| !p.outer.is_empty() || !p.holes.is_empty());
    let (outer, holes): (Vec<Ring>, Vec<Ring>) = loose.into_iter().partition(|ring| signed_area(ring) > 0.0);
    polygons.extend(outer.into_iter().map(|outer| Polygon { outer, holes: Vec::new() }));
    let sizes: Vec<(f64, crate::geometry::Bounds)> =
        polygons.iter().map(|p| (signed_area(&p.outer), p.bounds())).collect();
    for hole in holes {
        let round = |i: &usize| {
            sizes[*i].1.contains(hole[0])
                && Polygon { outer: polygons[*i].outer.clone(), holes: vec![] }.contains(hole[0])
        };
        let host = (0..polygons.len()).filter(round).min_by(|&a, &b| sizes[a].0.total_cmp(&sizes[b].0));
        if let Some(host) = host {
            polygons[host].holes.push(hole);
        }
    }
    polygons
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::band::piece::cut;
    use crate::geometry::topology;

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    /// A frame with an island, cut into three and put together again.
    fn placed() -> Vec<Placed> {
        let contours = [
            ring(&[[0., -2.], [12., -2.], [12., 2.], [0., 2.]]),
            ring(&[[2., -1.], [2., 1.], [10., 1.], [10., -1.]]),
            ring(&[[5., -0.5], [7., -0.5], [7., 0.5], [5., 0.5]]),
        ];
        let pieces = cut(&contours, 12.0, &[4.0, 8.0]).unwrap();
        let shift = |mut p: Placed, by: f64| {
            let points = p.chains.iter_mut().flat_map(|c| &mut c.points).chain(p.rings.iter_mut().flatten());
            points.for_each(|q| q.x += by);
            p
        };
        let placed = pieces.into_iter().map(|p| Placed { chains: p.chains, rings: p.rings, span: [0.0, 4.0] });
        placed.zip([0.0, 4.0, 8.0]).map(|(p, by)| shift(p, by)).collect()
    }

    #[test]
    fn pieces_become_the_whole_again() {
        let polygons = assemble(&placed(), false, &|_, _, _| {}, &|p| p);
        let counts = topology::count(&polygons).unwrap();
        assert_eq!((counts.components, counts.holes), (2, 1));
        assert_eq!(polygons.iter().map(Polygon::area).sum::<f64>(), 12.0 * 4.0 - 8.0 * 2.0 + 2.0);
    }

    #[test]
    fn open_portals_are_closed_by_an_edge() {
        let polygons = assemble(&placed()[1..2], false, &|_, _, _| {}, &|p| p);
        assert_eq!(polygons.len(), 3);
        assert_eq!(topology::count(&polygons).unwrap().holes, 0);
    }

    #[test]
    fn edges_are_divided_before_they_are_mapped() {
        let halve = |a: Point, b: Point, out: &mut Vec<Point>| out.push(a.lerp(b, 0.5));
        let polygons = assemble(&placed(), false, &halve, &|p| p);
        let whole = assemble(&placed(), false, &|_, _, _| {}, &|p| p);
        let count = |p: &[Polygon]| p.iter().flat_map(Polygon::rings).map(Vec::len).sum::<usize>();
        assert_eq!(count(&polygons), 2 * count(&whole));
    }
}
