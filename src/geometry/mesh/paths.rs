//! Ways over a mesh: short ones from place to place, and straight ones from triangle to triangle.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::nearest::Foot;
use super::{Mesh, Point3};

/// The edges of a mesh, and points along them that ways lead through.
pub struct Paths<'a> {
    mesh: &'a Mesh,
    /// The ends of each edge, in ascending order.
    edges: Vec<[u32; 2]>,
    /// The edges of each triangle: the one from its first corner first.
    sides: Vec<[u32; 3]>,
    /// The triangles at each edge, up to two; `u32::MAX` for none.
    beside: Vec<[u32; 2]>,
    /// The places that ways lead through: the corners, then points along edges.
    places: Vec<Point3>,
    /// For each edge its first point in `places`; the next edge's is behind its last.
    along: Vec<u32>,
    /// The triangles at each corner: those of corner `c` stand from `starts[c]` to `starts[c + 1]`.
    starts: Vec<u32>,
    around: Vec<u32>,
}

/// Edges longer than this part of the mesh get points along them.
const STEP: f64 = 1.0 / 60.0;
/// Points along an edge, at most.
const MOST: f64 = 24.0;
/// Triangles that a straight way crosses, at most.
const LONGEST_WALK: usize = 4096;

impl<'a> Paths<'a> {
    /// The ways over a mesh whose corners exist; corners in one place must be one.
    pub fn new(mesh: &'a Mesh) -> Paths<'a> {
        let side = |t: &[u32; 3], i: usize| [t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3])];
        let mut edges: Vec<[u32; 2]> = mesh
            .triangles
            .iter()
            .flat_map(|t| (0..3).map(move |i| side(t, i)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let number = |edge: [u32; 2]| edges.binary_search(&edge).unwrap_or(0) as u32;
        let sides: Vec<[u32; 3]> = mesh
            .triangles
            .iter()
            .map(|t| std::array::from_fn(|i| number(side(t, i))))
            .collect();
        let mut beside = vec![[u32::MAX; 2]; edges.len()];
        for (triangle, sides) in (0..).zip(&sides) {
            for &edge in sides {
                if let Some(free) = beside[edge as usize].iter_mut().find(|t| **t == u32::MAX) {
                    *free = triangle;
                }
            }
        }
        let mut paths = Paths {
            mesh,
            edges,
            sides,
            beside,
            places: mesh.positions.clone(),
            along: Vec::new(),
            starts: Vec::new(),
            around: Vec::new(),
        };
        paths.divide();
        (paths.starts, paths.around) = super::normals::triangles_around(mesh);
        paths
    }

    fn divide(&mut self) {
        let step = self.mesh.bounds().longest_side() * STEP;
        for &[a, b] in &self.edges {
            self.along.push(self.places.len() as u32);
            let (a, b) = (
                self.mesh.positions[a as usize],
                self.mesh.positions[b as usize],
            );
            let parts = if step > 0.0 {
                (a.distance(b) / step).clamp(1.0, MOST + 1.0) as u32
            } else {
                1
            };
            self.places
                .extend((1..parts).map(|i| a.lerp(b, f64::from(i) / f64::from(parts))));
        }
        self.along.push(self.places.len() as u32);
    }

    /// The places on the border of a triangle.
    fn border(&self, triangle: u32) -> impl Iterator<Item = u32> {
        let corners = self.mesh.triangles[triangle as usize];
        let points = self.sides[triangle as usize]
            .map(|e| self.along[e as usize]..self.along[e as usize + 1]);
        corners.into_iter().chain(points.into_iter().flatten())
    }

    /// The triangles that a place belongs to.
    fn triangles_at(&self, place: u32) -> impl Iterator<Item = u32> {
        let corner = (place as usize) < self.mesh.positions.len();
        let range = if corner {
            self.starts[place as usize]..self.starts[place as usize + 1]
        } else {
            0..0
        };
        let edge = if corner {
            None
        } else {
            Some(self.along.partition_point(|&first| first <= place) - 1)
        };
        let beside = edge.map_or([u32::MAX; 2], |e| self.beside[e]);
        self.around[range.start as usize..range.end as usize]
            .iter()
            .copied()
            .chain(beside.into_iter().filter(|&t| t != u32::MAX))
    }

    /// A short way from one place of the mesh to another (Dijkstra 1959, over points on the edges; Lanthier, Maheshwari,
    /// Sack 2001): its points with both ends. None when there is no way.
    pub fn short(&self, from: &Foot, to: &Foot) -> Option<Vec<Point3>> {
        if from.triangle == to.triangle {
            return Some(vec![from.at, to.at]);
        }
        let mut lengths = vec![f64::INFINITY; self.places.len()];
        let mut before = vec![u32::MAX; self.places.len()];
        let mut queue = BinaryHeap::new();
        let at = |place: u32| self.places[place as usize];
        for place in self.border(from.triangle) {
            let length = at(place).distance(from.at);
            lengths[place as usize] = length;
            queue.push(Reverse((length.to_bits(), place)));
        }
        let mut last = vec![false; self.places.len()];
        self.border(to.triangle)
            .for_each(|place| last[place as usize] = true);
        let mut best: (f64, Option<u32>) = (f64::INFINITY, None);
        while let Some(Reverse((bits, place))) = queue.pop() {
            // Lengths are not negative: their bits are in their order.
            let length = f64::from_bits(bits);
            if length >= best.0 {
                break;
            }
            if length > lengths[place as usize] {
                continue;
            }
            if last[place as usize] && length + at(place).distance(to.at) < best.0 {
                best = (length + at(place).distance(to.at), Some(place));
            }
            for next in self.triangles_at(place).flat_map(|t| self.border(t)) {
                let longer = length + at(place).distance(at(next));
                if longer < lengths[next as usize] {
                    lengths[next as usize] = longer;
                    before[next as usize] = place;
                    queue.push(Reverse((longer.to_bits(), next)));
                }
            }
        }
        let mut way = vec![to.at];
        let mut place = best.1?;
        while place != u32::MAX {
            way.push(at(place));
            place = before[place as usize];
        }
        way.push(from.at);
        way.reverse();
        Some(way)
    }

    /// The places where the straight way from one place to another, in the plane that also holds the normal, crosses
    /// edges. None when that plane leads elsewhere.
    pub fn crossings(&self, from: &Foot, to: &Foot) -> Option<Vec<Point3>> {
        let way = to.at - from.at;
        let normal = |t: u32| {
            super::doubled_normal(self.mesh.corners(self.mesh.triangles[t as usize])).unit()
        };
        let up = normal(from.triangle)? + normal(to.triangle)?;
        let plane = way.cross(up).unit()?;
        let (mut triangle, mut came) = (from.triangle, u32::MAX);
        let mut found: Vec<Point3> = Vec::new();
        while triangle != to.triangle {
            let ahead = self.sides[triangle as usize]
                .into_iter()
                .filter(|&e| e != came)
                .filter_map(|edge| {
                    let [a, b] = self.edges[edge as usize].map(|c| self.mesh.positions[c as usize]);
                    let (x, y) = (plane.dot(a - from.at), plane.dot(b - from.at));
                    let crossing = a.lerp(b, if x == y { 0.5 } else { x / (x - y) });
                    ((x <= 0.0) != (y <= 0.0))
                        .then(|| ((crossing - from.at).dot(way), edge, crossing))
                });
            let (_, edge, at) = ahead.max_by(|a, b| a.0.total_cmp(&b.0))?;
            let beyond = self.beside[edge as usize]
                .into_iter()
                .find(|&t| t != triangle && t != u32::MAX)?;
            if found.len() > LONGEST_WALK || (at - from.at).dot(way) > 1.5 * way.dot(way) {
                return None;
            }
            found.push(at);
            (triangle, came) = (beyond, edge);
        }
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::nearest::Nearest;

    /// A grid of squares in two triangles each, in the plane z = 0.
    fn sheet(n: u32) -> Mesh {
        let at = |i: u32, j: u32| i * (n + 1) + j;
        let positions = (0..=n)
            .flat_map(|i| (0..=n).map(move |j| Point3::new(f64::from(i), f64::from(j), 0.0)))
            .collect();
        let squares = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let triangles = squares
            .flat_map(|(i, j)| {
                [
                    [at(i, j), at(i + 1, j), at(i + 1, j + 1)],
                    [at(i, j), at(i + 1, j + 1), at(i, j + 1)],
                ]
            })
            .collect();
        Mesh {
            positions,
            triangles,
        }
    }

    #[test]
    fn ways_over_a_flat_sheet_are_nearly_straight() {
        let mesh = sheet(12);
        let (tree, paths) = (Nearest::new(&mesh), Paths::new(&mesh));
        let foot = |x: f64, y: f64| tree.foot(Point3::new(x, y, 1.0)).unwrap();
        let (a, b) = (foot(0.3, 0.2), foot(11.3, 7.9));
        let way = paths.short(&a, &b).unwrap();
        let length: f64 = way.windows(2).map(|w| w[0].distance(w[1])).sum();
        let straight = a.at.distance(b.at);
        assert!(
            length >= straight && length < 1.01 * straight,
            "{length} {straight}"
        );
        let crossed = paths.crossings(&a, &b).unwrap();
        assert!(crossed.len() > 20);
        for p in crossed {
            let t = (p - a.at).dot(b.at - a.at) / straight / straight;
            assert!(p.distance(a.at.lerp(b.at, t)) < 1e-12);
        }
    }

    #[test]
    fn there_is_no_way_between_two_meshes() {
        let mut mesh = sheet(2);
        let mut other = sheet(2);
        other.positions.iter_mut().for_each(|p| p.z = 5.0);
        mesh.append(&other);
        let (tree, paths) = (Nearest::new(&mesh), Paths::new(&mesh));
        let foot = |z: f64| tree.foot(Point3::new(0.5, 1.2, z)).unwrap();
        assert_eq!(paths.short(&foot(0.0), &foot(5.0)), None);
    }
}
