//! Half-edges: their order around vertices and the cycles that they form. Half-edge 2e runs along
//! edge e, 2e + 1 against it.

use super::exact::cross;
use super::lattice::Site;

/// Edges as geometry: what the rotation and the areas are computed from.
pub(super) struct Shape<'a> {
    /// Source and target vertex.
    pub ends: &'a [[u32; 2]],
    /// Where the inner sites of every edge begin; one more than edges.
    pub inner_starts: &'a [u32],
    /// Inner sites.
    pub inner: &'a [Site],
    /// Sites of the vertices.
    pub vertices: &'a [Site],
}

impl Shape<'_> {
    /// The vertex that a half-edge leaves.
    pub fn origin(&self, h: u32) -> u32 {
        self.ends[h as usize / 2][h as usize % 2]
    }

    /// The sites of an edge from source to target.
    pub fn sites(&self, edge: usize) -> impl DoubleEndedIterator<Item = Site> {
        let [a, b] = self.ends[edge].map(|v| self.vertices[v as usize]);
        let inner = &self.inner[self.inner_starts[edge] as usize..self.inner_starts[edge + 1] as usize];
        std::iter::once(a).chain(inner.iter().copied()).chain(std::iter::once(b))
    }

    /// The direction in which a half-edge leaves its origin.
    fn departure(&self, h: u32) -> Site {
        let edge = h as usize / 2;
        let mut sites = self.sites(edge);
        let pair = if h % 2 == 0 { (sites.next(), sites.next()) } else { (sites.next_back(), sites.next_back()) };
        let (Some(a), Some(b)) = pair else { unreachable!("an edge has two sites") };
        [b[0] - a[0], b[1] - a[1]]
    }
}

/// For every half-edge the one that follows it around the face on its left; and for every vertex
/// one half-edge that leaves it.
pub(super) fn link(shape: &Shape) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; shape.vertices.len() + 1];
    shape.ends.iter().flatten().for_each(|v| starts[*v as usize] += 1);
    let mut total = 0;
    for start in &mut starts {
        total += *start;
        *start = total;
    }
    let mut around = vec![0u32; total as usize];
    for h in (0..2 * shape.ends.len() as u32).rev() {
        let v = shape.origin(h) as usize;
        starts[v] -= 1;
        around[starts[v] as usize] = h;
    }
    let mut next = vec![0u32; around.len()];
    let mut outgoing = vec![0u32; shape.vertices.len()];
    let mut star: Vec<(Site, u32)> = Vec::new();
    for v in 0..shape.vertices.len() {
        star.clear();
        star.extend(around[starts[v] as usize..starts[v + 1] as usize].iter().map(|&h| (shape.departure(h), h)));
        star.sort_unstable_by(|p, q| {
            upper(p.0).cmp(&upper(q.0)).then_with(|| 0f64.total_cmp(&(cross(p.0, q.0) + 0.0)))
        });
        for k in 0..star.len() {
            let clockwise = star[if k == 0 { star.len() - 1 } else { k - 1 }].1;
            next[star[k].1 as usize ^ 1] = clockwise;
        }
        outgoing[v] = star.first().map_or(0, |s| s.1);
    }
    (next, outgoing)
}

/// 0 for directions from +x up to before -x, toward +y; 1 for the rest.
fn upper(d: Site) -> u8 {
    u8::from(d[1] < 0.0 || (d[1] == 0.0 && d[0] < 0.0))
}

/// The cycles of `next`.
pub(super) struct Cycles {
    /// The cycle of every half-edge.
    pub of: Vec<u32>,
    /// The first half-edge of every cycle.
    pub first: Vec<u32>,
    /// Whether the cycle goes round a face counter-clockwise; if not it bounds a component from outside.
    pub positive: Vec<bool>,
}

/// Traces all cycles, in the order of their first half-edges.
pub(super) fn trace(shape: &Shape, next: &[u32]) -> Cycles {
    let sweep: Vec<i128> = (0..shape.ends.len()).map(|e| swept(shape, e)).collect();
    let mut cycles = Cycles { of: vec![u32::MAX; next.len()], first: Vec::new(), positive: Vec::new() };
    for start in 0..next.len() {
        if cycles.of[start] != u32::MAX {
            continue;
        }
        let mut area = 0;
        let mut h = start;
        loop {
            cycles.of[h] = cycles.first.len() as u32;
            area += if h % 2 == 0 { sweep[h / 2] } else { -sweep[h / 2] };
            h = next[h] as usize;
            if h == start {
                break;
            }
        }
        cycles.first.push(start as u32);
        cycles.positive.push(area > 0);
    }
    cycles
}

/// Twice the area between an edge and the corner of the map.
fn swept(shape: &Shape, edge: usize) -> i128 {
    let mut sites = shape.sites(edge).map(|s| s.map(|v| v as i128));
    let Some(mut a) = sites.next() else { return 0 };
    let mut area = 0;
    for b in sites {
        area += a[0] * b[1] - a[1] * b[0];
        a = b;
    }
    area
}
