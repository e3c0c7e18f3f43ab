//! Edges: pieces that coincide are one, and pieces that follow one another through a node where
//! nothing ends and nothing branches are chained.

use crate::planar_map::build::stars::Stars;

/// The edges of a map, numbered as one reads the vertices where they begin or end first and counter-clockwise
/// around these; half-edge 2e runs along edge e like the first of its curves, 2e + 1 against it.
#[derive(Default)]
pub(in crate::planar_map) struct Chains {
    /// Source and target node of every edge.
    pub ends: Vec<[u32; 2]>,
    /// Where the inner nodes of every edge begin in `inner`; one more than edges, or empty when there are none.
    pub inner_starts: Vec<u32>,
    /// The inner nodes of the edges, from source to target.
    pub inner: Vec<u32>,
    /// The first curve along every edge.
    pub first: Vec<u32>,
    /// Edge and curve × 2, + 1 where the curve runs against the edge; ascending by edge, without the firsts.
    pub more: Vec<(u32, u32)>,
    /// Edge, curve and how often the curve runs along the edge, less how often against it: where `first` and `more`, which
    /// hold a curve once for each direction, do not tell. Ascending by edge and curve.
    pub passes: Vec<(u32, u32, i32)>,
    /// For every spoke at a vertex, the first of those that coincide, the half-edge that leaves along it.
    pub half_edges: Vec<u32>,
    /// The nodes that are vertices, ascending.
    pub vertices: Vec<u32>,
}

/// No half-edge.
pub(in crate::planar_map) const NONE: u32 = u32::MAX;

impl Chains {
    /// Chains the pieces around the nodes, given the nodes where curves end.
    pub fn join(stars: &Stars, curve_ends: &[u32]) -> Chains {
        let mut is_vertex: Vec<bool> = (0..stars.len())
            .map(|v| !matches!(stars.degree(v), 0 | 2))
            .collect();
        curve_ends
            .iter()
            .for_each(|v| is_vertex[*v as usize] = true);
        let vertices = (0..stars.len() as u32)
            .filter(|v| is_vertex[*v as usize])
            .collect();
        let mut chains = Chains {
            vertices,
            half_edges: vec![NONE; stars.spokes.len()],
            ..Chains::default()
        };
        let count = stars.spokes.len() / 2;
        chains.ends.reserve_exact(count);
        chains.first.reserve_exact(count);
        let mut sources = Vec::new();
        for i in 0..chains.vertices.len() {
            let v = chains.vertices[i];
            for slot in stars.starts[v as usize] as usize..stars.starts[v as usize + 1] as usize {
                let again = slot > stars.starts[v as usize] as usize
                    && stars.spokes[slot - 1].to == stars.spokes[slot].to;
                if chains.half_edges[slot] == NONE && !again {
                    chains.follow(stars, &is_vertex, v, slot, &mut sources);
                }
            }
        }
        chains
    }

    /// Makes the edge that leaves `from` at a spoke.
    fn follow(
        &mut self,
        stars: &Stars,
        is_vertex: &[bool],
        from: u32,
        slot: usize,
        sources: &mut Vec<u32>,
    ) {
        let edge = self.ends.len() as u32;
        let inner = self.inner.len();
        let (mut at, mut leaving) = (from, slot);
        sources.clear();
        let (to, arriving) = loop {
            let to = stars.spokes[leaving].to;
            let copies = stars.spokes[leaving..stars.starts[at as usize + 1] as usize].iter();
            sources.extend(copies.take_while(|s| s.to == to).map(|s| s.source));
            if is_vertex[to as usize] {
                break (to, stars.slot(to, at));
            }
            self.inner.push(to);
            let onward = stars.of(to as usize).iter().position(|s| s.to != at);
            leaving = stars.starts[to as usize] as usize
                + onward.expect("two pieces meet at a node inside an edge");
            at = to;
        };
        // The half-edge runs against the edge when the first curve comes the other way.
        let against = sources.iter().min().map_or(0, |first| first % 2);
        sources.iter_mut().for_each(|s| *s ^= against);
        sources.sort_unstable();
        sources.dedup();
        self.note_passes(stars, from, slot, sources, against);
        if against == 1 {
            self.inner[inner..].reverse();
        }
        self.half_edges[slot] = 2 * edge + against;
        self.half_edges[arriving] = 2 * edge + (1 - against);
        self.ends
            .push(if against == 0 { [from, to] } else { [to, from] });
        self.first.push(sources[0] / 2);
        self.more.extend(sources[1..].iter().map(|s| (edge, *s)));
        if !self.inner.is_empty() {
            // Up to here no edge had inner nodes.
            if self.inner_starts.is_empty() {
                self.inner_starts.resize(self.ends.len(), 0);
            }
            self.inner_starts.push(self.inner.len() as u32);
        }
    }

    /// Takes note of the curves that run along the next edge more than once, or along a part of it forth and back.
    ///
    /// It is enough to look at the first piece: no curve ends and nothing branches at the nodes inside an edge, so a
    /// curve that turns back inside of it has passed every piece as often in one direction, less the other, as the
    /// first one.
    fn note_passes(
        &mut self,
        stars: &Stars,
        from: u32,
        slot: usize,
        sources: &[u32],
        against: u32,
    ) {
        let to = stars.spokes[slot].to;
        let star = &stars.spokes[slot..stars.starts[from as usize + 1] as usize];
        let copies = star.iter().take_while(|s| s.to == to);
        if sources.len() == 1 && copies.clone().count() == 1 {
            return;
        }
        let edge = self.ends.len() as u32;
        let sign = |source: u32| if source.is_multiple_of(2) { 1 } else { -1 };
        for of_curve in sources.chunk_by(|a, b| a / 2 == b / 2) {
            let curve = of_curve[0] / 2;
            let told: i32 = of_curve.iter().map(|s| sign(*s)).sum();
            let passes: i32 = copies
                .clone()
                .filter(|s| s.source / 2 == curve)
                .map(|s| sign(s.source ^ against))
                .sum();
            if passes != told {
                self.passes.push((edge, curve, passes));
            }
        }
    }
}
