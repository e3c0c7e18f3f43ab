//! Whether a mesh is a closed, orientable surface, and of which genus. Nothing is repaired here.

use super::{Mesh, MeshError, Point3};
use crate::index::Rows;
use crate::numeric::UnionFind;

/// How the triangles of a mesh hang together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshTopology {
    /// Parts that are connected through edges.
    pub components: usize,
    /// Edges with a triangle on one side only.
    pub open_edges: usize,
    /// Edges where more than two triangles meet, or two that face opposite ways.
    pub bad_edges: usize,
    /// Fans of triangles beyond the first at their corner.
    pub pinches: usize,
    /// The handles of all components together, where the mesh is closed: from V − E + F = 2·C − 2·g, pinched
    /// corners counted once for each fan.
    pub genus: Option<usize>,
}

/// A side of a triangle: its ends in ascending order, whether it runs so, the triangle and the side's number.
type Side = (u32, u32, bool, u32, u8);

impl Mesh {
    /// How the triangles hang together. Numbers of corners must exist. O(n log n).
    pub fn topology(&self) -> MeshTopology {
        self.examine().0
    }

    /// The topology of a mesh that is closed and orientable and has positive volume.
    ///
    /// # Errors
    /// The first property that it lacks.
    pub fn check_closed(&self) -> Result<MeshTopology, MeshError> {
        self.validate()?;
        let (topology, witness) = self.examine();
        let near = witness.unwrap_or_default();
        if topology.bad_edges > 0 {
            return Err(MeshError::NotManifold {
                edges: topology.bad_edges,
                near,
            });
        }
        if topology.open_edges > 0 {
            return Err(MeshError::Open {
                edges: topology.open_edges,
                near,
            });
        }
        if topology.pinches > 0 {
            return Err(MeshError::Pinched {
                corners: topology.pinches,
                near,
            });
        }
        match self.volume() {
            volume if volume > 0.0 => Ok(topology),
            volume => Err(MeshError::InsideOut { volume }),
        }
    }

    /// The parts that are connected through edges, in the order of their first triangles. O(n log n).
    pub fn components(&self) -> Vec<Mesh> {
        let sides = self.sides();
        let mut triangles = UnionFind::new(self.triangles.len());
        runs(&sides).for_each(|run| unite_triangles(&mut triangles, run));
        let part_of = triangles.labels();
        let mut parts: Vec<Mesh> = Vec::new();
        // Of every corner the first part that has it, and its number there; parts that are pinched together share corners.
        let mut first: Vec<(u32, u32)> = vec![(u32::MAX, 0); self.positions.len()];
        let mut shared = std::collections::BTreeMap::new();
        for (triangle, &number) in self.triangles.iter().zip(&part_of) {
            if number as usize == parts.len() {
                parts.push(Mesh::default());
            }
            let part = &mut parts[number as usize];
            let corners = triangle.map(|corner| {
                let mut next = || {
                    part.positions.push(self.positions[corner as usize]);
                    (part.positions.len() - 1) as u32
                };
                let known = &mut first[corner as usize];
                if known.0 == u32::MAX {
                    *known = (number, next());
                }
                if known.0 == number {
                    known.1
                } else {
                    *shared.entry((number, corner)).or_insert_with(next)
                }
            });
            part.triangles.push(corners);
        }
        parts
    }

    /// The sides of all triangles, sorted: those of one edge stand together. They are gathered by their lower ends
    /// first, where there are few each, so that this takes O(n) and not the time of a sort.
    fn sides(&self) -> Vec<Side> {
        let side = |number: u32| -> Side {
            let (triangle, i) = (number / 3, number % 3);
            let t = self.triangles[triangle as usize];
            let (a, b) = (t[i as usize], t[(i as usize + 1) % 3]);
            (a.min(b), a.max(b), a < b, triangle, i as u8)
        };
        let count = 3 * self.triangles.len();
        let rows = Rows::fill(self.positions.len(), |filler| {
            (0..count as u32).for_each(|number| filler.put(side(number).0 as usize, number));
        });
        let mut sides = Vec::with_capacity(count);
        for row in 0..rows.len() {
            let from = sides.len();
            sides.extend(rows.row(row).iter().map(|number| side(*number)));
            sides[from..].sort_unstable();
        }
        sides
    }

    /// The topology, and a place where it is not that of a closed surface.
    fn examine(&self) -> (MeshTopology, Option<Point3>) {
        let sides = self.sides();
        let mut triangles = UnionFind::new(self.triangles.len());
        let mut fans = UnionFind::new(3 * self.triangles.len());
        let mut topology = MeshTopology::default();
        let (mut edges, mut bad, mut open) = (0, None, None);
        for run in runs(&sides) {
            edges += 1;
            unite_triangles(&mut triangles, run);
            let middle =
                || self.positions[run[0].0 as usize].lerp(self.positions[run[0].1 as usize], 0.5);
            match *run {
                [one, other] if one.2 != other.2 && one.0 != one.1 => join(&mut fans, one, other),
                [_] => {
                    topology.open_edges += 1;
                    open.get_or_insert_with(middle);
                }
                _ => {
                    topology.bad_edges += 1;
                    bad.get_or_insert_with(middle);
                }
            }
        }
        topology.components = triangles.count();
        let (vertices, pinch) = self.count_fans(&mut fans, &mut topology);
        if topology.bad_edges == 0 && topology.open_edges == 0 {
            let characteristic = vertices as i64 - edges as i64 + self.triangles.len() as i64;
            topology.genus = usize::try_from(topology.components as i64 - characteristic / 2).ok();
        }
        (topology, bad.or(open).or(pinch))
    }

