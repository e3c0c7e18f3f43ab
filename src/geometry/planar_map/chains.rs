//! Edges: pieces that coincide are one, and pieces that follow one another through a node where
//! nothing ends and nothing branches are chained.

use super::noding::Network;
use super::stars::Stars;

/// The edges of a map, numbered in the order in which the curves run along them first, and
/// oriented as that first curve runs.
#[derive(Default)]
pub(super) struct Chains {
    /// Source and target node of every edge.
    pub ends: Vec<[u32; 2]>,
    /// Where the inner nodes of every edge begin in `inner`; one more than edges, or empty when there are none.
    pub inner_starts: Vec<u32>,
    /// The inner nodes of the edges, from source to target.
    pub inner: Vec<u32>,
    /// The first curve along every edge, in its direction.
    pub first: Vec<u32>,
    /// Edge and curve × 2, + 1 where the curve runs against the edge; ascending by edge, without the firsts.
    pub more: Vec<(u32, u32)>,
    /// The half-edge (2 × edge, + 1 against it) along every piece; empty when edge i is piece i.
    along: Vec<u32>,
    /// The curve of every piece, ascending; empty when edge i is piece i.
    curves: Vec<u32>,
    /// Whether a node is a vertex; empty when all are.
    vertex: Vec<bool>,
}

impl Chains {
    /// Chains the pieces of a network; takes its pieces and curves.
    pub fn join(network: &mut Network, stars: &Stars) -> Chains {
        let is_vertex = vertices(network, stars);
        if !stars.coincident && is_vertex.iter().all(|v| *v) {
            let (ends, first) = (std::mem::take(&mut network.pieces), std::mem::take(&mut network.curves));
            return Chains { ends, first, ..Chains::default() };
        }
        let mut chains = Chains { inner_starts: vec![0], vertex: is_vertex, ..Chains::default() };
        chains.along = vec![u32::MAX; network.pieces.len()];
        for piece in 0..network.pieces.len() {
            if chains.along[piece] == u32::MAX {
                chains.follow(network, stars, piece);
            }
        }
        if chains.inner.is_empty() {
            chains.inner_starts = Vec::new();
        }
        chains.note_sources(network);
        network.pieces = Vec::new();
        chains.curves = std::mem::take(&mut network.curves);
        chains
    }

    /// Whether a node is a vertex.
    pub fn is_vertex(&self, node: usize) -> bool {
        self.vertex.is_empty() || self.vertex[node]
    }

    /// The half-edge along a half-piece (2 × piece, + 1 against it).
    pub fn half_edge(&self, half: u32) -> u32 {
        self.along.get(half as usize / 2).map_or(half, |h| h ^ (half % 2))
    }

    /// For every curve that has not vanished its number and the half-edges with which it begins and ends.
    pub fn curve_ends(&self) -> impl Iterator<Item = (u32, [u32; 2])> {
        let curves = if self.along.is_empty() { &self.first } else { &self.curves };
        ends(curves).map(|(curve, pieces)| (curve, pieces.map(|p| self.half_edge(2 * p as u32))))
    }

    /// Makes the edge that begins with a piece.
    fn follow(&mut self, network: &Network, stars: &Stars, piece: usize) {
        let edge = self.ends.len() as u32;
        let source = network.pieces[piece][0];
        let mut half = 2 * piece as u32;
        let target = loop {
            let ends = network.pieces[half as usize / 2];
            let (from, to) = (ends[half as usize % 2], ends[1 - half as usize % 2]);
            for copy in stars.of(from as usize).iter().filter(|s| s.to == to) {
                self.along[copy.half as usize / 2] = 2 * edge + copy.half % 2;
            }
            if self.is_vertex(to as usize) {
                break to;
            }
            self.inner.push(to);
            let onward = stars.distinct(to as usize).find(|s| s.to != from);
            half = onward.expect("two pieces meet at a node inside an edge").half;
        };
        self.ends.push([source, target]);
        self.first.push(network.curves[piece]);
        self.inner_starts.push(self.inner.len() as u32);
    }

    /// Notes which curves run along which edges beside the first.
    fn note_sources(&mut self, network: &Network) {
        for (&half, &curve) in self.along.iter().zip(&network.curves) {
            if half % 2 == 1 || self.first[half as usize / 2] != curve {
                self.more.push((half / 2, 2 * curve + half % 2));
            }
        }
        self.more.sort_unstable();
        self.more.dedup();
    }
}

/// Whether a node is a vertex: where curves end and where other than two different pieces meet.
fn vertices(network: &Network, stars: &Stars) -> Vec<bool> {
    let degree = |v| if stars.coincident { stars.distinct(v).count() } else { stars.of(v).len() };
    let mut is_vertex: Vec<bool> = (0..network.sites.len()).map(|v| degree(v) != 2).collect();
    ends(&network.curves).for_each(|(_, [first, last])| {
        is_vertex[network.pieces[first][0] as usize] = true;
        is_vertex[network.pieces[last][1] as usize] = true;
    });
    is_vertex
}

/// For every curve its number, its first and its last piece, given the curve of every piece.
fn ends(curves: &[u32]) -> impl Iterator<Item = (u32, [usize; 2])> {
    let mut from = 0;
    curves.chunk_by(|p, q| p == q).map(move |run| {
        let first = from;
        from += run.len();
        (run[0], [first, from - 1])
    })
}
