//! Whether meshes touch one another. Whether one passes through itself asks `overlap`; along curves that asks `crossing`,
//! which knows what is near along the curve.

use rayon::prelude::*;

use super::{Bounds3, Mesh};
use crate::Point3;
use crate::budget::{self, Meter};
use crate::index::{BoxTree, Extent};

/// The triangles of a mesh in a tree of boxes, for questions about what they touch.
pub struct Surface<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) tree: BoxTree<3>,
}

impl<'a> Surface<'a> {
    /// The surface of a mesh whose corners exist and are finite. O(n log n).
    pub fn new(mesh: &'a Mesh) -> Surface<'a> {
        Surface {
            mesh,
            tree: BoxTree::of(boxes(mesh)),
        }
    }

    /// Whether the two surfaces may have a point in common: false is certain where they are farther apart than rounding, and
    /// what is nearer counts as touching. One inside of the other, untouched, is apart. About O(n log n).
    ///
    /// ```
    /// use fretwork_geometry::{Affine3, Mesh, Point3, mesh::Surface};
    /// let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    /// let mesh = Mesh {
    ///     positions: corners.map(Point3::from).to_vec(),
    ///     triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    /// };
    /// let moved = |x: f64| mesh.transformed(&Affine3::translation(Point3::new(x, 0.2, 0.2)));
    /// assert!(Surface::new(&mesh).may_touch(&Surface::new(&moved(0.5))));
    /// // The boxes overlap, and the bodies do not.
    /// assert!(!Surface::new(&mesh).may_touch(&Surface::new(&moved(0.7))));
    /// ```
    pub fn may_touch(&self, other: &Surface) -> bool {
        let (few, many) = if self.tree.len() <= other.tree.len() {
            (self, other)
        } else {
            (other, self)
        };
        any(few.tree.len(), |i| {
            let own = few.mesh.corners(few.mesh.triangles[i]);
            let (mut near, mut touches) = (0, false);
            many.tree.for_meeting(&few.tree.boxes()[i], |j| {
                near += 1;
                let other = many.mesh.corners(many.mesh.triangles[j as usize]);
                touches = touches || !are_apart(own, other);
            });
            charge(near);
            touches
        })
    }
}

/// So many triangles are looked at in parallel before it is asked whether one of them was enough. What is charged for
/// must not depend on which thread is first.
const CHUNK: usize = 1 << 13;

/// Whether `holds` for a number below `count`.
pub(super) fn any(count: usize, holds: impl Fn(usize) -> bool + Sync) -> bool {
    let meter = Meter::current();
    let of_chunk = |from: usize| {
        let chunk = (from..count.min(from + CHUNK)).into_par_iter();
        let found = chunk.map(|i| meter.during(|| holds(i)));
        found.reduce(|| false, |a, b| a | b)
    };
    (0..count).step_by(CHUNK).any(of_chunk)
}

/// Charges for comparing a triangle with so many that are near.
pub(super) fn charge(near: u64) {
    budget::spend("triangles that may meet", 20 + 4 * near);
}

/// Charges `steps` steps for every pair of triangles of two meshes whose boxes meet. O(n log n + k) for k pairs, of
/// which no more are counted than the budget allows for.
pub fn charge_for_meetings(one: &Mesh, other: &Mesh, steps: u64) {
    let (few, many) = if one.triangles.len() <= other.triangles.len() {
        (one, other)
    } else {
        (other, one)
    };
    let tree = BoxTree::of(boxes(few));
    for view in boxes(many).iter().filter(|b| b.meets(tree.extent())) {
        let mut pairs = 0;
        tree.for_meeting(view, |_| pairs += 1);
        budget::spend("triangles that meet", steps * pairs);
    }
}

/// The boxes of all triangles.
fn boxes(mesh: &Mesh) -> Vec<Extent<3>> {
    let corners = mesh.triangles.par_iter().map(|&t| mesh.corners(t));
    corners.map(|t| Bounds3::of(t).into()).collect()
}

/// Rounding of a product of coordinates, as a part of it.
const ROUNDING: f64 = 1e-14;

/// Whether a plane between two triangles keeps them apart for certain. The separating axes are the two normals, the nine
/// products of their edges and, for triangles in one plane, the six directions square to an edge in it (Ericson, Real-Time
/// Collision Detection, 5.2.1).
pub(super) fn are_apart(s: [Point3; 3], t: [Point3; 3]) -> bool {
    let edges = |t: [Point3; 3]| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (e, f) = (edges(s), edges(t));
    let (m, n) = (e[0].cross(e[1]), f[0].cross(f[1]));
    let size = s.iter().chain(&t).map(|p| p.length()).fold(0.0, f64::max);
    let separates = |axis: Point3| {
        let range = |t: [Point3; 3]| {
            let at = t.map(|p| axis.dot(p));
            (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]))
        };
        let ((low, high), (other_low, other_high)) = (range(s), range(t));
        let slack = ROUNDING * size * axis.length();
        low > other_high + slack || other_low > high + slack
    };
    separates(m)
        || separates(n)
        || e.iter().any(|u| separates(m.cross(*u)))
        || f.iter().any(|v| separates(n.cross(*v)))
        || e.iter().any(|u| f.iter().any(|v| separates(u.cross(*v))))
}

#[cfg(test)]
mod tests {
    use super::super::crossing::passage;
    use super::super::tests::tetrahedron;
    use super::*;
    use crate::{Affine3, Seed};

    fn moved(mesh: &Mesh, x: f64, y: f64, z: f64) -> Mesh {
        mesh.transformed(&Affine3::translation(Point3::new(x, y, z)))
    }

    #[test]
    fn triangles_that_cross_are_never_apart() {
        let seed = Seed::root(11);
        let (mut crossing, mut apart) = (0, 0);
        for case in 0..4000 {
            let number = |k: u64| seed.range(20 * case + k, 0.0, 1.0);
            let point = |k: u64| Point3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2));
            let (s, t) = ([0, 1, 2].map(point), [3, 4, 5].map(point));
            let pass =
                |s: [Point3; 3], t| (0..3).any(|i| passage(s[i], s[(i + 1) % 3], t, 0.0).is_some());
            let crosses = pass(s, t) || pass(t, s);
            assert_eq!(are_apart(s, t), !crosses, "case {case}");
            crossing += usize::from(crosses);
            apart += usize::from(!crosses);
        }
        assert!(crossing > 500 && apart > 500);
    }

    #[test]
    fn triangles_in_one_plane_are_apart_where_they_do_not_overlap() {
        let flat = |x: f64| [[x, 0., 0.], [x + 1., 0., 0.], [x, 1., 0.]].map(Point3::from);
        assert!(are_apart(flat(0.0), flat(1.1)));
        assert!(!are_apart(flat(0.0), flat(0.5)));
    }

    #[test]
    fn what_is_inside_untouched_is_apart() {
        let outer = tetrahedron().transformed(&Affine3::scale(Point3::new(9.0, 9.0, 9.0)));
        let inner = moved(&tetrahedron(), 1.0, 1.0, 1.0);
        assert!(!Surface::new(&outer).may_touch(&Surface::new(&inner)));
        assert!(Surface::new(&outer).may_touch(&Surface::new(&moved(&inner, -1.0, 0.0, 0.0))));
    }
}
