//! Where a mesh passes through itself or lies on itself, as files are checked for.

use rayon::prelude::*;

use super::contact::{any, charge};
use super::crossing::passage;
use super::{Surface, doubled_normal};
use crate::Point3;
use crate::budget::Meter;

impl Surface<'_> {
    /// Whether the surface clearly passes through itself or lies on itself, deeper than `depth`: an edge goes through a
    /// triangle from one side to the other, or two triangles in one plane that face the same way overlap. Contacts that
    /// are less deep, such as rounding leaves where bodies were cut, and faces that lie back to back do not count. About
    /// O(n log n).
    pub fn overlaps_itself(&self, depth: f64) -> bool {
        let normals = self.normals();
        let is_after = |i: u32, j: u32| j > i;
        any(self.tree.len(), |i| {
            let found = self.overlapping(i, (&normals, depth), is_after);
            !found.is_empty()
        })
    }

    /// The pairs of triangles, in order, for which that is so. About O(n log n) but for the pairs.
    pub fn overlaps(&self, depth: f64) -> Vec<[u32; 2]> {
        let all: Vec<u32> = (0..self.tree.len() as u32).collect();
        self.overlaps_of(&all, depth)
    }

    /// Those of the pairs that hold one of the `wanted` triangles, which ascend. About O(n log n) for n of these.
    pub fn overlaps_of(&self, wanted: &[u32], depth: f64) -> Vec<[u32; 2]> {
        let normals = self.normals();
        let meter = Meter::current();
        let mut is_wanted = vec![false; self.tree.len()];
        wanted.iter().for_each(|i| is_wanted[*i as usize] = true);
        let counts = |i: u32, j: u32| j > i || (j < i && !is_wanted[j as usize]);
        let of = |&i: &u32| {
            let found = meter.during(|| self.overlapping(i as usize, (&normals, depth), counts));
            found.into_iter().map(move |j| [i.min(j), i.max(j)])
        };
        let mut pairs: Vec<[u32; 2]> = wanted.par_iter().flat_map_iter(of).collect();
        pairs.sort_unstable();
        pairs
    }

    /// The unit normals of all triangles; none of one without area.
    fn normals(&self) -> Vec<Point3> {
        let triangles = self.mesh.triangles.par_iter();
        triangles
            .map(|t| doubled_normal(self.mesh.corners(*t)).unit())
            .map(Option::unwrap_or_default)
            .collect()
    }

    /// The triangles that count beside the `i`-th and that it overlaps. Most whose boxes meet lie on one side of one
    /// another, but for where they touch, which two normals tell at once.
    fn overlapping(
        &self,
        i: usize,
        (normals, depth): (&[Point3], f64),
        counts: impl Fn(u32, u32) -> bool,
    ) -> Vec<u32> {
        let heights = |s: usize, t: usize| {
            let (normal, at) = (normals[s], self.mesh.corners(self.mesh.triangles[s])[0]);
            let other = self.mesh.corners(self.mesh.triangles[t]);
            let [a, b, c] = other.map(|p| normal.dot(p - at));
            (a.min(b).min(c), a.max(b).max(c))
        };
        let is_beside = |(low, high): (f64, f64)| low > 0.0 || high < 0.0;
        let is_through = |(low, high): (f64, f64)| low < -depth && high > depth;
        let s = self.mesh.triangles[i];
        let (mut near, mut found) = (0, Vec::new());
        self.tree.for_meeting(&self.tree.boxes()[i], |number| {
            near += 1;
            let j = number as usize;
            let t = self.mesh.triangles[j];
            if !counts(i as u32, number) {
                return;
            }
            let shared = shared_corners(s, t);
            if shared > 1 {
                return;
            }
            let both = [heights(i, j), heights(j, i)];
            // Without a side that passes through, only triangles in one plane overlap.
            let may_overlap = shared == 0 || both.into_iter().any(is_through);
            if may_overlap && !both.into_iter().any(is_beside) && self.overlap(s, t, depth) {
                found.push(number);
            }
        });
        charge(near);
        found.sort_unstable();
        found
    }

    /// Whether two triangles that share one corner at most overlap deeper than `depth`.
    fn overlap(&self, s: [u32; 3], t: [u32; 3], depth: f64) -> bool {
        let shared = shared_corners(s, t);
        let (s, t) = (self.mesh.corners(s), self.mesh.corners(t));
        let through = |s: [Point3; 3], t: [Point3; 3]| {
            (0..3).any(|i| {
                passage(s[i], s[(i + 1) % 3], t, depth).is_some_and(|at| is_deep(at, t, depth))
            })
        };
        through(s, t) || through(t, s) || (shared == 0 && lies_on(s, t, depth))
    }
}

