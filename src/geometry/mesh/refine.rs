//! A mesh with shorter edges: for what differs from place to place on flat faces, such as colours at corners.

use std::collections::BTreeMap;

use super::Mesh;

/// Edges are halved so often, at most.
const ROUNDS: usize = 12;

/// The mesh with its edges halved, round by round, until none is longer than `longest`, or there would be more than `most`
/// triangles. An edge is halved for both of its triangles, so that a closed mesh stays closed, and nothing moves. O(n log n).
///
/// ```
/// use fretwork_geometry::{Mesh, mesh::refined};
/// let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
/// let mesh = Mesh {
///     positions: corners.map(Into::into).to_vec(),
///     triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
/// };
/// let fine = refined(&mesh, 0.3, 10_000);
/// assert!(fine.triangles.len() > 60 && fine.check_closed().is_ok());
/// assert!((fine.volume() - mesh.volume()).abs() < 1e-12);
/// ```
pub fn refined(mesh: &Mesh, longest: f64, most: usize) -> Mesh {
    let mut mesh = mesh.clone();
    for _ in 0..ROUNDS {
        let mut middles = BTreeMap::new();
        for triangle in &mesh.triangles {
            for side in 0..3 {
                let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
                let (p, q) = (mesh.positions[a as usize], mesh.positions[b as usize]);
                if p.distance(q) > longest {
                    middles.insert((a.min(b), a.max(b)), p.lerp(q, 0.5));
                }
            }
        }
        if middles.is_empty() || mesh.triangles.len() + 2 * middles.len() > most {
            break;
        }
        let first = mesh.positions.len() as u32;
        let numbers: BTreeMap<(u32, u32), u32> = middles.keys().copied().zip(first..).collect();
        mesh.positions.extend(middles.values());
        let halved = |t: &[u32; 3]| {
            let middle = |a: u32, b: u32| numbers.get(&(a.min(b), a.max(b))).copied();
            split(
                *t,
                [middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])],
            )
        };
        mesh.triangles = mesh.triangles.iter().flat_map(halved).collect();
    }
    mesh
}

/// A triangle whose sides have these middles, in parts.
fn split([a, b, c]: [u32; 3], middles: [Option<u32>; 3]) -> Vec<[u32; 3]> {
    match middles {
        [None, None, None] => vec![[a, b, c]],
        [Some(p), None, None] => vec![[a, p, c], [p, b, c]],
        [Some(p), Some(q), None] => vec![[p, b, q], [a, p, q], [a, q, c]],
        [Some(p), Some(q), Some(r)] => vec![[a, p, r], [p, b, q], [r, q, c], [p, q, r]],
        [x, y, z] => split([b, c, a], [y, z, x]),
    }
}
