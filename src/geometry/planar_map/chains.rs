//! Edges: pieces that coincide are one, and pieces that follow one another through a node where
//! nothing ends and nothing branches are chained.

use super::noding::Network;

/// The edges of a map, numbered in the order in which the curves run along them first, and
/// oriented as that first curve runs.
#[derive(Default)]
pub(super) struct Chains {
    /// The node of every vertex.
    pub vertices: Vec<u32>,
    /// Source and target vertex of every edge.
    pub ends: Vec<[u32; 2]>,
    /// Where the inner nodes of every edge begin in `inner`; one more than edges.
    pub inner_starts: Vec<u32>,
    /// The inner nodes of the edges, from source to target.
    pub inner: Vec<u32>,
    /// The first curve along every edge, in its direction.
    pub first: Vec<u32>,
    /// Edge and curve × 2, + 1 where the curve runs against the edge; ascending by edge, without the firsts.
    pub more: Vec<(u32, u32)>,
    /// For every curve that has not vanished: its number, its first and its last (edge × 2, + 1
    /// where the curve runs against the edge).
    pub curves: Vec<(u32, [u32; 2])>,
}

/// Chains the pieces of a noded network.
pub(super) fn chain(network: &Network) -> Chains {
    let star = Star::around(network);
    let is_vertex = vertices(network, &star);
    let mut chains = Chains { inner_starts: vec![0], ..Chains::default() };
    let mut vertex_of = vec![u32::MAX; network.sites.len()];
    let mut name = |node: u32, chains: &mut Chains| {
        let v = &mut vertex_of[node as usize];
        if *v == u32::MAX {
            *v = chains.vertices.len() as u32;
            chains.vertices.push(node);
        }
        *v
    };
    // The edge along every piece × 2, + 1 where the piece runs against it.
    let mut along = vec![u32::MAX; network.pieces.len()];
    for start in 0..network.pieces.len() {
        if along[star.first[start] as usize] == u32::MAX {
            let edge = chains.ends.len() as u32;
            let (mut piece, mut forward) = (start as u32, true);
            let source = name(network.pieces[start][0], &mut chains);
            loop {
                along[piece as usize] = 2 * edge + u32::from(!forward);
                let to = network.pieces[piece as usize][usize::from(forward)];
                if is_vertex[to as usize] {
                    let target = name(to, &mut chains);
                    chains.ends.push([source, target]);
                    break;
                }
                chains.inner.push(to);
                (piece, forward) = star.onward(network, to, piece);
            }
            chains.inner_starts.push(chains.inner.len() as u32);
            chains.first.push(network.curves[start]);
        }
        let first = star.first[start] as usize;
        if first != start {
            along[start] = along[first] ^ u32::from(network.pieces[first][0] != network.pieces[start][0]);
        }
    }
    note_sources(network, &along, &mut chains);
    chains
}

/// Which curves run along which edges beside the first, and where the curves begin and end.
fn note_sources(network: &Network, along: &[u32], chains: &mut Chains) {
    for (k, &curve) in network.curves.iter().enumerate() {
        let (edge, against) = (along[k] / 2, along[k] % 2);
        if against == 1 || chains.first[edge as usize] != curve {
            chains.more.push((edge, 2 * curve + against));
        }
        match chains.curves.last_mut() {
            Some((c, ends)) if *c == curve => ends[1] = along[k],
            _ => chains.curves.push((curve, [along[k]; 2])),
        }
    }
    chains.more.sort_unstable();
    chains.more.dedup();
}

/// The nodes that are vertices: where curves end and where other than two different pieces meet.
fn vertices(network: &Network, star: &Star) -> Vec<bool> {
    let mut is_vertex: Vec<bool> = (0..network.sites.len()).map(|v| star.distinct(v).count() != 2).collect();
    for (k, piece) in network.pieces.iter().enumerate() {
        let curve = network.curves[k];
        if k == 0 || network.curves[k - 1] != curve {
            is_vertex[piece[0] as usize] = true;
        }
        if network.curves.get(k + 1) != Some(&curve) {
            is_vertex[piece[1] as usize] = true;
        }
    }
    is_vertex
}

/// The pieces around every node.
struct Star {
    starts: Vec<u32>,
    pieces: Vec<u32>,
    /// For every piece the first one between the same nodes.
    first: Vec<u32>,
}

impl Star {
    fn around(network: &Network) -> Star {
        let mut starts = vec![0u32; network.sites.len() + 1];
        network.pieces.iter().flatten().for_each(|v| starts[*v as usize] += 1);
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        let mut pieces = vec![0u32; total as usize];
        for (k, piece) in network.pieces.iter().enumerate().rev() {
            for v in piece {
                starts[*v as usize] -= 1;
                pieces[starts[*v as usize] as usize] = k as u32;
            }
        }
        let mut first: Vec<u32> = (0..network.pieces.len() as u32).collect();
        let other = |k: u32, v: u32| network.pieces[k as usize].iter().sum::<u32>() - v;
        let mut around: Vec<(u32, u32)> = Vec::new();
        for v in 0..network.sites.len() as u32 {
            around.clear();
            let range = starts[v as usize] as usize..starts[v as usize + 1] as usize;
            around.extend(pieces[range].iter().map(|&k| (other(k, v), k)));
            around.sort_unstable();
            for pair in around.windows(2).filter(|w| w[0].0 == w[1].0) {
                first[pair[1].1 as usize] = first[pair[0].1 as usize];
            }
        }
        Star { starts, pieces, first }
    }

    /// The pieces at a node, one of all that coincide.
    fn distinct(&self, v: usize) -> impl Iterator<Item = u32> {
        let range = self.starts[v] as usize..self.starts[v + 1] as usize;
        self.pieces[range].iter().copied().filter(|&k| self.first[k as usize] == k)
    }

    /// The piece that leaves `node`, where two meet, other than `piece`; whether it runs away from the node.
    fn onward(&self, network: &Network, node: u32, piece: u32) -> (u32, bool) {
        let next =
            self.distinct(node as usize).find(|&k| k != piece).expect("two pieces meet at a node inside a chain");
        (next, network.pieces[next as usize][0] == node)
    }
}
