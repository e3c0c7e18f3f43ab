//! Faces: cycles that go round them, and which face each component lies in.

use crate::planar_map::build::half_edges::{Cycles, Embedding};
use crate::planar_map::noding::exact::before;
use crate::planar_map::noding::snap_grid::Site;
use crate::planar_map::parallel;
use crate::planar_map::query::locate::{Index, left_of_each};

/// The faces of a map; 0 is the unbounded one.
pub(in crate::planar_map) struct Faces {
    /// The face on the left of every half-edge.
    pub of: Vec<u32>,
    /// A half-edge of the outer boundary of every bounded face, that of face f at f - 1.
    pub outer: Vec<u32>,
    /// Face and a half-edge, one for every inner boundary; ascending.
    pub inner: Vec<(u32, u32)>,
}

/// Makes faces of cycles.
pub(in crate::planar_map) fn nest(embedding: &Embedding, next: &[u32], cycles: Cycles) -> Faces {
    let mut face_of_cycle = vec![0u32; cycles.first.len()];
    let mut faces = Faces {
        of: cycles.of,
        outer: Vec::new(),
        inner: Vec::new(),
    };
    let mut islands = Vec::new();
    for (c, &first) in cycles.first.iter().enumerate() {
        if cycles.positive[c] {
            faces.outer.push(first);
            face_of_cycle[c] = faces.outer.len() as u32;
        } else {
            islands.push((topmost(embedding, next, first), c));
        }
    }
    // What is left of an island belongs to a component that begins farther up, or as far up and farther left.
    islands.sort_unstable_by(|p, q| before(p.0, q.0));
    for (&(_, c), left) in islands.iter().zip(left_neighbours(embedding, &islands)) {
        let face = left.map_or(0, |h| face_of_cycle[faces.of[h as usize] as usize]);
        face_of_cycle[c] = face;
        faces.inner.push((face, cycles.first[c]));
    }
    faces.inner.sort_unstable();
    faces
        .of
        .iter_mut()
        .for_each(|c| *c = face_of_cycle[*c as usize]);
    faces
}

/// The first site on a cycle in reading order.
fn topmost(embedding: &Embedding, next: &[u32], first: u32) -> Site {
    let mut best = embedding.sites[embedding.origin(first) as usize];
    let mut h = first;
    loop {
        for site in embedding.edge(h as usize / 2) {
            if before(site, best).is_lt() {
                best = site;
            }
        }
        h = next[h as usize];
        if h == first {
            return best;
        }
    }
}

/// For every island the half-edge that its first site sees looking toward -x, if any. They are in reading order, so
/// that the first sees none.
fn left_neighbours(embedding: &Embedding, islands: &[(Site, usize)]) -> Vec<Option<u32>> {
    /// For fewer it is faster to look at all edges for each than to sort these into bins.
    const MANY: usize = 8;
    let edges = || (0..embedding.chains.ends.len()).map(|e| embedding.edge(e));
    let sites: Vec<Site> = islands.iter().skip(1).map(|i| i.0).collect();
    let mut found = vec![None; islands.len().min(1)];
    if sites.len() < MANY {
        found.extend(left_of_each(&sites, edges()));
    } else {
        let index = Index::build(edges());
        found.extend(parallel::map(sites.len(), |i| index.left_of(sites[i])));
    }
    found
}