    /// How many fans there are; those beyond the first at their corner are noted, with a place of one.
    fn count_fans(
        &self,
        fans: &mut UnionFind,
        topology: &mut MeshTopology,
    ) -> (usize, Option<Point3>) {
        let mut seen = vec![false; self.positions.len()];
        let (mut count, mut pinch) = (0, None);
        for (at, &corner) in self.triangles.iter().flatten().enumerate() {
            if fans.find(at as u32) != at as u32 {
                continue;
            }
            count += 1;
            if std::mem::replace(&mut seen[corner as usize], true) {
                topology.pinches += 1;
                pinch.get_or_insert(self.positions[corner as usize]);
            }
        }
        (count, pinch)
    }
}

/// Puts the triangles at one edge into one set.
fn unite_triangles(triangles: &mut UnionFind, run: &[Side]) {
    for pair in run.windows(2) {
        triangles.unite(pair[0].3, pair[1].3);
    }
}

/// Puts the corners at both ends of an edge into one fan each.
fn join(fans: &mut UnionFind, one: Side, other: Side) {
    let ends = |side: Side| {
        let (first, second) = (
            3 * side.3 + u32::from(side.4),
            3 * side.3 + (u32::from(side.4) + 1) % 3,
        );
        if side.2 {
            [first, second]
        } else {
            [second, first]
        }
    };
    let ([a, b], [c, d]) = (ends(one), ends(other));
    fans.unite(a, c);
    fans.unite(b, d);
}

/// The sides of one edge after those of another.
fn runs(sides: &[Side]) -> impl Iterator<Item = &[Side]> {
    sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
}

#[cfg(test)]
mod tests {
    use super::super::tests::tetrahedron;
    use super::*;
    use crate::mesh::Affine3;

    /// A torus of n × m quads.
    pub fn torus(n: u32, m: u32) -> Mesh {
        let mut mesh = Mesh::default();
        for i in 0..n {
            for j in 0..m {
                let turn = |k: u32, of: u32| std::f64::consts::TAU * f64::from(k) / f64::from(of);
                let (u, v) = (turn(i, n), turn(j, m));
                let r = 3.0 + libm::cos(v);
                mesh.positions.push(Point3::new(
                    r * libm::cos(u),
                    r * libm::sin(u),
                    libm::sin(v),
                ));
                let at = |i: u32, j: u32| (i % n) * m + j % m;
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        mesh
    }

    #[test]
    fn handles_and_components_are_counted() {
        let mut mesh = torus(5, 4);
        let one = MeshTopology {
            components: 1,
            genus: Some(1),
            ..MeshTopology::default()
        };
        assert_eq!(mesh.check_closed(), Ok(one));
        mesh.append(&tetrahedron().transformed(&Affine3::translation(Point3::new(9.0, 0.0, 0.0))));
        mesh.append(&torus(3, 7).transformed(&Affine3::translation(Point3::new(0.0, 0.0, 9.0))));
        let three = MeshTopology {
            components: 3,
            genus: Some(2),
            ..MeshTopology::default()
        };
        assert_eq!(mesh.check_closed(), Ok(three));
        let parts = mesh.components();
        assert_eq!(
            parts.iter().map(|p| p.triangles.len()).collect::<Vec<_>>(),
            [40, 4, 42]
        );
        assert!((parts.iter().map(Mesh::volume).sum::<f64>() - mesh.volume()).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_closed_surface_is_told() {
        let mut open = tetrahedron();
        open.triangles.pop();
        assert!(matches!(
            open.check_closed(),
            Err(MeshError::Open { edges: 3, .. })
        ));
        assert_eq!(open.topology().genus, None);
        let mut turned = tetrahedron();
        turned.triangles[1].swap(0, 1);
        assert!(matches!(
            turned.check_closed(),
            Err(MeshError::NotManifold { edges: 3, .. })
        ));
        assert!(matches!(
            tetrahedron().reversed().check_closed(),
            Err(MeshError::InsideOut { .. })
        ));
        let mut doubled = tetrahedron();
        doubled.triangles.extend(tetrahedron().triangles);
        assert!(matches!(
            doubled.check_closed(),
            Err(MeshError::NotManifold { edges: 6, .. })
        ));
        let mut corner = tetrahedron();
        corner.triangles.push([1, 1, 2]);
        assert!(matches!(
            corner.check_closed(),
            Err(MeshError::NotManifold { .. })
        ));
    }

    #[test]
    fn bodies_that_touch_in_a_corner_are_pinched() {
        let mut mesh = tetrahedron();
        mesh.append(&tetrahedron().transformed(&Affine3::scale(Point3::new(-1.0, -1.0, -1.0))));
        assert_eq!(mesh.check_closed().map(|t| t.components), Ok(2));
        let error = mesh.welded().check_closed();
        assert_eq!(
            error,
            Err(MeshError::Pinched {
                corners: 1,
                near: Point3::ORIGIN
            })
        );
        assert_eq!(mesh.welded().topology().genus, Some(0));
    }
}
