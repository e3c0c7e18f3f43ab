//! The place of a mesh that is nearest to a point, by a tree of boxes over its triangles.

use super::{Bounds3, Mesh, Point3};

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
    /// Numbers of triangles, a leaf's ones together.
    order: Vec<u32>,
    /// The two halves of a node stand at 2·i + 1 and 2·i + 2.
    boxes: Vec<Bounds3>,
}

/// Triangles in a leaf, at most.
const LEAF: usize = 4;

impl<'a> Nearest<'a> {
    /// The tree of a mesh whose corners exist and are finite. O(n log² n).
    pub fn new(mesh: &'a Mesh) -> Nearest<'a> {
        let mut order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        let middles: Vec<Point3> = mesh
            .triangles
            .iter()
            .map(|&t| Bounds3::of(mesh.corners(t)).center())
            .collect();
        let mut boxes = Vec::new();
        let count = order.len();
        build(mesh, &middles, &mut order, 0, (0, count), &mut boxes);
        Nearest { mesh, order, boxes }
    }

    /// The nearest place to `p`; none of a mesh without triangles. Of equally near places the one on the triangle with the least
    /// number. O(log n) where the mesh is not much nearer than its triangles are large.
    pub fn foot(&self, p: Point3) -> Option<Foot> {
        let mut best: Option<Foot> = None;
        self.visit(p, 0, (0, self.order.len()), &mut best);
        best
    }

    fn visit(&self, p: Point3, node: usize, (from, to): (usize, usize), best: &mut Option<Foot>) {
        if from >= to || best.is_some_and(|b| gap(&self.boxes[node], p) > b.distance) {
            return;
        }
        if to - from <= LEAF {
            for &triangle in &self.order[from..to] {
                let at = on_triangle(p, self.mesh.corners(self.mesh.triangles[triangle as usize]));
                let distance = at.distance(p);
                let order = |b: &Foot| {
                    distance
                        .total_cmp(&b.distance)
                        .then(triangle.cmp(&b.triangle))
                };
                if best.as_ref().is_none_or(|b| order(b).is_lt()) {
                    *best = Some(Foot {
                        at,
                        triangle,
                        distance,
                    });
                }
            }
            return;
        }
        let middle = (from + to) / 2;
        let halves = [(2 * node + 1, (from, middle)), (2 * node + 2, (middle, to))];
        let left_first = gap(&self.boxes[halves[0].0], p) <= gap(&self.boxes[halves[1].0], p);
        for (child, range) in if left_first {
            halves
        } else {
            [halves[1], halves[0]]
        } {
            self.visit(p, child, range, best);
        }
    }
}

fn build(
    mesh: &Mesh,
    middles: &[Point3],
    order: &mut [u32],
    node: usize,
    (from, to): (usize, usize),
    boxes: &mut Vec<Bounds3>,
) {
    if boxes.len() <= node {
        boxes.resize(node + 1, Bounds3::EMPTY);
    }
    let corners = order[from..to]
        .iter()
        .flat_map(|&t| mesh.corners(mesh.triangles[t as usize]));
    boxes[node] = Bounds3::of(corners);
    if to - from <= LEAF {
        return;
    }
    let spread = Bounds3::of(order[from..to].iter().map(|&t| middles[t as usize])).size();
    let along = |t: u32| {
        let p = middles[t as usize];
        if spread.x >= spread.y && spread.x >= spread.z {
            p.x
        } else if spread.y >= spread.z {
            p.y
        } else {
            p.z
        }
    };
    order[from..to].sort_unstable_by(|&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
    let middle = (from + to) / 2;
    build(mesh, middles, order, 2 * node + 1, (from, middle), boxes);
    build(mesh, middles, order, 2 * node + 2, (middle, to), boxes);
}

/// The distance of `p` from a box.
fn gap(b: &Bounds3, p: Point3) -> f64 {
    let out = |low: f64, high: f64, v: f64| (low - v).max(v - high).max(0.0);
    Point3::new(
        out(b.min.x, b.max.x, p.x),
        out(b.min.y, b.max.y, p.y),
        out(b.min.z, b.max.z, p.z),
    )
    .length()
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
