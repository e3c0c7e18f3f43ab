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

    /// A place where the two triangles of such a pair overlap deeper than `depth`; none of another pair.
    pub fn place_of_overlap(&self, pair: [u32; 2], depth: f64) -> Option<Point3> {
        let [s, t] = pair.map(|number| self.mesh.triangles[number as usize]);
        self.overlap(s, t, depth)
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
            if may_overlap
                && !both.into_iter().any(is_beside)
                && self.overlap(s, t, depth).is_some()
            {
                found.push(number);
            }
        });
        charge(near);
        found.sort_unstable();
        found
    }

    /// Where two triangles that share one corner at most overlap deeper than `depth`, if they do.
    fn overlap(&self, s: [u32; 3], t: [u32; 3], depth: f64) -> Option<Point3> {
        let shared = shared_corners(s, t);
        let (s, t) = (self.mesh.corners(s), self.mesh.corners(t));
        let through = |s: [Point3; 3], t: [Point3; 3]| {
            let mut passages = (0..3).filter_map(|i| passage(s[i], s[(i + 1) % 3], t, depth));
            passages.find(|at| is_deep(*at, t, depth))
        };
        let on_it = || (shared == 0 && lies_on(s, t, depth)).then(|| common(s, t));
        let edges = through(s, t).or_else(|| through(t, s));
        edges.or_else(|| cut(s, t, depth)).or_else(on_it)
    }
}

/// The middle of the line along which two triangles cut one another, where it is farther inside of both than `depth` and each
/// reaches that far to both sides of the other. So crossings are found whose edges pass just between two triangles of a face.
fn cut(s: [Point3; 3], t: [Point3; 3], depth: f64) -> Option<Point3> {
    let [m, n] = [doubled_normal(s).unit()?, doubled_normal(t).unit()?];
    let way = m.cross(n).unit()?;
    let [(a, b), (c, d)] = [
        on_plane(s, (t[0], n), (way, depth))?,
        on_plane(t, (s[0], m), (way, depth))?,
    ];
    let at = |p: Point3| way.dot(p - a);
    let (from, to) = (at(c).max(0.0), at(d).min(at(b)));
    let middle = a + way * (0.5 * (from + to));
    let is_inside = from < to && is_deep(middle, s, depth) && is_deep(middle, t, depth);
    is_inside.then_some(middle)
}

/// The two ends, along `way`, of the line along which a plane cuts a triangle that reaches farther than `depth` to both sides
/// of it; none of another triangle.
fn on_plane(
    s: [Point3; 3],
    (origin, normal): (Point3, Point3),
    (way, depth): (Point3, f64),
) -> Option<(Point3, Point3)> {
    let heights = s.map(|p| normal.dot(p - origin));
    let reaches = heights.iter().any(|h| *h > depth) && heights.iter().any(|h| *h < -depth);
    if !reaches {
        return None;
    }
    let edges = (0..3).map(|i| (i, (i + 1) % 3));
    let passing = edges.filter(|&(i, j)| (heights[i] > 0.0) != (heights[j] > 0.0));
    let mut ends = passing.map(|(i, j)| s[i].lerp(s[j], heights[i] / (heights[i] - heights[j])));
    let (one, other) = (ends.next()?, ends.next()?);
    Some(match way.dot(other - one) > 0.0 {
        true => (one, other),
        false => (other, one),
    })
}

/// A place near both of two triangles that lie on one another: the middle of the smaller one.
fn common(s: [Point3; 3], t: [Point3; 3]) -> Point3 {
    let area = |t: [Point3; 3]| doubled_normal(t).length();
    let [a, b, c] = if area(s) <= area(t) { s } else { t };
    (a + b + c) * (1.0 / 3.0)
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
    use super::super::contact::are_apart;
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
                if shared_corners(s, t) < 2 && surface.overlap(s, t, 1e-6).is_some() {
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

    /// Loose triangles at random, every pair compared.
    #[test]
    fn overlaps_are_those_that_all_pairs_have() {
        let seed = Seed::root(5);
        let number = |k: u64, from: f64, to: f64| seed.range(k, from, to);
        let mut mesh = Mesh::default();
        for t in 0..400u64 {
            let place = |k: u64| {
                Point3::new(
                    number(k, 0.0, 9.0),
                    number(k + 1, 0.0, 9.0),
                    number(k + 2, 0.0, 9.0),
                )
            };
            let middle = place(20 * t);
            let size = number(20 * t + 3, 0.1, 2.5);
            let corner = |k: u64| {
                middle + (place(20 * t + 4 + 3 * k) - Point3::new(4.5, 4.5, 4.5)) * (size / 9.0)
            };
            mesh.positions.extend([corner(0), corner(1), corner(2)]);
            mesh.triangles.push([0, 1, 2].map(|i| 3 * t as u32 + i));
        }
        let corners = |i: u32| mesh.corners(mesh.triangles[i as usize]);
        let count = mesh.triangles.len() as u32;
        let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| [i, j]));
        let all: Vec<[u32; 2]> = pairs
            .filter(|[i, j]| !are_apart(corners(*i), corners(*j)))
            .collect();
        assert!(all.len() > 50, "{}", all.len());
        let surface = Surface::new(&mesh);
        assert_eq!(surface.overlaps(1e-12), all);
        for pair in all {
            let at = surface.place_of_overlap(pair, 1e-12).unwrap();
            let [near, far] =
                pair.map(|i| crate::mesh::nearest::on_triangle(at, corners(i)).distance(at));
            assert!(near.max(far) < 1e-9, "{pair:?}: {near}, {far}");
        }
    }

    /// All edges that pass through a face do so on its diagonal.
    #[test]
    fn boxes_that_cross_on_the_diagonals_of_their_faces_overlap() {
        let at = |v: f64| Point3::new(v, v, v);
        let cube = |from: f64| Mesh::cuboid(at(from), at(from + 1.0));
        let with = |from: f64| {
            let mut mesh = cube(0.0);
            mesh.append(&cube(from));
            let surface = Surface::new(&mesh);
            let pairs = surface.overlaps(1e-9);
            pairs
                .first()
                .and_then(|pair| surface.place_of_overlap(*pair, 1e-9))
        };
        let at = with(0.5).unwrap();
        let is_on = |low: f64| {
            let all = [at.x, at.y, at.z].map(|v| v - low);
            all.iter().all(|v| (0.0..=1.0).contains(v))
                && all.iter().any(|v| *v == 0.0 || *v == 1.0)
        };
        assert!(is_on(0.0) && is_on(0.5), "{at:?}");
        assert_eq!(with(1.0), None, "they touch in a corner");
    }
}
