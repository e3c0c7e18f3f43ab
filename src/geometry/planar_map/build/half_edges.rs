//! Half-edges and the cycles that they form. Half-edge 2e runs along edge e, 2e + 1 against it.

use crate::planar_map::build::chains::{Chains, NONE};
use crate::planar_map::build::stars::Stars;
use crate::planar_map::noding::snap_grid::Site;
use crate::planar_map::parallel;

/// Edges as geometry, between the nodes of the network.
pub(in crate::planar_map) struct Embedding<'a> {
    pub chains: &'a Chains,
    pub sites: &'a [Site],
}

impl Embedding<'_> {
    /// The node that a half-edge leaves.
    #[inline]
    pub fn origin(&self, h: u32) -> u32 {
        self.chains.ends[h as usize / 2][h as usize % 2]
    }

    /// The sites of an edge from source to target.
    #[inline]
    pub fn edge(&self, edge: usize) -> impl Iterator<Item = Site> {
        let [a, b] = self.chains.ends[edge];
        let inner = match self.chains.inner_starts.get(edge..edge + 2) {
            Some(range) => &self.chains.inner[range[0] as usize..range[1] as usize],
            None => &[],
        };
        let nodes = std::iter::once(a)
            .chain(inner.iter().copied())
            .chain(std::iter::once(b));
        nodes.map(|v| self.sites[v as usize])
    }
}

/// For every half-edge the one that follows it around the face on its left: the one that leaves its end
/// clockwise of its twin.
pub(in crate::planar_map) fn link(chains: &Chains, stars: &Stars) -> Vec<u32> {
    let mut next = vec![0u32; 2 * chains.ends.len()];
    for &v in &chains.vertices {
        let range = stars.starts[v as usize] as usize..stars.starts[v as usize + 1] as usize;
        let mut around = chains.half_edges[range]
            .iter()
            .copied()
            .filter(|h| *h != NONE);
        let Some(first) = around.next() else { continue };
        let last = around.fold(first, |clockwise, h| {
            next[h as usize ^ 1] = clockwise;
            h
        });
        next[first as usize ^ 1] = last;
    }
    next
}

/// The cycles of `next`.
pub(in crate::planar_map) struct Cycles {
    /// The cycle of every half-edge.
    pub of: Vec<u32>,
    /// The first half-edge of every cycle.
    pub first: Vec<u32>,
    /// Whether the cycle goes round a face counter-clockwise; if not it bounds a component from outside.
    pub positive: Vec<bool>,
}

/// Traces all cycles, in the order in which one reads the vertices and turns counter-clockwise around them.
pub(in crate::planar_map) fn trace(embedding: &Embedding, next: &[u32]) -> Cycles {
    let swept = parallel::map(next.len() / 2, |edge| swept(embedding, edge));
    let rounding = rounding(embedding);
    let mut cycles = Cycles {
        of: vec![NONE; next.len()],
        first: Vec::new(),
        positive: Vec::new(),
    };
    for &start in &embedding.chains.half_edges {
        if start == NONE || cycles.of[start as usize] != NONE {
            continue;
        }
        let (mut area, mut steps) = (0.0, 0.0);
        let mut h = start as usize;
        loop {
            cycles.of[h] = cycles.first.len() as u32;
            let part: f64 = swept[h / 2];
            area += if h % 2 == 1 { -part } else { part };
            steps += 1.0;
            h = next[h] as usize;
            if h == start as usize {
                break;
            }
        }
        let sure = area.abs() > steps * (steps + 4.0) * rounding;
        cycles.first.push(start);
        cycles.positive.push(if sure {
            area > 0.0
        } else {
            exact_area(embedding, next, start) > 0
        });
    }
    cycles
}

/// Twice the area between an edge and the corner of the map, rounded.
fn swept(embedding: &Embedding, edge: usize) -> f64 {
    let mut sites = embedding.edge(edge);
    let Some(mut a) = sites.next() else {
        return 0.0;
    };
    sites.fold(0.0, |area, b| {
        let part = a[0] * b[1] - a[1] * b[0];
        a = b;
        area + part
    })
}

/// A sum of n results of [`swept`] is off by less than n (n + 4) times this.
fn rounding(embedding: &Embedding) -> f64 {
    let reach = embedding
        .sites
        .iter()
        .fold(0.0f64, |r, s| r.max(s[0]).max(s[1]));
    let pieces = embedding
        .chains
        .inner_starts
        .windows(2)
        .map(|w| w[1] - w[0] + 1)
        .max()
        .unwrap_or(1) as f64;
    // One part is at most 2 reach², and so is each of at most n · pieces roundings by 2^-53 in n · pieces sums.
    4.0 * reach * reach * pieces * pieces * f64::EPSILON
}

/// Twice the area that a cycle goes round.
fn exact_area(embedding: &Embedding, next: &[u32], first: u32) -> i128 {
    let origin = embedding.sites[embedding.origin(first) as usize];
    let (mut area, mut h) = (0, first);
    loop {
        let mut around = 0;
        let mut last = None;
        for site in embedding.edge(h as usize / 2) {
            let p = [site[0] - origin[0], site[1] - origin[1]].map(|v| v as i128);
            if let Some([x, y]) = last.replace(p) {
                around += x * p[1] - y * p[0];
            }
        }
        area += if h % 2 == 1 { -around } else { around };
        h = next[h as usize];
        if h == first {
            return area;
        }
    }
}