fn shared_corners(s: [u32; 3], t: [u32; 3]) -> usize {
    s.iter().filter(|corner| t.contains(corner)).count()
}

/// Whether a point in the plane of a triangle is farther inside than `depth` from all sides.
fn is_deep(at: Point3, t: [Point3; 3], depth: f64) -> bool {
    let Some(normal) = (t[1] - t[0]).cross(t[2] - t[0]).unit() else {
        return false;
    };
    (0..3).all(|i| {
        let side = t[(i + 1) % 3] - t[i];
        normal.dot(side.cross(at - t[i])) > depth * side.length()
    })
}

/// Whether two triangles lie in one plane, face the same way and overlap deeper than `depth`.
fn lies_on(s: [Point3; 3], t: [Point3; 3], depth: f64) -> bool {
    let normal = |t: [Point3; 3]| (t[1] - t[0]).cross(t[2] - t[0]).unit();
    let (Some(m), Some(n)) = (normal(s), normal(t)) else {
        return false;
    };
    let is_flat = s.iter().all(|p| n.dot(*p - t[0]).abs() <= depth);
    if m.dot(n) <= 0.0 || !is_flat {
        return false;
    }
    // In the plane they overlap unless a side of one has all of the other beyond it.
    let is_beyond = |s: [Point3; 3], t: [Point3; 3]| {
        (0..3).any(|i| {
            let side = t[(i + 1) % 3] - t[i];
            let inward = n.cross(side);
            let reach = depth * side.length();
            s.iter().all(|p| inward.dot(*p - t[i]) <= reach)
        })
    };
    !is_beyond(s, t) && !is_beyond(t, s)
}

#[cfg(test)]
mod tests {
    use super::super::Mesh;
    use super::super::tests::tetrahedron;
    use super::*;
    use crate::{Affine3, Seed};

    fn moved(mesh: &Mesh, x: f64, y: f64, z: f64) -> Mesh {
        mesh.transformed(&Affine3::translation(Point3::new(x, y, z)))
    }

    #[test]
    fn bodies_that_overlap_or_lie_on_one_another_are_told_from_those_that_touch() {
        let one = tetrahedron();
        let with = |other: Mesh| {
            let mut mesh = one.clone();
            mesh.append(&other);
            Surface::new(&mesh).overlaps_itself(1e-9)
        };
        assert!(!Surface::new(&one).overlaps_itself(1e-9));
        assert!(with(moved(&one, 0.2, 0.1, 0.1)));
        assert!(
            with(moved(&one, 0.2, 0.1, 0.0)),
            "their lower faces overlap in one plane"
        );
        assert!(!with(moved(&one, 5.0, 0.0, 0.0)));
        // Less deep than what is asked for.
        assert!(!with(moved(&one, 0.0, 0.0, -1.0 + 1e-12)));
    }

    /// The pairs are those that the plain test finds among all, also where they are asked for in parts.
    #[test]
    fn the_pairs_that_overlap_agree_with_trying_all() {
        let seed = Seed::root(12);
        let number = |k: u64| seed.range(k, 0.0, 3.0);
        let point = |k: u64| Point3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2));
        // Every third corner is shared by the triangles of a fan, and some triangles lie in one plane.
        let flat = |p: Point3| Point3::new(p.x, p.y, 1.0);
        let positions: Vec<Point3> = (0..120)
            .map(|k| if k % 4 == 0 { flat(point(k)) } else { point(k) })
            .collect();
        let corner = |k: u64| seed.range(1000 + k, 0.0, 120.0) as u32;
        let triangles: Vec<[u32; 3]> = (0..90u64)
            .map(|t| match t % 3 {
                0 => [3 * t, 3 * t + 1, 3 * t + 2].map(|k| 4 * (k % 30) as u32),
                _ => [3 * t, 3 * t + 1, 3 * t + 2].map(corner),
            })
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let mesh = Mesh {
            positions,
            triangles,
        };
        let surface = Surface::new(&mesh);
        let count = mesh.triangles.len() as u32;
        let mut all = Vec::new();
        for i in 0..count {
            for j in i + 1..count {
                let [s, t] = [i, j].map(|n| mesh.triangles[n as usize]);
                if shared_corners(s, t) < 2 && surface.overlap(s, t, 1e-6) {
                    all.push([i, j]);
                }
            }
        }
        assert!(all.len() > 100, "{}", all.len());
        assert_eq!(surface.overlaps(1e-6), all);
        let some: Vec<u32> = (0..count).filter(|i| i % 5 < 2).collect();
        let holds = |pair: &&[u32; 2]| pair.iter().any(|i| some.contains(i));
        let of_some: Vec<[u32; 2]> = all.iter().filter(holds).copied().collect();
        assert_eq!(surface.overlaps_of(&some, 1e-6), of_some);
    }
}
