//! The place of a mesh that is nearest to a point, by a tree of boxes over its triangles.

use super::{Bounds3, Mesh, Point3};
use crate::index::{BoxTree, Extent};

/// Rounding of the square of a distance, as a part of it.
const ROUNDING: f64 = 1e-12;

/// A place on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Where it is.
    pub at: Point3,
    /// The number of a triangle that it lies on.
    pub triangle: u32,
    /// Its distance from the point that was asked for.
    pub distance: f64,
}

/// The triangles of a mesh in a tree of boxes.
pub struct Nearest<'a> {
    mesh: &'a Mesh,
    tree: BoxTree<3>,
}

impl<'a> Nearest<'a> {
    /// The tree of a mesh whose corners exist and are finite. O(n log n).
    pub fn new(mesh: &'a Mesh) -> Nearest<'a> {
        let boxes: Vec<Extent<3>> = mesh
            .triangles
            .iter()
            .map(|&t| Bounds3::of(mesh.corners(t)).into())
            .collect();
        Nearest {
            mesh,
            tree: BoxTree::of(boxes),
        }
    }

    /// The nearest place to `p`; none of a mesh without triangles. Of equally near places the one on the triangle with the least
    /// number. O(log n) where the mesh is not much nearer than its triangles are large.
    pub fn foot(&self, p: Point3) -> Option<Foot> {
        self.search(p, None)
    }

    /// What [`Nearest::foot`] gives, sooner where the triangle `near` is near to `p`, as the one that was found for a
    /// neighbour of it.
    pub fn foot_from(&self, p: Point3, near: u32) -> Option<Foot> {
        let is_known = (near as usize) < self.mesh.triangles.len();
        self.search(p, is_known.then(|| self.foot_on(p, near)))
    }

    /// The nearest foot, where `best` is one of them. A node is passed by only where it is farther away by more than
    /// rounding, so that what is found does not depend on the order in which nodes are looked at.
    fn search(&self, p: Point3, mut best: Option<Foot>) -> Option<Foot> {
        let here = Extent::from([p.x, p.y, p.z]);
        let bound = |extent: &Extent<3>, _| Some(extent.squared_distance(&here));
        let reach = |b: Foot| b.distance * b.distance * (1.0 + ROUNDING);
        let start = best.map_or(f64::INFINITY, reach);
        self.tree.nearest_first(bound, start, |triangle| {
            let foot = self.foot_on(p, triangle);
            let order = |b: &Foot| {
                let by_distance = foot.distance.total_cmp(&b.distance);
                by_distance.then(triangle.cmp(&b.triangle))
            };
            if best.as_ref().is_none_or(|b| order(b).is_lt()) {
                best = Some(foot);
            }
            best.map_or(f64::INFINITY, reach)
        });
        best
    }

    fn foot_on(&self, p: Point3, triangle: u32) -> Foot {
        let at = on_triangle(p, self.mesh.corners(self.mesh.triangles[triangle as usize]));
        Foot {
            at,
            triangle,
            distance: at.distance(p),
        }
    }
}

/// The place of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5: by Voronoi regions).
pub fn on_triangle(p: Point3, [a, b, c]: [Point3; 3]) -> Point3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    if sum > 0.0 {
        a + ab * (vb / sum) + ac * (vc / sum)
    } else {
        a
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    #[test]
    fn the_tree_agrees_with_trying_all_triangles() {
        let seed = Seed::root(8);
        let point = |n: u64, size: f64| {
            Point3::new(
                seed.range(3 * n, -size, size),
                seed.range(3 * n + 1, -size, size),
                seed.range(3 * n + 2, -size, size),
            )
        };
        let positions: Vec<Point3> = (0..300).map(|n| point(n, 5.0)).collect();
        let triangles: Vec<[u32; 3]> = (0..100).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mesh = Mesh {
            positions,
            triangles,
        };
        let tree = Nearest::new(&mesh);
        for n in 1000..1200 {
            let p = point(n, 9.0);
            let all = mesh
                .triangles
                .iter()
                .map(|&t| on_triangle(p, mesh.corners(t)).distance(p))
                .fold(f64::INFINITY, f64::min);
            let foot = tree.foot(p).unwrap();
            assert_eq!(foot.distance, all);
            let from = |near: u64| tree.foot_from(p, near as u32).unwrap();
            assert_eq!([from(n % 100), from(n)], [foot, foot]);
            let corners = mesh.corners(mesh.triangles[foot.triangle as usize]);
            assert!(on_triangle(foot.at, corners).distance(foot.at) < 1e-9);
        }
        assert_eq!(Nearest::new(&Mesh::default()).foot(Point3::ORIGIN), None);
    }

    #[test]
    fn the_nearest_place_of_a_triangle_is_in_all_its_regions() {
        let t = [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]].map(Point3::from);
        for (p, q) in [
            ([1., 1., 5.], [1., 1., 0.]),
            ([-1., -2., 1.], [0., 0., 0.]),
            ([9., -1., 0.], [4., 0., 0.]),
            ([2., -3., 1.], [2., 0., 0.]),
            ([3., 3., 0.], [2., 2., 0.]),
            ([-1., 2., 0.], [0., 2., 0.]),
        ] {
            assert_eq!(on_triangle(p.into(), t), Point3::from(q));
        }
    }
}
