//! Edges found by height: which of them cross a strip of the plane, and what lies inside them.

use fretwork_geometry::Point;

/// An edge and the number of the outline it belongs to.
#[derive(Clone, Copy)]
pub struct Edge {
    /// One end.
    pub a: Point,
    /// The other.
    pub b: Point,
    /// Its outline.
    pub outline: u32,
}

/// Edges in horizontal slabs. The slabs hold at most four entries per edge on average.
pub struct Slabs {
    edges: Vec<Edge>,
    slabs: Vec<Vec<u32>>,
    top: f64,
    per_unit: f64,
}

impl Slabs {
    /// The slabs of `edges`, whose coordinates are finite.
    pub fn new(edges: Vec<Edge>) -> Slabs {
        let top = edges
            .iter()
            .map(|e| e.a.y.min(e.b.y))
            .fold(f64::INFINITY, f64::min);
        let bottom = edges
            .iter()
            .map(|e| e.a.y.max(e.b.y))
            .fold(f64::NEG_INFINITY, f64::max);
        let height = bottom - top;
        let spanned: f64 = edges.iter().map(|e| (e.a.y - e.b.y).abs() / height).sum();
        let most = edges.len().max(1) as f64;
        let count = if height > 0.0 {
            (3.0 * most / spanned).clamp(1.0, most).floor()
        } else {
            1.0
        };
        let per_unit = if height > 0.0 { count / height } else { 0.0 };
        let mut index = Slabs {
            edges,
            slabs: vec![Vec::new(); count as usize],
            top,
            per_unit,
        };
        for i in 0..index.edges.len() {
            let e = index.edges[i];
            for slab in index.slab(e.a.y.min(e.b.y))..=index.slab(e.a.y.max(e.b.y)) {
                index.slabs[slab].push(i as u32);
            }
        }
        index
    }

    /// All edges, in the order given.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The edges that reach into the heights from `low` to `high`, and some near them; each once.
    pub fn between(&self, low: f64, high: f64) -> impl Iterator<Item = &Edge> {
        let first = self.slab(low);
        (first..=self.slab(high)).flat_map(move |slab| {
            self.slabs[slab]
                .iter()
                .map(|&i| &self.edges[i as usize])
                .filter(move |e| {
                    // An edge of several slabs is given in the first of them that was asked for.
                    slab == first.max(self.slab(e.a.y.min(e.b.y)))
                })
        })
    }

    /// The edges that a ray from `p` toward greater x crosses.
    pub fn crossed(&self, p: Point) -> impl Iterator<Item = &Edge> {
        self.between(p.y, p.y).filter(move |Edge { a, b, .. }| {
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
        })
    }

    /// Whether `p` is inside all edges together, by the even-odd rule.
    pub fn contains(&self, p: Point) -> bool {
        self.crossed(p).count() % 2 == 1
    }

    fn slab(&self, y: f64) -> usize {
        // Casting takes what is above the first slab, and NaN, to zero.
        (((y - self.top) * self.per_unit) as usize).min(self.slabs.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{Polygon, Ring, Seed};

    #[test]
    fn slabs_agree_with_looking_at_every_edge() {
        let seed = Seed::root(3);
        let at = |i: i64, k: usize| {
            Point::new(
                seed.number(i).unit(2 * k as u64),
                seed.number(i).unit(2 * k as u64 + 1),
            )
        };
        for i in 0..20 {
            let ring: Ring = (0..40).map(|k| at(i, k)).collect();
            let edges = (0..40)
                .map(|k| Edge {
                    a: ring[k],
                    b: ring[(k + 1) % 40],
                    outline: 0,
                })
                .collect();
            let slabs = Slabs::new(edges);
            let polygon = Polygon {
                outer: ring,
                holes: vec![],
            };
            for k in 100..300 {
                assert_eq!(slabs.contains(at(i, k)), polygon.contains(at(i, k)));
            }
            assert_eq!(slabs.between(-9.0, 9.0).count(), 40);
        }
        assert!(!Slabs::new(vec![]).contains(Point::ORIGIN));
    }
}
