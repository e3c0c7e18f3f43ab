//! Faces: cycles that go round them, and which face each component lies in.

use super::exact::before;
use super::half_edges::{Cycles, Shape};
use super::lattice::Site;
use super::locate::Index;

/// The faces of a map; 0 is the unbounded one.
pub(super) struct Faces {
    /// The face on the left of every half-edge.
    pub of: Vec<u32>,
    /// A half-edge of the outer boundary of every bounded face, that of face f at f - 1.
    pub outer: Vec<u32>,
    /// Face and a half-edge, one for every inner boundary; ascending.
    pub inner: Vec<(u32, u32)>,
}

/// Makes faces of cycles.
pub(super) fn nest(shape: &Shape, next: &[u32], cycles: Cycles) -> Faces {
    let mut face_of_cycle = vec![0u32; cycles.first.len()];
    let mut faces = Faces { of: cycles.of, outer: Vec::new(), inner: Vec::new() };
    let mut islands = Vec::new();
    for (c, &first) in cycles.first.iter().enumerate() {
        if cycles.positive[c] {
            faces.outer.push(first);
            face_of_cycle[c] = faces.outer.len() as u32;
        } else {
            islands.push((leftmost(shape, next, first), c));
        }
    }
    // An island's left neighbour belongs to a component that begins farther to the left.
    islands.sort_unstable_by(|p, q| before(p.0, q.0));
    let index = (islands.len() > 1).then(|| Index::build((0..shape.chains.ends.len()).map(|e| shape.edge(e))));
    for &(site, c) in &islands {
        let left = index.as_ref().and_then(|index| index.left_of(site));
        let face = left.map_or(0, |h| face_of_cycle[faces.of[h as usize] as usize]);
        face_of_cycle[c] = face;
        faces.inner.push((face, cycles.first[c]));
    }
    faces.inner.sort_unstable();
    faces.of.iter_mut().for_each(|c| *c = face_of_cycle[*c as usize]);
    faces
}

/// The lexicographically first site on a cycle.
fn leftmost(shape: &Shape, next: &[u32], first: u32) -> Site {
    let mut best = shape.sites[shape.origin(first) as usize];
    let mut h = first;
    loop {
        for site in shape.edge(h as usize / 2) {
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
