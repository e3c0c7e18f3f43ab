//! Corners of a net put back where its triangles pass through one another.
//!
//! A net whose corners all lie in the middles of their cubes is the border of the cubes about the points inside, which
//! never meets itself where the body is well-composed. A corner that is where its crossings are may do so, where the
//! pattern is as fine as the lattice: it is put back step by step, with those of the triangles that it belongs to.

use fretwork_geometry::Mesh;
use fretwork_geometry::mesh::Surface;

use super::corner::Corner;

/// How deep a triangle passes through another one that counts, in spacings: what files round is less.
pub const DEPTH: f64 = 1e-4;
/// How far corners are moved towards the middles of their cubes, one round after the other.
const STEPS: [f64; 4] = [0.0, 0.4, 0.8, 1.0];
/// Rounds, at most: corners beside those that are put back may have to follow them.
const ROUNDS: usize = 10;

/// Moves corners of triangles that pass through others until there are none. The pairs that are left.
pub fn untangle(mesh: &mut Mesh, corners: &[Corner], spacing: f64) -> Vec<[u32; 2]> {
    let mut steps = vec![0; corners.len()];
    let mut pairs = Surface::new(mesh).overlaps(DEPTH * spacing);
    for _ in 0..ROUNDS {
        if pairs.is_empty() {
            break;
        }
        let mut tangled: Vec<u32> = pairs.into_iter().flatten().collect();
        tangled.sort_unstable();
        tangled.dedup();
        let of_triangle = |t: u32| mesh.triangles[t as usize];
        let mut is_moved = vec![false; corners.len()];
        let of_tangled = tangled.into_iter().flat_map(of_triangle);
        of_tangled.for_each(|corner| is_moved[corner as usize] = true);
        for corner in (0..corners.len()).filter(|corner| is_moved[*corner]) {
            let step: &mut usize = &mut steps[corner];
            let Corner { plain, middle, .. } = corners[corner];
            mesh.positions[corner] = plain.lerp(middle, STEPS[*step]);
            *step = (*step + 1).min(STEPS.len() - 1);
        }
        // All of each pair has moved: those of the triangles that did not move are none.
        let touches = |t: &u32| of_triangle(*t).iter().any(|c| is_moved[*c as usize]);
        let touched: Vec<u32> = (0..mesh.triangles.len() as u32).filter(touches).collect();
        pairs = Surface::new(mesh).overlaps_of(&touched, DEPTH * spacing);
    }
    pairs
}
