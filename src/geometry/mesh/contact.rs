//! Whether meshes touch: one another, or themselves. Along curves that asks `crossing`, which knows what is near along
//! the curve.

use rayon::prelude::*;

use super::crossing::passage;
use super::{Bounds3, Mesh, doubled_normal};
use crate::Point3;
use crate::budget::{self, Meter};
use crate::index::{BoxTree, Extent};

/// The triangles of a mesh in a tree of boxes, for questions about what they touch.
pub struct Surface<'a> {
    mesh: &'a Mesh,
    boxes: Vec<Extent<3>>,
    tree: BoxTree<3>,
}

impl<'a> Surface<'a> {
    /// The surface of a mesh whose corners exist and are finite. O(n log n).
    pub fn new(mesh: &'a Mesh) -> Surface<'a> {
        let boxes = boxes(mesh);
        Surface {
            mesh,
            tree: BoxTree::new(&boxes),
            boxes,
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
        let (few, many) = if self.boxes.len() <= other.boxes.len() {
            (self, other)
        } else {
            (other, self)
        };
        any(few.boxes.len(), |i| {
            let own = few.mesh.corners(few.mesh.triangles[i]);
            let (mut near, mut touches) = (0, false);
            many.tree.for_meeting(&few.boxes[i], |j| {
                near += 1;
                let other = many.mesh.corners(many.mesh.triangles[j as usize]);
                touches = touches || !are_apart(own, other);
            });
            charge(near);
            touches
        })
    }

    /// Whether the surface clearly passes through itself or lies on itself, deeper than `depth`: an edge goes through a
    /// triangle from one side to the other, or two triangles in one plane that face the same way overlap. Contacts that
    /// are less deep, such as rounding leaves where bodies were cut, and faces that lie back to back do not count. About
    /// O(n log n).
    pub fn overlaps_itself(&self, depth: f64) -> bool {
        let normals = self.normals();
        any(self.boxes.len(), |i| {
            !self.overlapping(i, &normals, depth).is_empty()
        })
    }

    /// The pairs of triangles, in order, for which that is so. About O(n log n) but for the pairs.
    pub fn overlaps(&self, depth: f64) -> Vec<[u32; 2]> {
        let normals = self.normals();
        let meter = Meter::current();
        let of = |i: usize| {
            let found = meter.during(|| self.overlapping(i, &normals, depth));
            found.into_iter().map(move |j| [i as u32, j])
        };
        (0..self.boxes.len())
            .into_par_iter()
            .flat_map_iter(of)
            .collect()
    }

    /// A place where the two triangles of such a pair overlap deeper than `depth`; none of another pair.
    pub fn place_of_overlap(&self, pair: [u32; 2], depth: f64) -> Option<Point3> {
        let [s, t] = pair.map(|number| self.mesh.triangles[number as usize]);
        self.overlap(s, t, depth)
    }

    fn normals(&self) -> Vec<Point3> {
        let triangles = self.mesh.triangles.par_iter();
        triangles
            .map(|t| doubled_normal(self.mesh.corners(*t)))
            .collect()
    }

    /// The triangles after the `i`-th that it overlaps. Most whose boxes meet lie on one side of one another, which two
    /// normals tell at once.
    fn overlapping(&self, i: usize, normals: &[Point3], depth: f64) -> Vec<u32> {
        let is_beside = |s: usize, t: usize| {
            let (normal, at) = (normals[s], self.mesh.corners(self.mesh.triangles[s])[0]);
            let other = self.mesh.corners(self.mesh.triangles[t]);
            let heights = other.map(|p| normal.dot(p - at));
            heights.iter().all(|h| *h > 0.0) || heights.iter().all(|h| *h < 0.0)
        };
        let s = self.mesh.triangles[i];
        let (mut near, mut found) = (0, Vec::new());
        self.tree.for_meeting(&self.boxes[i], |number| {
            near += 1;
            let j = number as usize;
            let t = self.mesh.triangles[j];
            let overlaps = j > i
                && shared_corners(s, t) < 2
                && !is_beside(i, j)
                && !is_beside(j, i)
                && self.overlap(s, t, depth).is_some();
            if overlaps {
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

/// So many triangles are looked at in parallel before it is asked whether one of them was enough. What is charged for
/// must not depend on which thread is first.
const CHUNK: usize = 1 << 13;

/// Whether `holds` for a number below `count`.
fn any(count: usize, holds: impl Fn(usize) -> bool + Sync) -> bool {
    let meter = Meter::current();
    let of_chunk = |from: usize| {
        let chunk = (from..count.min(from + CHUNK)).into_par_iter();
        let found = chunk.map(|i| meter.during(|| holds(i)));
        found.reduce(|| false, |a, b| a | b)
    };
    (0..count).step_by(CHUNK).any(of_chunk)
}

/// Charges for comparing a triangle with so many that are near.
fn charge(near: u64) {
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
    let tree = BoxTree::new(&boxes(few));
    for view in boxes(many).iter().filter(|b| b.meets(tree.extent())) {
        let mut pairs = 0;
        tree.for_meeting(view, |_| pairs += 1);
        budget::spend("triangles that meet", steps * pairs);
    }
}

/// The boxes of all triangles.
fn boxes(mesh: &Mesh) -> Vec<Extent<3>> {
    let corners = mesh.triangles.iter().map(|&t| mesh.corners(t));
    corners.map(|t| Bounds3::of(t).into()).collect()
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

/// Rounding of a product of coordinates, as a part of it.
const ROUNDING: f64 = 1e-14;

/// Whether a plane between two triangles keeps them apart for certain. The separating axes are the two normals, the nine
/// products of their edges and, for triangles in one plane, the six directions square to an edge in it (Ericson, Real-Time
/// Collision Detection, 5.2.1).
fn are_apart(s: [Point3; 3], t: [Point3; 3]) -> bool {
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

    #[test]
    fn triangles_in_one_plane_are_apart_where_they_do_not_overlap() {
        let flat = |x: f64| [[x, 0., 0.], [x + 1., 0., 0.], [x, 1., 0.]].map(Point3::from);
        assert!(are_apart(flat(0.0), flat(1.1)));
        assert!(!are_apart(flat(0.0), flat(0.5)));
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

    /// All edges that pass through a face do so on its diagonal.
    #[test]
    fn boxes_that_cross_on_the_diagonals_of_their_faces_overlap() {
        let cube = |from: f64| {
            let corner = |i: usize| {
                Point3::from([0, 1, 2].map(|axis| from + f64::from((i >> axis & 1) as u8)))
            };
            let sides = [
                [0, 2, 3, 1],
                [4, 5, 7, 6],
                [0, 1, 5, 4],
                [2, 6, 7, 3],
                [0, 4, 6, 2],
                [1, 3, 7, 5],
            ];
            let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]];
            Mesh {
                positions: (0..8).map(corner).collect(),
                triangles: sides.iter().flat_map(halves).collect(),
            }
        };
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

    #[test]
    fn what_is_inside_untouched_is_apart() {
        let outer = tetrahedron().transformed(&Affine3::scale(Point3::new(9.0, 9.0, 9.0)));
        let inner = moved(&tetrahedron(), 1.0, 1.0, 1.0);
        assert!(!Surface::new(&outer).may_touch(&Surface::new(&inner)));
        assert!(Surface::new(&outer).may_touch(&Surface::new(&moved(&inner, -1.0, 0.0, 0.0))));
    }
}
